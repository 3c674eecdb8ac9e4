//! Cut edges between parts, counted.

use super::part_of;
use crate::adjacency::Adjacency;

/// Of every two parts the number of cut edges between them.
#[derive(Debug, Clone)]
pub(crate) struct Weights {
    parts: usize,
    weights: Vec<usize>,
}

impl Weights {
    /// No edges between so many parts.
    pub(crate) fn new(parts: usize) -> Self {
        Self { parts, weights: vec![0; parts * parts] }
    }

    /// The edges between parts of a graph; not those to panels in no part.
    pub(crate) fn between(parts: &[Vec<usize>], neighbours: &Adjacency) -> Self {
        let part_of = part_of(parts, neighbours.len());
        let mut weights = Self::new(parts.len());
        for &a in parts.iter().flatten() {
            let others = neighbours[a].iter().filter(|b| a < **b).map(|b| part_of[*b]);
            for other in others.filter(|other| *other != part_of[a] && *other != usize::MAX) {
                weights.add(part_of[a], other);
            }
        }
        weights
    }

    /// How many parts there are.
    pub(crate) fn parts(&self) -> usize {
        self.parts
    }

    /// Adds a cut edge.
    pub(crate) fn add(&mut self, a: usize, b: usize) {
        self.weights[a * self.parts + b] += 1;
        self.weights[b * self.parts + a] += 1;
    }

    /// The cut edges between two parts.
    pub(crate) fn of(&self, a: usize, b: usize) -> usize {
        self.weights[a * self.parts + b]
    }

    /// All cut edges.
    pub(crate) fn total(&self) -> usize {
        self.weights.iter().sum::<usize>() / 2
    }
}
