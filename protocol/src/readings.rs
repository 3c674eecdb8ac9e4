//! What every heater's thermistor reads and every heater gets, asked for channel by channel: what a calibration samples, and what
//! a host looks at before anything is heated.

use crate::{CentiCelsius, Micros, Milliamps, Millivolts};
use heapless::Vec;
use postcard_schema::Schema;
use serde::{Deserialize, Serialize};

/// Channels in one [`Readings`]: more than boards have, and they surely fit one frame.
pub const READINGS_PER_REPLY: usize = 24;

/// Heaters from one on.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, Schema)]
pub struct Readings {
    /// MCU time at which all of this was read.
    pub at: Micros,
    /// Supply voltage.
    pub supply: Millivolts,
    /// Measured sum of currents.
    pub current: Milliamps,
    /// The first channel.
    pub first: u16,
    /// The channels from there on; none beyond the last one fitted.
    pub channels: Vec<Reading, READINGS_PER_REPLY>,
}

/// One heater and its thermistor.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, Schema)]
pub struct Reading {
    /// Measured; `None` where the thermistor can't be believed.
    pub temperature: Option<CentiCelsius>,
    /// Power from this reading on, per mille.
    pub duty: u16,
}
