//! Joins cycles by exchanges of two edges: where a square of the graph has opposite edges in two cycles, taking the other
//! two edges instead makes one cycle of both. Near-linear: cycles are sets.

use super::cover::Cover;
use super::graph::Graph;
use crate::sets::Sets;
use std::collections::VecDeque;

/// Joins cycles until no square joins any more: first without touching the lanes, then anyhow.
pub(super) fn merge(graph: &Graph<'_>, cover: &mut Cover) {
    let mut cycles = cycles_of(cover);
    if !graph.lanes().is_empty() {
        merge_where(graph, cover, &mut cycles, |u, v| !graph.is_lane(u, v));
    }
    merge_where(graph, cover, &mut cycles, |_, _| true);
}

fn merge_where(
    graph: &Graph<'_>,
    cover: &mut Cover,
    cycles: &mut Sets,
    may_go: impl Fn(usize, usize) -> bool,
) {
    let mut queue: VecDeque<usize> = (0..graph.panels()).collect();
    let mut waiting = vec![true; graph.nodes()];
    while let Some(node) = queue.pop_front() {
        waiting[node] = false;
        if let Some([a, b, c, d]) = square(graph, cover, cycles, &may_go, node) {
            cover.exchange(&[(a, b), (c, d)], &[(b, c), (d, a)]);
            cycles.join(a, c);
            for corner in [a, b, c, d] {
                for &near in graph.neighbours(corner).iter().chain([&corner]) {
                    if !std::mem::replace(&mut waiting[near], true) {
                        queue.push_back(near);
                    }
                }
            }
        }
    }
}

/// A square a-b-c-d with a-b and c-d in two cycles and the other edges free.
fn square(
    graph: &Graph<'_>,
    cover: &Cover,
    cycles: &mut Sets,
    may_go: &impl Fn(usize, usize) -> bool,
    a: usize,
) -> Option<[usize; 4]> {
    for b in cover.mates(a).filter(|b| may_go(a, *b)) {
        for &c in graph.neighbours(b) {
            if cycles.find(c) == cycles.find(a) {
                continue;
            }
            if let Some(d) = cover.mates(c).find(|d| graph.joins(*d, a) && may_go(c, *d)) {
                return Some([a, b, c, d]);
            }
        }
    }
    None
}

/// One set for every cycle of a cover.
fn cycles_of(cover: &Cover) -> Sets {
    let mut cycles = Sets::new(cover.nodes());
    for start in 0..cover.nodes() {
        // Nodes of a cycle that was walked already are in the set of its first one.
        if cycles.find(start) == start {
            for node in cover.walk(start) {
                cycles.join(node, start);
            }
        }
    }
    cycles
}
