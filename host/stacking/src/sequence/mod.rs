//! The coded sequence of a plan: for every panel of every pile, from the bottom up, the side and the opening angle of the
//! hinge to the next panel, and the bridges. A line of text a pile; `docs/src/sequence.md` has the grammar.
//!
//! `zygote sequence` prints it, `parse` reads it, `build` makes a plan of it: nothing of a plan is lost but the numbers of
//! its panels and where the target stands in space.

mod build;
mod compare;
mod error;
mod parse;
mod walk;

pub use compare::Difference;
pub use error::{Place, SequenceError, SequenceProblem};
pub use parse::SequenceText;

use crate::plan::{HingeKind, Plan, Side};
use std::fmt;

/// A hinge as a person mounts it: on a side of a panel, opening by an angle.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct Mounted {
    /// The side of the panel's cell.
    pub side: Side,
    /// Opening angle, degrees: 90, 180 or 270.
    pub opening_deg: u16,
}

/// A panel of a pile with its hinges.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Layer {
    /// The hinge to the panel above; none at a break, and none at the top.
    pub above: Option<Mounted>,
    /// The bridges, in the order E, N, W, S. Each stands at both of its panels.
    pub bridges: Vec<Mounted>,
    /// Whether this is the panel that stays fixed.
    pub root: bool,
}

/// The layers on one cell.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Column {
    /// The cell.
    pub cell: [i32; 2],
    /// From the bottom up.
    pub layers: Vec<Layer>,
}

/// The coded sequence of a plan.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Sequence {
    /// A column a pile, equally high.
    pub columns: Vec<Column>,
}

impl Sequence {
    /// The sequence of a plan.
    pub fn of(plan: &Plan) -> Self {
        let places = plan.places();
        let column = |pile: &crate::plan::Pile| Column {
            cell: pile.cell,
            layers: vec![Layer::default(); pile.panels.len()],
        };
        let mut columns: Vec<Column> = plan.piles.iter().map(column).collect();
        for hinge in &plan.hinges {
            let [(pile, height), (other, other_height)] = hinge.panels.map(|panel| places[panel]);
            let mounted = Mounted { side: hinge.side, opening_deg: hinge.opening_deg };
            match hinge.kind {
                HingeKind::Fold => columns[pile].layers[height.min(other_height)].above = Some(mounted),
                HingeKind::Bridge => {
                    columns[pile].layers[height].bridges.push(mounted);
                    let across = Mounted { side: hinge.side.opposite(), ..mounted };
                    columns[other].layers[other_height].bridges.push(across);
                }
            }
        }
        for layer in columns.iter_mut().flat_map(|column| &mut column.layers) {
            layer.bridges.sort_unstable();
        }
        let (pile, height) = places[plan.root];
        columns[pile].layers[height].root = true;
        Self { columns }
    }

    /// The number of panels.
    pub fn panels(&self) -> usize {
        self.columns.iter().map(|column| column.layers.len()).sum()
    }
}

impl fmt::Display for Mounted {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}{}", self.side.letter(), self.opening_deg)
    }
}

/// A line a pile: what `SequenceText::parse` reads.
impl fmt::Display for Sequence {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for Column { cell: [i, j], layers } in &self.columns {
            write!(f, "({i},{j}):")?;
            for (height, layer) in layers.iter().enumerate() {
                write!(f, " {}", if layer.root { "*" } else { "" })?;
                for bridge in &layer.bridges {
                    write!(f, "[{bridge}]")?;
                }
                match layer.above {
                    Some(mounted) => write!(f, "{mounted}")?,
                    None if height + 1 == layers.len() => write!(f, ".")?,
                    None => write!(f, "/")?,
                }
            }
            writeln!(f)?;
        }
        Ok(())
    }
}
