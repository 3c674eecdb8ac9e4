//! A cover by cycles: two mates for every node. Greedy, the node with the least choice first; what is left without mates
//! is repaired along alternating walks.

use super::cover::Cover;
use super::graph::Graph;
use crate::random::Random;
use std::collections::{BTreeSet, VecDeque};

/// How often a node is tried from which a repair failed; each try walks in another order.
const REPAIRS: usize = 8;

/// Finds a cover by cycles, or gives up.
pub(super) fn find(graph: &Graph<'_>, random: &mut Random) -> Option<Cover> {
    let mut cover = greedy(graph, random);
    let mut search = Search::new(graph.nodes());
    for node in 0..graph.panels() {
        let mut tries = 0;
        while cover.lacks(node) > 0 {
            if !search.repair(graph, &mut cover, node, random) {
                tries += 1;
                if tries == REPAIRS {
                    return None;
                }
            }
        }
    }
    if let Some(apex) = graph.apex()
        && cover.lacks(apex) == 2
    {
        // All panels have mates among themselves: the apex goes between any two.
        let mate = cover.mates(0).next()?;
        cover.exchange(&[(0, mate)], &[(0, apex), (apex, mate)]);
    }
    (0..graph.nodes()).all(|node| cover.lacks(node) == 0).then_some(cover)
}

/// Nodes that wait for mates, by how much choice they have.
struct Queue {
    /// Nodes by choice; entries whose node has gone or has another choice by now are passed over.
    by_choice: Vec<Vec<usize>>,
    waiting: Vec<bool>,
    /// Of every node the edges that can still be taken.
    free: Vec<usize>,
}

impl Queue {
    fn new(graph: &Graph<'_>, random: &mut Random) -> Self {
        let free: Vec<usize> = (0..graph.panels()).map(|node| graph.neighbours(node).len()).collect();
        let most = free.iter().max().copied().unwrap_or_default();
        let mut queue = Self { by_choice: vec![Vec::new(); most + 3], waiting: vec![true; free.len()], free };
        let mut nodes: Vec<usize> = (0..graph.panels()).collect();
        random.shuffle(&mut nodes);
        for node in nodes {
            queue.by_choice[queue.free[node]].push(node);
        }
        queue
    }

    /// Edges that a node can still take, less those that it needs, plus two.
    fn choice(&self, cover: &Cover, node: usize) -> usize {
        self.free[node] + 2 - cover.lacks(node)
    }

    fn push(&mut self, cover: &Cover, node: usize) {
        self.waiting[node] = true;
        let choice = self.choice(cover, node);
        self.by_choice[choice].push(node);
    }

    /// The node with the least choice, of several the one that came last: so the next is mostly one nearby.
    fn pop(&mut self, cover: &Cover) -> Option<usize> {
        loop {
            let choice = self.by_choice.iter().position(|nodes| !nodes.is_empty())?;
            let node = self.by_choice[choice].pop()?;
            if self.waiting[node] && self.choice(cover, node) == choice {
                self.waiting[node] = false;
                return Some(node);
            }
        }
    }

    /// Links two nodes that wait.
    fn link(&mut self, graph: &Graph<'_>, cover: &mut Cover, u: usize, v: usize) {
        cover.link(u, v);
        for (node, mate) in [(u, v), (v, u)] {
            self.free[node] = self.free[node].saturating_sub(1);
            if cover.lacks(node) > 0 {
                self.push(cover, node);
            } else {
                self.waiting[node] = false;
                self.forget(graph, cover, node, mate);
            }
        }
    }

    /// A node takes no more mates: its neighbours have one edge less to choose from.
    fn forget(&mut self, graph: &Graph<'_>, cover: &Cover, full: usize, busy: usize) {
        for &other in graph.neighbours(full) {
            if other != busy && !cover.has(full, other) {
                self.free[other] = self.free[other].saturating_sub(1);
                if self.waiting[other] {
                    self.push(cover, other);
                }
            }
        }
    }
}

/// Links nodes to mates: along the lanes, then always at the node with the fewest edges to spare.
fn greedy(graph: &Graph<'_>, random: &mut Random) -> Cover {
    let mut cover = Cover::new(graph.nodes());
    let mut queue = Queue::new(graph, random);
    for &(u, v) in graph.lanes() {
        if cover.lacks(u) > 0 && cover.lacks(v) > 0 {
            queue.link(graph, &mut cover, u, v);
        }
    }
    let lot: Vec<u64> = (0..graph.panels()).map(|_| random.next()).collect();
    while let Some(node) = queue.pop(&cover) {
        while cover.lacks(node) > 0 {
            let usable = |other: &&usize| cover.lacks(**other) > 0 && !cover.has(node, **other);
            let best = graph
                .neighbours(node)
                .iter()
                .filter(usable)
                .min_by_key(|other| (queue.choice(&cover, **other), lot[**other] ^ lot[node]));
            let Some(&mate) = best else { break };
            cover.link(node, mate);
            queue.free[node] = queue.free[node].saturating_sub(1);
            queue.free[mate] = queue.free[mate].saturating_sub(1);
            if cover.lacks(mate) > 0 {
                queue.push(&cover, mate);
            } else {
                queue.waiting[mate] = false;
                queue.forget(graph, &cover, mate, node);
            }
        }
        queue.forget(graph, &cover, node, node);
    }
    cover
}

/// Where an alternating walk stands: at a node, about to add an edge or about to remove one.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Next {
    Adds,
    Removes,
}

/// Breadth-first search for an alternating walk from a node that lacks a mate to another one.
struct Search {
    /// For both states of every node the node that it was reached from, and the round of the search that did.
    reached: [Vec<(usize, usize)>; 2],
    round: usize,
}

impl Search {
    fn new(nodes: usize) -> Self {
        Self { reached: [vec![(0, 0); nodes], vec![(0, 0); nodes]], round: 0 }
    }

    fn mark(&mut self, state: Next, node: usize, from: usize) -> bool {
        let place = &mut self.reached[state as usize][node];
        let fresh = place.1 != self.round;
        if fresh {
            *place = (from, self.round);
        }
        fresh
    }

    /// Gives `start` one more mate without taking one from anybody but along the walk. False where no walk was found.
    fn repair(&mut self, graph: &Graph<'_>, cover: &mut Cover, start: usize, random: &mut Random) -> bool {
        self.round += 1;
        self.mark(Next::Adds, start, start);
        let mut queue = VecDeque::from([(start, Next::Adds)]);
        while let Some((node, next)) = queue.pop_front() {
            match next {
                Next::Adds => {
                    let mut others = graph.neighbours(node).to_vec();
                    random.shuffle(&mut others);
                    others.extend(graph.apex().filter(|apex| *apex != node));
                    for other in others {
                        if cover.has(node, other) || !self.mark(Next::Removes, other, node) {
                            continue;
                        }
                        let lacks = cover.lacks(other);
                        if lacks > usize::from(other == start) && self.apply(cover, start, other) {
                            return true;
                        }
                        if lacks == 0 {
                            queue.push_back((other, Next::Removes));
                        }
                    }
                }
                Next::Removes => {
                    for mate in cover.mates(node) {
                        if self.mark(Next::Adds, mate, node) {
                            queue.push_back((mate, Next::Adds));
                        }
                    }
                }
            }
        }
        false
    }

    /// Follows the walk back from its end and applies it, unless it takes an edge twice.
    fn apply(&self, cover: &mut Cover, start: usize, end: usize) -> bool {
        let (mut added, mut removed) = (Vec::new(), Vec::new());
        let (mut node, mut state) = (end, Next::Removes);
        while (node, state) != (start, Next::Adds) {
            let (from, _) = self.reached[state as usize][node];
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
        let distinct = |edges: &[(usize, usize)]| edges.iter().collect::<BTreeSet<_>>().len() == edges.len();
        let sound = distinct(&added) && distinct(&removed);
        if sound {
            cover.exchange(&removed, &added);
        }
        sound
    }
}
