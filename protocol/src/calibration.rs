//! What was measured of an actuator, as a board keeps it: the steps that drive the actuator are held against it (S6, S7, S13).

use crate::{CentiCelsius, Milliamps, Millis};
use postcard_schema::Schema;
use serde::{Deserialize, Serialize};

/// An actuator that can be calibrated.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, Schema)]
pub enum Actuator {
    /// The heater of this channel.
    Heater(u16),
    /// The servo of this channel.
    Servo(u16),
}

/// What is known of an actuator by measurement; `None` where nothing is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, Schema)]
pub enum Calibration {
    /// Of a heater.
    Heater {
        /// Heater and thermistor.
        channel: u16,
        /// What was measured.
        known: Option<HeaterCalibration>,
    },
    /// Of a servo.
    Servo {
        /// Servo output.
        channel: u16,
        /// What was measured.
        known: Option<ServoCalibration>,
    },
}

/// A heater with its hinge.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, Schema)]
pub struct HeaterCalibration {
    /// Current at full power.
    pub current: Milliamps,
    /// Rise in temperature at full power within [`Self::window`].
    pub gain: CentiCelsius,
    /// Time from switching on to that rise.
    pub window: Millis,
    /// Temperature at which the alloy has transformed, its Af, where that was seen.
    pub opens_at: Option<CentiCelsius>,
}

/// A servo with its hinge: the pulses between which it moves without touching its ends.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, Schema)]
pub struct ServoCalibration {
    /// Shortest pulse, microseconds.
    pub shortest_us: u16,
    /// Longest pulse, microseconds.
    pub longest_us: u16,
}

impl Calibration {
    /// Whose it is.
    pub const fn actuator(&self) -> Actuator {
        match *self {
            Self::Heater { channel, .. } => Actuator::Heater(channel),
            Self::Servo { channel, .. } => Actuator::Servo(channel),
        }
    }
}
