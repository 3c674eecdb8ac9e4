//! Between core and servo bus: the pulses that are wanted, and the pin that lets pulses out at all.
//!
//! The core's side shuts the gate at once, whatever the bus does (S3, S8). The bus opens it, and only when the chip
//! has been told exactly what is wanted now: stale pulses never come out.

use crate::board::SERVOS;
use core::{cell::RefCell, sync::atomic::AtomicBool, sync::atomic::Ordering};
use critical_section::Mutex;
use embassy_stm32::gpio::Output;
use zygote_core::PulseMicros;

/// A pulse for each servo, or none.
pub(crate) type Pulses = [Option<PulseMicros>; SERVOS];

/// No pulse at all.
pub(crate) const NO_PULSES: Pulses = [None; SERVOS];

struct Gate {
    /// Low lets pulses out.
    enable: Option<Output<'static>>,
    wanted: Pulses,
}

static GATE: Mutex<RefCell<Gate>> = Mutex::new(RefCell::new(Gate { enable: None, wanted: NO_PULSES }));
/// Until the chip has answered for the first time it counts as lost.
static LOST: AtomicBool = AtomicBool::new(true);

/// Gives the gate its pin, which is high.
pub(crate) fn install(enable: Output<'static>) {
    with(|gate| gate.enable = Some(enable));
}

/// What the core wants from now on; shuts the gate if that is nothing.
pub(crate) fn want(pulses: &Pulses) {
    with(|gate| {
        gate.wanted = *pulses;
        if *pulses == NO_PULSES {
            gate.shut();
        }
    });
}

/// What the core wants.
pub(crate) fn wanted() -> Pulses {
    with(|gate| gate.wanted)
}

/// The chip has been told these pulses: opens the gate, if they are still what is wanted.
pub(crate) fn told(pulses: &Pulses) {
    LOST.store(false, Ordering::Relaxed);
    with(|gate| {
        if gate.wanted == *pulses && *pulses != NO_PULSES {
            if let Some(enable) = &mut gate.enable {
                enable.set_low();
            }
        }
    });
}

/// The chip can't be relied on: shuts the gate and lets the core know.
pub(crate) fn lose() {
    LOST.store(true, Ordering::Relaxed);
    with(Gate::shut);
}

/// The chip can't be relied on.
pub(crate) fn is_lost() -> bool {
    LOST.load(Ordering::Relaxed)
}

impl Gate {
    fn shut(&mut self) {
        if let Some(enable) = &mut self.enable {
            enable.set_high();
        }
    }
}

fn with<R>(verb: impl FnOnce(&mut Gate) -> R) -> R {
    critical_section::with(|token| verb(&mut GATE.borrow_ref_mut(token)))
}
