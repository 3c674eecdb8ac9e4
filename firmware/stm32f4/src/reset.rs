//! Before and after a reset: why the chip started, a number for this start, what is kept, and the ways a program ends.

use crate::safe_state;
use core::{
    panic::PanicInfo,
    sync::atomic::{AtomicU32, Ordering},
};
use cortex_m::peripheral::SCB;
use embassy_stm32::pac::RCC;
use zygote_protocol::{RETAINED_WORDS, ResetCause, Retained, Snapshot};

/// Counts starts. Survives every reset but a power failure, after which it starts anywhere.
#[expect(unsafe_code, reason = "the section is left alone by the start-up code; any bits are a valid u32")]
#[unsafe(link_section = ".uninit.STARTS")]
static STARTS: AtomicU32 = AtomicU32::new(0);

/// What the core was doing, as of its latest change; whole or told by its checksum not to be.
#[expect(unsafe_code, reason = "the section is left alone by the start-up code; any bits are valid")]
#[unsafe(link_section = ".uninit.RETAINED")]
static RETAINED: [AtomicU32; RETAINED_WORDS] = [const { AtomicU32::new(0) }; RETAINED_WORDS];

/// [`DEAD_MAN`] after the dead man's switch, anything else after other resets.
#[expect(unsafe_code, reason = "the section is left alone by the start-up code; any bits are a valid u32")]
#[unsafe(link_section = ".uninit.MARK")]
static MARK: AtomicU32 = AtomicU32::new(0);
const DEAD_MAN: u32 = 0xdead_a11f;

/// Keeps what the core is doing for after a reset.
pub(crate) fn keep(snapshot: &Snapshot) {
    for (kept, word) in RETAINED.iter().zip(Retained::new(snapshot).to_words()) {
        kept.store(word, Ordering::Relaxed);
    }
}

/// What was kept before this start; gone after it was asked for, so that no later start takes it for its own.
pub(crate) fn kept() -> Option<Snapshot> {
    let words = core::array::from_fn(|at| RETAINED.get(at).map_or(0, |word| word.swap(0, Ordering::Relaxed)));
    Retained::from_words(&words).recall()
}

/// Everything off and a new start, by the dead man's switch.
pub(crate) fn dead_man() -> ! {
    safe_state::all_off();
    MARK.store(DEAD_MAN, Ordering::Relaxed);
    SCB::sys_reset();
}

/// A number that differs from that of the start before, and by chance from all others: a count that any reset but a power failure
/// leaves alone, spread over all bits, and noise.
pub(crate) fn chance(noise: u32) -> u32 {
    let starts = STARTS.load(Ordering::Relaxed).wrapping_add(1);
    STARTS.store(starts, Ordering::Relaxed);
    starts.wrapping_mul(0x9e37_79b9) ^ noise
}

/// Why the chip started; clears the flags, so that the next start reads its own.
pub(crate) fn cause() -> ResetCause {
    let flags = RCC.csr().read();
    RCC.csr().modify(|flags| flags.set_rmvf(true));
    let marked = MARK.swap(0, Ordering::Relaxed) == DEAD_MAN;
    // Every reset also pulls the pin, and power-on sets the brown-out flag: from the special to the common.
    if flags.wdgrstf() || flags.wwdgrstf() {
        ResetCause::Watchdog
    } else if flags.sftrstf() && marked {
        ResetCause::DeadMan
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
