//! What goes wrong, and when: the timed events of a rehearsal, with hinges already resolved to channels.

use std::fmt;
use zygote_protocol::{Micros, Millis, ResetCause, State, StepState};
use zygote_sim::plant::Fault;
use zygote_sim::{Impairment, Stuck};

/// Something that goes wrong.
#[derive(Debug, Clone, PartialEq)]
pub struct Cause {
    /// What it waits for.
    pub when: When,
    /// How long after that it happens.
    pub after: Millis,
    /// What happens.
    pub what: What,
}

/// What a cause waits for. Judged by the board's core and the plant themselves, so that no line stands between.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum When {
    /// A virtual time, from when the board was switched on.
    At(Micros),
    /// The MCU is in a state.
    State(State),
    /// A step of the program is in a state.
    Step {
        /// Its index.
        step: usize,
        /// The state.
        state: StepState,
    },
    /// A foil is truly hotter than this.
    Above {
        /// Its heater channel.
        channel: usize,
        /// The temperature.
        celsius: f64,
    },
}

/// One direction of the line, or both.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Way {
    /// From host to board.
    ToBoard,
    /// From board to host.
    ToHost,
    /// Both.
    Both,
}

/// What happens.
#[derive(Debug, Clone, PartialEq)]
pub enum What {
    /// Something on the rig breaks, or is mended.
    Break(Fault),
    /// The MCU is reset.
    Reset(ResetCause),
    /// The MCU's program stops.
    Hang(Stuck),
    /// The stop button is pressed, or released.
    StopButton(bool),
    /// A stop frame comes that belongs to no session.
    StopFrame,
    /// The line is cut, for this long or for good.
    Cut(Way, Option<Millis>),
    /// The line gets worse, or good again.
    Impair(Way, Impairment),
    /// The host's process is killed.
    KillHost,
    /// The user wants to stop: Ctrl-C.
    UserStops,
    /// Another host says hello on the same line.
    SecondHost,
    /// Everything that the host has sent so far comes once more.
    Replay,
    /// So many bytes of noise reach the board.
    Garbage(usize),
}

impl fmt::Display for What {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Break(fault) => f.write_str(&broken(*fault)),
            Self::Hang(Stuck::Tasks) => write!(f, "tasks stuck"),
            Self::Hang(Stuck::Everything) => write!(f, "MCU stuck"),
            Self::Reset(cause) => write!(f, "MCU reset ({cause:?})"),
            Self::StopButton(true) => write!(f, "stop button pressed"),
            Self::StopButton(false) => write!(f, "stop button released"),
            Self::StopFrame => write!(f, "stop frame"),
            Self::Cut(way, None) => write!(f, "line cut ({way})"),
            Self::Cut(way, Some(span)) => write!(f, "line cut for {span} ({way})"),
            Self::Impair(way, Impairment::NONE) => write!(f, "line good again ({way})"),
            Self::Impair(way, impairment) => {
                let Impairment { delay, loss, flip, duplicate, reorder } = impairment;
                write!(
                    f,
                    "bad line ({way}): {delay} late, lost {loss:.1e}, flipped {flip:.1e}, twice {duplicate:.2}, turned {reorder:.2}"
                )
            }
            Self::KillHost => write!(f, "host killed"),
            Self::UserStops => write!(f, "user stops"),
            Self::SecondHost => write!(f, "second host"),
            Self::Replay => write!(f, "frames replayed"),
            Self::Garbage(count) => write!(f, "{count} bytes of noise"),
        }
    }
}

/// A fault of the plant in words.
fn broken(fault: Fault) -> String {
    match fault {
        Fault::ThermistorOpen(at) => format!("thermistor {at} open"),
        Fault::ThermistorShorted(at) => format!("thermistor {at} shorted"),
        Fault::ThermistorFrozen(at) => format!("thermistor {at} frozen"),
        Fault::ThermistorLoose(at) => format!("thermistor {at} loose"),
        Fault::ThermistorDrifting { channel, kelvin_per_s } => {
            format!("thermistor {channel} drifts {kelvin_per_s:+.2} K/s")
        }
        Fault::HeaterOpen(at) => format!("heater {at} open"),
        Fault::HeaterShorted { channel, ohm } => format!("heater {channel} shorted to {ohm:.2} ohm"),
        Fault::MosfetStuckOn(at) => format!("MOSFET {at} stuck on"),
        Fault::Jammed(hinge) => format!("{hinge} jammed"),
        Fault::ServoStalled(at) => format!("servo {at} stalled"),
        Fault::SupplyCut => "supply cut".to_owned(),
        Fault::SupplySag { open_circuit_v, source_ohm } => {
            format!("supply sags to {open_circuit_v:.2} V, {source_ohm:.2} ohm")
        }
        Fault::SupplyRestored => "supply restored".to_owned(),
    }
}

impl fmt::Display for Way {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::ToBoard => "to board",
            Self::ToHost => "to host",
            Self::Both => "both ways",
        })
    }
}
