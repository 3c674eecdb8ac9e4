//! Makes a schedule: list scheduling of the hinges on a number of lanes, each lane one motion at a time.
//!
//! Of the steps whose hinge before them is opened, the one with the longest way to go to its farthest tip is
//! started first, as soon as a lane is free and the supply has current for it. With one lane the order is that of
//! [`Tree::branches`] instead: the safest one, as long as nothing looks for collisions.
//!
//! What makes a step wait here is written into its `after`, so that a run that is slower or faster than
//! expected keeps the order of the tree and the number of motions at once.

use super::motion::{Cost, start_opening_deg};
use super::{Fingerprint, Milliamps, Millis, Schedule, Step, VERSION};
use crate::rig::{Fitting, Rig, RigError};
use crate::tree::{Tree, TreeError};
use std::cmp::Reverse;
use std::collections::BinaryHeap;
use zygote_stacking::Plan;

/// Why there is no schedule.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum SchedulingError {
    /// The rig can't drive the plan.
    #[error(transparent)]
    Rig(#[from] RigError),
    /// The plan is no tree.
    #[error(transparent)]
    Tree(#[from] TreeError),
    /// What already stands open takes too much to go on.
    #[error(
        "hinge {hinge} needs {needed}, but of the supply limit of {limit} the hinges that hold their angle leave \
         only {left}; raise supply.limit or lower servo.hold_current"
    )]
    Supply {
        /// The hinge that can't be moved.
        hinge: usize,
        /// What its motion draws.
        needed: Milliamps,
        /// The limit in the rig file.
        limit: Milliamps,
        /// What is left.
        left: Milliamps,
    },
}

/// A hinge that may move as soon as there is room, best first.
#[derive(PartialEq, Eq, PartialOrd, Ord)]
struct Ready {
    /// Longest way from the start of this motion to the end of the last that waits for it.
    remaining: Millis,
    /// Place in the order of the tree; the lower first.
    branch: Reverse<usize>,
}

struct Lists<'a> {
    tree: &'a Tree,
    fittings: &'a [Fitting],
    costs: &'a [Cost],
    limit: Milliamps,
    /// Step of each hinge that has one.
    step_of_hinge: Vec<Option<usize>>,
    /// Last step of each lane.
    lanes: Vec<Option<usize>>,
    steps: Vec<Step>,
}

impl Schedule {
    /// Schedules all hinges of a plan, at most `parallel` (at least 1) at a time.
    ///
    /// # Errors
    /// [`SchedulingError`] if the rig can't drive the plan.
    pub fn plan(plan: &Plan, rig: &Rig, parallel: usize) -> Result<Self, SchedulingError> {
        let tree = Tree::new(plan)?;
        let fittings = rig.fit(plan.hinges.len())?;
        let costs: Vec<_> = plan
            .hinges
            .iter()
            .zip(&fittings)
            .map(|(hinge, fitting)| Cost::new(rig, hinge, &fitting.drive))
            .collect();
        let parallel = parallel.clamp(1, plan.hinges.len().max(1));
        let mut lists = Lists {
            tree: &tree,
            fittings: &fittings,
            costs: &costs,
            limit: Milliamps::at_most(rig.supply.limit),
            step_of_hinge: vec![None; plan.hinges.len()],
            lanes: vec![None; parallel],
            steps: Vec::with_capacity(plan.hinges.len()),
        };
        let peak_current = lists.run(plan)?;
        let (limit, steps) = (lists.limit, lists.steps);
        Ok(Self {
            version: VERSION,
            rig: rig.id.clone(),
            plan_crc64: Fingerprint::of(plan),
            parallel,
            supply_limit: limit,
            peak_current,
            makespan: steps.iter().map(Step::opened).max().unwrap_or_default(),
            steps,
        })
    }
}

impl Lists<'_> {
    /// Starts every step, and returns the highest sum of currents.
    fn run(&mut self, plan: &Plan) -> Result<Milliamps, SchedulingError> {
        let children = self.children();
        let remaining = self.remaining();
        let mut ready = BinaryHeap::new();
        let push = |ready: &mut BinaryHeap<Ready>, branches: &[usize]| {
            ready.extend(branches.iter().map(|&b| Ready { remaining: remaining[b], branch: Reverse(b) }));
        };
        let firsts: Vec<_> =
            (0..remaining.len()).filter(|&b| self.tree.branches()[b].before.is_none()).collect();
        push(&mut ready, &firsts);
        let mut running: BinaryHeap<Reverse<(Millis, usize)>> = BinaryHeap::new();
        let (mut now, mut drawn, mut peak) = (Millis(0), Milliamps(0), Milliamps(0));
        // A step whose end made this moment: what starts now may have waited for the current that it left.
        let mut ended = None;
        loop {
            let mut waiting = Vec::new();
            while running.len() < self.lanes.len() {
                let Some(Ready { branch: Reverse(branch), remaining }) = ready.pop() else { break };
                let needed = self.costs[self.tree.branches()[branch].hinge].current;
                if drawn.0 + needed.0 > self.limit.0 {
                    waiting.push(Ready { remaining, branch: Reverse(branch) });
                    continue;
                }
                drawn.0 += needed.0;
                peak = peak.max(drawn);
                let step = self.start(plan, branch, now, ended, &running);
                running.push(Reverse((self.steps[step].opened(), branch)));
            }
            ready.extend(waiting);
            let Some(&Reverse((time, _))) = running.peek() else {
                let Some(Ready { branch: Reverse(branch), .. }) = ready.pop() else { return Ok(peak) };
                let hinge = self.tree.branches()[branch].hinge;
                let left = Milliamps(self.limit.0.saturating_sub(drawn.0));
                let needed = self.costs[hinge].current;
                return Err(SchedulingError::Supply { hinge, needed, limit: self.limit, left });
            };
            now = time;
            // All that end at this moment, before anything is started at it.
            while let Some(&Reverse((end, branch))) = running.peek()
                && end == now
            {
                running.pop();
                let hinge = self.tree.branches()[branch].hinge;
                let cost = &self.costs[hinge];
                drawn.0 -= cost.current.0 - cost.hold_current.0.min(cost.current.0);
                ended = self.step_of_hinge[hinge];
                push(&mut ready, &children[branch]);
            }
        }
    }

    /// Adds the step of a branch, in a free lane, and returns its index.
    fn start(
        &mut self,
        plan: &Plan,
        branch: usize,
        now: Millis,
        ended: Option<usize>,
        running: &BinaryHeap<Reverse<(Millis, usize)>>,
    ) -> usize {
        let branch = &self.tree.branches()[branch];
        let busy: Vec<_> = running
            .iter()
            .map(|Reverse((_, other))| self.step_of_hinge[self.tree.branches()[*other].hinge])
            .collect();
        // There is one: fewer run than there are lanes.
        let free = self.lanes.iter().position(|last| last.is_none() || !busy.contains(last)).unwrap_or(0);
        let before = branch.before.and_then(|hinge| self.step_of_hinge[hinge]);
        let mut after: Vec<_> = [before, self.lanes[free], ended].into_iter().flatten().collect();
        after.sort_unstable();
        after.dedup();
        let (fitting, cost, hinge) =
            (&self.fittings[branch.hinge], &self.costs[branch.hinge], &plan.hinges[branch.hinge]);
        let index = self.steps.len();
        self.steps.push(Step {
            hinge: branch.hinge,
            node: fitting.node,
            channel: fitting.channel,
            after,
            from_opening_deg: start_opening_deg(hinge),
            opening_deg: hinge.opening_deg,
            start: now,
            duration: cost.duration,
            current: cost.current,
            hold_current: cost.hold_current,
            motion: cost.motion,
        });
        self.step_of_hinge[branch.hinge] = Some(index);
        self.lanes[free] = Some(index);
        index
    }

    /// The branches that wait for each branch.
    fn children(&self) -> Vec<Vec<usize>> {
        let branches = self.tree.branches();
        let mut branch_of_hinge = vec![0; branches.len()];
        let mut children = vec![Vec::new(); branches.len()];
        for (index, branch) in branches.iter().enumerate() {
            branch_of_hinge[branch.hinge] = index;
            if let Some(before) = branch.before {
                children[branch_of_hinge[before]].push(index);
            }
        }
        children
    }

    /// See [`Ready::remaining`]; all equal with one lane, so that the order of the tree decides.
    fn remaining(&self) -> Vec<Millis> {
        let branches = self.tree.branches();
        let mut remaining = vec![Millis(0); branches.len()];
        if self.lanes.len() == 1 {
            return remaining;
        }
        let mut longest = vec![Millis(0); branches.len()];
        // Children come after their parents.
        for (index, branch) in branches.iter().enumerate().rev() {
            remaining[index] = longest[branch.hinge] + self.costs[branch.hinge].duration;
            if let Some(before) = branch.before {
                longest[before] = longest[before].max(remaining[index]);
            }
        }
        remaining
    }
}
