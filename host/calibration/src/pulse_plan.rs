//! Which pulse is next: chosen from what the record so far has shown, within the bounds. A record that was interrupted is taken up
//! where it ended, for the plan keeps nothing but the record.
//!
//! ```text
//!   Watch --> Probe --> Warm --> Ramp --> Again --> HeldOut --> Done
//!     |         |        |        |         |
//!     +---------+--------+--------+---------+----> Refusal
//! ```

use crate::diagnosis::{self, Diagnosis};
use crate::fit;
use crate::model::{Model, State};
use crate::nominal::{Bounds, Nominal};
use crate::record::{Record, RecordError};

/// What a pulse is for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Purpose {
    /// Weak and brief: is there a heater, a thermistor, and do they belong together?
    Probe,
    /// Long and below As: thermal resistance and time constant.
    Warm,
    /// Slowly through the transformation: latent heat, As, Af, and Mf, Ms on the way back.
    Ramp,
    /// Faster through it: tells the film and the thermistor's lag from the foil.
    Again,
    /// With all power, kept from the fit: does it predict what it hasn't seen?
    HeldOut,
}

impl Purpose {
    /// In the order in which they are driven.
    pub const ALL: [Self; 5] = [Self::Probe, Self::Warm, Self::Ramp, Self::Again, Self::HeldOut];
}

/// A pulse and the rest after it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pulse {
    /// What it is for.
    pub purpose: Purpose,
    /// Constant duty, 0.001 to 1.
    pub duty: f64,
    /// The heater goes off after so long ...
    pub longest_s: f64,
    /// ... or as soon as the thermistor reads this.
    pub until_c: f64,
    /// Then it rests, and is sampled on, until the thermistor reads this ...
    pub rest_below_c: f64,
    /// ... or for so long, but not for less than the shortest rest.
    pub longest_rest_s: f64,
}

/// What to do next.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Next {
    /// Sample with the heater off.
    Watch {
        /// For so long.
        for_s: f64,
    },
    /// Drive a pulse.
    Pulse(Pulse),
    /// The record is complete.
    Done,
}

/// Why a hinge must not be heated (on).
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum Refusal {
    /// The record contradicts itself.
    #[error(transparent)]
    Record(#[from] RecordError),
    /// Something is broken.
    #[error(transparent)]
    Fault(#[from] Diagnosis),
    /// It may be open already, and can't be measured.
    #[error(
        "the hinge rests at {ambient_c:.1} °C, expected below {below_c:.1} °C, where its alloy is martensite: let it cool, or name its alloy"
    )]
    TooWarm {
        /// What the thermistor reads at rest.
        ambient_c: f64,
        /// Nominal Ms.
        below_c: f64,
    },
    /// It was heated shortly before.
    #[error(
        "the hinge isn't at rest: its reading went from {first_c:.2} to {last_c:.2} °C with the heater off, expected within {within_k:.2} K"
    )]
    NotAtRest {
        /// First reading.
        first_c: f64,
        /// Last reading.
        last_c: f64,
        /// The most that is rest.
        within_k: f64,
    },
    /// The limit doesn't let it transform.
    #[error(
        "the limit of {limit_c:.1} °C leaves no room above the austenite start of {as_c:.1} °C: raise it, or name another alloy"
    )]
    LimitTooLow {
        /// The limit.
        limit_c: f64,
        /// Nominal As.
        as_c: f64,
    },
}

const BASELINE_S: f64 = 2.0;
/// Kept below the limit: noise, and what a model that isn't fitted yet doesn't know.
const MARGIN_K: f64 = 5.0;

/// What to do next with a hinge of which `record` is known. Call it again once that is done.
///
/// # Errors
/// [`Refusal`], when the hinge must not be heated (on).
pub fn next(record: &Record, nominal: &Nominal, bounds: &Bounds) -> Result<Next, Refusal> {
    record.check()?;
    let baseline = record.baseline();
    let watched_s = match baseline {
        [first, .., last] => last.t_s - first.t_s,
        _ => 0.0,
    };
    if watched_s < BASELINE_S * 0.95 {
        return Ok(Next::Watch { for_s: BASELINE_S - watched_s.min(BASELINE_S) + 0.1 });
    }
    if let Some(fault) = diagnosis::first_fault(record, nominal) {
        return Err(fault.into());
    }
    let ambient_c = fit::ambient_c(record);
    let at = &nominal.transformation;
    if ambient_c >= at.ms_c {
        return Err(Refusal::TooWarm { ambient_c, below_c: at.ms_c });
    }
    at_rest(record, nominal)?;
    let limit_c = bounds.max_temperature_c;
    if limit_c - MARGIN_K < at.as_c {
        return Err(Refusal::LimitTooLow { limit_c, as_c: at.as_c });
    }
    let done = record.drives.iter().map(|drive| drive.purpose).max();
    let Some(purpose) = Purpose::ALL.into_iter().find(|purpose| done.is_none_or(|done| *purpose > done))
    else {
        return Ok(Next::Done);
    };
    let model = match done {
        None | Some(Purpose::Probe) => Model::nominal(nominal, ambient_c),
        Some(Purpose::Warm | Purpose::Ramp | Purpose::Again | Purpose::HeldOut) => {
            fit::provisional(record, nominal).unwrap_or_else(|| Model::nominal(nominal, ambient_c))
        }
    };
    let heater_ohm = diagnosis::electrical(record).map_or(nominal.heater_ohm, |heater| heater.ohm);
    let voltage_v = record.samples.last().map_or(0.0, |sample| sample.voltage_v);
    let planner = Planner {
        full_w: voltage_v * voltage_v / heater_ohm,
        model: Model { ambient_c, heater_ohm, ..model },
        bounds,
    };
    Ok(Next::Pulse(planner.pulse(purpose, nominal, record)))
}

fn at_rest(record: &Record, nominal: &Nominal) -> Result<(), Refusal> {
    let [first, .., last] = record.baseline() else { return Ok(()) };
    let within_k = 0.3 + 8.0 * nominal.sensor.k_per_count(last.reading_c);
    if (last.reading_c - first.reading_c).abs() > within_k {
        return Err(Refusal::NotAtRest { first_c: first.reading_c, last_c: last.reading_c, within_k });
    }
    Ok(())
}

/// Chooses duty and end of a pulse by running the model.
struct Planner<'a> {
    model: Model,
    /// Power at full duty.
    full_w: f64,
    bounds: &'a Bounds,
}

/// How a pulse would go.
struct Forecast {
    /// When the thermistor reads the target; none within the longest pulse.
    reached_s: Option<f64>,
    /// Highest reading.
    peak_c: f64,
}

impl Planner<'_> {
    fn pulse(&self, purpose: Purpose, nominal: &Nominal, record: &Record) -> Pulse {
        // A nominal Af may be this much too low.
        const ALLOY_K: f64 = 18.0;
        // Past Af nothing more is to be seen but that it is past.
        const PAST_K: f64 = 12.0;
        const PROBE_S: f64 = 1.5;
        const PROBE_W: f64 = 0.25;
        const BELOW_AS_K: f64 = 8.0;
        let ambient_c = self.model.ambient_c;
        let limit_c = self.bounds.max_temperature_c - MARGIN_K;
        let (nominal_at, fitted_at) = (&nominal.transformation, &self.model.transformation);
        let longest_s = self.bounds.max_on_s;
        // A settled reading fluctuates by a count or two.
        let rest_below_c = ambient_c + 1.5 + 2.0 * nominal.sensor.k_per_count(ambient_c);
        let rests = 8.0 * self.model.time_constant_s() + 15.0;
        let pulse = |duty: f64, longest_s: f64, until_c: f64| Pulse {
            purpose,
            duty: (duty * 1000.0).round().clamp(1.0, 1000.0) / 1000.0,
            longest_s,
            until_c,
            rest_below_c,
            longest_rest_s: rests.max(self.bounds.min_rest_s),
        };
        let passed = self.highest_c(record);
        // What the ramp showed of Af counts once it was passed.
        let target_c = if passed > fitted_at.af_c {
            fitted_at.af_c + PAST_K
        } else {
            nominal_at.af_c.max(fitted_at.af_c) + ALLOY_K
        };
        match purpose {
            Purpose::Probe => pulse(PROBE_W / self.full_w, PROBE_S.min(longest_s), ambient_c + 20.0),
            Purpose::Warm => {
                let top_c = nominal_at.as_c - BELOW_AS_K;
                let power_w = (top_c - 2.0 - ambient_c) / self.model.foil_rise_k_per_w();
                pulse(power_w / self.full_w, longest_s, top_c)
            }
            Purpose::Ramp | Purpose::Again => {
                let share = if purpose == Purpose::Ramp { 0.75 } else { 0.35 };
                let duty = self.duty_for(target_c, share * longest_s);
                pulse(duty, longest_s, self.end_c(duty, target_c, limit_c))
            }
            Purpose::HeldOut => pulse(1.0, longest_s, self.end_c(1.0, target_c, limit_c)),
        }
    }

    /// The hottest that the thermistor was.
    fn highest_c(&self, record: &Record) -> f64 {
        record.samples.iter().map(|sample| sample.reading_c).fold(self.model.ambient_c, f64::max)
    }

    /// The least duty that reaches a target in time; 1 if none does.
    fn duty_for(&self, target_c: f64, within_s: f64) -> f64 {
        const ROUNDS: u32 = 12;
        let (mut low, mut high) = (0.0, 1.0);
        for _ in 0..ROUNDS {
            let duty = f64::midpoint(low, high);
            let reached = self.forecast(&self.model, duty, target_c, within_s).reached_s;
            if reached.is_some() {
                high = duty;
            } else {
                low = duty;
            }
        }
        high
    }

    /// Where to switch off so that the reading, which goes on rising, stays below the limit: without the latent heat, which
    /// can't be relied on.
    fn end_c(&self, duty: f64, target_c: f64, limit_c: f64) -> f64 {
        const ROUNDS: u32 = 8;
        let bare = Model { latent_j: 0.0, ..self.model };
        let mut end_c = target_c.min(limit_c);
        for _ in 0..ROUNDS {
            let over_k = self.forecast(&bare, duty, end_c, self.bounds.max_on_s).peak_c - limit_c;
            if over_k <= 0.0 {
                break;
            }
            end_c -= over_k;
        }
        end_c
    }

    fn forecast(&self, model: &Model, duty: f64, target_c: f64, longest_s: f64) -> Forecast {
        const STEP_S: f64 = 0.05;
        // As slow as the sampling, and a tick more.
        const LATE_S: f64 = 0.1;
        const AFTER_S: f64 = 3.0;
        let mut state = State::at_rest(model.ambient_c);
        let (mut t_s, mut reached_s) = (0.0, None);
        let mut peak_c = state.bead_c;
        let mut off_s = longest_s;
        while t_s < off_s + AFTER_S {
            model.advance(&mut state, STEP_S, if t_s < off_s { duty * self.full_w } else { 0.0 });
            t_s += STEP_S;
            peak_c = peak_c.max(state.bead_c);
            if reached_s.is_none() && t_s <= longest_s && state.bead_c >= target_c {
                reached_s = Some(t_s);
                off_s = t_s + LATE_S;
            }
        }
        Forecast { reached_s, peak_c }
    }
}
