//! Alternating trails of any length: add an edge, remove one, add one, ... from a node that lacks a mate to another one. They
//! mend a cover, and they carry what no exchange nearby can put right to the next place where it can be.

use super::cover::Cover;
use super::graph::Graph;
use crate::random::Random;
use std::collections::{BTreeSet, VecDeque};

type Edge = (usize, usize);

/// Where a trail stands: at a node, about to add an edge or about to remove one.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Next {
    Adds,
    Removes,
}

/// Breadth-first search for trails.
pub(super) struct Trails {
    /// For both states of every node the node that it was reached from, and the round of the search that did.
    reached: [Vec<(u32, u32)>; 2],
    round: u32,
    /// Nodes looked at, by all searches so far.
    steps: usize,
}

impl Trails {
    pub(super) fn new(nodes: usize) -> Self {
        Self { reached: [vec![(0, 0); nodes], vec![(0, 0); nodes]], round: 0, steps: 0 }
    }

    /// Nodes looked at, by all searches so far.
    pub(super) fn steps(&self) -> usize {
        self.steps
    }

    fn mark(&mut self, state: Next, node: usize, from: usize) -> bool {
        let place = &mut self.reached[state as usize][node];
        let fresh = place.1 != self.round;
        if fresh {
            #[expect(
                clippy::cast_possible_truncation,
                reason = "surfaces of 2^32 panels don't fit in memory"
            )]
            let from = from as u32;
            *place = (from, self.round);
        }
        fresh
    }

    /// The edges to remove and to add, so that `start` gets one more mate and nobody but the trail's end does. One edge may
    /// be kept from being removed. None where no trail was found among the first so many nodes.
    pub(super) fn from(
        &mut self,
        graph: &Graph<'_>,
        cover: &Cover,
        start: usize,
        kept: Option<Edge>,
        reach: usize,
        random: &mut Random,
    ) -> Option<(Vec<Edge>, Vec<Edge>)> {
        self.round += 1;
        self.mark(Next::Adds, start, start);
        let mut queue = VecDeque::from([(start, Next::Adds)]);
        let end = self.steps.saturating_add(reach);
        while let Some((node, next)) = queue.pop_front() {
            if self.steps == end {
                return None;
            }
            self.steps += 1;
            match next {
                Next::Adds => {
                    let near = graph.neighbours(node);
                    let turn = if near.is_empty() { 0 } else { random.below(near.len()) };
                    let apex = graph.apex().filter(|apex| *apex != node);
                    for &other in near[turn..].iter().chain(&near[..turn]).chain(&apex) {
                        if cover.has(node, other) || !self.mark(Next::Removes, other, node) {
                            continue;
                        }
                        let lacks = cover.lacks(other);
                        if lacks > usize::from(other == start)
                            && let Some(trail) = self.back(start, other)
                        {
                            return Some(trail);
                        }
                        if lacks == 0 {
                            queue.push_back((other, Next::Removes));
                        }
                    }
                }
                Next::Removes => {
                    for mate in cover.mates(node) {
                        let is_kept = kept == Some((node, mate)) || kept == Some((mate, node));
                        if !is_kept && self.mark(Next::Adds, mate, node) {
                            queue.push_back((mate, Next::Adds));
                        }
                    }
                }
            }
        }
        None
    }

    /// Follows the trail back from its end; none when it takes an edge twice.
    fn back(&self, start: usize, end: usize) -> Option<(Vec<Edge>, Vec<Edge>)> {
        let (mut added, mut removed) = (Vec::new(), Vec::new());
        let (mut node, mut state) = (end, Next::Removes);
        while (node, state) != (start, Next::Adds) {
            let from = self.reached[state as usize][node].0 as usize;
            let edge = (from.min(node), from.max(node));
            state = match state {
                Next::Removes => {
                    added.push(edge);
                    Next::Adds
                }
                Next::Adds => {
                    removed.push(edge);
                    Next::Removes
                }
            };
            node = from;
        }
        let distinct = |edges: &[Edge]| edges.iter().collect::<BTreeSet<_>>().len() == edges.len();
        (distinct(&added) && distinct(&removed)).then_some((removed, added))
    }
}
