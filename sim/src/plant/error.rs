//! What can be wrong with a plant's configuration, or with what it is asked to do.

use core::fmt;

/// A hinge, by its kind and channel.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Hinge {
    /// The shape-memory hinge on this heater channel.
    Sma(usize),
    /// The hinge on this servo channel.
    Servo(usize),
    /// The spring hinge on this release channel.
    Spring(usize),
}

impl fmt::Display for Hinge {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Sma(channel) => write!(f, "heater {channel}"),
            Self::Servo(channel) => write!(f, "servo {channel}"),
            Self::Spring(channel) => write!(f, "spring {channel}"),
        }
    }
}

/// The part of a plant that an error is about.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Place {
    /// The surroundings.
    Room,
    /// The actuator supply.
    Supply,
    /// One hinge with its actuator and sensor.
    Hinge(Hinge),
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Room => write!(f, "room"),
            Self::Supply => write!(f, "supply"),
            Self::Hinge(hinge) => hinge.fmt(f),
        }
    }
}

/// Why a plant refused.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum PlantError {
    /// A number that no such part can have.
    #[error("plant, {place}: {quantity} is {got}, expected {expected}")]
    Value {
        /// The part that has it.
        place: Place,
        /// What it is, with its unit where it has one.
        quantity: &'static str,
        /// The number given.
        got: f64,
        /// The range that it must lie in.
        expected: &'static str,
    },
    /// A drive with fewer outputs than the plant has actuators.
    #[error("plant, drive: {got} {kind}, expected at least {expected}, one for each in the plant")]
    Drive {
        /// Which outputs.
        kind: &'static str,
        /// How many the plant has.
        expected: usize,
        /// How many were given.
        got: usize,
    },
    /// A fault in a hinge that the plant does not have.
    #[error("plant, fault: there is no {hinge}, expected a channel below {count}")]
    NoSuchHinge {
        /// The hinge named.
        hinge: Hinge,
        /// How many of its kind there are.
        count: usize,
    },
}

pub(super) fn finite(place: Place, quantity: &'static str, got: f64) -> Result<(), PlantError> {
    within(got.is_finite(), place, quantity, got, "a finite number")
}

pub(super) fn positive(place: Place, quantity: &'static str, got: f64) -> Result<(), PlantError> {
    within(got.is_finite() && got > 0.0, place, quantity, got, "a finite number above 0")
}

pub(super) fn not_negative(place: Place, quantity: &'static str, got: f64) -> Result<(), PlantError> {
    within(got.is_finite() && got >= 0.0, place, quantity, got, "a finite number, at least 0")
}

pub(super) fn within(
    holds: bool,
    place: Place,
    quantity: &'static str,
    got: f64,
    expected: &'static str,
) -> Result<(), PlantError> {
    if holds { Ok(()) } else { Err(PlantError::Value { place, quantity, got, expected }) }
}
