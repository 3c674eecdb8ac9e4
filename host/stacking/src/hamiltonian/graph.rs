//! The graph that a cycle is sought in: the panels, and for a path the apex that neighbours them all.

use crate::adjacency::Adjacency;

/// Panels by number; the apex, where there is one, has the number after the last.
pub(super) struct Graph<'a> {
    neighbours: &'a Adjacency,
    with_apex: bool,
    /// Edges that the cycle should keep to, sorted, the lower node first.
    lanes: Vec<(usize, usize)>,
}

impl<'a> Graph<'a> {
    pub(super) fn new(neighbours: &'a Adjacency, with_apex: bool) -> Self {
        Self { neighbours, with_apex, lanes: Vec::new() }
    }

    /// The same graph with edges that the cycle should keep to.
    pub(super) fn along(mut self, lanes: &[(usize, usize)]) -> Self {
        self.lanes = lanes.iter().map(|(u, v)| (*u.min(v), *u.max(v))).collect();
        self.lanes.sort_unstable();
        self.lanes.dedup();
        self
    }

    /// The edges that the cycle should keep to.
    pub(super) fn lanes(&self) -> &[(usize, usize)] {
        &self.lanes
    }

    /// Whether an edge is one that the cycle should keep to.
    pub(super) fn is_lane(&self, u: usize, v: usize) -> bool {
        !self.lanes.is_empty() && self.lanes.binary_search(&(u.min(v), u.max(v))).is_ok()
    }

    /// The number of panels, without the apex.
    pub(super) fn panels(&self) -> usize {
        self.neighbours.len()
    }

    /// The number of nodes, with the apex.
    pub(super) fn nodes(&self) -> usize {
        self.neighbours.len() + usize::from(self.with_apex)
    }

    /// The apex.
    pub(super) fn apex(&self) -> Option<usize> {
        self.with_apex.then_some(self.neighbours.len())
    }

    /// The panels beside a panel. The apex has none of its own: searches treat it apart, so as not to try all panels.
    pub(super) fn neighbours(&self, node: usize) -> &'a [usize] {
        if node < self.neighbours.len() { &self.neighbours[node] } else { &[] }
    }

    /// Whether an edge joins two different nodes.
    pub(super) fn joins(&self, u: usize, v: usize) -> bool {
        let apex = self.apex();
        u != v && (apex == Some(u) || apex == Some(v) || self.neighbours(u).contains(&v))
    }
}
