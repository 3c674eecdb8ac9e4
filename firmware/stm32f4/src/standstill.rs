//! Time goes on while the flash is written and the processor stands still.
//!
//! The clock, TIM5, has sixteen bits and an interrupt at every half turn, 33 ms. Erasing takes up to 0.8 s, code and all: half turns
//! would be missed, and the clock would be behind for good and, missing an odd number of them, jump back by a turn now and then. So it
//! is stopped meanwhile, and the time is taken by TIM2, which has 32 bits.

use core::cell::Cell;
use critical_section::Mutex;
use embassy_stm32::pac::{RCC, TIM2, TIM5};

/// How long the clock has been stopped so far, in microseconds.
static STOPPED: Mutex<Cell<u64>> = Mutex::new(Cell::new(0));

/// How long the clock has been stopped so far, in microseconds.
pub(crate) fn stopped_us() -> u64 {
    critical_section::with(|cs| STOPPED.borrow(cs).get())
}

/// Does what may halt the processor, for an hour at the most.
pub(crate) fn through<R>(work: impl FnOnce() -> R) -> R {
    start_stopwatch();
    TIM5.cr1().modify(|control| control.set_cen(false));
    TIM2.cr1().modify(|control| control.set_cen(true));
    let result = work();
    TIM2.cr1().modify(|control| control.set_cen(false));
    TIM5.cr1().modify(|control| control.set_cen(true));
    let time = u64::from(TIM2.cnt().read());
    critical_section::with(|cs| {
        let stopped = STOPPED.borrow(cs);
        stopped.set(stopped.get() + time);
    });
    result
}

/// From 0, in microseconds as the clock's.
fn start_stopwatch() {
    RCC.apb1enr().modify(|enable| enable.set_tim2en(true));
    TIM2.psc().write_value(TIM5.psc().read());
    TIM2.arr().write_value(u32::MAX);
    // The prescaler is taken over, and the count is 0.
    TIM2.egr().write(|event| event.set_ug(true));
}
