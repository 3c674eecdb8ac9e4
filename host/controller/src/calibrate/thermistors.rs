//! The check before anything is heated: does every thermistor read, and do all read alike?

use super::hinge::Hinge;
use super::sampler::Look;
use std::collections::BTreeMap;

/// Thermistors in one room read alike within this: their tolerance, and a lamp or a draught.
const ALIKE_K: f64 = 6.0;
/// What a room may be.
const ROOM_C: (f64, f64) = (-10.0, 50.0);

/// What is wrong with a hinge's thermistor, before anything was heated.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum ThermistorError {
    /// Open, shorted, or not there.
    #[error("its thermistor can't be believed: open, shorted, jumping, or not there; look at its wire")]
    Unreadable,
    /// No room is so warm or cold.
    #[error("its thermistor reads {reading_c:.1} °C, expected a room's {} to {} °C: another kind of thermistor, or it is hot still", ROOM_C.0, ROOM_C.1)]
    NoRoom {
        /// The reading.
        reading_c: f64,
    },
    /// The others are warmer or colder.
    #[error(
        "its thermistor reads {reading_c:.1} °C, expected within {ALIKE_K} K of the others' {median_c:.1} °C: let it cool, or look at it"
    )]
    Unlike {
        /// The reading.
        reading_c: f64,
        /// The median of all.
        median_c: f64,
    },
}

/// What is wrong, hinge by hinge. `looks` has what was last read of every channel.
pub(crate) fn check(hinges: &[Hinge], looks: &BTreeMap<u16, Look>) -> Vec<(usize, ThermistorError)> {
    let reading = |hinge: &Hinge| looks.get(&hinge.channel).and_then(|look| look.reading_c);
    let mut readings: Vec<f64> = hinges.iter().filter_map(reading).collect();
    readings.sort_by(f64::total_cmp);
    let median_c = readings.get(readings.len() / 2).copied().unwrap_or_default();
    let judge = |hinge: &Hinge| match reading(hinge) {
        None => Some(ThermistorError::Unreadable),
        Some(reading_c) if !(ROOM_C.0..=ROOM_C.1).contains(&reading_c) => {
            Some(ThermistorError::NoRoom { reading_c })
        }
        Some(reading_c) if (reading_c - median_c).abs() > ALIKE_K => {
            Some(ThermistorError::Unlike { reading_c, median_c })
        }
        Some(_) => None,
    };
    hinges.iter().enumerate().filter_map(|(at, hinge)| Some((at, judge(hinge)?))).collect()
}
