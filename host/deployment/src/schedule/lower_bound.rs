//! No schedule is shorter than this.

use super::problem::Problem;
use super::progress;

/// More work than this is not worth a better bound.
const WORK: usize = 20_000_000;

/// A time that no schedule of the problem is shorter than.
///
/// For any `a` and `b`, the tasks that can't start before `a` and after which at least `b` is left to do share the time
/// between: their charge has to go through the supply, their motions through what may move at once.
pub(super) fn of(problem: &Problem) -> u64 {
    let path = (0..problem.len())
        .map(|task| problem.head[task] + problem.tasks[task].duration + problem.tail[task])
        .max()
        .unwrap_or(0);
    let mut by_tail: Vec<_> = (0..problem.len()).collect();
    by_tail.sort_by_key(|task| std::cmp::Reverse(problem.tail[*task]));
    let mut best = path;
    let turns = problem.tasks.iter().filter_map(|task| task.turn).max().map_or(0, |turn| turn + 1);
    for head in heads(problem) {
        let mut all = Shared::new(problem.parallel);
        let mut in_turn = vec![Shared::new(1); turns];
        let mut rest = by_tail.iter().filter(|task| problem.head[**task] >= head).peekable();
        while let Some(&task) = rest.next() {
            let tail = problem.tail[task];
            all.add(problem, task);
            if let Some(turn) = problem.tasks[task].turn {
                in_turn[turn].add(problem, task);
                best = best.max(head + tail + in_turn[turn].time(problem.limit, tail));
            }
            // Of equal tails all together.
            if rest.peek().is_none_or(|next| problem.tail[**next] != tail) {
                best = best.max(head + tail + all.time(problem.limit, tail));
            }
        }
    }
    best.max(progress::of(problem))
}

/// Some of the heads of the tasks, 0 among them; all if there is time for that.
fn heads(problem: &Problem) -> Vec<u64> {
    let mut heads = problem.head.clone();
    heads.push(0);
    heads.sort_unstable();
    heads.dedup();
    let most = (WORK / problem.len().max(1)).max(1);
    let step = heads.len().div_ceil(most);
    heads.into_iter().step_by(step).collect()
}

/// Tasks that share a time.
#[derive(Clone)]
struct Shared {
    most: usize,
    count: u64,
    least_current: u64,
    least_duration: u64,
    durations: u128,
    charge: u128,
    hold: u128,
    /// Hold times the tail of each.
    held: u128,
}

impl Shared {
    fn new(most: usize) -> Self {
        Self {
            most,
            count: 0,
            least_current: u64::MAX,
            least_duration: u64::MAX,
            durations: 0,
            charge: 0,
            hold: 0,
            held: 0,
        }
    }

    fn add(&mut self, problem: &Problem, number: usize) {
        let task = &problem.tasks[number];
        self.count += 1;
        self.least_current = self.least_current.min(task.current);
        self.least_duration = self.least_duration.min(task.duration);
        self.durations += u128::from(task.duration);
        self.charge += u128::from(task.duration) * u128::from(task.current);
        self.hold += u128::from(task.hold);
        self.held += u128::from(task.hold) * u128::from(problem.tail[number]);
    }

    /// The time that they take at least, all with a tail of `tail` or more. What one holds after its own end, while its
    /// tail goes on, is drawn within that time but for `tail` of it.
    fn time(&self, limit: u64, tail: u64) -> u64 {
        let at_once = match limit.checked_div(self.least_current) {
            Some(fit) => fit.clamp(1, self.most as u64),
            None => self.most as u64,
        };
        let held = self.held - self.hold * u128::from(tail);
        let by_charge = (self.charge + held).div_ceil(u128::from(limit.max(1)));
        let by_count = self.durations.div_ceil(u128::from(at_once));
        let whole = self.count.div_ceil(at_once).saturating_mul(self.least_duration);
        u64::try_from(by_charge.max(by_count)).unwrap_or(u64::MAX).max(whole)
    }
}
