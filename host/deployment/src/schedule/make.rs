//! Makes a schedule: from an order and a rig the tasks, the shortest schedule found of them, and what each step waits for.

use super::motion::{Cost, start_opening_deg};
use super::problem::{Problem, Task};
use super::search::{self, Found};
use super::waiting::{self, Gathering, Waiting};
use super::{Fingerprint, Milliamps, Millis, Schedule, Step, VERSION, greedy, lower_bound};
use crate::calibration::Calibration;
use crate::order::Order;
use crate::rig::{Fitting, Kind, Rig, RigError};
use crate::tree::{Tree, TreeError};
use zygote_stacking::Plan;

/// Rounds of letting steps wait for each other, before all wait one for the other.
const ROUNDS: usize = 24;
/// Random lists in such a round, a share of those of the first search.
const SHARE: usize = 10;

/// What a schedule keeps to beside the order and the supply.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Limits {
    /// Most motions at once, at least 1; without it as many as the rest allows.
    pub parallel: Option<usize>,
    /// Of the servos of a node, which share a bus, one moves at a time.
    pub one_servo_a_node: bool,
    /// How many lists at random are tried where the rules find no schedule that is proven to be the shortest.
    pub samples: usize,
}

impl Default for Limits {
    fn default() -> Self {
        Self { parallel: None, one_servo_a_node: false, samples: 1000 }
    }
}

impl Limits {
    /// At most so many motions at once.
    pub fn at_most(parallel: usize) -> Self {
        Self { parallel: Some(parallel), ..Self::default() }
    }
}

/// Why there is no schedule.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum SchedulingError {
    /// The rig can't drive the plan.
    #[error(transparent)]
    Rig(#[from] RigError),
    /// The plan is no tree.
    #[error(transparent)]
    Tree(#[from] TreeError),
    /// The order isn't one of all hinges.
    #[error("order: expected each of the plan's {hinges} hinges once, found {found}")]
    Order {
        /// Hinges of the plan.
        hinges: usize,
        /// What is wrong.
        found: String,
    },
    /// The order contradicts itself.
    #[error("order: hinge {hinge} is to wait for hinge {other}, expected one that comes before it")]
    Late {
        /// The hinge that waits.
        hinge: usize,
        /// What it waits for.
        other: usize,
    },
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

impl Schedule {
    /// Schedules all hinges of a plan in this order, as short as it can be found; the same every time.
    ///
    /// # Errors
    /// [`SchedulingError`] if the rig can't drive the plan, or the order isn't one.
    pub fn plan(plan: &Plan, rig: &Rig, order: &Order, limits: &Limits) -> Result<Self, SchedulingError> {
        let tree = Tree::new(plan)?;
        let before = places(plan.hinges.len(), order)?;
        let fittings = rig.fit_tree(&tree)?;
        let costs: Vec<_> = plan
            .hinges
            .iter()
            .zip(&fittings)
            .enumerate()
            .map(|(number, (hinge, fitting))| Cost::new(rig, number, hinge, &fitting.drive))
            .collect::<Result<_, _>>()?;
        let tasks =
            order.hinges.iter().map(|hinge| task(&costs[*hinge], &fittings[*hinge], limits)).collect();
        let limit = Milliamps::at_most(rig.supply.limit);
        let parallel = limits.parallel.unwrap_or(usize::MAX);
        let in_order = || "a hinge that waits for itself".to_owned();
        let problem = Problem::new(tasks, before, limit.0, parallel)
            .ok_or_else(|| SchedulingError::Order { hinges: plan.hinges.len(), found: in_order() })?;
        let (found, waiting) = solve(&problem, limits.samples).map_err(|stuck| {
            let hinge = order.hinges[stuck.task];
            SchedulingError::Supply {
                hinge,
                needed: costs[hinge].current,
                limit,
                left: Milliamps(stuck.left),
            }
        })?;
        let steps: Vec<_> = waiting
            .tasks
            .iter()
            .zip(waiting.after)
            .map(|(task, after)| {
                let hinge = order.hinges[*task];
                let (fitting, cost) = (&fittings[hinge], &costs[hinge]);
                Step {
                    hinge,
                    node: fitting.node,
                    channel: fitting.channel,
                    after,
                    from_opening_deg: start_opening_deg(&plan.hinges[hinge]),
                    opening_deg: plan.hinges[hinge].opening_deg,
                    start: Millis(found.starts[*task]),
                    duration: cost.duration,
                    current: cost.current,
                    hold_current: cost.hold_current,
                    motion: cost.motion,
                }
            })
            .collect();
        Ok(Self {
            version: VERSION,
            rig: rig.id.clone(),
            calibrated_at: rig.calibrated_by.as_ref().map(Calibration::at),
            plan_crc64: Fingerprint::of(plan),
            order_crc64: Fingerprint::of_order(&steps),
            certificate: None,
            loads: None,
            parallel: limits.parallel.map(|parallel| parallel.max(1)),
            one_servo_a_node: limits.one_servo_a_node,
            supply_limit: limit,
            peak_current: peak(&steps),
            makespan: Millis(found.makespan),
            lower_bound: Millis(found.bound),
            steps,
        })
    }
}

/// What each place of an order waits for, in places.
fn places(hinges: usize, order: &Order) -> Result<Vec<Vec<usize>>, SchedulingError> {
    let refuse = |found: String| SchedulingError::Order { hinges, found };
    if order.hinges.len() != hinges || order.waits_for.len() != hinges {
        return Err(refuse(format!(
            "{} hinges, and what {} wait for",
            order.hinges.len(),
            order.waits_for.len()
        )));
    }
    let mut place_of = vec![None; hinges];
    let mut before = Vec::with_capacity(hinges);
    for (place, &hinge) in order.hinges.iter().enumerate() {
        let slot = place_of.get_mut(hinge).ok_or_else(|| refuse(format!("hinge {hinge}")))?;
        if slot.is_some() {
            return Err(refuse(format!("hinge {hinge} again")));
        }
        let earlier = |other: &usize| {
            let known = place_of.get(*other).copied().flatten();
            known.ok_or(SchedulingError::Late { hinge, other: *other })
        };
        before.push(order.waits_for[hinge].iter().map(earlier).collect::<Result<Vec<_>, _>>()?);
        place_of[hinge] = Some(place);
    }
    Ok(before)
}

fn task(cost: &Cost, fitting: &Fitting, limits: &Limits) -> Task {
    let in_turn = limits.one_servo_a_node && fitting.drive.kind() == Kind::Servo;
    Task {
        duration: cost.duration.0.max(1),
        current: cost.current.0,
        hold: cost.hold_current.0.min(cost.current.0),
        turn: in_turn.then_some(fitting.node),
    }
}

/// The best schedule that is found, and what its steps wait for. Where that is more than fits, some tasks have to wait
/// for each other, and the best schedule with that is looked for.
pub(super) fn solve(problem: &Problem, samples: usize) -> Result<(Found, Waiting), greedy::Stuck> {
    let bound = lower_bound::of(problem);
    let mut found = search::best(problem, bound, samples)?;
    let bound = found.bound;
    let mut narrowed = problem.clone();
    for _ in 0..ROUNDS {
        match waiting::of(&narrowed, &found.starts) {
            Ok(waiting) => return Ok((Found { bound, ..found }, waiting)),
            Err(gatherings) => narrowed = narrower(&narrowed, &gatherings, &found.starts),
        }
        found = search::best(&narrowed, lower_bound::of(&narrowed), samples / SHARE)?;
    }
    let starts = greedy::starts(&one_by_one(&narrowed, &found.starts), &vec![0; problem.len()])?;
    let chain = one_by_one(&narrowed, &starts);
    let makespan = chain.makespan(&starts);
    match waiting::of(&chain, &starts) {
        Ok(waiting) => Ok((Found { starts, makespan, bound }, waiting)),
        // A chain waits for the step before it alone, which is that of its lane, its turn and what was held.
        Err(_) => Err(greedy::Stuck { task: 0, left: 0 }),
    }
}

/// The problem with what overfull steps ask for: of all of them, or of the first so many that make no cycle.
fn narrower(problem: &Problem, gatherings: &[Gathering], starts: &[u64]) -> Problem {
    let mut count = gatherings.len();
    while count > 0 {
        if let Some(narrower) = problem.with(&gatherings[..count].concat()) {
            return narrower;
        }
        count /= 2;
    }
    one_by_one(problem, starts)
}

/// Every task after the one that starts before it.
fn one_by_one(problem: &Problem, starts: &[u64]) -> Problem {
    let mut place = vec![0; problem.len()];
    problem.topological.iter().enumerate().for_each(|(at, task)| place[*task] = at);
    let mut tasks: Vec<_> = (0..problem.len()).collect();
    tasks.sort_by_key(|task| (starts[*task], place[*task]));
    let chain: Vec<_> = tasks.windows(2).map(|pair| (pair[0], pair[1])).collect();
    // In the order of starts nothing waits for what comes later.
    problem.with(&chain).unwrap_or_else(|| problem.clone())
}

/// The highest sum of currents.
fn peak(steps: &[Step]) -> Milliamps {
    // Of changes at one time endings come first.
    let mut changes = Vec::with_capacity(2 * steps.len());
    for step in steps {
        changes.push((step.start, true, step.current.0));
        changes.push((step.opened(), false, step.current.0.saturating_sub(step.hold_current.0)));
    }
    changes.sort_unstable();
    let (mut drawn, mut peak) = (0_u64, 0);
    for (_, starts, current) in changes {
        drawn = if starts { drawn + current } else { drawn.saturating_sub(current) };
        peak = peak.max(drawn);
    }
    Milliamps(peak)
}
