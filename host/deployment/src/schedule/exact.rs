//! Branch and bound for a few hinges: starts them in every order that could be the best, in the order of time. A partial
//! schedule is dropped if a known one has started the same, no later, and ended each no later.
//!
//! Complete: put the tasks of a shortest schedule in the order of their starts; placed in that order, each as early
//! as can be but not before the last, none starts later than there, as what is held never is more than what was drawn.

use super::problem::Problem;
use std::collections::HashMap;

/// So many tasks at most.
pub(super) const MOST: usize = 20;
/// Partial schedules looked at before it gives up.
const NODES: usize = 100_000;
/// States kept of each set of started tasks.
const STATES: usize = 48;

struct Exact<'a> {
    problem: &'a Problem,
    /// Charge that each task draws at least from its start on: motion, and what it holds while its tail goes on.
    charge: Vec<u64>,
    /// Of every task, tasks below it that are just like it: they start first.
    twins: Vec<u32>,
    starts: Vec<u64>,
    best: Option<Vec<u64>>,
    makespan: u64,
    nodes: usize,
    seen: HashMap<u32, Vec<(u64, Vec<u64>)>>,
}

/// Starts that end before `known`, if there are any, the shortest; and whether all has been looked at.
pub(super) fn shorter(problem: &Problem, known: Option<u64>) -> (Option<Vec<u64>>, bool) {
    if problem.len() > MOST {
        return (None, false);
    }
    let tasks = &problem.tasks;
    let charge = (0..problem.len())
        .map(|task| tasks[task].current * tasks[task].duration + tasks[task].hold * problem.tail[task])
        .collect();
    let alike = |a: usize, b: usize| {
        tasks[a] == tasks[b]
            && problem.before[a] == problem.before[b]
            && problem.followers[a] == problem.followers[b]
    };
    let twins = (0..problem.len())
        .map(|task| (0..task).filter(|other| alike(*other, task)).fold(0, |twins, other| twins | 1 << other))
        .collect();
    let mut exact = Exact {
        problem,
        charge,
        twins,
        starts: vec![0; problem.len()],
        best: None,
        makespan: known.unwrap_or(u64::MAX),
        nodes: 0,
        seen: HashMap::new(),
    };
    exact.go(0, 0);
    (exact.best, exact.nodes < NODES)
}

impl Exact<'_> {
    fn end(&self, task: usize) -> u64 {
        self.starts[task] + self.problem.tasks[task].duration
    }

    fn members(&self, set: u32) -> impl Iterator<Item = usize> {
        (0..self.problem.len()).filter(move |task| set >> task & 1 == 1)
    }

    /// From the tasks in `started`, the last at `now`.
    fn go(&mut self, started: u32, now: u64) {
        self.nodes += 1;
        let all = (1_u32 << self.problem.len()) - 1;
        if started == all {
            let makespan = self.problem.makespan(&self.starts);
            if makespan < self.makespan {
                self.makespan = makespan;
                self.best = Some(self.starts.clone());
            }
            return;
        }
        if self.nodes >= NODES || self.bound(started, now) >= self.makespan || self.is_dominated(started, now)
        {
            return;
        }
        let mut next: Vec<(u64, u64, usize)> = self
            .members(all & !started)
            .filter(|task| self.problem.before[*task].iter().all(|b| started >> b & 1 == 1))
            .filter(|task| self.twins[*task] & !started == 0)
            .filter_map(|task| {
                Some((self.earliest(task, started, now)?, u64::MAX - self.problem.tail[task], task))
            })
            .collect();
        next.sort_unstable();
        for (start, _, task) in next {
            self.starts[task] = start;
            self.go(started | 1 << task, start);
        }
    }

    /// The first time from `now` on at which `task` may start beside those in `started`.
    fn earliest(&self, task: usize, started: u32, now: u64) -> Option<u64> {
        let ready = self.problem.before[task].iter().map(|b| self.end(*b)).max().unwrap_or(0).max(now);
        let mut times: Vec<_> =
            self.members(started).map(|other| self.end(other)).filter(|end| *end > ready).collect();
        times.push(ready);
        times.sort_unstable();
        let moved = &self.problem.tasks[task];
        times.into_iter().find(|time| {
            let (mut drawn, mut moving, mut free) = (moved.current, 1, true);
            for other in self.members(started) {
                let (end, other) = (self.end(other), &self.problem.tasks[other]);
                if end > *time {
                    drawn += other.current;
                    moving += 1;
                    free &= moved.turn.is_none() || moved.turn != other.turn;
                } else {
                    drawn += other.hold;
                }
            }
            free && drawn <= self.problem.limit && moving <= self.problem.parallel
        })
    }

    /// No schedule that goes on from here is shorter.
    fn bound(&self, started: u32, now: u64) -> u64 {
        let (mut bound, mut charge, mut moves) = (0, 0_u64, 0_u64);
        let mut ends = vec![0; self.problem.len()];
        for &task in &self.problem.topological {
            let (own, left) = (&self.problem.tasks[task], self.problem.tail[task]);
            if started >> task & 1 == 1 {
                ends[task] = self.end(task);
                let still = ends[task].saturating_sub(now);
                charge +=
                    own.current * still + own.hold * left.saturating_sub(now.saturating_sub(ends[task]));
                moves += still;
            } else {
                let ready = self.problem.before[task].iter().map(|b| ends[*b]).max().unwrap_or(0).max(now);
                ends[task] = ready + own.duration;
                charge += self.charge[task];
                moves += own.duration;
            }
            bound = bound.max(ends[task] + left);
        }
        let by_charge = charge.div_ceil(self.problem.limit.max(1));
        bound.max(now + by_charge).max(now + moves.div_ceil(self.problem.parallel as u64))
    }

    /// Whether a known state is no worse; if not, this one is kept.
    fn is_dominated(&mut self, started: u32, now: u64) -> bool {
        let ends: Vec<_> = self.members(started).map(|task| self.end(task).max(now)).collect();
        let known = self.seen.entry(started).or_default();
        let no_worse = |(time, other): &(u64, Vec<u64>)| {
            *time <= now && other.iter().zip(&ends).all(|(other, end)| other <= end)
        };
        if known.iter().any(no_worse) {
            return true;
        }
        if known.len() < STATES {
            known.push((now, ends));
        }
        false
    }
}
