//! How far each hinge is opened at each time of a deployment.

use crate::schedule::{Fingerprint, Millis, ReadError, Schedule, VerifyError};
use crate::tree::{Tree, TreeError};
use zygote_stacking::Plan;

/// Why a plan can't be shown in motion.
#[derive(Debug, thiserror::Error)]
pub enum TimelineError {
    /// The plan is no tree.
    #[error(transparent)]
    Tree(#[from] TreeError),
    /// Its schedule can't be read.
    #[error(transparent)]
    Read(#[from] ReadError),
    /// Its schedule is that of another plan.
    #[error(transparent)]
    Verify(#[from] VerifyError),
}

/// When each hinge moves.
#[derive(Debug, Clone)]
pub struct Timeline {
    /// Start and end of each hinge's motion.
    spans: Vec<(f64, f64)>,
    end: f64,
    scheduled: bool,
}

impl Timeline {
    /// The timeline of the plan's own schedule; without one, hinge after hinge in the order of the tree, all
    /// equally long.
    ///
    /// # Errors
    /// [`TimelineError`] if the plan is no tree or its schedule isn't its own.
    pub fn new(plan: &Plan) -> Result<Self, TimelineError> {
        let mut spans = vec![(0.0, 0.0); plan.hinges.len()];
        if let Some(json) = &plan.schedule {
            let schedule = Schedule::from_json(json)?;
            let fingerprint = Fingerprint::of(plan);
            if schedule.plan_crc64 != fingerprint {
                return Err(
                    VerifyError::OtherPlan { schedule: schedule.plan_crc64, plan: fingerprint }.into()
                );
            }
            for step in &schedule.steps {
                if let Some(span) = spans.get_mut(step.hinge) {
                    *span = (seconds(step.start), seconds(step.opened()));
                }
            }
        } else {
            for (index, branch) in Tree::new(plan)?.branches().iter().enumerate() {
                spans[branch.hinge] = (index as f64, index as f64 + 1.0);
            }
        }
        let end = spans.iter().map(|(_, end)| *end).fold(0.0, f64::max);
        Ok(Self { spans, end, scheduled: plan.schedule.is_some() })
    }

    /// When a hinge starts and when it is opened; `None` if there is no such hinge.
    pub fn span(&self, hinge: usize) -> Option<(f64, f64)> {
        self.spans.get(hinge).copied()
    }

    /// When the last hinge is opened: seconds, or hinges where there is no schedule.
    pub fn end(&self) -> f64 {
        self.end
    }

    /// Of each hinge, how far it is from the zygote (0) to the target (1) at a time, eased in and out.
    pub fn fractions(&self, time: f64) -> Vec<f64> {
        self.spans
            .iter()
            .map(|(start, end)| ease(((time - start) / (end - start).max(1e-9)).clamp(0.0, 1.0)))
            .collect()
    }

    /// How many hinges are opened at a time.
    pub fn opened(&self, time: f64) -> usize {
        self.spans.iter().filter(|(_, end)| *end <= time + 1e-9).count()
    }

    /// The time in words, if there is a schedule.
    pub(super) fn clock(&self, time: f64) -> Option<String> {
        let whole = time.round();
        self.scheduled.then(|| format!("{:.0}:{:02.0}", (whole / 60.0).floor(), whole % 60.0))
    }
}

fn seconds(time: Millis) -> f64 {
    time.0 as f64 / 1e3
}

/// From 0 to 1 with a slow start and a slow end.
pub(super) fn ease(share: f64) -> f64 {
    share * share * (3.0 - 2.0 * share)
}
