//! A strip cut into equal arcs, each stacked into a pile: alternately upwards and downwards, so that every arc ends at the
//! height at which the next one begins. Any two panels of equal height that are neighbours can be joined by a bridge.

use crate::dual::Dual;
use crate::folding_map::Facing;

/// Piles before they have a cell: every pile in a frame of its own.
#[derive(Debug, Clone)]
pub(super) struct Stack {
    /// Panels of every pile from the bottom up.
    pub(super) piles: Vec<Vec<usize>>,
    /// Of every panel how it lies in its pile's frame.
    pub(super) facing: Vec<Facing>,
}

impl Stack {
    /// Cuts a strip of panels, from place `offset` on, into `count` equal arcs and stacks them.
    pub(super) fn cut(order: &[usize], offset: usize, count: usize, dual: &Dual) -> Self {
        let height = order.len() / count;
        let mut facing = vec![Facing::BOTTOM; order.len()];
        let piles = (0..count).map(|number| {
            let start = offset + number * height;
            let mut pile: Vec<usize> =
                (start..start + height).map(|place| order[place % order.len()]).collect();
            if number % 2 == 1 {
                pile.reverse();
            }
            for pair in pile.windows(2) {
                // Neighbours in a strip are neighbours in the graph, so the edges are there.
                if let Some([edge, other]) = dual.common_edges(pair[0], pair[1]) {
                    facing[pair[1]] = facing[pair[0]].folded(edge, other);
                }
            }
            pile
        });
        let piles = piles.collect();
        Self { piles, facing }
    }
}
