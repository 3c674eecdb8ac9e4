//! A run as the MCU executes it: steps, one a hinge, in an order that the MCU checks (S10).

use crate::{CentiCelsius, Milliamps, Millis, crc::Crc32Flavor};
use heapless::Vec;
use postcard_schema::Schema;
use serde::{Deserialize, Serialize};

/// How many steps one step may wait for.
pub const MAX_AFTER: usize = 4;

/// The motion of one hinge.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, Schema)]
pub struct Step {
    /// The hinge's number in the plan; for people and reports.
    pub hinge: u16,
    /// Steps that must be opened before this one starts. All are smaller than this step's own index.
    pub after: Vec<u16, MAX_AFTER>,
    /// What to do.
    pub action: Action,
}

/// What moves a hinge.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, Schema)]
pub enum Action {
    /// Heat an SMA hinge until it has opened.
    Heat(Heat),
    /// Turn a servo hinge.
    Turn(Turn),
    /// Release a spring hinge.
    Release(Release),
    /// Heat an SMA hinge at constant power for a while, to learn what it is like.
    Pulse(Pulse),
}

/// Heat to a temperature, hold it, let cool.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, Schema)]
pub struct Heat {
    /// Heater and thermistor.
    pub channel: u16,
    /// Temperature at which the alloy has transformed, above its Af.
    pub target: CentiCelsius,
    /// How long to stay at the target; then the hinge counts as opened.
    pub hold: Millis,
    /// Longest time with the heater on; reaching it is a fault.
    pub max_on: Millis,
    /// Highest temperature; reaching it is a fault.
    pub max_temperature: CentiCelsius,
    /// Temperature below which the hinge counts as cooled.
    pub cool: CentiCelsius,
    /// Shortest time off before the step is done.
    pub rest: Millis,
    /// Least rise in temperature within [`Self::gain_window`] (S6).
    pub min_gain: CentiCelsius,
    /// Time from switching on to the check of the rise.
    pub gain_window: Millis,
    /// Current at full power.
    pub current: Milliamps,
}

/// Move a servo from one pulse width to another at constant speed, and hold it there.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, Schema)]
pub struct Turn {
    /// Servo output.
    pub channel: u16,
    /// Pulse at the start, microseconds.
    pub from_us: u16,
    /// Pulse at the end, microseconds.
    pub to_us: u16,
    /// Time for the motion.
    pub duration: Millis,
    /// Time at the end for the servo to arrive; then the hinge counts as opened.
    pub settle: Millis,
    /// Current while moving.
    pub current: Milliamps,
    /// Current while holding, until the run ends.
    pub hold_current: Milliamps,
}

/// Energise a burn wire or latch, then give the spring time to open.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, Schema)]
pub struct Release {
    /// Release output.
    pub channel: u16,
    /// Time energised.
    pub pulse: Millis,
    /// Time to open after the pulse; then the hinge counts as opened.
    pub settle: Millis,
    /// Current while energised.
    pub current: Milliamps,
}

/// Heat at constant power until the time is over or a temperature is reached, whichever comes first; let cool.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, Schema)]
pub struct Pulse {
    /// Heater and thermistor.
    pub channel: u16,
    /// Power, 1 to 1000 per mille.
    pub duty: u16,
    /// Longest time with the heater on; then the hinge counts as opened.
    pub duration: Millis,
    /// Temperature that ends it earlier.
    pub target: CentiCelsius,
    /// Highest temperature; reaching it is a fault.
    pub max_temperature: CentiCelsius,
    /// Temperature below which the hinge counts as cooled.
    pub cool: CentiCelsius,
    /// Shortest time off before the step is done.
    pub rest: Millis,
    /// Least rise in temperature within [`Self::gain_window`] at this power (S6).
    pub min_gain: CentiCelsius,
    /// Time from switching on to the check of the rise.
    pub gain_window: Millis,
    /// Current at full power: so much flows while it is on, if not all the time.
    pub current: Milliamps,
}

impl Pulse {
    /// The [`Heat`] whose limits a pulse keeps: on for its time at most, and held for none.
    pub const fn heat(&self) -> Heat {
        Heat {
            channel: self.channel,
            target: self.target,
            hold: Millis(0),
            max_on: self.duration,
            max_temperature: self.max_temperature,
            cool: self.cool,
            rest: self.rest,
            min_gain: self.min_gain,
            gain_window: self.gain_window,
            current: self.current,
        }
    }
}

impl Action {
    /// Current that the supply must have to spare when the step starts.
    pub const fn current(&self) -> Milliamps {
        match self {
            Self::Heat(heat) => heat.current,
            Self::Turn(turn) => turn.current,
            Self::Release(release) => release.current,
            Self::Pulse(pulse) => pulse.current,
        }
    }
}

/// CRC-32 over the postcard encodings of the steps, one after the other: what [`crate::Command::Upload`] declares
/// and the MCU computes from what it has stored.
pub fn program_crc<'a>(steps: impl IntoIterator<Item = &'a Step>) -> u32 {
    let mut crc = Crc32Flavor::new();
    for step in steps {
        crc.add(step);
    }
    crc.finish()
}
