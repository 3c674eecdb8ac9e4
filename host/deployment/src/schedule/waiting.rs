//! What each step waits for, so that an MCU that goes by that alone keeps precedence, the number of motions at once and the
//! turns of servos, however long its motions take.
//!
//! Current is no reason to wait for a certain step: the MCU starts nothing that the supply has no room for (S7). But what
//! opened hinges hold never comes free again. So a motion that the supply could not drive with everything else held
//! is waited for by the holding ones that come after it; and a step that the supply would have room for too early waits for
//! the one that ends when it is to start.
//!
//! The wire has room for [`MOST_AFTER`] entries. More are gathered: by steps that start late enough to wait for them
//! instead, which costs no time; where there are none, by a wait of one for another, which the search has to plan for.

use super::MOST_AFTER;
use super::problem::Problem;
use std::collections::BTreeSet;

/// Steps that may gather what another waits for are looked for so far back.
const NEAR: usize = 256;
/// More steps than this aren't looked at for starting too early: they come from the rules, which leave no room.
const EARLY: usize = 6_000;

/// Steps in the order of their starts.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Waiting {
    /// Task of every step.
    pub(super) tasks: Vec<usize>,
    /// What it waits for: steps, rising.
    pub(super) after: Vec<Vec<usize>>,
}

/// Precedence that one overfull step asks for.
pub(super) type Gathering = Vec<(usize, usize)>;

struct Steps<'a> {
    problem: &'a Problem,
    tasks: Vec<usize>,
    start: Vec<u64>,
    opened: Vec<u64>,
    after: Vec<Vec<usize>>,
}

/// One that is waited for, with its start and end as waiting for others would delay them.
struct Left {
    step: usize,
    start: u64,
    opened: u64,
    room: usize,
}

/// The waiting of a schedule.
///
/// # Errors
/// For every step that would wait for too many, tasks of which the first should end before the second starts.
pub(super) fn of(problem: &Problem, starts: &[u64]) -> Result<Waiting, Vec<Gathering>> {
    let mut place = vec![0; problem.len()];
    problem.topological.iter().enumerate().for_each(|(at, task)| place[*task] = at);
    let mut tasks: Vec<_> = (0..problem.len()).collect();
    tasks.sort_by_key(|task| (starts[*task], place[*task]));
    let mut step_of = vec![0; problem.len()];
    tasks.iter().enumerate().for_each(|(step, task)| step_of[*task] = step);
    let mut steps = Steps {
        problem,
        start: tasks.iter().map(|task| starts[*task]).collect(),
        opened: tasks.iter().map(|task| starts[*task] + problem.tasks[*task].duration).collect(),
        after: tasks
            .iter()
            .map(|task| problem.before[*task].iter().map(|before| step_of[*before]).collect())
            .collect(),
        tasks,
    };
    steps.wait_for_lanes();
    steps.wait_for_turns();
    steps.wait_for_what_is_held();
    let gatherings: Vec<_> = (0..problem.len()).filter_map(|step| steps.thin(step)).collect();
    if !gatherings.is_empty() {
        return Err(gatherings);
    }
    steps.wait_for_the_right_time();
    let Steps { tasks, after, .. } = steps;
    Ok(Waiting { tasks, after })
}

impl Steps<'_> {
    fn add(&mut self, step: usize, before: usize) {
        if let Err(at) = self.after[step].binary_search(&before) {
            self.after[step].insert(at, before);
        }
    }

    fn room(&self, step: usize) -> usize {
        MOST_AFTER.saturating_sub(self.after[step].len())
    }

    /// Steps share as many lanes as may move at once, each one motion at a time; best one that the step waits for anyway.
    fn wait_for_lanes(&mut self) {
        self.after.iter_mut().for_each(|after| after.sort_unstable());
        if self.problem.parallel >= self.tasks.len() {
            return;
        }
        // The last step of each lane, by its end.
        let mut lasts: BTreeSet<(u64, usize)> = BTreeSet::new();
        let mut empty = self.problem.parallel;
        for step in 0..self.tasks.len() {
            let waited =
                self.after[step].iter().map(|b| (self.opened[*b], *b)).find(|last| lasts.contains(last));
            let ended = || lasts.range(..=(self.start[step], usize::MAX)).next_back().copied();
            let last = waited.or_else(|| if empty > 0 { None } else { ended() });
            match last {
                Some(last) => {
                    lasts.remove(&last);
                    self.add(step, last.1);
                }
                None => empty = empty.saturating_sub(1),
            }
            lasts.insert((self.opened[step], step));
        }
    }

    fn wait_for_turns(&mut self) {
        let turns = self.problem.tasks.iter().filter_map(|task| task.turn).max().map_or(0, |turn| turn + 1);
        let mut last = vec![None; turns];
        for step in 0..self.tasks.len() {
            let Some(turn) = self.problem.tasks[self.tasks[step]].turn else { continue };
            if let Some(before) = last[turn].replace(step) {
                self.add(step, before);
            }
        }
    }

    /// See above: what would find the supply taken for ever goes before what takes it.
    fn wait_for_what_is_held(&mut self) {
        let task = |step: usize| &self.problem.tasks[self.tasks[step]];
        let held: u64 = self.problem.tasks.iter().map(|task| task.hold).sum();
        let is_tight: Vec<_> = (0..self.tasks.len())
            .map(|step| held - task(step).hold + task(step).current > self.problem.limit)
            .collect();
        let mut tight: Vec<_> = (0..self.tasks.len()).filter(|step| is_tight[*step]).collect();
        tight.sort_by_key(|step| self.opened[*step]);
        // Of those that ended by then the latest start: what ended before it is waited for by that one.
        let latest: Vec<u64> = tight
            .iter()
            .scan(0, |latest: &mut u64, step| {
                *latest = self.start[*step].max(*latest);
                Some(*latest)
            })
            .collect();
        for (step, is_tight) in is_tight.into_iter().enumerate() {
            if task(step).hold == 0 && !is_tight {
                continue;
            }
            let ended = tight.partition_point(|other| self.opened[*other] <= self.start[step]);
            let Some(latest) = ended.checked_sub(1).map(|last| latest[last]) else { continue };
            let first = tight.partition_point(|other| self.opened[*other] <= latest);
            for other in &tight[first..ended] {
                if let Err(at) = self.after[step].binary_search(other) {
                    self.after[step].insert(at, *other);
                }
            }
        }
    }

    /// Leaves a step no more to wait for than it has room for, or says what should wait for each other.
    fn thin(&mut self, step: usize) -> Option<Gathering> {
        if self.after[step].len() <= MOST_AFTER {
            return None;
        }
        self.drop_implied(step);
        while self.after[step].len() > MOST_AFTER && self.relay(step) {}
        let mut left: Vec<_> = self.after[step]
            .iter()
            .map(|&step| Left {
                step,
                start: self.start[step],
                opened: self.opened[step],
                room: self.room(step),
            })
            .collect();
        let mut gathering = Vec::new();
        while left.len() > MOST_AFTER {
            let pairs = (0..left.len()).flat_map(|i| (0..left.len()).map(move |j| (i, j)));
            let cost = |(i, j): &(usize, usize)| {
                let (first, then) = (&left[*i], &left[*j]);
                (then.room == 0, first.opened.saturating_sub(then.start), then.step, first.step)
            };
            let Some((i, j)) = pairs.filter(|(i, j)| i != j).min_by_key(cost) else { break };
            gathering.push((self.tasks[left[i].step], self.tasks[left[j].step]));
            let delay = left[i].opened.saturating_sub(left[j].start);
            let then = &mut left[j];
            then.room = then.room.saturating_sub(1);
            (then.start, then.opened) = (then.start + delay, then.opened + delay);
            left.remove(i);
        }
        (!gathering.is_empty()).then_some(gathering)
    }

    /// Drops what is waited for by others that the step waits for.
    fn drop_implied(&mut self, step: usize) {
        let Some(&lowest) = self.after[step].first() else { return };
        let mut open: Vec<_> = self.after[step].iter().flat_map(|b| &self.after[*b]).copied().collect();
        let mut reached = BTreeSet::new();
        while let Some(other) = open.pop() {
            if other >= lowest && reached.insert(other) {
                open.extend(&self.after[other]);
            }
        }
        self.after[step].retain(|before| !reached.contains(before));
    }

    /// Lets an earlier step wait for some of what `step` waits for, and `step` for that one; false if that gains nothing.
    fn relay(&mut self, step: usize) -> bool {
        let waited = self.after[step].clone();
        let gain = |relay: usize| {
            let gathered = self.gathers(&waited, relay).len();
            gathered.saturating_sub(usize::from(!waited.contains(&relay)))
        };
        let near = (step.saturating_sub(NEAR)..step).filter(|relay| self.opened[*relay] <= self.start[step]);
        let far = waited.iter().copied().filter(|relay| *relay < step.saturating_sub(NEAR));
        let best = near.chain(far).max_by_key(|relay| (gain(*relay), waited.contains(relay), *relay));
        let Some(relay) = best.filter(|relay| gain(*relay) > 0) else { return false };
        let gathered = self.gathers(&waited, relay);
        self.after[step].retain(|before| !gathered.contains(before));
        self.add(step, relay);
        for before in gathered {
            self.add(relay, before);
        }
        true
    }

    /// Those of `waited` that `relay` could wait for instead.
    fn gathers(&self, waited: &[usize], relay: usize) -> Vec<usize> {
        let early = waited.iter().filter(|b| **b != relay && self.opened[**b] <= self.start[relay]);
        early.filter(|b| !self.after[relay].contains(b)).take(self.room(relay)).copied().collect()
    }

    /// Holds back what the MCU would start earlier than planned, where there is room to say so.
    fn wait_for_the_right_time(&mut self) {
        if self.tasks.len() > EARLY {
            return;
        }
        let draw = self.draw();
        for step in 0..self.tasks.len() {
            let ready = self.after[step].iter().map(|before| self.opened[*before]).max().unwrap_or(0);
            let (start, current) = (self.start[step], self.problem.tasks[self.tasks[step]].current);
            if ready == start || self.room(step) == 0 {
                continue;
            }
            let first = draw.partition_point(|(time, _)| *time <= ready).saturating_sub(1);
            let mut until = draw[first..].iter().take_while(|(time, _)| *time < start);
            if until.any(|(_, drawn)| drawn + current <= self.problem.limit)
                && let Some(before) = (0..step).rev().find(|before| self.opened[*before] == start)
            {
                self.add(step, before);
            }
        }
    }

    /// What is drawn from each time on at which that changes.
    fn draw(&self) -> Vec<(u64, u64)> {
        let mut changes = Vec::with_capacity(2 * self.tasks.len());
        for (step, task) in self.tasks.iter().enumerate() {
            let task = &self.problem.tasks[*task];
            changes.push((self.start[step], task.current, 0));
            changes.push((self.opened[step], task.hold, task.current));
        }
        changes.sort_unstable();
        let mut draw: Vec<(u64, u64)> = Vec::new();
        let (mut more, mut less) = (0, 0);
        for (time, rise, fall) in changes {
            more += rise;
            less += fall;
            match draw.last_mut().filter(|(last, _)| *last == time) {
                Some(last) => last.1 = u64::saturating_sub(more, less),
                None => draw.push((time, u64::saturating_sub(more, less))),
            }
        }
        draw
    }
}
