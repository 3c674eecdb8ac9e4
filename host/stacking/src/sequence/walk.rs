//! The hinges of a sequence as joints between panels, numbered column by column from the bottom up.

use super::{Mounted, Sequence};
use crate::plan::{HingeKind, Side};
use std::collections::BTreeMap;

/// A hinge between two panels of a sequence.
#[derive(Debug, Clone, Copy)]
pub(super) struct Joint {
    pub(super) kind: HingeKind,
    /// Of a fold the lower one first.
    pub(super) panels: [usize; 2],
    /// Height of the first panel.
    pub(super) height: usize,
    /// On the first panel.
    pub(super) mounted: Mounted,
}

/// The cell beyond a side.
pub(super) fn beyond(cell: [i32; 2], side: Side) -> [i32; 2] {
    let [dx, dy] = side.step();
    [cell[0].saturating_add(dx), cell[1].saturating_add(dy)]
}

impl Sequence {
    /// The number of the column on each cell.
    pub(super) fn on_cell(&self) -> BTreeMap<[i32; 2], usize> {
        self.columns.iter().enumerate().map(|(number, column)| (column.cell, number)).collect()
    }

    /// All hinges: the folds column by column from the bottom up, then the bridges, each once. Columns are equally high, and
    /// every bridge stands at both of its panels.
    pub(super) fn joints(&self) -> Vec<Joint> {
        let on_cell = self.on_cell();
        let height_of_all = self.columns.first().map_or(0, |column| column.layers.len());
        let (mut folds, mut bridges) = (Vec::new(), Vec::new());
        for (number, column) in self.columns.iter().enumerate() {
            for (height, layer) in column.layers.iter().enumerate() {
                let panel = number * height_of_all + height;
                if let Some(mounted) = layer.above {
                    folds.push(Joint { kind: HingeKind::Fold, panels: [panel, panel + 1], height, mounted });
                }
                for mounted in &layer.bridges {
                    let other = on_cell.get(&beyond(column.cell, mounted.side));
                    if let Some(other) = other.filter(|other| number < **other) {
                        let panels = [panel, other * height_of_all + height];
                        bridges.push(Joint { kind: HingeKind::Bridge, panels, height, mounted: *mounted });
                    }
                }
            }
        }
        folds.append(&mut bridges);
        folds
    }
}
