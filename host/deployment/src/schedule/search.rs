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
use super::problem::{Problem, Task};
use super::timeline::{Load, Timeline};
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// More hinges than this are scheduled by the quick rules alone.
const SERIAL: usize = 6_000;
/// Random lists end when hinges times hinges times lists come to this.
const WORK: usize = 40_000_000;
/// Kinds of random lists, by turns.
const FORMS: usize = 6;
/// Motions at other times, at most.
const MOVED: u64 = 8;
/// How much more a long motion counts than the way after it.
const FAVOURS: [u64; 4] = [0, 1, 4, 16];
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

    /// Places by a list, then pushes to the end and back: the last of these, if what is held leaves room.
    fn list(&mut self, keys: &[u64]) -> Option<(u64, Vec<u64>)> {
        let starts = serial(self.problem, keys)?;
        let justified = from_end(self.problem, &until_end(self.problem, &starts));
        let last = justified.as_ref().unwrap_or(&starts).clone();
        self.offer(starts);
        if let Some(justified) = justified {
            self.offer(justified);
        }
        Some((self.problem.makespan(&last), last))
    }

    /// Places by a list from the end.
    fn list_from_end(&mut self, keys: &[u64]) -> Option<(u64, Vec<u64>)> {
        let starts = from_end(self.problem, keys)?;
        self.offer(starts.clone());
        Some((self.problem.makespan(&starts), starts))
    }

    /// Lists at random, by turns: by the longest way to go, from the start or from the end; by the best so far; and by a
    /// schedule of which a few motions go to another time, from one to the next that is no longer.
    fn sample(&mut self, samples: usize) {
        let mut random = Random(SEED);
        let problem = self.problem;
        let longest_motion = problem.tasks.iter().map(|task| task.duration).max().unwrap_or(0);
        let longest = (0..problem.len()).map(|task| problem.tail[task] + problem.tasks[task].duration).max();
        let longest = longest.unwrap_or(0);
        // Long motions had best run before much is held.
        let by_way =
            |ways: &[u64], favour: u64, from_end: bool, reach: u64, random: &mut Random| -> Vec<u64> {
                let tasks = problem.tasks.iter().zip(ways);
                let late = |(task, way): (&Task, &u64)| {
                    let long = if from_end { task.duration } else { longest_motion - task.duration };
                    longest - way - task.duration + favour * long
                };
                tasks.map(|task| late(task) + random.below(reach)).collect()
            };
        let mut here = self.shortest.clone();
        for sample in 0..samples {
            let round = sample / FORMS;
            let reach = 1 + longest / (1 + round as u64 % 4);
            let favour = FAVOURS[round / 4 % FAVOURS.len()];
            let found = match (sample % FORMS, &self.shortest, &here) {
                (0, _, _) => self.list(&by_way(&problem.tail, favour, false, reach, &mut random)),
                (1, _, _) | (_, None, _) | (_, _, None) => {
                    self.list_from_end(&by_way(&problem.head, favour, true, reach, &mut random))
                }
                (2, Some((makespan, starts)), _) => {
                    // From a tenth of the whole down to a fiftieth.
                    let reach = 1 + makespan / (10 + 10 * (round as u64 % 5));
                    let keys: Vec<_> = starts.iter().map(|start| start + random.below(reach)).collect();
                    self.list(&keys)
                }
                (form, _, Some((makespan, starts))) => {
                    let turned = form % 2 == 0;
                    let mut keys = if turned { until_end(problem, starts) } else { starts.clone() };
                    for key in &mut keys {
                        *key += makespan / 2;
                    }
                    for _ in 0..=random.below(MOVED) {
                        let task = random.index(keys.len());
                        keys[task] = (keys[task] + random.below(*makespan)).saturating_sub(makespan / 2);
                    }
                    if turned { self.list_from_end(&keys) } else { self.list(&keys) }
                }
            };
            if let Some(found) = found
                && here.as_ref().is_none_or(|here| found.0 <= here.0)
            {
                here = Some(found);
            }
            if self.is_proven() {
                return;
            }
        }
    }
}

/// Starts of tasks that are placed one by one, each as early as can be: of those whose predecessors are placed the
/// lowest key first. `None` if what is held leaves no room.
fn serial(problem: &Problem, keys: &[u64]) -> Option<Vec<u64>> {
    let mut timeline = Timeline::new(0, signed(problem.limit), problem.parallel);
    let mut starts = vec![0; problem.len()];
    for number in listed(&problem.before, &problem.followers, keys) {
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

/// Starts of tasks that are placed one by one, each as late as can be, of those whose followers are placed the lowest key
/// first; and then pushed as early as can be, the first first.
fn from_end(problem: &Problem, keys: &[u64]) -> Option<Vec<u64>> {
    // Time runs backwards: everything is held at first, and no longer before its own motion.
    let held = problem.tasks.iter().map(|task| task.hold).sum();
    let mut timeline = Timeline::new(signed(held), signed(problem.limit), problem.parallel);
    let mut left = vec![0; problem.len()];
    for number in listed(&problem.followers, &problem.before, keys) {
        let task = &problem.tasks[number];
        let ready = problem.followers[number].iter().map(|f| left[*f] + problem.tasks[*f].duration).max();
        let load = Load {
            duration: task.duration,
            during: signed(task.current) - signed(task.hold),
            after: -signed(task.hold),
            turn: task.turn,
        };
        left[number] = timeline.place(ready.unwrap_or(0), &load)?;
    }
    serial(problem, &until_end(problem, &left))
}

/// How long before the end of all each ends; of a schedule whose time runs backwards, when each starts.
fn until_end(problem: &Problem, starts: &[u64]) -> Vec<u64> {
    let makespan = problem.makespan(starts);
    starts.iter().zip(&problem.tasks).map(|(start, task)| makespan - start - task.duration).collect()
}

/// All tasks, each after those in its `before`, of those that may be next the one of the lowest key.
fn listed(before: &[Vec<usize>], followers: &[Vec<usize>], keys: &[u64]) -> Vec<usize> {
    let mut missing: Vec<_> = before.iter().map(Vec::len).collect();
    let mut ready: BinaryHeap<_> =
        (0..before.len()).filter(|t| missing[*t] == 0).map(|task| Reverse((keys[task], task))).collect();
    let mut order = Vec::with_capacity(before.len());
    while let Some(Reverse((_, task))) = ready.pop() {
        order.push(task);
        for &follower in &followers[task] {
            missing[follower] -= 1;
            if missing[follower] == 0 {
                ready.push(Reverse((keys[follower], follower)));
            }
        }
    }
    order
}

/// Currents are bounded by a supply's limit, or are refused before.
fn signed(current: u64) -> i64 {
    i64::try_from(current).unwrap_or(i64::MAX / 2)
}

/// `SplitMix64` (Steele, Lea and Flood 2014).
struct Random(u64);

impl Random {
    /// One of so many.
    fn index(&mut self, count: usize) -> usize {
        usize::try_from(self.below(count as u64)).unwrap_or(0)
    }

    fn below(&mut self, end: u64) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut mixed = self.0;
        mixed = (mixed ^ (mixed >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        (mixed ^ (mixed >> 31)) % end.max(1)
    }
}
