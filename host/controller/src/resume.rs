//! An earlier run's report as the start of the next one (S12).

use crate::report::{HingeOutcome, RunReport};
use serde::Deserialize;
use std::collections::BTreeSet;
use zygote_deployment::{Direction, Kind, Schedule};

/// What a report says of an earlier run, as far as the next one needs it.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize)]
pub struct EarlierRun {
    rig: String,
    direction: Direction,
    hinges: Vec<EarlierHinge>,
}

#[derive(Debug, Clone, PartialEq, Eq, Deserialize)]
struct EarlierHinge {
    hinge: usize,
    kind: Kind,
    outcome: HingeOutcome,
}

impl From<&RunReport> for EarlierRun {
    fn from(report: &RunReport) -> Self {
        let hinges = report.hinges.iter();
        let hinges =
            hinges.map(|one| EarlierHinge { hinge: one.hinge, kind: one.kind, outcome: one.outcome });
        Self { rig: report.rig.clone(), direction: report.direction, hinges: hinges.collect() }
    }
}

/// Why a run can't go on from an earlier one.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum ResumeError {
    /// Another rig, way or set of hinges.
    #[error("the report is of another run than this schedule's: {what}")]
    OtherRun {
        /// What differs.
        what: String,
    },
    /// Servos of which nobody knows where they are.
    #[error(
        "the servos of hinges {} were interrupted, and may stand anywhere: bring them back by hand to where they started, then say so \
         with --interrupted-are-back",
        list(hinges)
    )]
    Interrupted {
        /// Their hinges.
        hinges: Vec<usize>,
    },
    /// Nothing is left to do.
    #[error("every hinge of that run reached its angle: nothing is left to do")]
    Complete,
}

fn list(hinges: &[usize]) -> String {
    hinges.iter().map(usize::to_string).collect::<Vec<_>>().join(", ")
}

impl EarlierRun {
    /// The hinges that need not be moved again. A heater that was interrupted is heated anew, and a spring released anew; a servo may
    /// stand anywhere, so somebody has to put it `back` to where it started.
    ///
    /// # Errors
    /// [`ResumeError`], when the run can't go on.
    pub fn open(&self, schedule: &Schedule, back: bool) -> Result<BTreeSet<usize>, ResumeError> {
        let other = |what: String| Err(ResumeError::OtherRun { what });
        if self.rig != schedule.rig {
            return other(format!("expected rig `{}`, found `{}`", schedule.rig, self.rig));
        }
        if self.direction != schedule.direction() {
            return other(format!("expected the way {:?}, found {:?}", schedule.direction(), self.direction));
        }
        let all: BTreeSet<_> = schedule.steps.iter().map(|step| step.hinge).collect();
        let told: BTreeSet<_> = self.hinges.iter().map(|hinge| hinge.hinge).collect();
        if all != told {
            return other(format!(
                "expected {} hinges, found {}, not all of them the same",
                all.len(),
                told.len()
            ));
        }
        let of = |outcome| self.hinges.iter().filter(move |hinge| hinge.outcome == outcome);
        let lost = of(HingeOutcome::Interrupted).filter(|hinge| hinge.kind == Kind::Servo);
        let lost: Vec<_> = lost.map(|hinge| hinge.hinge).collect();
        if !lost.is_empty() && !back {
            return Err(ResumeError::Interrupted { hinges: lost });
        }
        let open: BTreeSet<_> = of(HingeOutcome::Opened).map(|hinge| hinge.hinge).collect();
        if open == all { Err(ResumeError::Complete) } else { Ok(open) }
    }
}
