//! How far a calibration is, for a display: what is done now, how warm it is there, and about how long it will still take.

use super::hinge::Hinge;
use super::is_alone;
use super::sampler::Look;
use std::collections::BTreeMap;
use zygote_calibration::{Pulse, Purpose};

/// How far a calibration is.
#[derive(Debug, Clone, PartialEq)]
pub struct Progress {
    /// Hinges that have ended.
    pub ended: usize,
    /// All hinges.
    pub total: usize,
    /// What is done now.
    pub doing: String,
    /// Hinges under way, those that are heated first.
    pub running: Vec<Running>,
    /// Time that the rig will still need, as far as that can be told: the rig file's values say it, and hinges differ.
    pub left_s: f64,
}

/// A hinge under way.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Running {
    /// Its number.
    pub hinge: usize,
    /// What its thermistor reads.
    pub reading_c: f64,
    /// Whether its heater is on; else it cools.
    pub heated: bool,
}

/// A hinge has cooled to its rest after so many time constants.
const REST_TAUS: f64 = 4.0;
/// Full power takes a hinge past Af in about so many time constants.
const HEAT_TAUS: f64 = 1.0;
const PROBE_S: f64 = 1.5;

/// About how long it takes until all hinges have ended, from what they have been through. `at_once` is how many heaters the supply
/// can carry.
pub(super) fn left_s(hinges: &[Hinge], at_once: usize) -> f64 {
    let mut left_s = 0.0;
    for purpose in Purpose::ALL {
        let waiting: Vec<&Hinge> = hinges.iter().filter(|hinge| is_ahead(hinge, purpose)).collect();
        let longest = |value: fn(&Hinge) -> f64| waiting.iter().map(|hinge| value(hinge)).fold(0.0, f64::max);
        if waiting.is_empty() {
            continue;
        }
        let count = waiting.len() as f64;
        let rest_s = REST_TAUS * longest(|hinge| hinge.nominal.time_constant_s);
        left_s += match purpose {
            Purpose::Probe => count * PROBE_S + rest_s / 2.0,
            Purpose::Warm | Purpose::Ramp | Purpose::Again => {
                let waves = (count / at_once.max(1) as f64).ceil();
                waves * longest(|hinge| hinge.bounds.max_on_s) + rest_s
            }
            Purpose::HeldOut => count * HEAT_TAUS * longest(|hinge| hinge.nominal.time_constant_s) + rest_s,
        };
    }
    left_s
}

/// Whether a hinge has this pulse still before it.
fn is_ahead(hinge: &Hinge, purpose: Purpose) -> bool {
    let done = hinge.record.drives.iter().map(|drive| drive.purpose).max();
    hinge.ending.is_none() && done.is_none_or(|done| done < purpose)
}

/// The hinges of the pulses under way.
pub(super) fn running(
    hinges: &[Hinge],
    pulses: &[(usize, Pulse)],
    looks: &BTreeMap<u16, Look>,
) -> Vec<Running> {
    let seen = |(at, _): &(usize, Pulse)| {
        let hinge = hinges.get(*at)?;
        let look = looks.get(&hinge.channel)?;
        Some(Running { hinge: hinge.number, reading_c: look.reading_c?, heated: look.duty > 0.0 })
    };
    let mut running: Vec<Running> = pulses.iter().filter_map(seen).collect();
    running.sort_by_key(|running| (!running.heated, running.hinge));
    running
}

/// Pulses in words.
pub(super) fn describe(hinges: &[Hinge], pulses: &[(usize, Pulse)]) -> String {
    match pulses {
        [(at, pulse)] => {
            let number = hinges.get(*at).map_or(0, |hinge| hinge.number);
            let purpose = super::records::name_of(pulse.purpose);
            format!("hinge {number}: {purpose}, {:.1} % power", pulse.duty * 100.0)
        }
        [(_, pulse), ..] => {
            let side = if is_alone(pulse) { "one after the other" } else { "side by side" };
            format!("{} hinges {side}: {}", pulses.len(), super::records::name_of(pulse.purpose))
        }
        [] => String::new(),
    }
}
