//! From a record to a hinge's parameters, each with its interval or with why it has none.

use crate::course::{Course, Moment};
use crate::diagnosis::{self, Diagnosis};
use crate::estimate::{Estimate, Interval, Quantity, Verdict, Why, Width};
use crate::interval::{half_interval, value};
use crate::model::Model;
use crate::nominal::{Nominal, Transformation};
use crate::pulse_plan::Purpose;
use crate::record::{Record, RecordError};
use crate::residuals::{HeldOut, Residuals};
use crate::solve::{Problem, Solution};
use crate::space::{Candidate, Point, Space};

/// What a record says of its hinge.
#[derive(Debug, Clone, PartialEq)]
pub struct Fit {
    /// Every parameter, in the order of [`Quantity::ALL`].
    pub estimates: Vec<Estimate>,
    /// What is broken; nothing has a value then.
    pub fault: Option<Diagnosis>,
    /// What the model misses of the samples that were fitted.
    pub residuals: Option<Residuals>,
    /// How the pulse that was held out was predicted.
    pub held_out: Option<HeldOut>,
    /// The model's reading at every sample, the held-out ones too; empty where there was nothing to fit.
    pub predicted_c: Vec<f64>,
    /// The hinge that gives them. Its numbers are the best guess; which of them to trust the estimates say.
    pub model: Option<Model>,
}

impl Fit {
    /// The verdict on one parameter.
    pub fn verdict(&self, quantity: Quantity) -> Option<Verdict> {
        self.estimates.iter().find(|estimate| estimate.quantity == quantity).map(|estimate| estimate.verdict)
    }

    /// The value of a parameter, if it was identified.
    pub fn value(&self, quantity: Quantity) -> Option<Interval> {
        match self.verdict(quantity)? {
            Verdict::Identified(interval) => Some(interval),
            Verdict::NotIdentified { .. } => None,
        }
    }
}

/// More than this, and the model is of something else.
const MOST_MISFIT_K: f64 = 1.0;
/// More than this, and what it predicts is not worth having.
const MOST_HELD_OUT_K: f64 = 2.0;
/// The fewest samples that a fit is tried on.
const FEWEST: usize = 100;

/// Fits a record. The pulse of [`Purpose::HeldOut`] and all after it isn't fitted, but predicted.
///
/// # Errors
/// [`RecordError`], when the record contradicts itself.
pub fn fit(record: &Record, nominal: &Nominal) -> Result<Fit, RecordError> {
    record.check()?;
    let held_out_from = held_out_from(record);
    if let Some(fault) = diagnosis::first_fault(record, nominal) {
        return Ok(Fit::without(Why::Fault(fault), Some(fault)));
    }
    for missing in [Purpose::Warm, Purpose::Ramp] {
        if !record.drives.iter().any(|drive| drive.purpose == missing) {
            let missing = if missing == Purpose::Warm { "warm pulse" } else { "ramp" };
            return Ok(Fit::without(Why::TooShort { missing }, None));
        }
    }
    if held_out_from < FEWEST {
        return Ok(Fit::without(Why::TooShort { missing: "100 samples" }, None));
    }
    let space = space(record, nominal);
    let course = Course::new(record, held_out_from);
    let start = search(record, &course, held_out_from, nominal, space, 1e-6);
    let solution = Problem::new(record, &course, held_out_from, nominal, space).polish(&start);
    let candidate = space.at(&solution.point);
    let predicted = Problem::moments(&Course::new(record, record.samples.len()), &candidate);
    let fitted = predicted.get(..held_out_from).unwrap_or(&predicted);

    let residuals = Residuals::new(record, &solution);
    let held_out = HeldOut::new(record, &predicted);
    let fault = drifting(record, nominal, &predicted);
    let judge = Judge { space, solution, candidate, fitted, residuals, held_out, fault };
    Ok(Fit {
        estimates: judge.estimates(),
        fault,
        residuals: Some(residuals),
        held_out,
        predicted_c: predicted.iter().map(|moment| moment.bead_c).collect(),
        model: Some(candidate.model),
    })
}

/// The hinge as far as a record shows it that isn't complete: for choosing the next pulse.
pub(crate) fn provisional(record: &Record, nominal: &Nominal) -> Option<Model> {
    let count = held_out_from(record);
    if count < FEWEST {
        return None;
    }
    let space = space(record, nominal);
    let course = Course::new(record, count);
    let point = search(record, &course, count, nominal, space, 1e-3);
    Some(space.at(&point).model)
}

/// Temperature at rest: the median before the first pulse.
pub(crate) fn ambient_c(record: &Record) -> f64 {
    let mut readings: Vec<f64> = record.baseline().iter().map(|sample| sample.reading_c).collect();
    readings.sort_by(f64::total_cmp);
    readings.get(readings.len() / 2).copied().unwrap_or(22.0)
}

fn space(record: &Record, nominal: &Nominal) -> Space {
    Space::new(nominal, diagnosis::electrical(record), ambient_c(record))
}

/// How many samples may be fitted.
fn held_out_from(record: &Record) -> usize {
    let drive = record.drives.iter().find(|drive| drive.purpose == Purpose::HeldOut);
    drive.map_or(record.samples.len(), |drive| record.index_after(drive.from_s))
}

/// First the pulses below As, which have one optimum; then the whole from the likeliest alloys, with a slow and a quick thermistor
/// (whose lag may be taken for the film's), until nothing but noise is left.
fn search(
    record: &Record,
    course: &Course,
    count: usize,
    nominal: &Nominal,
    space: Space,
    tolerance: f64,
) -> Point {
    const SHIFTS_K: [f64; 11] = [-25.0, -20.0, -15.0, -10.0, -5.0, 0.0, 5.0, 10.0, 15.0, 20.0, 25.0];
    const ALLOYS: usize = 2;
    const LAGS: [f64; 3] = [1.5, 0.5, 1.0];
    const NOISE: f64 = 1.3;
    let below = record
        .drives
        .iter()
        .find(|drive| drive.purpose > Purpose::Warm)
        .map_or(count, |drive| record.index_after(drive.from_s));
    let before = Course::new(record, below);
    let (warm, _) = Problem::new(record, &before, below, nominal, space).descend(&Point::zeros(), 1e-3);
    if below == count {
        return warm;
    }
    let mut problem = Problem::new(record, course, count, nominal, space);
    let plain = space.unbiased(&warm, 1.0);
    let mut alloys: Vec<(f64, f64)> =
        SHIFTS_K.iter().map(|shift_k| (problem.cost(&space.shifted(&plain, *shift_k)), *shift_k)).collect();
    alloys.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut best = (f64::INFINITY, warm);
    for lag in LAGS {
        for (_, shift_k) in alloys.iter().take(ALLOYS) {
            let start = space.shifted(&space.unbiased(&warm, lag), *shift_k);
            let (point, cost) = problem.descend(&start, tolerance);
            if cost < best.0 {
                best = (cost, point);
            }
            if problem.correlation(&best.1) < NOISE {
                return best.1;
            }
        }
    }
    best.1
}

/// Whether the reading at rest moved: the residuals at the end of each rest, where nothing but the air counts.
fn drifting(record: &Record, nominal: &Nominal, predicted: &[Moment]) -> Option<Diagnosis> {
    const LAST: usize = 10;
    let expected_k = 0.35 + 4.0 * nominal.sensor.k_per_count(ambient_c(record));
    let ends = record.drives.iter().skip(1).map(|drive| record.index_after(drive.from_s));
    let mut worst_k: f64 = 0.0;
    for end in ends.chain([record.samples.len()]) {
        let range = end.saturating_sub(LAST)..end;
        let (Some(samples), Some(moments)) = (record.samples.get(range.clone()), predicted.get(range)) else {
            continue;
        };
        let sum: f64 =
            samples.iter().zip(moments).map(|(sample, moment)| sample.reading_c - moment.bead_c).sum();
        let mean_k = sum / samples.len().max(1) as f64;
        if mean_k.abs() > worst_k.abs() {
            worst_k = mean_k;
        }
    }
    (worst_k.abs() > expected_k).then_some(Diagnosis::Drifting { change_k: worst_k, expected_k })
}

impl Fit {
    fn without(why: Why, fault: Option<Diagnosis>) -> Self {
        let estimate = |quantity| Estimate { quantity, verdict: Verdict::NotIdentified { why } };
        Self {
            estimates: Quantity::ALL.into_iter().map(estimate).collect(),
            fault,
            residuals: None,
            held_out: None,
            predicted_c: Vec::new(),
            model: None,
        }
    }
}

/// All that a verdict depends on.
struct Judge<'a> {
    space: Space,
    solution: Solution,
    candidate: Candidate,
    fitted: &'a [Moment],
    residuals: Residuals,
    held_out: Option<HeldOut>,
    fault: Option<Diagnosis>,
}

impl Judge<'_> {
    fn estimates(&self) -> Vec<Estimate> {
        let all = Quantity::ALL.into_iter();
        all.map(|quantity| Estimate { quantity, verdict: self.verdict(quantity) }).collect()
    }

    fn verdict(&self, quantity: Quantity) -> Verdict {
        let why = self.misfit().or_else(|| self.not_reached(quantity));
        match (why, value(&self.candidate.model, quantity)) {
            (Some(why), _) => Verdict::NotIdentified { why },
            (None, None) => Verdict::NotIdentified { why: Why::AngleUnseen },
            (None, Some(value)) => self.interval(quantity, value),
        }
    }

    fn misfit(&self) -> Option<Why> {
        if let Some(fault) = self.fault {
            return Some(Why::Fault(fault));
        }
        // Asked this way round, a NaN is a misfit.
        let rmse_k = self.residuals.rmse_k;
        let fits = rmse_k <= MOST_MISFIT_K;
        if !fits {
            return Some(Why::Misfit { rmse_k, most_k: MOST_MISFIT_K });
        }
        let rmse_k = self.held_out.map_or(0.0, |held_out| held_out.worse_rmse_k());
        let predicts = rmse_k <= MOST_HELD_OUT_K;
        (!predicts).then_some(Why::HeldOut { rmse_k, most_k: MOST_HELD_OUT_K })
    }

    /// What the foil would have had to get to, and how far it got.
    fn not_reached(&self, quantity: Quantity) -> Option<Why> {
        // A cosine begins flat: less than this past As is hardly seen.
        const PAST_K: f64 = 2.0;
        // It ends flat as well: a foil that doesn't get hotter than where it stops may not have turned as a whole.
        const BEYOND_K: f64 = 1.0;
        // Less austenite gives back too little heat.
        const HALF: f64 = 0.5;
        let highest_c = self.fitted.iter().map(|moment| moment.foil_c).fold(f64::NEG_INFINITY, f64::max);
        let turned = self.fitted.iter().map(|moment| moment.austenite).fold(0.0, f64::max);
        let at: Transformation = self.candidate.model.transformation;
        let unless =
            |reached: bool, expected_c| (!reached).then_some(Why::NotReached { highest_c, expected_c });
        match quantity {
            Quantity::ThermalResistance
            | Quantity::TimeConstant
            | Quantity::HeaterResistance
            | Quantity::FoilRise
            | Quantity::ThermistorLag
            | Quantity::Opening => None,
            Quantity::AusteniteStart => unless(highest_c >= at.as_c + PAST_K, at.as_c + PAST_K),
            Quantity::AusteniteFinish | Quantity::LatentHeat => {
                unless(highest_c >= at.af_c + BEYOND_K, at.af_c + BEYOND_K)
            }
            Quantity::MartensiteStart | Quantity::MartensiteFinish if turned < HALF => unless(false, at.af_c),
            Quantity::MartensiteStart | Quantity::MartensiteFinish => {
                let hot = self.fitted.iter().position(|moment| moment.austenite >= HALF).unwrap_or(0);
                let after = self.fitted.iter().skip(hot);
                let lowest_c = after.map(|moment| moment.foil_c).fold(f64::INFINITY, f64::min);
                let expected_c =
                    if quantity == Quantity::MartensiteStart { at.ms_c - PAST_K } else { at.mf_c };
                (lowest_c > expected_c).then_some(Why::NotCooled { lowest_c, expected_c })
            }
        }
    }

    fn interval(&self, quantity: Quantity, best: f64) -> Verdict {
        let half = half_interval(&self.space, &self.solution, quantity, best);
        let most = match quantity.widest() {
            Width::Share(share) => share * best.abs(),
            Width::Absolute(most) => most,
        };
        // Asked this way round, a NaN isn't identified.
        if half <= most {
            Verdict::Identified(Interval { value: best, low: best - half, high: best + half })
        } else {
            Verdict::NotIdentified { why: Why::TooWide { value: best, half, most, unit: quantity.unit() } }
        }
    }
}
