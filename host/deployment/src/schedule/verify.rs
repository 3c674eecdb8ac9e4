//! Holds a schedule against its plan and rig. Shares nothing with what makes schedules but the rig's settings
//! and the tree: what is wrong there, or was changed by hand since, is found here.

use super::motion::{Cost, start_opening_deg};
use super::{Fingerprint, MOST_AFTER, Milliamps, Millis, Schedule};
use crate::calibration::{CalibratedAt, Calibration};
use crate::rig::{Kind, Rig, RigError};
use crate::statics::{Loads, Statics};
use crate::tree::{Tree, TreeError};
use std::collections::{BTreeMap, BTreeSet};
use zygote_stacking::Plan;

/// Why a schedule must not be run.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum VerifyError {
    /// Made for another plan.
    #[error(
        "schedule: it belongs to the plan {schedule}, this plan is {plan}; make it anew with `zygote schedule`"
    )]
    OtherPlan {
        /// Fingerprint in the schedule.
        schedule: Fingerprint,
        /// Fingerprint of the plan.
        plan: Fingerprint,
    },
    /// Made for another rig.
    #[error(
        "schedule: it belongs to the rig \"{schedule}\", this rig is \"{rig}\"; make it anew with `zygote schedule`"
    )]
    OtherRig {
        /// Id in the schedule.
        schedule: String,
        /// Id in the rig file.
        rig: String,
    },
    /// Made with another calibration.
    #[error(
        "schedule: it was made {schedule}, the rig is now driven {rig}; make it anew with `zygote schedule`"
    )]
    OtherCalibration {
        /// What the schedule says.
        schedule: String,
        /// What the rig says.
        rig: String,
    },
    /// The rig can't drive the plan.
    #[error(transparent)]
    Rig(#[from] RigError),
    /// The plan is no tree.
    #[error(transparent)]
    Tree(#[from] TreeError),
    /// Something that a whole schedule says isn't so.
    #[error("schedule: {key} should be {expected}, found {found}")]
    Whole {
        /// Which key.
        key: &'static str,
        /// What follows from the steps, the plan or the rig.
        expected: String,
        /// What the schedule says.
        found: String,
    },
    /// Something that a step says isn't so.
    #[error("schedule: step {step} (hinge {hinge}): {key} should be {expected}, found {found}")]
    Step {
        /// Index of the step.
        step: usize,
        /// Its hinge.
        hinge: usize,
        /// Which key.
        key: &'static str,
        /// What follows from other steps, the plan or the rig.
        expected: String,
        /// What the schedule says.
        found: String,
    },
    /// A motion isn't what the rig says.
    #[error(
        "schedule: step {step} (hinge {hinge}): {differences}: the rig file or its calibration has changed since; make it anew with \
         `zygote schedule`"
    )]
    Motion {
        /// Index of the step.
        step: usize,
        /// Its hinge.
        hinge: usize,
        /// What should be what, in words.
        differences: String,
    },
    /// More current than the supply gives.
    #[error("schedule: at {time} the motions draw {drawn}, expected at most the supply limit of {limit}")]
    Current {
        /// When.
        time: Millis,
        /// The sum of currents.
        drawn: Milliamps,
        /// The limit.
        limit: Milliamps,
    },
    /// More motions at once than the schedule allows.
    #[error("schedule: at {time} there are {found} motions, expected at most {most} at once")]
    TooManyAtOnce {
        /// When.
        time: Millis,
        /// How many there are.
        found: usize,
        /// How many there may be.
        most: usize,
    },
}

impl Schedule {
    /// Checks that this schedule is for this plan and rig, and safe to run on it as far as it says: every hinge
    /// once, in the order of the tree or in one that was checked, on its channel and with its settings, within the supply
    /// limit.
    ///
    /// # Errors
    /// [`VerifyError`] with the first thing that is wrong.
    pub fn verify(&self, plan: &Plan, rig: &Rig) -> Result<(), VerifyError> {
        let fingerprint = Fingerprint::of(plan);
        if self.plan_crc64 != fingerprint {
            return Err(VerifyError::OtherPlan { schedule: self.plan_crc64, plan: fingerprint });
        }
        if self.rig != rig.id {
            return Err(VerifyError::OtherRig { schedule: self.rig.clone(), rig: rig.id.clone() });
        }
        let calibrated_at = rig.calibrated_by.as_ref().map(Calibration::at);
        if self.calibrated_at != calibrated_at {
            let (schedule, rig) =
                (by_calibration(self.calibrated_at.as_ref()), by_calibration(calibrated_at.as_ref()));
            return Err(VerifyError::OtherCalibration { schedule, rig });
        }
        let limit = Milliamps::at_most(rig.supply.limit);
        whole("supply_limit_ma", limit, self.supply_limit)?;
        whole("number of steps", plan.hinges.len(), self.steps.len())?;
        let step_of_hinge = self.step_of_hinge(plan)?;
        self.verify_waiting()?;
        let tree = Tree::new(plan)?;
        // An order that was checked for collisions may differ from that of the tree; its number tells it from another.
        if self.certificate.is_none() {
            self.verify_tree_order(&tree, &step_of_hinge)?;
        }
        whole("order_crc64", Fingerprint::of_order(&self.steps), self.order_crc64)?;
        self.verify_settings(plan, rig, &tree)?;
        self.verify_turns()?;
        self.verify_currents()?;
        self.verify_loads(plan, rig)
    }

    #[expect(
        clippy::needless_pass_by_value,
        reason = "numbers and fresh strings; a reference would only add noise"
    )]
    fn refuse(
        &self,
        step: usize,
        key: &'static str,
        expected: impl ToString,
        found: impl ToString,
    ) -> VerifyError {
        let hinge = self.steps[step].hinge;
        VerifyError::Step { step, hinge, key, expected: expected.to_string(), found: found.to_string() }
    }

    /// The step of every hinge: each has one.
    fn step_of_hinge(&self, plan: &Plan) -> Result<Vec<usize>, VerifyError> {
        let mut steps = vec![None; plan.hinges.len()];
        for (index, step) in self.steps.iter().enumerate() {
            let slot = steps.get_mut(step.hinge).ok_or_else(|| {
                self.refuse(index, "hinge", format!("less than {}", plan.hinges.len()), step.hinge)
            })?;
            if let Some(other) = slot.replace(index) {
                return Err(self.refuse(
                    index,
                    "hinge",
                    format!("another than that of step {other}"),
                    step.hinge,
                ));
            }
        }
        // As many steps as hinges and none twice: none is missing.
        Ok(steps.into_iter().flatten().collect())
    }

    /// After nothing that comes later, and not before what it waits for is expected to be open.
    fn verify_waiting(&self) -> Result<(), VerifyError> {
        for (index, step) in self.steps.iter().enumerate() {
            if step.after.len() > MOST_AFTER {
                let most = format!("at most {MOST_AFTER} steps");
                return Err(self.refuse(index, "after", most, step.after.len()));
            }
            let rising = step.after.windows(2).all(|pair| pair[0] < pair[1]);
            if !rising || step.after.last().is_some_and(|last| *last >= index) {
                return Err(self.refuse(
                    index,
                    "after",
                    "rising and below its own index",
                    format!("{:?}", step.after),
                ));
            }
            for &other in &step.after {
                let opened = self.steps[other].opened();
                if step.start < opened {
                    let expected = format!("at least {opened}, when step {other} is opened");
                    return Err(self.refuse(index, "start_ms", expected, step.start));
                }
            }
        }
        Ok(())
    }

    /// S10: after the hinge before it in the tree, itself or by way of other steps.
    fn verify_tree_order(&self, tree: &Tree, step_of_hinge: &[usize]) -> Result<(), VerifyError> {
        for branch in tree.branches() {
            let step = step_of_hinge[branch.hinge];
            let before = branch.before.map(|hinge| step_of_hinge[hinge]);
            if let Some(before) = before.filter(|before| !self.waits_for(step, *before)) {
                let expected = format!("with step {before}, the hinge before it");
                return Err(self.refuse(step, "after", expected, format!("{:?}", self.steps[step].after)));
            }
        }
        Ok(())
    }

    fn waits_for(&self, step: usize, before: usize) -> bool {
        if self.steps[step].after.contains(&before) {
            return true;
        }
        let (mut open, mut seen) = (vec![step], BTreeSet::new());
        while let Some(other) = open.pop() {
            // Steps wait for lower ones alone.
            open.extend(
                self.steps[other].after.iter().filter(|other| **other >= before && seen.insert(**other)),
            );
        }
        seen.contains(&before)
    }

    /// Channels, angles and motions are those of plan and rig, and no channel is used twice.
    fn verify_settings(&self, plan: &Plan, rig: &Rig, tree: &Tree) -> Result<(), VerifyError> {
        let fittings = rig.fit_tree(tree)?;
        let mut users: BTreeMap<(usize, Kind, u16), usize> = BTreeMap::new();
        for (index, step) in self.steps.iter().enumerate() {
            let (hinge, fitting) = (&plan.hinges[step.hinge], &fittings[step.hinge]);
            let cost = Cost::new(rig, step.hinge, hinge, &fitting.drive)?;
            let same = |key, expected: String, found: String| {
                if expected == found { Ok(()) } else { Err(self.refuse(index, key, expected, found)) }
            };
            same("node", fitting.node.to_string(), step.node.to_string())?;
            if cost.motion != step.motion {
                let differences = step.motion.differences(&cost.motion);
                return Err(VerifyError::Motion { step: index, hinge: step.hinge, differences });
            }
            same("channel", fitting.channel.to_string(), step.channel.to_string())?;
            same(
                "from_opening_deg",
                start_opening_deg(hinge).to_string(),
                step.from_opening_deg.to_string(),
            )?;
            same("opening_deg", hinge.opening_deg.to_string(), step.opening_deg.to_string())?;
            same("duration_ms", cost.duration.to_string(), step.duration.to_string())?;
            same("current_ma", cost.current.to_string(), step.current.to_string())?;
            same("hold_current_ma", cost.hold_current.to_string(), step.hold_current.to_string())?;
            if let Some(other) = users.insert((step.node, step.motion.kind(), step.channel), index) {
                return Err(self.refuse(
                    index,
                    "channel",
                    format!("another than that of step {other}"),
                    step.channel,
                ));
            }
        }
        Ok(())
    }

    /// Currents and motions at once, at every moment at which something changes; makespan and peak.
    fn verify_currents(&self) -> Result<(), VerifyError> {
        // (time, change of current, change of motions); at one time endings come first, being negative.
        let mut changes: Vec<(Millis, i128, i32)> = Vec::with_capacity(2 * self.steps.len());
        for step in &self.steps {
            let (current, hold) = (i128::from(step.current.0), i128::from(step.hold_current.0));
            changes.push((step.start, current, 1));
            changes.push((step.opened(), hold - current, -1));
        }
        changes.sort_unstable_by_key(|(time, _, motions)| (*time, *motions));
        let (mut drawn, mut peak, mut motions) = (0_i128, 0_i128, 0_i32);
        for (time, current, motion) in changes {
            drawn += current;
            peak = peak.max(drawn);
            motions += motion;
            if drawn > i128::from(self.supply_limit.0) {
                let drawn = Milliamps(u64::try_from(drawn).unwrap_or(u64::MAX));
                return Err(VerifyError::Current { time, drawn, limit: self.supply_limit });
            }
            let found = usize::try_from(motions).unwrap_or(0);
            if let Some(most) = self.parallel.filter(|most| found > *most) {
                return Err(VerifyError::TooManyAtOnce { time, found, most });
            }
        }
        whole("peak_current_ma", Milliamps(u64::try_from(peak).unwrap_or(u64::MAX)), self.peak_current)?;
        let makespan = self.steps.iter().map(super::Step::opened).max().unwrap_or_default();
        whole("makespan_ms", makespan, self.makespan)?;
        if self.lower_bound > makespan {
            let (expected, found) =
                (format!("at most makespan_ms, {makespan}"), self.lower_bound.to_string());
            return Err(VerifyError::Whole { key: "lower_bound_ms", expected, found });
        }
        Ok(())
    }

    /// What was weighed is what this rig's masses, gravity and ratings say.
    fn verify_loads(&self, plan: &Plan, rig: &Rig) -> Result<(), VerifyError> {
        let Some(loads) = &self.loads else { return Ok(()) };
        let refuse = |key, expected, found| Err(VerifyError::Whole { key, expected, found });
        let weighed = match Statics::of(plan, rig, &self.hinges(), loads.support) {
            Ok(statics) => Loads::of(&statics, rig),
            Err(error) => return refuse("loads", format!("left out ({error})"), "some".to_owned()),
        };
        match weighed.difference(loads) {
            Some((key, expected, found)) => refuse(key, expected, found),
            None => Ok(()),
        }
    }

    /// Of the servos of a node one at a time, where the schedule says so.
    fn verify_turns(&self) -> Result<(), VerifyError> {
        if !self.one_servo_a_node {
            return Ok(());
        }
        let servos = self.steps.iter().enumerate().filter(|(_, step)| step.motion.kind() == Kind::Servo);
        let mut servos: Vec<_> =
            servos.map(|(index, step)| (step.node, step.start, step.opened(), index)).collect();
        servos.sort_unstable();
        for pair in servos.windows(2) {
            let [(node, _, opened, before), (other_node, start, _, step)] = [pair[0], pair[1]];
            if node == other_node && start < opened {
                let expected = format!("at least {opened}, when the servo of step {before} has moved");
                return Err(self.refuse(step, "start_ms", expected, start));
            }
        }
        Ok(())
    }
}

fn by_calibration(at: Option<&CalibratedAt>) -> String {
    at.map_or_else(|| "without a calibration".to_owned(), |at| format!("by a calibration at board {at}"))
}

fn whole<T: PartialEq + ToString + Copy>(
    key: &'static str,
    expected: T,
    found: T,
) -> Result<(), VerifyError> {
    if expected == found {
        return Ok(());
    }
    Err(VerifyError::Whole { key, expected: expected.to_string(), found: found.to_string() })
}
