//! The stop button as an interrupt: supply and servo signals are cut within microseconds, whatever the tasks do, and
//! the core is told in its next tick, even if the button bounced or was pressed for an instant only (S8).

use crate::safe_state;
use core::sync::atomic::{AtomicBool, Ordering};
use embassy_stm32::pac::{EXTI, Interrupt, RCC, SYSCFG};

/// An edge that the core hasn't been told of.
static PRESSED: AtomicBool = AtomicBool::new(false);

/// The edge that pressing makes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Edge {
    /// Pressed is high.
    Rising,
    /// Pressed is low.
    Falling,
}

/// Starts the interrupt of pin `line` of a port (0 is A), whose handler in the board calls [`on_edge`].
#[expect(unsafe_code, reason = "unmasking an interrupt that no critical section relies on")]
pub fn watch(port: u8, line: u8, edge: Edge, interrupt: Interrupt) {
    let pin = usize::from(line);
    RCC.apb2enr().modify(|enable| enable.set_syscfgen(true));
    SYSCFG.exticr(pin / 4).modify(|source| source.set_exti(pin % 4, port));
    EXTI.ftsr(0).modify(|edges| edges.set_line(pin, edge == Edge::Falling));
    EXTI.rtsr(0).modify(|edges| edges.set_line(pin, edge == Edge::Rising));
    EXTI.imr(0).modify(|mask| mask.set_line(pin, true));
    unsafe { cortex_m::peripheral::NVIC::unmask(interrupt) };
}

/// What the interrupt's handler does.
pub fn on_edge(line: u8) {
    EXTI.pr(0).write(|pending| pending.set_line(line.into(), true));
    safe_state::cut();
    PRESSED.store(true, Ordering::Relaxed);
}

/// Whether the button was pressed since this was last asked.
pub(crate) fn was_pressed() -> bool {
    PRESSED.swap(false, Ordering::Relaxed)
}
