//! What a board tells the core about itself, once, at start.

use crate::thermistor::Thermistor;
use core::ops::RangeInclusive;
use zygote_protocol::{Channels, Identity, Limits};

/// A board as the core sees it.
#[derive(Debug, Clone)]
pub struct Config {
    /// Who the MCU is, for the hello.
    pub identity: Identity,
    /// Ceilings that no session can raise (S13).
    pub ceiling: Limits,
    /// How many of the core's channels are fitted; at most as many as the core has.
    pub channels: Channels,
    /// The thermistors of the heaters.
    pub thermistor: Thermistor,
    /// Servo pulses that the board sends at all, microseconds.
    pub servo_pulse_us: RangeInclusive<u16>,
}
