//! The most work that tasks can have whose holds come to no more than so much, if none of them is started before what it
//! waits for: how much can be done before that much is held.

use super::problem::{Problem, Task};

/// Steps of the table at most, about; beyond them precedence is left out.
const WORK: u128 = 20_000_000;

/// Work by hold.
#[derive(Debug)]
pub(super) enum Heaviest {
    /// Of every number of such units of hold.
    Table { unit: u64, work: Vec<u128> },
    /// Hold and work of tasks, in sums from the first on: those of the most work for their hold come first.
    Sums(Vec<(u64, u128)>),
}

impl Heaviest {
    /// Of all tasks, each with so much work.
    ///
    /// The table is a knapsack on a forest, in which every task keeps one of those that it waits for: fewer rules
    /// allow no less. Without rules, parts of tasks allowed as well, it is filled by those of the most work for their hold
    /// (Dantzig 1957).
    pub(super) fn new(problem: &Problem, work: impl Fn(&Task) -> u128) -> Self {
        let work: Vec<u128> = problem.tasks.iter().map(work).collect();
        let unit = problem.tasks.iter().fold(0, |unit, task| common(unit, task.hold)).max(1);
        let units = u128::from(problem.tasks.iter().map(|task| task.hold / unit).sum::<u64>());
        if units * (units + problem.len() as u128) <= WORK {
            return Self::Table { unit, work: on_forest(problem, &work, unit) };
        }
        let mut tasks: Vec<_> = (0..problem.len()).collect();
        tasks.sort_by(|a, b| {
            let (in_a, in_b) = (u128::from(problem.tasks[*a].hold), u128::from(problem.tasks[*b].hold));
            (work[*b] * in_a).cmp(&(work[*a] * in_b)).then(in_a.cmp(&in_b))
        });
        let mut sum = (0, 0);
        let sums = tasks.into_iter().map(|task| {
            sum = (sum.0 + problem.tasks[task].hold, sum.1 + work[task]);
            sum
        });
        Self::Sums([(0, 0)].into_iter().chain(sums).collect())
    }

    /// The most work with at most so much held.
    pub(super) fn within(&self, hold: u64) -> u128 {
        match self {
            Self::Table { unit, work } => {
                let units = usize::try_from(hold / unit).unwrap_or(usize::MAX);
                work[units.min(work.len() - 1)]
            }
            Self::Sums(sums) => {
                let next = sums.partition_point(|(held, _)| *held <= hold);
                let (held, done) = sums[next - 1];
                sums.get(next).map_or(done, |(held_then, done_then)| {
                    let part = (done_then - done) * u128::from(hold - held);
                    done + part.div_ceil(u128::from(held_then - held))
                })
            }
        }
    }
}

/// The most work by units of hold.
fn on_forest(problem: &Problem, work: &[u128], unit: u64) -> Vec<u128> {
    // Of every task, for it and all that hang on it; what comes to nothing is not started.
    let mut below: Vec<Vec<u128>> = vec![vec![0]; problem.len()];
    let mut whole = vec![0];
    for &task in problem.topological.iter().rev() {
        let hanging = std::mem::take(&mut below[task]);
        let units = usize::try_from(problem.tasks[task].hold / unit).unwrap_or(usize::MAX);
        let mut own = vec![0; units];
        own.extend(hanging.into_iter().map(|hanging| hanging + work[task]));
        let kept =
            problem.before[task].iter().max_by_key(|b| problem.head[**b] + problem.tasks[**b].duration);
        let onto = kept.map_or(&mut whole, |kept| &mut below[*kept]);
        *onto = together(onto, &own);
    }
    whole
}

/// The most that two have together.
fn together(a: &[u128], b: &[u128]) -> Vec<u128> {
    let mut most = vec![0; a.len() + b.len() - 1];
    for (in_a, a) in a.iter().enumerate() {
        for (most, b) in most[in_a..].iter_mut().zip(b) {
            *most = (*most).max(a + b);
        }
    }
    most
}

/// The greatest common divisor.
fn common(a: u64, b: u64) -> u64 {
    if b == 0 { a } else { common(b, a % b) }
}
