//! A bound from what can be done by when, for hinges that hold: the more are open, the fewer move.
//!
//! Work is measured by moves (each task's duration) or by charge (duration times current). In any schedule, let work
//! `x` of `W` be done at the time `t`, out of `T`. Then
//!
//! ```text
//! t >= time(x), the larger of         by heads: no task does any work before its head
//!                                     by rates: the work before x goes on at no more than rate(x)
//! T - t >= by tails(W - x)            turned round: no task does any work within its tail of the end
//! ```
//!
//! so no `T` is less than the sum of both, for any `x`. What rate goes with `x`: if `open` tasks hold `h`, the limit
//! leaves room for so many moves, or so much charge, and for `n` tasks at once. Those that have started hold `h` and no more than
//! the `n` largest holds when they end, so the work done is at most that of the heaviest tasks that hold this. The more work
//! is done, the higher `h` has to be; a rate is one of the least `h` that `x` allows, since rates fall as `h` rises.

use super::heaviest::Heaviest;
use super::problem::{Problem, Task};
use std::cmp::Reverse;

/// Levels of what is held that are told apart.
const LEVELS: u64 = 4096;
/// Parts of a millisecond that times are rounded down to.
const PARTS: u128 = 1 << 20;

/// What is counted.
#[derive(Debug, Clone, Copy)]
enum Measure {
    Moves,
    Charge,
}

impl Measure {
    /// What a task does in a millisecond.
    fn of(self, task: &Task) -> u64 {
        match self {
            Self::Moves => 1,
            Self::Charge => task.current,
        }
    }
}

/// A time that no schedule is shorter than.
pub(super) fn of(problem: &Problem) -> u64 {
    let most = problem.parallel.min(chains(problem)).max(1);
    by(problem, most, Measure::Moves).max(by(problem, most, Measure::Charge))
}

fn by(problem: &Problem, most: usize, measure: Measure) -> u64 {
    let rates = rates(problem, most, measure);
    let from_start = Ramp::new(problem, &problem.head, measure);
    let from_end = Ramp::new(problem, &problem.tail, measure);
    let whole = from_start.corners.last().map_or(0, |corner| corner.work);
    let mut marks: Vec<u128> = from_start.corners.iter().map(|corner| corner.work).collect();
    marks.extend(from_end.corners.iter().map(|corner| whole - corner.work));
    marks.extend(rates.iter().map(|rate| rate.reach));
    marks.sort_unstable();
    marks.dedup();
    let (mut time, mut done, mut shortest) = (0, 0, 0);
    let mut rates = rates.into_iter().peekable();
    for mark in marks {
        // Every reach is a mark, so from mark to mark there is one rate.
        while rates.next_if(|rate| rate.reach < mark).is_some() {}
        let Some(rate) = rates.peek() else { break };
        time = from_start.time(mark).max(time + (mark - done) * PARTS / rate.most);
        done = mark;
        shortest = shortest.max(time + from_end.time(whole - mark));
    }
    u64::try_from(shortest.div_ceil(PARTS)).unwrap_or(u64::MAX)
}

/// As many chains, each task of which waits for the one before it, as all tasks are in: of a chain one moves at a time.
fn chains(problem: &Problem) -> usize {
    let mut goes_on = vec![false; problem.len()];
    let mut chains = 0;
    for &task in &problem.topological {
        match problem.before[task].iter().find(|b| !goes_on[**b]) {
            Some(&last) => goes_on[last] = true,
            None => chains += 1,
        }
    }
    chains
}

/// How much is done in a millisecond at most, at least 1, until so much work is done.
struct Rate {
    reach: u128,
    most: u128,
}

/// Reaches rise up to the whole work, rates fall.
fn rates(problem: &Problem, most: usize, measure: Measure) -> Vec<Rate> {
    let heaviest = Heaviest::new(problem, |task| u128::from(measure.of(task)) * u128::from(task.duration));
    let fastest = sums_of_largest(problem, most, |task| measure.of(task));
    let holds = sums_of_largest(problem, most, |task| task.hold);
    let least_current = problem.tasks.iter().map(|task| task.current).min().unwrap_or(0);
    let held: u64 = problem.tasks.iter().map(|task| task.hold).sum();
    let step = (held / LEVELS).max(1);
    let mut rates: Vec<Rate> = Vec::new();
    let mut level = 0;
    // Where at least `level` is held, and less than the next.
    while level <= held {
        let left = problem.limit.saturating_sub(level);
        let fit = left.checked_div(least_current).map_or(most, |fit| usize::try_from(fit).unwrap_or(most));
        // Where not even one fits there is no schedule at all.
        let at_once = fit.clamp(1, most).min(problem.len());
        let rate = match measure {
            Measure::Moves => fastest[at_once],
            Measure::Charge => fastest[at_once].min(left),
        };
        let reach = heaviest.within(level + step - 1 + holds[at_once]);
        let rate = Rate { reach, most: u128::from(rate.max(1)) };
        match rates.last_mut() {
            Some(last) if last.reach >= reach => {}
            Some(last) if last.most == rate.most => last.reach = reach,
            _ => rates.push(rate),
        }
        level += step;
    }
    rates
}

/// Of none, one, two and so on up to `most`.
fn sums_of_largest(problem: &Problem, most: usize, of: impl Fn(&Task) -> u64) -> Vec<u64> {
    let mut largest: Vec<u64> = problem.tasks.iter().map(of).collect();
    largest.sort_unstable_by_key(|one| Reverse(*one));
    let mut sums = vec![0];
    for one in largest.into_iter().take(most) {
        sums.push(sums[sums.len() - 1] + one);
    }
    sums
}

/// The most work by time, if every task begins as soon as `earliest` says.
struct Ramp {
    corners: Vec<Corner>,
}

/// From `time` on work goes up by `slope`.
struct Corner {
    time: u64,
    work: u128,
    slope: u128,
}

impl Ramp {
    fn new(problem: &Problem, earliest: &[u64], measure: Measure) -> Self {
        let tasks = problem.tasks.iter().zip(earliest);
        let mut changes: Vec<(u64, bool, u64)> = tasks
            .flat_map(|(task, begin)| {
                let slope = measure.of(task);
                [(*begin, true, slope), (begin + task.duration, false, slope)]
            })
            .collect();
        // What ends at a moment comes after what begins at it, so no slope goes below 0.
        changes.sort_unstable_by_key(|(time, begins, _)| (*time, !begins));
        let mut corners: Vec<Corner> = Vec::with_capacity(changes.len());
        for (time, begins, by) in changes {
            let last = corners.last().map_or((0, 0, 0), |last| (last.time, last.work, last.slope));
            let work = last.1 + last.2 * u128::from(time - last.0);
            let slope = if begins { last.2 + u128::from(by) } else { last.2 - u128::from(by) };
            corners.push(Corner { time, work, slope });
        }
        Self { corners }
    }

    /// When so much work can be done, in parts of a millisecond.
    fn time(&self, work: u128) -> u128 {
        let next = self.corners.partition_point(|corner| corner.work < work);
        next.checked_sub(1).map_or(0, |last| {
            let corner = &self.corners[last];
            u128::from(corner.time) * PARTS + (work - corner.work) * PARTS / corner.slope.max(1)
        })
    }
}
