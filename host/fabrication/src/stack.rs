//! The zygote as bodies: where each panel of each pile stands, none touching another.

use crate::panel::{Holes, Panel, PanelError, length};
use crate::soup::{Point, Soup};
use zygote_stacking::{Plan, Side};

/// What is left between panels, millimetres, so that they don't stick together in the printer.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Gaps {
    /// Between the panels of a pile.
    pub layers_mm: f64,
    /// Between piles.
    pub piles_mm: f64,
}

impl Default for Gaps {
    /// The paper's: 0.2 mm.
    fn default() -> Self {
        Self { layers_mm: 0.2, piles_mm: 0.2 }
    }
}

/// A zygote to print.
#[derive(Debug, Clone, PartialEq)]
pub struct Stack {
    /// The one body of all panels, about its middle.
    pub body: Soup,
    /// The middle of every panel, by its number; the lowest corner of the whole is at the origin.
    pub middles: Vec<Point>,
    /// Sides of the whole, millimetres.
    pub box_mm: [f64; 3],
    /// Magnet holes that open towards another pile.
    pub hidden_holes: usize,
}

impl Stack {
    /// The stack of a plan.
    ///
    /// # Errors
    /// [`PanelError`] if a panel can't be made, or a gap isn't one.
    pub fn new(plan: &Plan, panel: &Panel, gaps: Gaps) -> Result<Self, PanelError> {
        let body = panel.body()?;
        length("gap between layers", gaps.layers_mm)?;
        length("gap between piles", gaps.piles_mm)?;
        let least = [0, 1].map(|axis| plan.piles.iter().map(|pile| pile.cell[axis]).min().unwrap_or(0));
        let (across, up) = (panel.side_mm + gaps.piles_mm, panel.thickness_mm + gaps.layers_mm);
        let mut middles = vec![[0.0; 3]; plan.panels()];
        for pile in &plan.piles {
            let [x, y] =
                [0, 1].map(|axis| f64::from(pile.cell[axis] - least[axis]) * across + panel.side_mm / 2.0);
            for (height, number) in pile.panels.iter().enumerate() {
                middles[*number] = [x, y, height as f64 * up + panel.thickness_mm / 2.0];
            }
        }
        let [cells_x, cells_y] = plan.grid().map(f64::from);
        let box_mm = [
            cells_x * across - gaps.piles_mm,
            cells_y * across - gaps.piles_mm,
            plan.height() as f64 * up - gaps.layers_mm,
        ];
        Ok(Self { body, middles, box_mm, hidden_holes: hidden_holes(plan, panel) })
    }

    /// The number of triangles of all bodies.
    pub fn triangles(&self) -> usize {
        self.body.triangles.len() * self.middles.len()
    }
}

/// Every side of a panel has the opening of one hole, that along the side next to it.
fn hidden_holes(plan: &Plan, panel: &Panel) -> usize {
    if !matches!(panel.holes, Holes::Magnets(_)) {
        return 0;
    }
    let cells: std::collections::BTreeSet<_> = plan.piles.iter().map(|pile| pile.cell).collect();
    let covered = |cell: &[i32; 2]| {
        let beyond = |side: &Side| [cell[0] + side.step()[0], cell[1] + side.step()[1]];
        Side::ALL.iter().filter(|side| cells.contains(&beyond(side))).count()
    };
    cells.iter().map(covered).sum::<usize>() * plan.height()
}
