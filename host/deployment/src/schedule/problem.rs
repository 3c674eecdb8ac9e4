//! What the search for a short schedule works on: tasks with times and currents, and which waits for which. Times are raw
//! milliseconds, currents raw milliamperes. A task's number is its hinge's place in the order.

use super::reduction;
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// One motion.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Task {
    /// At least 1.
    pub(super) duration: u64,
    pub(super) current: u64,
    /// Drawn from the end on; at most `current`.
    pub(super) hold: u64,
    /// Tasks of one turn never move at once.
    pub(super) turn: Option<usize>,
}

/// Tasks, precedence and limits.
#[derive(Debug, Clone)]
pub(super) struct Problem {
    pub(super) tasks: Vec<Task>,
    /// Of every task, those that must have ended before it starts; none that another of them implies.
    pub(super) before: Vec<Vec<usize>>,
    /// The other way round.
    pub(super) followers: Vec<Vec<usize>>,
    /// All tasks, each after those before it.
    pub(super) topological: Vec<usize>,
    /// Earliest start, by precedence alone.
    pub(super) head: Vec<u64>,
    /// Longest way from the end of a task to the end of all.
    pub(super) tail: Vec<u64>,
    /// Most current.
    pub(super) limit: u64,
    /// Most tasks at once; at least 1.
    pub(super) parallel: usize,
}

impl Problem {
    /// `before` must have no cycle and as many entries as there are tasks; `None` if it has one.
    pub(super) fn new(
        tasks: Vec<Task>,
        before: Vec<Vec<usize>>,
        limit: u64,
        parallel: usize,
    ) -> Option<Self> {
        let topological = topological(&before)?;
        let before = reduction::of(before, &topological);
        let followers = turned(&before);
        let (mut head, mut tail) = (vec![0; tasks.len()], vec![0; tasks.len()]);
        for &task in &topological {
            head[task] = before[task].iter().map(|b| head[*b] + tasks[*b].duration).max().unwrap_or(0);
        }
        for &task in topological.iter().rev() {
            tail[task] = followers[task].iter().map(|f| tail[*f] + tasks[*f].duration).max().unwrap_or(0);
        }
        Some(Self { tasks, before, followers, topological, head, tail, limit, parallel: parallel.max(1) })
    }

    /// The same with more precedence; `None` if that makes a cycle.
    pub(super) fn with(&self, edges: &[(usize, usize)]) -> Option<Self> {
        let mut before = self.before.clone();
        for &(first, then) in edges {
            before[then].push(first);
        }
        Self::new(self.tasks.clone(), before, self.limit, self.parallel)
    }

    /// How many tasks there are.
    pub(super) fn len(&self) -> usize {
        self.tasks.len()
    }

    /// When all have ended.
    pub(super) fn makespan(&self, starts: &[u64]) -> u64 {
        starts.iter().zip(&self.tasks).map(|(start, task)| start + task.duration).max().unwrap_or(0)
    }
}

/// The other way round.
fn turned(before: &[Vec<usize>]) -> Vec<Vec<usize>> {
    let mut followers = vec![Vec::new(); before.len()];
    for (task, before) in before.iter().enumerate() {
        for earlier in before {
            followers[*earlier].push(task);
        }
    }
    followers
}

/// All tasks, each after those before it, the lowest that can be first.
fn topological(before: &[Vec<usize>]) -> Option<Vec<usize>> {
    let followers = turned(before);
    let mut missing: Vec<_> = before.iter().map(Vec::len).collect();
    let mut ready: BinaryHeap<_> = (0..before.len()).filter(|t| missing[*t] == 0).map(Reverse).collect();
    let mut order = Vec::with_capacity(before.len());
    while let Some(Reverse(task)) = ready.pop() {
        order.push(task);
        for &follower in &followers[task] {
            missing[follower] -= 1;
            if missing[follower] == 0 {
                ready.push(Reverse(follower));
            }
        }
    }
    (order.len() == before.len()).then_some(order)
}
