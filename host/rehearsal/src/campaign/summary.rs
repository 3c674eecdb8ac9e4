//! What a campaign amounts to: what happened how often, what broke a rule, and the extremes.

use super::fingerprint;
use crate::judge::{Breach, seconds};
use crate::run::{Ending, Rehearsed, Trial};
use std::collections::BTreeMap;
use std::fmt;
use zygote_controller::Outcome;
use zygote_deployment::Motion;

/// A trial in which a rule didn't hold.
#[derive(Debug, Clone)]
pub struct Failure {
    /// Its number.
    pub number: u64,
    /// Of what truly happened in it.
    pub fingerprint: u64,
    /// The rules.
    pub breaches: Vec<Breach>,
}

/// Counts over all trials.
#[derive(Debug, Clone, Default)]
pub struct Summary {
    /// Trials.
    pub runs: u64,
    /// Hinges of all of them.
    pub hinges: u64,
    /// Virtual time of all of them, s.
    pub virtual_s: f64,
    /// Trials in which something happened, by what.
    pub causes: BTreeMap<String, u64>,
    /// Trials with a line that was bad from the start.
    pub bad_lines: u64,
    /// Ends of the host.
    pub endings: BTreeMap<&'static str, u64>,
    /// First faults of the MCU, by code.
    pub faults: BTreeMap<u16, u64>,
    /// How far above its step's limit a foil got at most without a fault of its own thermistor or heater, K.
    pub most_over_limit_k: Option<f64>,
    /// Trials that broke a rule.
    pub failures: Vec<Failure>,
}

impl Summary {
    pub(super) fn add(&mut self, number: u64, trial: &Trial, rehearsed: &Rehearsed, breaches: Vec<Breach>) {
        self.runs += 1;
        self.hinges += trial.schedule.steps.len() as u64;
        self.virtual_s += seconds(rehearsed.ended_at.plus(trial.afterwards));
        self.bad_lines += u64::from(!trial.line.is_empty());
        for (_, what) in rehearsed.script.happened() {
            // Without the numbers: what comes before the first digit or bracket.
            let text = what.to_string();
            let name: String =
                text.chars().map(|letter| if letter.is_ascii_digit() { '#' } else { letter }).collect();
            let name = name.split(['#', '(', ':']).next().unwrap_or_default().trim().to_owned();
            let name = if name.is_empty() { "noise".to_owned() } else { name };
            *self.causes.entry(name).or_default() += 1;
        }
        let ending = match &rehearsed.ending {
            Ending::Report(report) => match report.outcome {
                Outcome::Deployed | Outcome::Folded => "deployed",
                Outcome::Stopped => "stopped",
                Outcome::Paused => "paused",
                Outcome::Fault(_) => "fault",
                Outcome::Lost(_) => "lost",
            },
            Ending::Measured { done, of } if done == of => "calibrated",
            Ending::Measured { .. } => "calibrated in part",
            Ending::Refused(_) => "refused",
            Ending::Killed => "killed",
        };
        *self.endings.entry(ending).or_default() += 1;
        if let Some(fault) = rehearsed.witness.faults.first() {
            *self.faults.entry(fault.code.number()).or_default() += 1;
        }
        self.note_heat(trial, rehearsed);
        if !breaches.is_empty() {
            self.failures.push(Failure { number, fingerprint: fingerprint(rehearsed), breaches });
        }
    }

    fn note_heat(&mut self, trial: &Trial, rehearsed: &Rehearsed) {
        if rehearsed.script.happened().next().is_some() {
            return;
        }
        for (step, hinge) in trial.schedule.steps.iter().zip(&rehearsed.witness.hinges) {
            if let (Motion::Sma(motion), Some((hottest_c, _))) = (step.motion, hinge.hottest) {
                let over_k = hottest_c - f64::from(motion.max_temperature.0) / 100.0;
                self.most_over_limit_k = Some(self.most_over_limit_k.map_or(over_k, |most| most.max(over_k)));
            }
        }
    }

    pub(super) fn merge(&mut self, other: Self) {
        self.runs += other.runs;
        self.hinges += other.hinges;
        self.virtual_s += other.virtual_s;
        self.bad_lines += other.bad_lines;
        for (name, count) in other.causes {
            *self.causes.entry(name).or_default() += count;
        }
        for (name, count) in other.endings {
            *self.endings.entry(name).or_default() += count;
        }
        for (code, count) in other.faults {
            *self.faults.entry(code).or_default() += count;
        }
        self.most_over_limit_k =
            [self.most_over_limit_k, other.most_over_limit_k].into_iter().flatten().reduce(f64::max);
        self.failures.extend(other.failures);
    }
}

impl fmt::Display for Summary {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(
            f,
            "{} runs, {} hinges, {:.1} h of virtual time",
            self.runs,
            self.hinges,
            self.virtual_s / 3600.0
        )?;
        writeln!(f, "{} lines bad from the start", self.bad_lines)?;
        let list = |f: &mut fmt::Formatter<'_>, title: &str, rows: Vec<(String, u64)>| {
            writeln!(f, "{title}:")?;
            rows.iter().try_for_each(|(name, count)| writeln!(f, "  {count:>6}  {name}"))
        };
        list(f, "what went wrong", self.causes.iter().map(|(name, count)| (name.clone(), *count)).collect())?;
        list(
            f,
            "how the host ended",
            self.endings.iter().map(|(name, count)| ((*name).to_owned(), *count)).collect(),
        )?;
        list(
            f,
            "faults of the MCU",
            self.faults.iter().map(|(code, count)| (format!("F{code:02}"), *count)).collect(),
        )?;
        if let Some(over_k) = self.most_over_limit_k {
            writeln!(f, "undisturbed foils stayed at least {:.1} K below their step's limit", -over_k)?;
        }
        write!(f, "{} runs in which a rule didn't hold", self.failures.len())
    }
}
