//! The pin that lets servo pulses out, and what is wanted of it: written by the core's side, read by the bus's.
//!
//! The core's side shuts it at once, whatever the bus does (S3, S8); `zygote_parts::ServoGate` says when it may open.

use core::{cell::RefCell, sync::atomic::AtomicBool, sync::atomic::Ordering};
use critical_section::Mutex;
use embassy_stm32::gpio::Output;
use zygote_parts::{Pulses, ServoGate, Wanted};

struct Pin {
    gate: ServoGate,
    /// Low lets pulses out.
    enable: Option<Output<'static>>,
}

static PIN: Mutex<RefCell<Pin>> = Mutex::new(RefCell::new(Pin { gate: ServoGate::new(), enable: None }));
/// Until the chip has answered for the first time it counts as lost.
static LOST: AtomicBool = AtomicBool::new(true);

/// Gives the gate its pin, which is high.
pub(crate) fn install(enable: Output<'static>) {
    with(|pin| pin.enable = Some(enable));
}

/// What the core wants from now on; shuts the gate if that is nothing.
pub(crate) fn want(pulses: &Pulses) {
    with(|pin| {
        if pin.gate.want(pulses) {
            pin.shut();
        }
    });
}

/// What the core wants.
pub(crate) fn wanted() -> Wanted {
    with(|pin| pin.gate.wanted())
}

/// The chip is there and was told this: opens the gate, if that is still good.
pub(crate) fn told(told: &Wanted) {
    LOST.store(false, Ordering::Relaxed);
    with(|pin| {
        if pin.gate.may_open(told)
            && let Some(enable) = &mut pin.enable
        {
            enable.set_low();
        }
    });
}

/// The chip is there, and has no pulses yet.
pub(crate) fn found() {
    LOST.store(false, Ordering::Relaxed);
}

/// The chip can't be relied on: shuts the gate and lets the core know.
pub(crate) fn lose() {
    LOST.store(true, Ordering::Relaxed);
    with(Pin::shut);
}

/// The chip can't be relied on.
pub(crate) fn is_lost() -> bool {
    LOST.load(Ordering::Relaxed)
}

impl Pin {
    fn shut(&mut self) {
        if let Some(enable) = &mut self.enable {
            enable.set_high();
        }
    }
}

fn with<R>(verb: impl FnOnce(&mut Pin) -> R) -> R {
    critical_section::with(|token| verb(&mut PIN.borrow_ref_mut(token)))
}
