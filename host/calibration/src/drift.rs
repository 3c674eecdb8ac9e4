//! Is a hinge still what its calibration says? What a run saw of it is fitted as a calibration's pulses are, and held against the values
//! that were measured then.

use crate::course::Course;
use crate::diagnosis::Electrical;
use crate::estimate::{Interval, Quantity};
use crate::interval::{SIGMAS, half_interval, value};
use crate::nominal::{Nominal, Transformation};
use crate::record::Record;
use crate::residuals::Residuals;
use crate::sighting::Sighting;
use crate::solve::Problem;
use crate::space::{Point, Space};
use core::fmt;
use std::collections::BTreeMap;

/// What a calibration knows of a hinge: the quantities that it identified.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Known(pub BTreeMap<Quantity, Interval>);

/// What a run says of a hinge's calibration.
#[derive(Debug, Clone, PartialEq)]
pub enum Drift {
    /// It still holds.
    Keep,
    /// It doesn't.
    Recalibrate {
        /// What has changed.
        changes: Vec<Change>,
    },
    /// The run didn't show it.
    CannotTell {
        /// Why not.
        why: Unclear,
    },
}

/// Something that isn't as it was.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Change {
    /// A quantity has another value.
    Value {
        /// Which.
        quantity: Quantity,
        /// What was calibrated.
        calibrated: Interval,
        /// What the run shows.
        seen: Interval,
    },
    /// It doesn't cool to where it began.
    Rest {
        /// What it read before it was heated.
        began_c: f64,
        /// What it cools towards.
        ends_c: f64,
    },
    /// No hinge like it reads so.
    Misfit {
        /// Root of the mean square of what the model misses.
        rmse_k: f64,
        /// The most that is accepted.
        most_k: f64,
    },
}

/// Why a run doesn't show whether a calibration holds.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum Unclear {
    /// The calibration lacks what would be compared.
    #[error("its calibration has no {0}")]
    Unknown(Quantity),
    /// Telemetry has room for a few hinges.
    #[error(
        "while it was heated it was seen {seen} times of {of}, expected at least {expected}, the first at once: telemetry shows \
         at most 8 hinges at a time"
    )]
    SeldomSeen {
        /// Looks.
        seen: usize,
        /// Looks that there would have been.
        of: usize,
        /// The fewest that say something.
        expected: usize,
    },
    /// It didn't get to its angle.
    #[error("it didn't open")]
    NotOpened,
    /// It cools to below where it began.
    #[error(
        "it read {began_c:.1} °C when it began and cools towards {ends_c:.1} °C: it was heated shortly before, or its thermistor drifts"
    )]
    NotAtRest {
        /// What it read before it was heated.
        began_c: f64,
        /// What it cools towards.
        ends_c: f64,
    },
    /// Too little was seen for this quantity.
    #[error("the run shows its {quantity} only to ±{half:.3} {unit}, expected ±{most:.3} {unit}", unit = .quantity.unit())]
    TooWide {
        /// Which.
        quantity: Quantity,
        /// Half the interval.
        half: f64,
        /// The widest that would show a change.
        most: f64,
    },
}

/// What is compared; by how much it may change before it matters; how well the run must show it to say that it didn't. Air that moves
/// changes the loss, and with it the time constant, by some percent from day to day.
const COMPARED: [(Quantity, Most, Most); 5] = [
    (Quantity::HeaterResistance, Most::Share(0.04), Most::Share(0.06)),
    (Quantity::FoilRise, Most::Share(0.10), Most::Share(0.10)),
    (Quantity::TimeConstant, Most::Share(0.10), Most::Share(0.10)),
    (Quantity::AusteniteStart, Most::Kelvins(2.0), Most::Kelvins(2.0)),
    (Quantity::AusteniteFinish, Most::Kelvins(2.0), Most::Kelvins(2.0)),
];
/// Standard deviations of a run's and a calibration's value together within which a change is chance.
const CHANCE: f64 = 4.0;
/// Of a normal distribution, in an interval of 95 %.
const CALIBRATED_SIGMAS: f64 = 1.96;
/// As in a calibration.
const MOST_MISFIT_K: f64 = 1.0;
/// A neighbour's heat may warm the air around a hinge by so much.
const MOST_WARMER_K: f64 = 3.0;
/// So many looks at a heated hinge, at least ..
const FEWEST: usize = 20;
/// .. and this share of those that there would have been.
const LEAST_SHARE: f64 = 0.5;
/// A heater that was not measured in the run is taken to be as it was, give or take this share.
const HEATER_SHARE: f64 = 0.01;

/// The most of something.
#[derive(Debug, Clone, Copy)]
enum Most {
    /// Of the calibrated value.
    Share(f64),
    /// In kelvins.
    Kelvins(f64),
}

impl Most {
    fn of(self, calibrated: f64) -> f64 {
        match self {
            Self::Share(share) => share * calibrated.abs(),
            Self::Kelvins(kelvins) => kelvins,
        }
    }
}

/// Holds what a run saw of a hinge against its calibration. `nominal` is what the rig file says of it; `heater` its resistance in the run,
/// where the currents showed it (see [`crate::heaters`]).
pub fn drift(known: &Known, nominal: &Nominal, sighting: &Sighting, heater: Option<Electrical>) -> Drift {
    match fitted(known, nominal, sighting, heater) {
        Ok(changes) if changes.is_empty() => Drift::Keep,
        Ok(changes) => Drift::Recalibrate { changes },
        Err(why) => Drift::CannotTell { why },
    }
}

fn fitted(
    known: &Known,
    nominal: &Nominal,
    sighting: &Sighting,
    heater: Option<Electrical>,
) -> Result<Vec<Change>, Unclear> {
    if let Some((missing, ..)) = COMPARED.iter().find(|(quantity, ..)| known.value(*quantity).is_none()) {
        return Err(Unclear::Unknown(*missing));
    }
    let record = record(sighting)?;
    let nominal = known.nominal(nominal);
    let ambient_c = record.samples.first().map_or(22.0, |sample| sample.reading_c);
    let measured = heater.or_else(|| {
        let ohm = known.value(Quantity::HeaterResistance)?.value;
        Some(Electrical { ohm, error_ohm: HEATER_SHARE * ohm })
    });
    let space = Space::new(&nominal, measured, ambient_c);
    let count = record.samples.len();
    let course = Course::new(&record, count);
    let start = search(&record, &course, &nominal, space);
    let solution = Problem::new(&record, &course, count, &nominal, space).polish(&start);
    let rmse_k = Residuals::new(&record, &solution).rmse_k;
    // Asked this way round, a NaN is a misfit.
    let fits = rmse_k <= MOST_MISFIT_K;
    if !fits {
        return Ok(vec![Change::Misfit { rmse_k, most_k: MOST_MISFIT_K }]);
    }
    let model = space.at(&solution.point).model;
    let warmer_k = model.ambient_c - ambient_c;
    if warmer_k < -MOST_WARMER_K {
        return Err(Unclear::NotAtRest { began_c: ambient_c, ends_c: model.ambient_c });
    }
    let (mut changes, mut unclear) = (Vec::new(), None);
    if warmer_k > MOST_WARMER_K {
        changes.push(Change::Rest { began_c: ambient_c, ends_c: model.ambient_c });
    }
    for (quantity, matters, shows) in COMPARED {
        // Without currents it is what it was taken for.
        if quantity == Quantity::HeaterResistance && heater.is_none() {
            continue;
        }
        let (Some(calibrated), Some(best)) = (known.value(quantity), value(&model, quantity)) else {
            continue;
        };
        let half = half_interval(&space, &solution, quantity, best);
        let sigma = (half / SIGMAS).hypot((calibrated.high - calibrated.low) / 2.0 / CALIBRATED_SIGMAS);
        let chance = CHANCE * sigma;
        if (best - calibrated.value).abs() > matters.of(calibrated.value).max(chance) {
            let seen = Interval { value: best, low: best - half, high: best + half };
            changes.push(Change::Value { quantity, calibrated, seen });
        }
        let most = shows.of(calibrated.value);
        // Asked this way round, a NaN shows nothing.
        let shown = half <= most;
        if !shown {
            unclear.get_or_insert(Unclear::TooWide { quantity, half, most });
        }
    }
    match unclear {
        Some(unclear) if changes.is_empty() => Err(unclear),
        _ => Ok(changes),
    }
}

/// The record of a hinge that was seen often enough.
fn record(sighting: &Sighting) -> Result<Record, Unclear> {
    if sighting.opened_s.is_none() {
        return Err(Unclear::NotOpened);
    }
    let (seen, of) = sighting.seen();
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a share of a count")]
    let share = (LEAST_SHARE * of as f64).ceil() as usize;
    let expected = share.max(FEWEST);
    let seldom = Unclear::SeldomSeen { seen, of, expected };
    if seen < expected {
        return Err(seldom);
    }
    sighting.record().filter(|record| record.check().is_ok() && record.samples.len() > FEWEST).ok_or(seldom)
}

/// From the calibrated hinge on, and from alloys beside it, until nothing but noise is left.
fn search(record: &Record, course: &Course, nominal: &Nominal, space: Space) -> Point {
    const SHIFTS_K: [f64; 5] = [0.0, 5.0, -5.0, 10.0, -10.0];
    const NOISE: f64 = 1.5;
    let mut problem = Problem::new(record, course, record.samples.len(), nominal, space);
    let mut best = (f64::INFINITY, Point::zeros());
    for shift_k in SHIFTS_K {
        let (point, cost) = problem.descend(&space.shifted(&Point::zeros(), shift_k), 1e-4);
        if cost < best.0 {
            best = (cost, point);
        }
        if problem.correlation(&best.1) < NOISE {
            break;
        }
    }
    best.1
}

impl Known {
    fn value(&self, quantity: Quantity) -> Option<Interval> {
        self.0.get(&quantity).copied()
    }

    /// The nominal hinge with all that is known in its place.
    fn nominal(&self, nominal: &Nominal) -> Nominal {
        let or = |quantity, otherwise| self.value(quantity).map_or(otherwise, |known| known.value);
        let at = &nominal.transformation;
        let as_c = or(Quantity::AusteniteStart, at.as_c);
        let af_c = or(Quantity::AusteniteFinish, at.af_c).max(as_c + 1.0);
        let ms_c = or(Quantity::MartensiteStart, at.ms_c).min(af_c - 1.0);
        let mf_c = or(Quantity::MartensiteFinish, at.mf_c).min(ms_c - 1.0);
        let thermal_resistance_k_per_w = or(Quantity::ThermalResistance, nominal.thermal_resistance_k_per_w);
        let time_constant_s = or(Quantity::TimeConstant, nominal.time_constant_s);
        let foil_j_per_k = time_constant_s / thermal_resistance_k_per_w * (1.0 - nominal.film_share);
        let latent_j = or(Quantity::LatentHeat, nominal.latent_k * foil_j_per_k);
        Nominal {
            transformation: Transformation { mf_c, ms_c, as_c, af_c },
            heater_ohm: or(Quantity::HeaterResistance, nominal.heater_ohm),
            thermal_resistance_k_per_w,
            time_constant_s,
            latent_k: latent_j / foil_j_per_k,
            lag_s: or(Quantity::ThermistorLag, nominal.lag_s),
            ..*nominal
        }
    }
}

impl fmt::Display for Change {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Value { quantity, calibrated, seen } => {
                let unit = quantity.unit();
                write!(
                    f,
                    "{quantity} {:.2} {unit} ({:.2} to {:.2}), calibrated {:.2} {unit} ({:.2} to {:.2})",
                    seen.value, seen.low, seen.high, calibrated.value, calibrated.low, calibrated.high
                )
            }
            Self::Rest { began_c, ends_c } => write!(
                f,
                "it read {began_c:.1} °C when it began and cools towards {ends_c:.1} °C: its thermistor drifts, or the air got warmer"
            ),
            Self::Misfit { rmse_k, most_k } => write!(
                f,
                "no hinge like it reads so: off by {rmse_k:.2} K (rms), expected {most_k:.2} K at most; look at its thermistor first"
            ),
        }
    }
}
