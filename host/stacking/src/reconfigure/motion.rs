//! The motions of a whole stack that bring its piles to the cells of another plan.

use crate::plan::{Plan, Side};
use std::collections::BTreeSet;
use std::fmt;

/// A motion of a stack: upside down or not, then quarter turns, then a shift.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Motion {
    /// Panels in a pile, where the stack is turned upside down about its x axis.
    upside_down: Option<usize>,
    /// Quarter turns counter-clockwise, 0 to 3.
    quarters: usize,
    shift: [i32; 2],
}

impl Motion {
    /// No motion.
    pub(super) const NONE: Self = Self { upside_down: None, quarters: 0, shift: [0, 0] };

    /// All motions that bring the piles of `first` to the cells of `second`, turned least first.
    pub(super) fn all(first: &Plan, second: &Plan) -> Vec<Self> {
        let there = cells(second, &Self::NONE);
        Self::to_corner(first, least(&there)).filter(|motion| cells(first, motion) == there).collect()
    }

    /// All motions of a stack that bring the least corner of its grid to a cell, turned least first.
    pub(super) fn to_corner(plan: &Plan, corner: [i32; 2]) -> impl Iterator<Item = Self> + use<'_> {
        // Turned over, an odd number of panels would have outer sides up at odd heights.
        let over = Some(plan.height()).filter(|height| height.is_multiple_of(2)).map(Some);
        let turns =
            [None].into_iter().chain(over).flat_map(|upside_down| (0..4).map(move |q| (upside_down, q)));
        turns.map(move |(upside_down, quarters)| {
            let turned = Self { upside_down, quarters, shift: [0, 0] };
            let from = least(&cells(plan, &turned));
            Self { shift: [corner[0] - from[0], corner[1] - from[1]], ..turned }
        })
    }

    /// Where a cell comes to.
    pub fn cell(&self, [i, j]: [i32; 2]) -> [i32; 2] {
        // A cell's middle turns about the origin; with doubled coordinates it stays a whole number.
        let (mut x, mut y) = (2 * i + 1, 2 * j + 1);
        if self.upside_down.is_some() {
            y = -y;
        }
        for _ in 0..self.quarters {
            (x, y) = (-y, x);
        }
        [(x - 1) / 2 + self.shift[0], (y - 1) / 2 + self.shift[1]]
    }

    /// Where a side comes to.
    pub fn side(&self, side: Side) -> Side {
        let side = match (self.upside_down, side) {
            (Some(_), Side::N | Side::S) => side.opposite(),
            _ => side,
        };
        side.turned(self.quarters)
    }

    /// Where a height comes to.
    pub fn height(&self, height: usize) -> usize {
        self.upside_down.map_or(height, |panels| panels - 1 - height)
    }
}

/// The cells of a plan after a motion.
fn cells(plan: &Plan, motion: &Motion) -> BTreeSet<[i32; 2]> {
    plan.piles.iter().map(|pile| motion.cell(pile.cell)).collect()
}

fn least(cells: &BTreeSet<[i32; 2]>) -> [i32; 2] {
    [0, 1].map(|axis| cells.iter().map(|cell| cell[axis]).min().unwrap_or(0))
}

impl fmt::Display for Motion {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let turn = match self.quarters {
            0 => "",
            1 => "a quarter turn counter-clockwise",
            2 => "half a turn",
            _ => "a quarter turn clockwise",
        };
        match (self.upside_down, turn) {
            (None, "") => f.write_str("as it stands"),
            (None, turn) => f.write_str(turn),
            (Some(_), "") => f.write_str("upside down about its x axis"),
            (Some(_), turn) => write!(f, "upside down about its x axis, then {turn}"),
        }
    }
}
