//! Cuts the dual graph into parts of exactly equal size with few edges between them, and gives every part a ring: a
//! Hamiltonian cycle of its own, or a path where it has none.
//!
//! ```text
//! bisect: two halves of exact size, Fiduccia-Mattheyses -> split: K parts, by halves, then pair by pair
//! held:   panels that stay in their parts
//! sound:  cheap proofs that a part has no cycle
//! settle: panels change places across a border until no such proof holds
//! rings:  a cycle in every part; a part without one is cut anew together with a neighbour
//! lanes:  the edges along a border that a cycle should keep to
//! ```

mod bisect;
mod held;
mod lanes;
mod rings;
mod settle;
mod shortened;
mod sound;
mod split;
mod weights;

pub(crate) use held::Held;
pub(crate) use lanes::Borders;
pub(crate) use rings::{Keeping, Ringed, again, rings};
pub(crate) use split::{split, split_held};
pub(crate) use weights::Weights;

use crate::adjacency::Adjacency;

/// Of every one of so many panels the part that it is in; `usize::MAX` where it is in none.
fn part_of(parts: &[Vec<usize>], panels: usize) -> Vec<usize> {
    let mut part_of = vec![usize::MAX; panels];
    for (number, part) in parts.iter().enumerate() {
        for panel in part {
            part_of[*panel] = number;
        }
    }
    part_of
}

/// Numbers panels of a part from 0 on; made once for a graph and used for all its parts.
pub(crate) struct Numbering {
    number: Vec<usize>,
}

impl Numbering {
    /// For a graph of so many panels.
    pub(crate) fn new(panels: usize) -> Self {
        Self { number: vec![usize::MAX; panels] }
    }

    /// The neighbours within a part: node i is `members[i]`.
    pub(crate) fn within(&mut self, neighbours: &Adjacency, members: &[usize]) -> Adjacency {
        for (number, panel) in members.iter().enumerate() {
            self.number[*panel] = number;
        }
        let inner = |panel: &usize| {
            let all = neighbours[*panel].iter().map(|other| self.number[*other]);
            all.filter(|number| *number != usize::MAX)
        };
        let part = members.iter().map(inner).collect();
        for panel in members {
            self.number[*panel] = usize::MAX;
        }
        part
    }
}

/// The pieces of the nodes that `keeps` keeps, each in the order in which it was reached.
fn pieces(graph: &Adjacency, keeps: impl Fn(usize) -> bool) -> Vec<Vec<usize>> {
    let mut seen = vec![false; graph.len()];
    let mut pieces = Vec::new();
    for start in 0..graph.len() {
        if seen[start] || !keeps(start) {
            continue;
        }
        seen[start] = true;
        let mut piece = vec![start];
        let mut next = 0;
        while next < piece.len() {
            for &other in &graph[piece[next]] {
                if !seen[other] && keeps(other) {
                    seen[other] = true;
                    piece.push(other);
                }
            }
            next += 1;
        }
        pieces.push(piece);
    }
    pieces
}
