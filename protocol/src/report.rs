//! What an MCU tells a host unasked: events and faults, which arrive for sure, and telemetry, which may not.

use crate::{CentiCelsius, FaultCode, Micros, Milliamps, Millivolts, Response, State};
use heapless::Vec;
use postcard_schema::Schema;
use serde::{Deserialize, Serialize};

/// Motions that one [`Telemetry`] shows at the most.
pub const TELEMETRY_MOTIONS: usize = 8;

/// Everything that goes from MCU to host in order and exactly once.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, Schema)]
pub enum Report {
    /// The answer to a request.
    Response(Response),
    /// Something happened.
    Event(Event),
}

/// Something happened.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, Schema)]
pub struct Event {
    /// MCU time.
    pub at: Micros,
    /// What.
    pub kind: EventKind,
}

/// What happened.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, Schema)]
pub enum EventKind {
    /// The MCU went into another state.
    State(State),
    /// A hinge starts to move.
    StepStarted {
        /// Index in the program.
        step: u16,
    },
    /// A hinge is open; what waits for it may start.
    StepOpened {
        /// Index in the program.
        step: u16,
    },
    /// A step is over.
    StepDone {
        /// Index in the program.
        step: u16,
        /// Highest temperature seen, for an SMA hinge.
        peak: Option<CentiCelsius>,
    },
}

/// A fault, sent ahead of everything else.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, Schema)]
pub struct Fault {
    /// What is wrong.
    pub code: FaultCode,
    /// MCU time.
    pub at: Micros,
    /// The step concerned, where there is one.
    pub step: Option<u16>,
    /// The channel concerned, where there is one.
    pub channel: Option<u16>,
    /// What was measured, in the unit that the code says.
    pub value: i64,
    /// What it was held against.
    pub limit: i64,
}

/// What a host sends ahead of everything else.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, Schema)]
pub enum Urgent {
    /// Everything off, now (S8).
    Stop,
}

/// A look at the rig. Lossy: the newest one wins.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, Schema)]
pub struct Telemetry {
    /// MCU time.
    pub at: Micros,
    /// What the MCU is doing.
    pub state: State,
    /// Supply voltage.
    pub supply: Millivolts,
    /// Measured sum of currents.
    pub current: Milliamps,
    /// Steps opened so far.
    pub opened: u16,
    /// Steps under way, those that move first.
    pub motions: Vec<Motion, TELEMETRY_MOTIONS>,
}

/// A step under way.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, Schema)]
pub struct Motion {
    /// Index in the program.
    pub step: u16,
    /// What the actuator does.
    pub phase: Phase,
}

/// What an actuator does, with what is known of it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, Schema)]
pub enum Phase {
    /// A heater raises an SMA hinge to its target.
    Heating {
        /// Measured.
        temperature: CentiCelsius,
        /// Power, per mille.
        duty: u16,
    },
    /// A heater keeps an SMA hinge at its target.
    Holding {
        /// Measured.
        temperature: CentiCelsius,
        /// Power, per mille.
        duty: u16,
    },
    /// An opened SMA hinge cools.
    Cooling {
        /// Measured.
        temperature: CentiCelsius,
    },
    /// A servo moves.
    Turning {
        /// Pulse width sent, microseconds.
        pulse_us: u16,
    },
    /// A spring is being released, or opens.
    Releasing,
}
