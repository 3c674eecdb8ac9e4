//! The folding map as arithmetic: how a panel lies on its cell, given how its neighbour lies on its own.
//!
//! A panel with its outer side up has its edges counter-clockwise on the sides of the cell, one with its outer side down
//! clockwise: edge `e` is on the side `turn + e` or `turn - e`, in quarter turns from E.

use crate::plan::Side;

/// How a panel lies on its cell.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Facing {
    /// Quarter turns counter-clockwise that bring edge 0 from E to where it is, 0 to 3.
    turn: usize,
    /// Whether the outer side is up.
    up: bool,
}

impl Facing {
    /// Outer side up, edge 0 on E: how the bottom panel of a pile lies before the pile is turned.
    pub(crate) const BOTTOM: Self = Self { turn: 0, up: true };

    /// Outer side as the height asks for, edge 0 on E.
    pub(crate) fn square_on(height: usize) -> Self {
        Self { turn: 0, up: height.is_multiple_of(2) }
    }

    /// The edge that is on a side of the cell.
    pub(crate) fn edge(self, side: Side) -> usize {
        let quarters = side as usize + 4 - self.turn;
        if self.up { quarters % 4 } else { (8 - quarters) % 4 }
    }

    /// The side of the cell that an edge is on.
    pub(crate) fn side(self, edge: usize) -> Side {
        Side::E.turned(if self.up { self.turn + edge } else { self.turn + 4 - edge })
    }

    /// The facing of the panel that is folded onto this one about `edge`, with its own edge `other` there.
    pub(crate) fn folded(self, edge: usize, other: usize) -> Self {
        let up = !self.up;
        let shared = self.side(edge) as usize;
        Self { turn: if up { shared + 4 - other } else { shared + other } % 4, up }
    }

    /// The facing of the panel that lies beside this one across `edge`, with its own edge `other` there.
    pub(crate) fn beside(self, edge: usize, other: usize) -> Self {
        let shared = self.side(edge).opposite() as usize;
        Self { turn: if self.up { shared + 4 - other } else { shared + other } % 4, up: self.up }
    }

    /// The facing after quarter turns of the whole pile.
    pub(crate) fn turned(self, quarters: usize) -> Self {
        Self { turn: (self.turn + quarters) % 4, up: self.up }
    }

    /// Whether the outer side is up.
    pub(crate) fn is_up(self) -> bool {
        self.up
    }

    /// The facing in the mirror image of the whole pile, where up and down, N and S change places.
    pub(crate) fn mirrored(self) -> Self {
        Self { turn: (4 - self.turn) % 4, up: !self.up }
    }

    /// The quarter turns of the pile from this facing to another with the same side up.
    pub(crate) fn quarters_to(self, other: Self) -> usize {
        (other.turn + 4 - self.turn) % 4
    }

    /// The facing of a panel at a height that has these corners on a cell.
    pub(crate) fn with_corners(height: usize, cell: [i32; 2], corners: &[[i32; 2]; 4]) -> Option<Self> {
        let square_on = Self::square_on(height);
        (0..4).map(|quarters| square_on.turned(quarters)).find(|facing| facing.corners(cell) == *corners)
    }

    /// The corners of the panel on a cell.
    pub(crate) fn corners(self, cell: [i32; 2]) -> [[i32; 2]; 4] {
        // Corner e is where edge e begins: the clockwise end of its side when the panel looks up, else the other end.
        [0, 1, 2, 3].map(|edge| {
            let side = self.side(edge);
            let end = if self.up { side } else { side.turned(1) };
            let [dx, dy] = match end {
                Side::E => [1, 0],
                Side::N => [1, 1],
                Side::W => [0, 1],
                Side::S => [0, 0],
            };
            [cell[0] + dx, cell[1] + dy]
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_folded_panel_is_the_mirror_image_in_the_common_edge() {
        for turn in 0..4 {
            for (edge, other) in (0..16).map(|number| (number / 4, number % 4)) {
                for below in [Facing { turn, up: true }, Facing { turn, up: false }] {
                    let above = below.folded(edge, other);
                    assert_ne!(above.up, below.up);
                    assert_eq!(above.side(other), below.side(edge));
                    // The common edge runs in opposite directions in the two panels.
                    let (a, b) = (below.corners([0, 0]), above.corners([0, 0]));
                    assert_eq!(a[edge], b[(other + 1) % 4]);
                    assert_eq!(a[(edge + 1) % 4], b[other]);
                    // So it does when they lie side by side.
                    let beside = below.beside(edge, other);
                    let b = beside.corners(below.side(edge).step());
                    assert_eq!(
                        (beside.up, a[edge], a[(edge + 1) % 4]),
                        (below.up, b[(other + 1) % 4], b[other])
                    );
                }
            }
        }
    }

    #[test]
    fn folding_the_mirror_image_gives_the_mirror_image_of_the_fold() {
        for (turn, number) in (0..4).flat_map(|turn| (0..16).map(move |number| (turn, number))) {
            let below = Facing { turn, up: true };
            let folded = below.folded(number / 4, number % 4);
            assert_eq!(below.mirrored().folded(number / 4, number % 4), folded.mirrored());
        }
    }

    #[test]
    fn every_edge_runs_along_the_side_that_it_is_on() {
        for turn in 0..4 {
            for facing in [Facing { turn, up: true }, Facing { turn, up: false }] {
                let corners = facing.corners([3, -2]);
                for edge in 0..4 {
                    assert_eq!(facing.edge(facing.side(edge)), edge);
                    let (p, q) = (corners[edge], corners[(edge + 1) % 4]);
                    let [dx, dy] = facing.side(edge).step();
                    // The middle of a side lies half a cell from the middle of the cell.
                    assert_eq!([p[0] + q[0], p[1] + q[1]], [2 * 3 + 1 + dx, 2 * -2 + 1 + dy]);
                }
            }
        }
    }
}
