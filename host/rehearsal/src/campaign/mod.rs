//! Campaigns: thousands of random trials, each of which is judged by the same rules. A seed and a number give the same
//! trial, to the bit, on every machine.

mod hinges;
mod mishaps;
mod summary;
mod trials;

pub use summary::{Failure, Summary};
pub use trials::{TrialError, trial};

use crate::board::BoardError;
use crate::judge::{Breach, judge, judge_calibration};
use crate::run::{Ending, Rehearsed, Trial};
use std::sync::atomic::{AtomicU64, Ordering};
use std::thread;
use zygote_controller::Outcome;

/// Why a campaign can't go on; a fault of this program.
#[derive(Debug, thiserror::Error)]
pub enum CampaignError {
    /// A trial that can't be made.
    #[error(transparent)]
    Trial(#[from] TrialError),
    /// A trial that can't be run.
    #[error(transparent)]
    Board(#[from] BoardError),
}

/// What the host of a campaign does.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Work {
    /// It opens all hinges.
    Deploy,
    /// It measures the shape-memory hinges.
    Calibrate,
}

/// Runs and judges one trial; with a log if that is asked for.
///
/// # Errors
/// [`CampaignError`].
pub fn replay(
    work: Work,
    seed: u64,
    number: u64,
    log: bool,
) -> Result<(Trial, Rehearsed, Vec<Breach>), CampaignError> {
    if work == Work::Calibrate {
        let trial = Trial { log, ..trials::calibrated(seed, number)? };
        let rehearsed = trial.calibrate()?;
        let mut breaches = judge_calibration(&trial, &rehearsed);
        breaches.extend(unmeasured(&trial, &rehearsed));
        return Ok((trial, rehearsed, breaches));
    }
    let trial = Trial { log, ..trial(seed, number)? };
    let rehearsed = trial.run()?;
    let mut breaches = judge(&trial, &rehearsed);
    breaches.extend(undisturbed(&trial, &rehearsed));
    Ok((trial, rehearsed, breaches))
}

/// Where nothing goes wrong, every hinge opens.
fn undisturbed(trial: &Trial, rehearsed: &Rehearsed) -> Option<Breach> {
    let alone = trial.line.is_empty() && rehearsed.script.happened().next().is_none();
    let deployed = matches!(&rehearsed.ending, Ending::Report(report) if report.outcome == Outcome::Deployed);
    (alone && !deployed).then(|| Breach {
        rule: "S12",
        at: rehearsed.ended_at,
        heater: None,
        what: format!("nothing went wrong, and yet {:?}, {:?}", rehearsed.ending, rehearsed.witness.faults),
    })
}

/// Where nothing goes wrong, every hinge is measured to the end.
fn unmeasured(trial: &Trial, rehearsed: &Rehearsed) -> Option<Breach> {
    let alone = trial.line.is_empty() && rehearsed.script.happened().next().is_none();
    let measured = matches!(rehearsed.ending, Ending::Measured { done, of } if done == of);
    (alone && !measured).then(|| Breach {
        rule: "S12",
        at: rehearsed.ended_at,
        heater: None,
        what: format!("nothing went wrong, and yet {:?}, {:?}", rehearsed.ending, rehearsed.witness.faults),
    })
}

/// Runs the trials 0 to `runs` of a seed on some threads.
///
/// # Errors
/// [`CampaignError`] of the first trial, by number, that can't be made or run.
pub fn run(work: Work, seed: u64, runs: u64, threads: usize) -> Result<Summary, CampaignError> {
    let next = AtomicU64::new(0);
    let worker = || {
        let mut summary = Summary::default();
        loop {
            let number = next.fetch_add(1, Ordering::Relaxed);
            if number >= runs {
                return Ok(summary);
            }
            let (trial, rehearsed, breaches) = replay(work, seed, number, false)?;
            summary.add(number, &trial, &rehearsed, breaches);
        }
    };
    let results: Vec<Result<Summary, CampaignError>> = thread::scope(|scope| {
        let workers: Vec<_> = (0..threads.max(1)).map(|_| scope.spawn(worker)).collect();
        workers
            .into_iter()
            .map(|worker| worker.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic)))
            .collect()
    });
    let mut all = Summary::default();
    for result in results {
        all.merge(result?);
    }
    all.failures.sort_by_key(|failure| failure.number);
    Ok(all)
}

/// A number that tells two rehearsals apart by what truly happened in them: equal for equal seeds.
pub fn fingerprint(rehearsed: &Rehearsed) -> u64 {
    // FNV-1a.
    let mut hash = 0xcbf2_9ce4_8422_2325_u64;
    let mut eat = |bits: u64| {
        for byte in bits.to_le_bytes() {
            hash = (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
        }
    };
    let witness = &rehearsed.witness;
    eat(rehearsed.ended_at.0);
    for span in witness.energised.iter().chain(&witness.heated) {
        eat(span.from.0);
        eat(span.to.0);
    }
    for hinge in &witness.hinges {
        eat(hinge.angle_deg.to_bits());
        eat(hinge.hottest.map_or(0, |(celsius, _)| celsius.to_bits()));
        eat(hinge.driven_at.unwrap_or_default().0);
    }
    for (at, _) in &witness.states {
        eat(at.0);
    }
    hash
}

#[cfg(test)]
mod tests;
