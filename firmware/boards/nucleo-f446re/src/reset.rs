//! Before and after a reset: why the chip started, a number for this start, and the ways a program ends.

use crate::safe_state;
use core::{
    panic::PanicInfo,
    sync::atomic::{AtomicU32, Ordering},
};
use cortex_m::peripheral::SCB;
use embassy_stm32::pac::RCC;
use zygote_protocol::ResetCause;

/// Counts starts. Survives every reset but a power failure, after which it starts anywhere.
#[expect(unsafe_code, reason = "the section is left alone by the start-up code; any bits are a valid u32")]
#[unsafe(link_section = ".uninit.STARTS")]
static STARTS: AtomicU32 = AtomicU32::new(0);

/// A number that differs from that of the start before: the count in the lower half, `noise` in the upper.
pub(crate) fn boot_id(noise: u16) -> u32 {
    let starts = STARTS.load(Ordering::Relaxed).wrapping_add(1);
    STARTS.store(starts, Ordering::Relaxed);
    u32::from(noise) << 16 | starts & 0xffff
}

/// Why the chip started; clears the flags, so that the next start reads its own.
pub(crate) fn cause() -> ResetCause {
    let flags = RCC.csr().read();
    RCC.csr().modify(|flags| flags.set_rmvf(true));
    // Every reset also pulls the pin, and power-on sets the brown-out flag: from the special to the common.
    if flags.wdgrstf() || flags.wwdgrstf() {
        ResetCause::Watchdog
    } else if flags.sftrstf() {
        ResetCause::Software
    } else if flags.porrstf() || flags.borrstf() || flags.lpwrrstf() {
        ResetCause::Power
    } else if flags.padrstf() {
        ResetCause::Pin
    } else {
        ResetCause::Unknown
    }
}

/// A panic: outputs off, a word for the debugger, reset into S1.
#[panic_handler]
fn panic(info: &PanicInfo) -> ! {
    cortex_m::interrupt::disable();
    safe_state::all_off();
    defmt::error!("{}", defmt::Display2Format(info));
    SCB::sys_reset();
}

/// A hard fault, and every fault that became one: outputs off, reset into S1.
#[allow(unsafe_code, reason = "the exception table asks for it")]
#[cortex_m_rt::exception]
unsafe fn HardFault(_frame: &cortex_m_rt::ExceptionFrame) -> ! {
    safe_state::all_off();
    SCB::sys_reset();
}

/// An interrupt that nobody has bound: the same end.
#[allow(unsafe_code, reason = "the exception table asks for it")]
#[cortex_m_rt::exception]
unsafe fn DefaultHandler(_interrupt: i16) {
    safe_state::all_off();
    SCB::sys_reset();
}
