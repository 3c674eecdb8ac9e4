//! Schedules of random problems: against every schedule there is, and as an MCU runs them.

use super::MOST_AFTER;
use super::problem::{Problem, Task};
use super::waiting::{self, Waiting};
use super::{Limits, Schedule};
use super::{exact, lower_bound, make, progress, search};
use crate::order::Order;
use crate::rig::Rig;
use crate::tree::Tree;
use proptest::prelude::*;
use std::collections::BTreeSet;
use std::path::Path;
use zygote_stacking::{Bridges, Model, Request};

const LIMIT: u64 = 10;

/// Tasks of up to the limit, some of which hold, with precedence from lower to higher.
fn random_problem(
    most: usize,
    longest: u64,
    edge: f64,
    hold: u64,
) -> impl Strategy<Value = (Problem, Vec<Vec<usize>>)> {
    let task = (1..=longest, 0..=LIMIT, 0..=hold, prop::option::weighted(0.3, 0_usize..2));
    (1..=most).prop_flat_map(move |count| {
        let tasks = prop::collection::vec(task.clone(), count);
        let edges = prop::collection::vec(prop::bool::weighted(edge), count * count);
        let parallel = prop_oneof![Just(usize::MAX), 1_usize..4];
        (tasks, edges, parallel).prop_map(move |(tasks, edges, parallel)| {
            let tasks: Vec<_> = tasks
                .into_iter()
                .map(|(duration, current, hold, turn)| Task {
                    duration,
                    current,
                    hold: hold.min(current),
                    turn,
                })
                .collect();
            let before: Vec<Vec<usize>> = (0..count)
                .map(|task| (0..task).filter(|other| edges[task * count + other]).collect())
                .collect();
            (Problem::new(tasks, before.clone(), LIMIT, parallel).expect("no cycle"), before)
        })
    })
}

/// Whether all limits are kept, looked at for every moment.
fn is_good(problem: &Problem, starts: &[u64], durations: &[u64]) -> Result<(), String> {
    let end = |task: usize| starts[task] + durations[task];
    for (task, start) in starts.iter().enumerate() {
        if problem.before[task].iter().any(|before| end(*before) > *start) {
            return Err(format!("{task} starts too early"));
        }
    }
    let last = (0..problem.len()).map(end).max().unwrap_or(0);
    for time in 0..=last {
        let moving: Vec<_> =
            (0..problem.len()).filter(|task| starts[*task] <= time && time < end(*task)).collect();
        let held: u64 =
            (0..problem.len()).filter(|task| end(*task) <= time).map(|task| problem.tasks[task].hold).sum();
        let drawn = held + moving.iter().map(|task| problem.tasks[*task].current).sum::<u64>();
        if drawn > problem.limit {
            return Err(format!("{drawn} drawn at {time}"));
        }
        if moving.len() > problem.parallel {
            return Err(format!("{} move at {time}", moving.len()));
        }
        let turns: Vec<_> = moving.iter().filter_map(|task| problem.tasks[*task].turn).collect();
        if turns.iter().collect::<BTreeSet<_>>().len() < turns.len() {
            return Err(format!("two of a turn move at {time}"));
        }
    }
    Ok(())
}

fn durations(problem: &Problem) -> Vec<u64> {
    problem.tasks.iter().map(|task| task.duration).collect()
}

/// The shortest of all schedules there are, found by trying every start of every task.
fn shortest(problem: &Problem) -> Option<u64> {
    fn go(problem: &Problem, starts: &mut Vec<u64>, best: &mut Option<u64>, horizon: u64) {
        let task = starts.len();
        if task == problem.len() {
            if is_good(problem, starts, &durations(problem)).is_ok() {
                *best = Some(problem.makespan(starts));
            }
            return;
        }
        let ready =
            problem.before[task].iter().map(|b| starts[*b] + problem.tasks[*b].duration).max().unwrap_or(0);
        for start in ready..=horizon {
            let end = start + problem.tasks[task].duration + problem.tail[task];
            if best.map_or(end > horizon, |best| end >= best) {
                break;
            }
            starts.push(start);
            go(problem, starts, best, horizon);
            starts.pop();
        }
    }
    let mut best = None;
    go(problem, &mut Vec::new(), &mut best, durations(problem).iter().sum());
    best
}

/// Starts as an MCU makes them, that knows currents and what each step waits for alone; `None` if it comes to a standstill.
fn run(problem: &Problem, waiting: &Waiting, durations: &[u64]) -> Option<Vec<u64>> {
    let mut starts = vec![None; problem.len()];
    for time in 0..=durations.iter().sum() {
        for (step, &task) in waiting.tasks.iter().enumerate() {
            let ended = |task: usize| starts[task].is_some_and(|start: u64| start + durations[task] <= time);
            let ready = waiting.after[step].iter().all(|before| ended(waiting.tasks[*before]));
            let drawn = (0..problem.len()).filter(|other| starts[*other].is_some()).map(|other| {
                if ended(other) { problem.tasks[other].hold } else { problem.tasks[other].current }
            });
            let drawn: u64 = drawn.sum();
            if starts[task].is_none() && ready && drawn + problem.tasks[task].current <= problem.limit {
                starts[task] = Some(time);
            }
        }
    }
    starts.into_iter().collect()
}

/// Everything that a step waits for, by way of other steps too.
fn implied(waiting: &Waiting) -> Vec<BTreeSet<usize>> {
    let mut implied: Vec<BTreeSet<usize>> = vec![BTreeSet::new(); waiting.tasks.len()];
    for step in 0..waiting.tasks.len() {
        let mut tasks = BTreeSet::new();
        for &before in &waiting.after[step] {
            tasks.extend(&implied[waiting.tasks[before]]);
            tasks.insert(waiting.tasks[before]);
        }
        implied[waiting.tasks[step]] = tasks;
    }
    implied
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(128))]

    #[test]
    fn of_a_few_hinges_the_schedule_is_the_shortest_of_all((problem, _) in random_problem(5, 3, 0.3, 3)) {
        let bound = lower_bound::of(&problem);
        match (shortest(&problem), search::best(&problem, bound, 20)) {
            (Some(shortest), Ok(found)) => {
                prop_assert!(bound <= shortest, "no bound: {} of {}", bound, shortest);
                prop_assert_eq!((found.makespan, found.bound), (shortest, shortest));
                prop_assert_eq!(is_good(&problem, &found.starts, &durations(&problem)), Ok(()));
            }
            (None, Err(_)) => {}
            (shortest, found) => prop_assert!(false, "the shortest is {:?}, found {:?}", shortest, found),
        }
    }

    /// Beyond what trying everything can do, the bounds against branch and bound.
    #[test]
    fn no_bound_is_above_the_shortest_whatever_is_held((problem, _) in random_problem(11, 6, 0.15, 2)) {
        let (starts, proven) = exact::shorter(&problem, None);
        prop_assert!(proven, "a few tasks are looked at to the end");
        let Some(starts) = starts else { return Ok(()) };
        prop_assert_eq!(is_good(&problem, &starts, &durations(&problem)), Ok(()));
        let shortest = problem.makespan(&starts);
        prop_assert!(progress::of(&problem) <= shortest, "{} of {}", progress::of(&problem), shortest);
        prop_assert!(lower_bound::of(&problem) <= shortest, "{} of {}", lower_bound::of(&problem), shortest);
    }

    #[test]
    fn every_schedule_keeps_precedence_supply_lanes_and_turns((problem, _) in random_problem(40, 9, 0.1, 0)) {
        let found = search::best(&problem, lower_bound::of(&problem), 20).expect("nothing is held");
        prop_assert_eq!(is_good(&problem, &found.starts, &durations(&problem)), Ok(()));
        prop_assert_eq!(problem.makespan(&found.starts), found.makespan);
        prop_assert!(found.bound <= found.makespan);
    }

    /// The wire has room for four waits a step, however many the order asks for.
    #[test]
    fn everything_that_a_hinge_must_wait_for_is_waited_for_by_way_of_four(
        (problem, before) in random_problem(30, 9, 0.25, 0),
        took in prop::collection::vec(1_u64..20, 30),
    ) {
        let (found, waiting) = make::solve(&problem, 20).expect("nothing is held");
        prop_assert!(waiting.after.iter().all(|after| after.len() <= MOST_AFTER));
        let implied = implied(&waiting);
        for (task, before) in before.iter().enumerate() {
            prop_assert!(before.iter().all(|before| implied[task].contains(before)));
        }
        prop_assert_eq!(is_good(&problem, &found.starts, &durations(&problem)), Ok(()));
        prop_assert!(found.bound <= found.makespan);
        let took = &took[..problem.len()];
        let starts = run(&problem, &waiting, took).expect("the MCU comes to an end");
        prop_assert_eq!(is_good(&problem, &starts, took), Ok(()));
    }

    /// Servos that hold must not take what a later motion needs, whichever is the quicker.
    #[test]
    fn whatever_motions_take_the_mcu_comes_to_an_end(
        (problem, _) in random_problem(14, 9, 0.15, 1),
        took in prop::collection::vec(1_u64..20, 14),
    ) {
        let Ok((found, waiting)) = make::solve(&problem, 20) else { return Ok(()) };
        prop_assert_eq!(is_good(&problem, &found.starts, &durations(&problem)), Ok(()));
        let took = &took[..problem.len()];
        let starts = run(&problem, &waiting, took);
        prop_assert_eq!(starts.map(|starts| is_good(&problem, &starts, took)), Some(Ok(())));
        if waiting.after.iter().all(|after| after.len() < MOST_AFTER) {
            let starts = run(&problem, &waiting, &durations(&problem));
            prop_assert_eq!(starts, Some(found.starts), "as expected, if motions take what is expected");
        }
    }
}

#[test]
fn sixteen_that_all_later_ones_wait_for_are_gathered_in_one_more_round() {
    let task = Task { duration: 10, current: 1, hold: 0, turn: None };
    let before = (0..32).map(|task| if task < 16 { vec![] } else { (0..16).collect() }).collect();
    let problem = Problem::new(vec![task; 32], before, 100, usize::MAX).expect("no cycle");
    assert_eq!(search::best(&problem, lower_bound::of(&problem), 0).expect("room").makespan, 20);
    let (found, waiting) = make::solve(&problem, 0).expect("room");
    assert!(waiting.after.iter().all(|after| after.len() <= MOST_AFTER));
    assert_eq!((found.makespan, found.bound), (30, 20));
    assert_eq!(waiting::of(&problem, &[0; 32]).map_err(|asked| asked.len()), Err(16));
}

/// Kinds of hinges by turns, what servos hold in mA, the limit in mA, and the shortest makespans in ms of `i14` in one pile
/// and in two, and of `l14` in one and in two. That none is shorter was proven by OR-Tools CP-SAT 9.15.
const SHORTEST: [(&[&str], u64, u64, [u64; 4]); 9] = [
    (&["sma"], 0, 200, [108_433, 108_433, 108_433, 108_433]),
    (&["sma"], 0, 400, [58_387, 58_387, 58_387, 58_387]),
    (&["sma"], 0, 800, [58_387, 41_705, 58_387, 33_364]),
    (&["servo"], 10, 380, [28_600, 31_600, 28_600, 29_600]),
    (&["servo"], 10, 630, [16_400, 16_200, 16_400, 15_000]),
    (&["servo"], 60, 1_030, [19_600, 16_400, 18_800, 15_600]),
    (&["servo"], 60, 1_280, [16_400, 11_000, 16_400, 10_000]),
    (&["servo"], 60, 1_530, [16_400, 11_000, 16_400, 8_800]),
    (&["sma", "servo"], 60, 860, [37_964, 28_423, 37_964, 27_223]),
];

#[test]
fn fourteen_panels_are_scheduled_as_short_as_another_solver_proves() {
    let mut plans = Vec::new();
    for name in ["i14", "l14"] {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("../../models/{name}.txt"));
        let model = Model::read(&path, None).expect("a model");
        for piles in [1, 2] {
            let request = Request { piles, bridges: Bridges::Least, ..Request::default() };
            plans.push((name, zygote_stacking::plan(&model, &request).expect("a plan")));
        }
    }
    for (kinds, hold, limit, shortest) in SHORTEST {
        for ((name, plan), shortest) in plans.iter().zip(shortest) {
            let entries: Vec<String> = (0..plan.hinges.len())
                .map(|hinge| {
                    format!("[[hinge]]\nhinge = {hinge}\nkind = \"{}\"\n", kinds[hinge % kinds.len()])
                })
                .collect();
            let current = if kinds == ["sma"] { 200 } else { 250 };
            let rig = format!(
                "version = 1\n[rig]\nid = \"14\"\n[supply]\nvoltage = \"5 V\"\nlimit = \"{limit} mA\"\n\
                 resistance = \"0 ohm\"\n[hinges]\ndefault = \"{}\"\n[servo]\ncurrent = \"{current} mA\"\n\
                 hold_current = \"{hold} mA\"\n[[node]]\nname = \"one\"\nheaters = 13\nservos = 13\n{}",
                kinds[0],
                entries.concat()
            );
            let rig = Rig::read("rig.toml", &rig).expect("a good rig");
            let order = Order::of_tree(&Tree::new(plan).expect("a tree"));
            let schedule = Schedule::plan(plan, &rig, &order, &Limits::default()).expect("a schedule");
            schedule.verify(plan, &rig).expect("a good schedule");
            let case = format!("{name} in {} piles, {kinds:?}, {hold} mA, {limit} mA", plan.piles.len());
            assert_eq!((schedule.makespan.0, schedule.lower_bound.0), (shortest, shortest), "{case}");
        }
    }
}
