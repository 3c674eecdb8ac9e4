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
    pub(super) fn new(problem: &Problem, work: impl Fn(&Task) -> u128) -> Self {
        let work: Vec<u128> = problem.tasks.iter().map(work).collect();
        let unit = problem.tasks.iter().fold(0, |unit, task| common(unit, task.hold)).max(1);
        let units = u128::from(problem.tasks.iter().map(|task| task.hold / unit).sum::<u64>());
        if units * (units + problem.len() as u128) <= WORK {
            Self::table(problem, &work, unit)
        } else {
            Self::sums(problem, &work)
        }
    }

    /// A knapsack on a forest: every task keeps one of those that it waits for, as fewer rules allow no less. `unit`
    /// divides every hold.
    fn table(problem: &Problem, work: &[u128], unit: u64) -> Self {
        // Of every task, for it and all that hang on it; with too little hold it is not started.
        let mut below: Vec<Vec<u128>> = vec![vec![0]; problem.len()];
        let mut whole = vec![0];
        for &task in problem.topological.iter().rev() {
            let hanging = std::mem::take(&mut below[task]);
            let units = usize::try_from(problem.tasks[task].hold / unit).unwrap_or(usize::MAX);
            let mut own = vec![0; units];
            own.extend(hanging.into_iter().map(|hanging| hanging + work[task]));
            let end = |b: &usize| problem.head[*b] + problem.tasks[*b].duration;
            let kept = problem.before[task].iter().copied().max_by_key(end);
            let onto = kept.map_or(&mut whole, |kept| &mut below[kept]);
            *onto = together(onto, &own);
        }
        Self::Table { unit, work: whole }
    }

    /// Without rules, and with parts of tasks allowed: those of the most work for their hold (Dantzig 1957).
    fn sums(problem: &Problem, work: &[u128]) -> Self {
        let mut tasks: Vec<_> = (0..problem.len()).collect();
        tasks.sort_by(|a, b| {
            let (in_a, in_b) = (u128::from(problem.tasks[*a].hold), u128::from(problem.tasks[*b].hold));
            (work[*b] * in_a).cmp(&(work[*a] * in_b)).then(in_a.cmp(&in_b))
        });
        let mut sums = vec![(0, 0)];
        let mut sum = (0, 0);
        for task in tasks {
            sum = (sum.0 + problem.tasks[task].hold, sum.1 + work[task]);
            sums.push(sum);
        }
        Self::Sums(sums)
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

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Seven tasks with work and hold, each after one before it or after none.
    fn forest() -> impl Strategy<Value = Problem> {
        prop::collection::vec((1_u64..9, 0_u64..5, any::<prop::sample::Index>()), 7).prop_map(|tasks| {
            let before = tasks.iter().enumerate().map(|(task, (_, _, parent))| {
                let parent = parent.index(task + 1);
                if parent == task { vec![] } else { vec![parent] }
            });
            let before = before.collect();
            let task = |(duration, hold, _)| Task { duration, current: 5, hold, turn: None };
            Problem::new(tasks.into_iter().map(task).collect(), before, 100, 7).expect("no cycle")
        })
    }

    /// By trying every set.
    fn heaviest(problem: &Problem, hold: u64) -> u128 {
        let has = |set: u32, task: usize| set >> task & 1 == 1;
        let good = |set: u32| {
            let mut tasks = (0..problem.len()).filter(|task| has(set, *task));
            tasks.all(|task| problem.before[task].iter().all(|b| has(set, *b)))
        };
        let sum = |set: u32, of: fn(&Task) -> u64| -> u64 {
            (0..problem.len()).filter(|task| has(set, *task)).map(|task| of(&problem.tasks[task])).sum()
        };
        let sets = (0..1 << problem.len()).filter(|set| good(*set) && sum(*set, |task| task.hold) <= hold);
        sets.map(|set| u128::from(sum(set, |task| task.duration))).max().expect("the empty set")
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(64))]

        #[test]
        fn of_a_forest_the_table_has_the_heaviest_set_and_the_sums_no_less(problem in forest()) {
            let work: Vec<u128> = problem.tasks.iter().map(|task| u128::from(task.duration)).collect();
            let (table, sums) = (Heaviest::table(&problem, &work, 1), Heaviest::sums(&problem, &work));
            for hold in 0..40 {
                prop_assert_eq!(table.within(hold), heaviest(&problem, hold));
                prop_assert!(sums.within(hold) >= table.within(hold));
            }
        }
    }

    #[test]
    fn the_sums_take_parts_of_what_is_too_much() {
        let tasks = [(10, 1), (30, 4), (6, 0)].map(|(duration, hold)| Task {
            duration,
            current: 9,
            hold,
            turn: None,
        });
        let problem = Problem::new(tasks.to_vec(), vec![vec![]; 3], 100, 3).expect("no cycle");
        let sums = Heaviest::sums(&problem, &[10, 30, 6]);
        assert_eq!([0, 1, 2, 3, 5, 9].map(|hold| sums.within(hold)), [6, 16, 24, 31, 46, 46]);
    }
}
