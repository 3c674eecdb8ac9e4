//! A cover by cycles: two mates for every node. Greedy, the node with the least choice first; what is left without mates
//! is repaired along alternating walks.

use super::cover::Cover;
use super::graph::Graph;
use super::trails::Trails;
use crate::random::Random;

/// How often a node is tried from which a repair failed; each try walks in another order.
const REPAIRS: usize = 8;

/// Finds a cover by cycles, or gives up.
pub(super) fn find(graph: &Graph<'_>, random: &mut Random) -> Option<Cover> {
    let mut cover = greedy(graph, random);
    let mut trails = Trails::new(graph.nodes());
    for node in 0..graph.panels() {
        let mut tries = 0;
        while cover.lacks(node) > 0 {
            if let Some((removed, added)) = trails.from(graph, &cover, node, None, usize::MAX, random) {
                cover.exchange(&removed, &added);
            } else {
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
