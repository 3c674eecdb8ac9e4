//! The core with its pins: the one thing that the tasks share. Each call goes to the core and then applies
//! what it decided, so that no decision waits for another task.

use crate::{
    actuators::Actuators,
    board::{HEATERS, SERVOS, SPRINGS, STEPS},
    dead_man,
    memory::Keeping,
    reset, standstill,
};
use core::cell::RefCell;
use embassy_sync::{
    blocking_mutex::{Mutex, raw::NoopRawMutex},
    signal::Signal,
};
use embassy_time::Instant;
use zygote_core::{Core, Inputs};
use zygote_protocol::Micros;

/// The core of this board.
pub(crate) type BoardCore = Core<HEATERS, SERVOS, SPRINGS, STEPS>;

/// The core, the actuators, and the core's changes that are kept for after a reset; for tasks of one executor.
pub(crate) struct Shell {
    inner: Mutex<NoopRawMutex, RefCell<(BoardCore, Actuators, Keeping, u32)>>,
    /// Set when the core may have something to say to the host.
    pub(crate) speak: Signal<NoopRawMutex, ()>,
}

impl Shell {
    pub(crate) const fn new(core: BoardCore, actuators: Actuators, keeping: Keeping) -> Self {
        Self { inner: Mutex::new(RefCell::new((core, actuators, keeping, 0))), speak: Signal::new() }
    }

    /// Bytes from the host.
    pub(crate) fn receive(&self, bytes: &[u8]) {
        self.call(|core| core.handle_bytes(now(), bytes));
        self.speak.signal(());
    }

    /// Bytes for the host; their number, 0 when there is nothing to say.
    pub(crate) fn transmit(&self, out: &mut [u8]) -> usize {
        self.call(|core| core.poll_transmit(now(), out))
    }

    /// One control tick.
    pub(crate) fn tick(&self, inputs: &Inputs<'_>) {
        self.call(|core| core.tick(now(), inputs));
        self.speak.signal(());
    }

    fn call<R>(&self, verb: impl FnOnce(&mut BoardCore) -> R) -> R {
        self.inner.lock(|inner| {
            let (core, actuators, keeping, kept) = &mut *inner.borrow_mut();
            let result = verb(core);
            actuators.apply(core.outputs());
            dead_man::set(core.dead_line());
            if let Some(kept) = core.to_store() {
                let is_stored = keeping.keep(kept);
                core.stored(is_stored);
            }
            let changes = core.changes();
            if changes != *kept {
                *kept = changes;
                reset::keep(&core.snapshot(now()));
            }
            result
        })
    }
}

/// Time since the start.
pub(crate) fn now() -> Micros {
    Micros(Instant::now().as_micros() + standstill::stopped_us())
}
