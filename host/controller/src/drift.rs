//! Which hinges of a run are still what their calibration says. Every record of the run is noted, live or from a recording; at the end each
//! hinge that was heated is held against its calibration. What is compared, and how, is `zygote_calibration`'s business.
//!
//! ```text
//!   Record --observe--> Sightings --drift--> HingeDrift, hinge by hinge
//! ```

use crate::calibrate::nominal;
use crate::event_log::{Observer, Record, Times};
use serde::{Deserialize, Serialize};
use std::collections::{BTreeMap, BTreeSet};
use std::fmt;
use zygote_calibration::{
    Currents, Doing, Drift, Electrical, Interval, Known, Look, Quantity, Sighting, drift, heaters,
};
use zygote_deployment::{
    CalibratedAt, CalibratedHinge, Calibration, CalibrationError, Drive, Fitting, Rig, RigError,
};
use zygote_protocol::TELEMETRY_MOTIONS;

/// Two looks at currents so near to each other show the same state.
const NEAR_US: u64 = 350_000;
/// Duties so near to each other are the same.
const SAME_DUTY: f64 = 1e-6;

/// What to think of a hinge's calibration after a run.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum DriftVerdict {
    /// It still holds.
    Keep,
    /// It doesn't.
    Recalibrate,
    /// The run didn't show it.
    CannotTell,
}

/// A hinge that a run heated, held against its calibration.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct HingeDrift {
    /// Number of the hinge in the plan.
    pub hinge: usize,
    /// When it was calibrated, in UTC.
    pub calibrated: String,
    /// What to think of it.
    pub verdict: DriftVerdict,
    /// What has changed, or why it can't be told.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub why: Vec<String>,
}

/// Why a run can't be held against a calibration at all.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum DriftError {
    /// Another board.
    #[error("it ran on board {found}, the hinges were calibrated at {expected}")]
    OtherBoard {
        /// Of the calibration.
        expected: CalibratedAt,
        /// Of the run.
        found: CalibratedAt,
    },
    /// The rig has no such hinges.
    #[error(transparent)]
    Rig(#[from] RigError),
    /// A calibration with a value that can't be read.
    #[error(transparent)]
    Calibration(#[from] CalibrationError),
}

/// What a run showed of its hinges.
#[derive(Debug, Clone, Default)]
pub struct Sightings {
    board: Option<CalibratedAt>,
    /// MCU times, by hinge.
    started_us: BTreeMap<usize, u64>,
    opened_us: BTreeMap<usize, u64>,
    looks: BTreeMap<u64, Glance>,
}

/// One telemetry message.
#[derive(Debug, Clone)]
struct Glance {
    supply_v: f64,
    current_a: f64,
    /// It may have been seen that more hinges move than there was room for.
    full: bool,
    /// Something that isn't a heater moves.
    others: bool,
    heated: Vec<Heated>,
}

#[derive(Debug, Clone, Copy)]
struct Heated {
    hinge: usize,
    doing: Doing,
    reading_c: f64,
    duty: f64,
}

/// A hinge in a telemetry message: its number, what it is doing, its temperature (°C) and the share of its heater's power.
pub type SeenMotion<'a> = (usize, &'a str, Option<f64>, Option<f64>);

impl Sightings {
    /// Notes one telemetry message.
    pub fn look<'a>(
        &mut self,
        mcu_us: u64,
        supply_v: f64,
        current_a: f64,
        motions: impl Iterator<Item = SeenMotion<'a>>,
    ) {
        let (mut count, mut others, mut heated) = (0, false, Vec::new());
        for (hinge, phase, temperature_c, duty) in motions {
            count += 1;
            let doing = match phase {
                "heating" => Doing::Heating,
                "holding" => Doing::Holding,
                "cooling" => Doing::Cooling,
                _ => {
                    others = true;
                    continue;
                }
            };
            if let Some(reading_c) = temperature_c {
                heated.push(Heated { hinge, doing, reading_c, duty: duty.unwrap_or(0.0) });
            }
        }
        let full = count >= TELEMETRY_MOTIONS;
        self.looks.insert(mcu_us, Glance { supply_v, current_a, full, others, heated });
    }

    /// Notes any other record.
    pub fn note(&mut self, record: &Record) {
        match record {
            // Recordings of earlier versions don't tell the chip.
            Record::Connected { chip, .. } if chip.is_empty() => {}
            Record::Connected { board, chip, .. } => {
                self.board = Some(CalibratedAt { board: board.clone(), unique_id: chip.clone() });
            }
            Record::Started { mcu_us, hinge, .. } => {
                self.started_us.insert(*hinge, *mcu_us);
            }
            Record::Opened { mcu_us, hinge, .. } => {
                self.opened_us.insert(*hinge, *mcu_us);
            }
            Record::Telemetry { mcu_us, supply_mv, current_ma, motions, .. } => {
                let motions = motions
                    .iter()
                    .map(|motion| (motion.hinge, motion.phase, motion.temperature_c, motion.duty));
                self.look(*mcu_us, f64::from(*supply_mv) / 1e3, f64::from(*current_ma) / 1e3, motions);
            }
            Record::Uploaded { .. }
            | Record::State { .. }
            | Record::Done { .. }
            | Record::Fault { .. }
            | Record::Paused
            | Record::StopRequested
            | Record::StopConfirmed { .. }
            | Record::Lost { .. } => {}
        }
    }

    /// Every hinge that began to be heated and has a calibration, held against it. `hinges` is how many the plan has.
    ///
    /// # Errors
    /// [`DriftError`]: another board, or a calibration that can't be read.
    pub fn drift(
        &self,
        rig: &Rig,
        calibration: &Calibration,
        hinges: usize,
    ) -> Result<Vec<HingeDrift>, DriftError> {
        if let Some(found) = self.board.as_ref().filter(|board| **board != calibration.at()) {
            return Err(DriftError::OtherBoard { expected: calibration.at(), found: found.clone() });
        }
        let fittings = rig.fit(hinges)?;
        let heater_ohm: BTreeMap<usize, f64> = fittings
            .iter()
            .enumerate()
            .filter_map(|(hinge, fitting)| match fitting.drive {
                Drive::Sma(sma) => Some((hinge, sma.heater_resistance.0)),
                Drive::Servo(_) | Drive::Spring(_) => None,
            })
            .collect();
        let heaters = heaters(&self.currents(&fittings), &heater_ohm);
        calibration
            .hinges
            .iter()
            .filter_map(|calibrated| {
                let Drive::Sma(settings) = fittings.get(calibrated.hinge)?.drive else { return None };
                let sighting = self.sighting(calibrated.hinge)?;
                let heater = heaters.get(&calibrated.hinge).copied();
                Some(judged(calibrated, &nominal(&settings), &sighting, heater))
            })
            .collect()
    }

    /// All looks at one hinge; none where it never started.
    fn sighting(&self, hinge: usize) -> Option<Sighting> {
        let started_us = *self.started_us.get(&hinge)?;
        let looks = self
            .looks
            .range(started_us..)
            .filter_map(|(at_us, glance)| {
                let seen = glance.heated.iter().find(|seen| seen.hinge == hinge)?;
                let Heated { doing, reading_c, duty, .. } = *seen;
                Some(Look { t_s: seconds(*at_us), doing, reading_c, duty, voltage_v: glance.supply_v })
            })
            .collect();
        let opened_s = self.opened_us.get(&hinge).map(|at_us| seconds(*at_us));
        Some(Sighting { started_s: seconds(started_us), opened_s, looks })
    }

    /// Looks at the sum of currents in which nothing changes and every heater that is on is seen.
    fn currents(&self, fittings: &[Fitting]) -> Vec<Currents> {
        let is_heated =
            |hinge: &usize| matches!(fittings.get(*hinge).map(|fit| fit.drive), Some(Drive::Sma(_)));
        // A servo holds from then on.
        let first_other =
            self.started_us.iter().filter(|(hinge, _)| !is_heated(hinge)).map(|(_, at_us)| *at_us).min();
        let until_us = first_other.unwrap_or(u64::MAX);
        let looks = self.looks.range(..until_us);
        let pairs = looks.clone().zip(looks.skip(1));
        pairs
            .filter_map(|((before_us, before), (now_us, now))| {
                let unclear = before.full || now.full || before.others || now.others;
                let near = now_us - before_us <= NEAR_US;
                (near && !unclear && before.is_as_powered_as(now)).then(|| Currents {
                    sum_a: now.current_a,
                    voltage_v: now.supply_v,
                    duties: now.powered().map(|seen| (seen.hinge, seen.duty)).collect(),
                })
            })
            .collect()
    }
}

impl Observer for Sightings {
    fn observe(&mut self, _: Times, record: &Record) {
        self.note(record);
    }

    fn error(&self) -> Option<String> {
        None
    }
}

impl Glance {
    fn powered(&self) -> impl Iterator<Item = &Heated> {
        self.heated.iter().filter(|seen| seen.duty > 0.0)
    }

    /// The same heaters are on, each as much.
    fn is_as_powered_as(&self, other: &Self) -> bool {
        let hinges = |glance: &Self| glance.powered().map(|seen| seen.hinge).collect::<BTreeSet<_>>();
        let same = |seen: &Heated| {
            let there = other.heated.iter().find(|there| there.hinge == seen.hinge);
            there.is_some_and(|there| (there.duty - seen.duty).abs() < SAME_DUTY)
        };
        hinges(self) == hinges(other) && self.powered().all(same)
    }
}

fn judged(
    calibrated: &CalibratedHinge,
    nominal: &zygote_calibration::Nominal,
    sighting: &Sighting,
    heater: Option<Electrical>,
) -> Result<HingeDrift, DriftError> {
    let (verdict, why) = match drift(&known(calibrated)?, nominal, sighting, heater) {
        Drift::Keep => (DriftVerdict::Keep, Vec::new()),
        Drift::Recalibrate { changes } => {
            (DriftVerdict::Recalibrate, changes.iter().map(ToString::to_string).collect())
        }
        Drift::CannotTell { why } => (DriftVerdict::CannotTell, vec![why.to_string()]),
    };
    Ok(HingeDrift { hinge: calibrated.hinge, calibrated: calibrated.date.clone(), verdict, why })
}

/// The values of a calibration file.
fn known(calibrated: &CalibratedHinge) -> Result<Known, CalibrationError> {
    let mut known = Known::default();
    for quantity in Quantity::ALL {
        if let Some([value, low, high]) = calibrated.interval(&quantity.key(), &quantity.ascii_unit())? {
            known.0.insert(quantity, Interval { value, low, high });
        }
    }
    Ok(known)
}

#[expect(clippy::cast_precision_loss, reason = "exact for 285 years")]
fn seconds(us: u64) -> f64 {
    us as f64 / 1e6
}

impl DriftVerdict {
    /// For people.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Keep => "keep",
            Self::Recalibrate => "recalibrate",
            Self::CannotTell => "can't tell",
        }
    }
}

impl fmt::Display for HingeDrift {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "hinge {}: {}", self.hinge, self.verdict.name())?;
        if self.why.is_empty() { Ok(()) } else { write!(f, ": {}", self.why.join("; ")) }
    }
}
