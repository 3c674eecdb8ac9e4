//! The dead man's switch: a timer interrupt that turns everything off when the core isn't heard of in time, whatever became of the
//! executor and its tasks (S3, S9). The core says how long it may be silent; nothing is decided here.

use crate::{reset, shell};
use core::sync::atomic::{AtomicU32, Ordering};
use cortex_m::peripheral::NVIC;
use embassy_stm32::{
    interrupt,
    pac::{Interrupt, RCC, TIM7},
};
use zygote_protocol::Micros;

/// Until then nothing need be heard of the core, in milliseconds that wrap around; [`NEVER`] while nothing is energised.
static DEAD_LINE: AtomicU32 = AtomicU32::new(NEVER);
const NEVER: u32 = u32::MAX;
/// The timer's clock is 84 MHz at most: 42,000 counts of 2 ticks are a millisecond or more.
const PRESCALER: u16 = 1;
const PERIOD: u16 = 42_000 - 1;

/// Sets the time by which the core must be heard of again.
pub(crate) fn set(dead_line: Option<Micros>) {
    // The one value that means never is a millisecond early.
    let line = dead_line.map_or(NEVER, |line| millis(line).min(NEVER - 1));
    DEAD_LINE.store(line, Ordering::Relaxed);
}

/// Starts the interrupt.
#[expect(
    unsafe_code,
    reason = "unmasking an interrupt whose handler stands below, and that no critical section relies on"
)]
pub(crate) fn watch() {
    RCC.apb1enr().modify(|enable| enable.set_tim7en(true));
    TIM7.psc().write_value(PRESCALER);
    TIM7.arr().write(|reload| reload.set_arr(PERIOD));
    TIM7.dier().write(|enable| enable.set_uie(true));
    TIM7.cr1().write(|control| control.set_cen(true));
    unsafe { NVIC::unmask(Interrupt::TIM7) };
}

#[interrupt]
fn TIM7() {
    TIM7.sr().write(|status| status.set_uif(false));
    let line = DEAD_LINE.load(Ordering::Relaxed);
    // Past, if it lies in the half of the circle behind now.
    if line != NEVER && millis(shell::now()).wrapping_sub(line) < u32::MAX / 2 {
        reset::dead_man();
    }
}

#[expect(clippy::cast_possible_truncation, reason = "milliseconds that wrap around")]
fn millis(time: Micros) -> u32 {
    (time.0 / 1000) as u32
}
