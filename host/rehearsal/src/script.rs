//! The causes of a rehearsal in the course of it: which wait, which are due, which have happened.

use crate::cause::{Cause, What, When};
use crate::subject::Subject;
use zygote_protocol::Micros;

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Stage {
    Waiting,
    Due(Micros),
    Happened(Micros),
}

/// Causes with how far they are.
#[derive(Debug)]
pub struct Script {
    causes: Vec<(Cause, Stage)>,
}

impl Script {
    /// Causes that all wait.
    pub fn new(causes: Vec<Cause>) -> Self {
        Self { causes: causes.into_iter().map(|cause| (cause, Stage::Waiting)).collect() }
    }

    /// Causes that have all happened, for tests of what is made of them.
    #[cfg(test)]
    pub(crate) fn of_the_past(causes: Vec<(Cause, Micros)>) -> Self {
        Self { causes: causes.into_iter().map(|(cause, at)| (cause, Stage::Happened(at))).collect() }
    }

    /// What has happened, with when.
    pub fn happened(&self) -> impl Iterator<Item = (Micros, &What)> {
        self.causes.iter().filter_map(|(cause, stage)| match stage {
            Stage::Happened(at) => Some((*at, &cause.what)),
            Stage::Waiting | Stage::Due(_) => None,
        })
    }

    /// When a cause happened.
    pub fn time_of(&self, index: usize) -> Option<Micros> {
        match self.causes.get(index)?.1 {
            Stage::Happened(at) => Some(at),
            Stage::Waiting | Stage::Due(_) => None,
        }
    }

    /// When something happens by the clock alone.
    pub(crate) fn next_time(&self) -> Option<Micros> {
        let time = |(cause, stage): &(Cause, Stage)| match (stage, cause.when) {
            (Stage::Due(at), _) => Some(*at),
            (Stage::Waiting, When::At(at)) => Some(at.plus(cause.after)),
            (Stage::Waiting | Stage::Happened(_), _) => None,
        };
        self.causes.iter().filter_map(time).min()
    }

    /// Takes what is to happen now, one cause at a time.
    pub(crate) fn take(&mut self, board: &impl Subject) -> Option<What> {
        let now = board.now();
        for (cause, stage) in &mut self.causes {
            if *stage == Stage::Waiting && holds(cause.when, board) {
                *stage = Stage::Due(match cause.when {
                    When::At(at) => at.plus(cause.after),
                    When::State(_) | When::Step { .. } | When::Above { .. } => now.plus(cause.after),
                });
            }
            if let Stage::Due(at) = *stage
                && at <= now
            {
                *stage = Stage::Happened(now);
                return Some(cause.what.clone());
            }
        }
        None
    }
}

fn holds(when: When, board: &impl Subject) -> bool {
    match when {
        When::At(at) => board.now() >= at,
        When::State(state) => board.state() == state,
        When::Step { step, state } => board.step_states().get(step) == Some(&state),
        When::Above { channel, celsius } => {
            board.plant().sma_hinges().get(channel).is_some_and(|hinge| hinge.temperature_c() > celsius)
        }
    }
}
