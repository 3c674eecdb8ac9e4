//! What a schedule says of its motion, read without the reader of schedules: which plan, which order, what was proved.

use super::DenseError;
use crate::motion::Certificate;
use crate::order::Order;
use crate::schedule::Fingerprint;
use serde::Deserialize;
use zygote_stacking::Plan;

/// A schedule's motion.
#[derive(Debug, Clone, PartialEq)]
pub struct Scheduled {
    /// Its order, with what waits for what.
    pub order: Order,
    /// Hinges that springs open, at a jump.
    pub springs: Vec<usize>,
    /// What was proved of it; none where nothing was.
    pub certificate: Option<Certificate>,
}

#[derive(Deserialize)]
struct File {
    plan_crc64: Fingerprint,
    steps: Vec<Step>,
    #[serde(default)]
    certificate: Option<Certificate>,
}

#[derive(Deserialize)]
struct Step {
    hinge: usize,
    after: Vec<usize>,
    #[serde(default)]
    motion: Motion,
}

#[derive(Default, Deserialize)]
struct Motion {
    #[serde(default)]
    kind: String,
}

impl Scheduled {
    /// Reads a schedule in JSON.
    ///
    /// # Errors
    /// [`DenseError`] if it is none, belongs to another plan, or has a step that waits for none of the steps before it.
    pub fn read(plan: &Plan, schedule: &serde_json::Value) -> Result<Self, DenseError> {
        let File { plan_crc64, steps, certificate } =
            File::deserialize(schedule).map_err(|error| DenseError::Schedule { error: error.to_string() })?;
        let own = Fingerprint::of(plan);
        if plan_crc64 != own {
            return Err(DenseError::OtherPlan { schedule: plan_crc64, plan: own });
        }
        let hinges: Vec<_> = steps.iter().map(|step| step.hinge).collect();
        let mut waits_for = vec![Vec::new(); plan.hinges.len()];
        for step in &steps {
            let refused = || DenseError::Order { hinge: step.hinge };
            let others: Option<Vec<_>> = step.after.iter().map(|after| hinges.get(*after).copied()).collect();
            *waits_for.get_mut(step.hinge).ok_or_else(refused)? = others.ok_or_else(refused)?;
        }
        let springs =
            steps.iter().filter(|step| step.motion.kind == "spring").map(|step| step.hinge).collect();
        Ok(Self { order: Order { hinges, waits_for }, springs, certificate })
    }
}
