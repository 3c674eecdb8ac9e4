//! How a ring may become a pile: opened anywhere, run either way, turned. Every panel's height and facing follow.

use crate::dual::Dual;
use crate::folding_map::Facing;
use crate::hamiltonian::Strip;

/// One way to make a pile of a ring.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Opening {
    /// 0 to run as the ring does, 1 to run against it.
    pub(super) way: usize,
    /// The place of the bottom panel, counted in that way.
    pub(super) start: usize,
    /// Quarter turns of the pile.
    pub(super) turn: usize,
}

/// A ring with the facings that folding along it gives.
#[derive(Debug, Clone)]
pub(super) struct Frame {
    pub(super) ring: Strip,
    /// For each way the facings from place 0 on; of a closed ring twice around, since they need not agree after one.
    facings: [Vec<Facing>; 2],
}

impl Frame {
    pub(super) fn of(ring: Strip, dual: &Dual) -> Self {
        let height = ring.order.len();
        let length = if ring.closed { 2 * height } else { height };
        let facings = [0, 1].map(|way| {
            let at = |place: usize| panel_at(&ring.order, way, place);
            let mut facings = vec![Facing::BOTTOM];
            for place in 1..length {
                let below = facings[place - 1];
                // Neighbours in a ring are neighbours in the graph, so the edges are there.
                let edges = dual.common_edges(at(place - 1), at(place));
                facings.push(edges.map_or(below, |[edge, other]| below.folded(edge, other)));
            }
            facings
        });
        Self { ring, facings }
    }

    pub(super) fn height(&self) -> usize {
        self.ring.order.len()
    }

    /// The place of a panel, counted in a way, given its place in the ring's own.
    pub(super) fn place(&self, way: usize, place: usize) -> usize {
        if way == 0 { place } else { self.height() - 1 - place }
    }

    /// Whether the ring can be opened there.
    pub(super) fn opens(&self, start: usize) -> bool {
        self.ring.closed || start == 0
    }

    /// How the panel at a height lies when the ring is opened at `start`, before the pile is turned.
    pub(super) fn facing(&self, way: usize, start: usize, height: usize) -> Facing {
        let facing = self.facings[way][start + height];
        // The bottom panel has its outer side up.
        if self.facings[way][start].is_up() { facing } else { facing.mirrored() }
    }

    /// The panels of the pile from the bottom up.
    pub(super) fn pile(&self, opening: Opening) -> Vec<usize> {
        let panels = &self.ring.order;
        (0..panels.len()).map(|height| panel_at(panels, opening.way, opening.start + height)).collect()
    }
}

fn panel_at(order: &[usize], way: usize, place: usize) -> usize {
    let place = place % order.len();
    order[if way == 0 { place } else { order.len() - 1 - place }]
}
