//! Everything that a board calls of the core, each call an entry of its own, with inputs that the compiler cannot see. The panic
//! handler calls what is nowhere to be found: were a panic left anywhere in core, link or codec, this would not link.
//!
//! No board runs it: the emulator calls the entries one by one and counts (`sim/emulator/src/bin/figures`).
#![no_std]
#![no_main]

mod call;
mod config;

use call::{CHANNELS, Call};
use core::mem::MaybeUninit;
use core::sync::atomic::AtomicU32;
use zygote_core::{Core, Inputs};
use zygote_protocol::{Micros, Milliamps, Millivolts, Retained, Snapshot};

/// As many channels as a board of 16 heaters with 16 servos and 16 springs has.
type AnyCore = Core<CHANNELS, CHANNELS, CHANNELS, { 3 * CHANNELS }>;

/// RAM for something; the emulator finds it by its name.
#[repr(align(8))]
struct Room<const WORDS: usize>([AtomicU32; WORDS]);

impl<const WORDS: usize> Room<WORDS> {
    const fn new() -> Self {
        Self([const { AtomicU32::new(0) }; WORDS])
    }
}

const fn words<T>() -> usize {
    size_of::<T>().div_ceil(size_of::<u32>())
}

#[expect(unsafe_code, reason = "the emulator finds it by its name")]
#[unsafe(no_mangle)]
static FIGURES_CORE: Room<{ words::<AnyCore>() }> = Room::new();

/// What goes in and out.
#[expect(unsafe_code, reason = "the emulator finds it by its name")]
#[unsafe(no_mangle)]
static FIGURES_CALL: Room<{ words::<Call>() }> = Room::new();

#[expect(unsafe_code, reason = "a name that the linker looks for and must not find")]
unsafe extern "C" {
    safe fn a_panic_is_left_in_the_core() -> !;
}

#[panic_handler]
fn panic(_: &core::panic::PanicInfo<'_>) -> ! {
    a_panic_is_left_in_the_core()
}

/// A core after a reset, with what `call` says was kept over it.
#[expect(unsafe_code, reason = "the linker finds the entry by its name")]
#[unsafe(no_mangle)]
extern "C" fn figures_new(core: &mut MaybeUninit<AnyCore>, call: &mut Call) {
    let before = Retained::from_words(&call.retained).recall();
    restore(build(core, call, before));
}

/// By itself, so that a whole new core and what is kept don't lie on the stack at once.
#[inline(never)]
fn build<'a>(core: &'a mut MaybeUninit<AnyCore>, call: &Call, before: Option<Snapshot>) -> &'a mut AnyCore {
    core.write(AnyCore::new(config::config(call.boot), Micros(call.now), before))
}

/// As [`build`].
#[inline(never)]
fn restore(core: &mut AnyCore) {
    core.restore(config::kept());
}

#[expect(unsafe_code, reason = "the linker finds the entry by its name")]
#[unsafe(no_mangle)]
extern "C" fn figures_handle_bytes(core: &mut AnyCore, call: &mut Call) {
    let length = usize::try_from(call.length).unwrap_or(0);
    core.handle_bytes(Micros(call.now), call.bytes.get(..length).unwrap_or_default());
}

#[expect(unsafe_code, reason = "the linker finds the entry by its name")]
#[unsafe(no_mangle)]
extern "C" fn figures_tick(core: &mut AnyCore, call: &mut Call) {
    let inputs = Inputs {
        thermistors: &call.thermistors,
        supply: Millivolts(call.supply),
        current: Milliamps(call.current),
        stop_pressed: call.stop_pressed != 0,
        servos_lost: false,
    };
    core.tick(Micros(call.now), &inputs);
}

#[expect(unsafe_code, reason = "the linker finds the entry by its name")]
#[unsafe(no_mangle)]
extern "C" fn figures_poll_transmit(core: &mut AnyCore, call: &mut Call) {
    let length = core.poll_transmit(Micros(call.now), &mut call.bytes);
    call.length = u32::try_from(length).unwrap_or(0);
}

/// What a board does after each call: what the actuators are to do, and until when.
#[expect(unsafe_code, reason = "the linker finds the entry by its name")]
#[unsafe(no_mangle)]
extern "C" fn figures_apply(core: &mut AnyCore, call: &mut Call) {
    let outputs = core.outputs();
    call.main_switch = outputs.main_switch.into();
    for (to, from) in call.heaters.iter_mut().zip(outputs.heaters) {
        *to = from.per_mille();
    }
    for (to, from) in call.servos.iter_mut().zip(outputs.servos) {
        *to = from.map_or(0, |pulse| pulse.0);
    }
    for (to, from) in call.springs.iter_mut().zip(outputs.springs) {
        *to = from.into();
    }
    call.changes = core.changes();
    call.dead_line = core.dead_line().map_or(u64::MAX, |at| at.0);
    call.due = core.poll_timeout(Micros(call.now)).map_or(u64::MAX, |at| at.0);
}

/// What a board does whenever [`Core::changes`] is another.
#[expect(unsafe_code, reason = "the linker finds the entry by its name")]
#[unsafe(no_mangle)]
extern "C" fn figures_keep(core: &mut AnyCore, call: &mut Call) {
    call.retained = Retained::new(&core.snapshot(Micros(call.now))).to_words();
}

/// What a board does with what is to be kept: writes them down, says so, and knows them after the next start. Not counted, for nothing is
/// energised then.
#[expect(unsafe_code, reason = "the linker finds the entry by its name")]
#[unsafe(no_mangle)]
extern "C" fn figures_settings(core: &mut AnyCore, call: &mut Call) {
    if let Some(kept) = core.to_store().cloned() {
        core.stored(call.stop_pressed != 0);
        core.restore(kept);
    }
}
