//! Everything that a board calls of the core, with inputs that the compiler cannot see. The panic handler calls what is nowhere to be
//! found: were a panic left anywhere in core, link or codec, this would not link. It never runs.
#![no_std]
#![no_main]

use core::hint::black_box;
use core::sync::atomic::AtomicU8;
use zygote_core::{Config, Core, Inputs};
use zygote_protocol::{MAX_ENCODED, Micros, Milliamps, Millivolts, Retained, Snapshot};

/// As many channels as a board of 16 heaters with 16 servos and 16 springs has.
type AnyCore = Core<16, 16, 16, 48>;

/// The RAM of one core.
static RAM: [AtomicU8; size_of::<AnyCore>()] = [const { AtomicU8::new(0) }; size_of::<AnyCore>()];

#[expect(unsafe_code, reason = "a name that the linker looks for and must not find")]
unsafe extern "C" {
    safe fn a_panic_is_left_in_the_core() -> !;
}

#[panic_handler]
fn panic(_: &core::panic::PanicInfo<'_>) -> ! {
    a_panic_is_left_in_the_core()
}

/// A value that the compiler must take for possible.
fn any<T>() -> Option<T> {
    black_box(None)
}

/// What a board does with its core.
#[expect(unsafe_code, reason = "the linker finds the entry by its name")]
#[unsafe(no_mangle)]
extern "C" fn main() -> ! {
    black_box(&RAM);
    let mut out = [0; MAX_ENCODED];
    loop {
        let now = || Micros(black_box(1));
        if let Some(config) = any::<Config>() {
            let mut core = AnyCore::new(config, now(), any::<Snapshot>());
            loop {
                core.handle_bytes(now(), black_box(&[]));
                core.tick(
                    now(),
                    &Inputs {
                        thermistors: black_box(&[]),
                        supply: Millivolts(black_box(1)),
                        current: Milliamps(black_box(1)),
                        stop_pressed: black_box(false),
                        servos_lost: false,
                    },
                );
                black_box(core.poll_transmit(now(), black_box(&mut out)));
                black_box((core.outputs(), core.dead_line(), core.changes(), core.poll_timeout(now())));
                black_box(Retained::new(&core.snapshot(now())).to_words());
                black_box(Retained::from_words(&black_box([0; zygote_protocol::RETAINED_WORDS])).recall());
            }
        }
    }
}
