//! The schedule of a list, as the MCU goes through it: whatever may start and has current to spare is started at once, the
//! one that matters most first. Quick enough for 100,000 hinges.

use super::problem::Problem;
use std::cmp::Reverse;
use std::collections::{BTreeMap, BinaryHeap};

/// A task that can never start.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Stuck {
    pub(super) task: usize,
    /// Current that is left for it.
    pub(super) left: u64,
}

/// What makes tasks wait for the same: all of one current and turn are ready in one heap.
type Class = (u64, Option<usize>);

/// Starts of all tasks, those of the highest priority first.
pub(super) fn starts<P: Ord + Copy>(problem: &Problem, priority: &[P]) -> Result<Vec<u64>, Stuck> {
    let mut ready: BTreeMap<Class, BinaryHeap<(P, Reverse<usize>)>> = BTreeMap::new();
    let mut missing: Vec<_> = problem.before.iter().map(Vec::len).collect();
    let push = |ready: &mut BTreeMap<Class, BinaryHeap<_>>, task: usize| {
        let class = (problem.tasks[task].current, problem.tasks[task].turn);
        ready.entry(class).or_default().push((priority[task], Reverse(task)));
    };
    for task in (0..problem.len()).filter(|task| missing[*task] == 0) {
        push(&mut ready, task);
    }
    let turns = problem.tasks.iter().filter_map(|task| task.turn).max().map_or(0, |turn| turn + 1);
    let mut taken = vec![false; turns];
    let mut starts = vec![0; problem.len()];
    let mut moving = BinaryHeap::new();
    let (mut now, mut drawn) = (0, 0);
    loop {
        while moving.len() < problem.parallel {
            let fits = |(current, turn): &Class| {
                drawn + current <= problem.limit && turn.is_none_or(|turn| !taken[turn])
            };
            let next = ready.iter().filter(|(class, _)| fits(class));
            let Some(class) = next.max_by_key(|(_, heap)| heap.peek().copied()).map(|(class, _)| *class)
            else {
                break;
            };
            let Some(heap) = ready.get_mut(&class) else { break };
            let Some((_, Reverse(task))) = heap.pop() else { break };
            if heap.is_empty() {
                ready.remove(&class);
            }
            starts[task] = now;
            drawn += class.0;
            if let Some(turn) = class.1 {
                taken[turn] = true;
            }
            moving.push(Reverse((now + problem.tasks[task].duration, task)));
        }
        let Some(&Reverse((time, _))) = moving.peek() else {
            let best = ready.values().filter_map(BinaryHeap::peek).max();
            let left = problem.limit.saturating_sub(drawn);
            return best.map_or(Ok(starts), |(_, Reverse(task))| Err(Stuck { task: *task, left }));
        };
        now = time;
        // All that end at this moment, before anything starts at it.
        while let Some(&Reverse((end, number))) = moving.peek()
            && end == now
        {
            moving.pop();
            let task = &problem.tasks[number];
            drawn -= task.current - task.hold;
            if let Some(turn) = task.turn {
                taken[turn] = false;
            }
            for &follower in &problem.followers[number] {
                missing[follower] -= 1;
                if missing[follower] == 0 {
                    push(&mut ready, follower);
                }
            }
        }
    }
}
