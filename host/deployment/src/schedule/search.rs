//! Looks for a short schedule: a list by each of several rules, then lists at random around the best, each made shorter by
//! pushing all motions to the end of time and back; for few hinges a search that proves what it finds.
//!
//! ```text
//! rules -> greedy, serial -> justify --+--> best --> random lists around it -> serial -> justify --> best
//!                                      +--> few hinges: exact
//! ```
//!
//! Serial placing and justification are the field's standard for project scheduling: Kolisch 1996; Valls, Ballestin and
//! Quintanilla 2005.

use super::exact;
use super::greedy::{self, Stuck};
use super::problem::Problem;
use super::timeline::{Load, Timeline};
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// More hinges than this are scheduled by the quick rules alone.
const SERIAL: usize = 6_000;
/// Random lists end when hinges times hinges times lists come to this.
const WORK: usize = 40_000_000;
/// Seed of the random lists: a plan has one schedule.
const SEED: u64 = 0x7a79_676f_7465_0004;

/// The best that was found.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Found {
    pub(super) starts: Vec<u64>,
    pub(super) makespan: u64,
    /// No schedule is shorter than this.
    pub(super) bound: u64,
}

/// The best schedule found, with at most `samples` random lists; `bound` is a time that none is shorter than.
pub(super) fn best(problem: &Problem, bound: u64, samples: usize) -> Result<Found, Stuck> {
    let mut found = Best { problem, bound, shortest: None };
    let mut stuck = None;
    for rule in rules(problem) {
        match greedy::starts(problem, &rule) {
            Ok(starts) => found.offer(starts),
            Err(error) => stuck = stuck.or(Some(error)),
        }
        if problem.len() <= SERIAL && !found.is_proven() {
            let keys: Vec<_> = rule.iter().map(|priority| u64::MAX - priority).collect();
            found.list(&keys);
        }
        if found.is_proven() {
            break;
        }
    }
    if !found.is_proven() {
        let most = WORK / problem.len().pow(2).max(1);
        found.sample(samples.min(most));
    }
    if !found.is_proven() && problem.len() <= exact::MOST {
        let known = found.shortest.as_ref().map(|(makespan, _)| *makespan);
        let (better, proven) = exact::shorter(problem, known);
        if let Some(starts) = better {
            found.offer(starts);
        }
        if let (true, Some((makespan, _))) = (proven, &found.shortest) {
            found.bound = *makespan;
        }
    }
    match (found.shortest, stuck) {
        (Some((makespan, starts)), _) => Ok(Found { starts, makespan, bound: found.bound }),
        (None, Some(stuck)) => Err(stuck),
        // There always is a rule, and what it makes is offered.
        (None, None) => Ok(Found { starts: Vec::new(), makespan: 0, bound: 0 }),
    }
}

/// Priorities by every rule, the higher the sooner; the first is the order's own.
fn rules(problem: &Problem) -> [Vec<u64>; 4] {
    let own = (0..problem.len()).rev().map(|place| place as u64).collect();
    let mut charge = vec![0_u64; problem.len()];
    let mut following = vec![0_u64; problem.len()];
    for &task in problem.topological.iter().rev() {
        let followers = &problem.followers[task];
        let sum = |of: &[u64]| followers.iter().fold(0_u64, |sum, f| sum.saturating_add(of[*f]));
        following[task] = sum(&following).saturating_add(followers.len() as u64);
        let own = problem.tasks[task].duration.saturating_mul(problem.tasks[task].current);
        charge[task] = sum(&charge).saturating_add(own);
    }
    let way = problem.tasks.iter().zip(&problem.tail).map(|(task, tail)| task.duration + tail).collect();
    [own, way, following, charge]
}

struct Best<'a> {
    problem: &'a Problem,
    bound: u64,
    shortest: Option<(u64, Vec<u64>)>,
}

impl Best<'_> {
    fn is_proven(&self) -> bool {
        self.shortest.as_ref().is_some_and(|(makespan, _)| *makespan <= self.bound)
    }

    /// Of equally long ones the first stays.
    fn offer(&mut self, starts: Vec<u64>) {
        let makespan = self.problem.makespan(&starts);
        if self.shortest.as_ref().is_none_or(|(best, _)| makespan < *best) {
            self.shortest = Some((makespan, starts));
        }
    }

    /// Places by a list, then pushes to the end and back.
    fn list(&mut self, keys: &[u64]) {
        let Some(starts) = serial(self.problem, keys) else { return };
        let justified = justify(self.problem, &starts);
        self.offer(starts);
        if let Some(justified) = justified {
            self.offer(justified);
        }
    }

    /// Lists at random: by turns around the longest way to go, with more or less favour for long motions, which had best run
    /// before much is held; and around the best so far.
    fn sample(&mut self, samples: usize) {
        let mut random = Random(SEED);
        let way: Vec<u64> = self
            .problem
            .tasks
            .iter()
            .zip(&self.problem.tail)
            .map(|(task, tail)| task.duration + tail)
            .collect();
        let longest = way.iter().copied().max().unwrap_or(0);
        let longest_motion = self.problem.tasks.iter().map(|task| task.duration).max().unwrap_or(0);
        for sample in 0..samples {
            let keys: Vec<u64> = match &self.shortest {
                Some((makespan, starts)) if sample % 2 == 1 => {
                    // From a tenth of the whole down to a fiftieth.
                    let reach = 1 + makespan / (10 + 10 * (sample as u64 / 2 % 5));
                    starts.iter().map(|start| start + random.below(reach)).collect()
                }
                _ => {
                    let reach = 1 + longest / (1 + sample as u64 / 2 % 4);
                    let favour = [0, 1, 4, 16][sample / 8 % 4];
                    let late = |task: usize| {
                        longest - way[task] + favour * (longest_motion - self.problem.tasks[task].duration)
                    };
                    (0..self.problem.len()).map(|task| late(task) + random.below(reach)).collect()
                }
            };
            self.list(&keys);
            if self.is_proven() {
                return;
            }
        }
    }
}

/// Starts of tasks that are placed one by one, each as early as can be: of those whose predecessors are placed the
/// lowest key first. `None` if what is held leaves no room.
fn serial(problem: &Problem, keys: &[u64]) -> Option<Vec<u64>> {
    let mut missing: Vec<_> = problem.before.iter().map(Vec::len).collect();
    let mut ready: BinaryHeap<_> =
        (0..problem.len()).filter(|t| missing[*t] == 0).map(|task| Reverse((keys[task], task))).collect();
    let mut order = Vec::with_capacity(problem.len());
    while let Some(Reverse((_, task))) = ready.pop() {
        order.push(task);
        for &follower in &problem.followers[task] {
            missing[follower] -= 1;
            if missing[follower] == 0 {
                ready.push(Reverse((keys[follower], follower)));
            }
        }
    }
    place(problem, &order)
}

/// Places tasks in this order, in which each comes after those before it.
fn place(problem: &Problem, order: &[usize]) -> Option<Vec<u64>> {
    let mut timeline = Timeline::new(0, signed(problem.limit), problem.parallel);
    let mut starts = vec![0; problem.len()];
    for &number in order {
        let task = &problem.tasks[number];
        let ready = problem.before[number].iter().map(|b| starts[*b] + problem.tasks[*b].duration).max();
        let load = Load {
            duration: task.duration,
            during: signed(task.current),
            after: signed(task.hold),
            turn: task.turn,
        };
        starts[number] = timeline.place(ready.unwrap_or(0), &load)?;
    }
    Some(starts)
}

/// Pushes every task as late as can be, the last first, then as early as can be.
fn justify(problem: &Problem, starts: &[u64]) -> Option<Vec<u64>> {
    let ended = |task: usize| starts[task] + problem.tasks[task].duration;
    let mut place_of = vec![0; problem.len()];
    problem.topological.iter().enumerate().for_each(|(at, task)| place_of[*task] = at);
    let mut order: Vec<_> = (0..problem.len()).collect();
    order.sort_by_key(|task| Reverse((ended(*task), place_of[*task])));
    // Time runs backwards: everything is held at first, and no longer before its own motion.
    let held = problem.tasks.iter().map(|task| task.hold).sum();
    let mut timeline = Timeline::new(signed(held), signed(problem.limit), problem.parallel);
    let mut ends = vec![0; problem.len()];
    for &number in &order {
        let task = &problem.tasks[number];
        let ready = problem.followers[number].iter().map(|f| ends[*f] + problem.tasks[*f].duration).max();
        let load = Load {
            duration: task.duration,
            during: signed(task.current) - signed(task.hold),
            after: -signed(task.hold),
            turn: task.turn,
        };
        ends[number] = timeline.place(ready.unwrap_or(0), &load)?;
    }
    order.sort_by_key(|task| (Reverse(ends[*task] + problem.tasks[*task].duration), place_of[*task]));
    place(problem, &order)
}

/// Currents are bounded by a supply's limit, or are refused before.
fn signed(current: u64) -> i64 {
    i64::try_from(current).unwrap_or(i64::MAX / 2)
}

/// `SplitMix64` (Steele, Lea and Flood 2014).
struct Random(u64);

impl Random {
    fn below(&mut self, end: u64) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut mixed = self.0;
        mixed = (mixed ^ (mixed >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        (mixed ^ (mixed >> 31)) % end.max(1)
    }
}
