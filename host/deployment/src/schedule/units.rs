//! Quantities of a schedule: whole numbers, since they go over a wire and into a hash.

use crate::rig::{Amps, Celsius, Kelvins, Seconds};
use serde::{Deserialize, Serialize};
use std::fmt;

macro_rules! unit {
    ($(#[$doc:meta])* $name:ident($raw:ty), $suffix:literal) => {
        $(#[$doc])*
        #[derive(
            Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default, Serialize, Deserialize,
        )]
        #[serde(transparent)]
        pub struct $name(pub $raw);

        impl fmt::Display for $name {
            fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                write!(f, concat!("{} ", $suffix), self.0)
            }
        }
    };
}

unit! {
    /// Time in milliseconds.
    Millis(u64), "ms"
}
unit! {
    /// Time in microseconds.
    Micros(u32), "us"
}
unit! {
    /// Current in milliamperes.
    Milliamps(u64), "mA"
}
unit! {
    /// Temperature, or a difference of two, in hundredths of a degree Celsius.
    CentiCelsius(i32), "c°C"
}

impl std::ops::Add for Millis {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self(self.0.saturating_add(other.0))
    }
}

/// A whole number from one that the rules of the rig file have bounded.
#[expect(clippy::cast_possible_truncation, reason = "bounded by the rules of the rig file, and saturating")]
fn whole(value: f64) -> i64 {
    value as i64
}

/// Less than this above a whole number is rounding, not a reason to round up.
const ROUNDING: f64 = 1e-6;

/// A whole number at or above a value that is not negative.
fn whole_up(value: f64) -> u64 {
    u64::try_from(whole((value - ROUNDING).ceil())).unwrap_or(0)
}

impl Millis {
    /// At least as long as `time`.
    pub fn at_least(time: Seconds) -> Self {
        Self(whole_up(time.0 * 1e3))
    }
}

impl Micros {
    /// As near to `time` as can be.
    pub(crate) fn nearest(time: Seconds) -> Self {
        Self(u32::try_from(whole((time.0 * 1e6).round())).unwrap_or(0))
    }
}

impl Milliamps {
    /// At least as much as `current`.
    pub(crate) fn at_least(current: Amps) -> Self {
        Self(whole_up(current.0 * 1e3))
    }

    /// At most as much as `current`.
    pub fn at_most(current: Amps) -> Self {
        Self(u64::try_from(whole((current.0 * 1e3 + ROUNDING).floor())).unwrap_or(0))
    }
}

impl From<Celsius> for CentiCelsius {
    fn from(temperature: Celsius) -> Self {
        Self(i32::try_from(whole((temperature.0 * 100.0).round())).unwrap_or(i32::MAX))
    }
}

impl From<Kelvins> for CentiCelsius {
    fn from(difference: Kelvins) -> Self {
        Self(i32::try_from(whole((difference.0 * 100.0).round())).unwrap_or(i32::MAX))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_and_currents_are_rounded_up_but_not_for_noise_of_scaling() {
        assert_eq!(Millis::at_least(Seconds(1.2)), Millis(1200));
        assert_eq!(Millis::at_least(Seconds(0.0301)), Millis(31));
        assert_eq!(Milliamps::at_least(Amps(0.2)), Milliamps(200));
        assert_eq!(Milliamps::at_most(Amps(0.0029)), Milliamps(2));
        assert_eq!(CentiCelsius::from(Celsius(-40.0)), CentiCelsius(-4000));
    }
}
