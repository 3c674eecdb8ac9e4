//! How thick the plates are, and how wide the border that may touch; what can be wrong with them.

use crate::tree::TreeError;
use zygote_stacking::Plan;

/// The plates of a motion check, in panel lengths.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Thickness {
    /// Thickness of a plate, above 0.
    pub thickness: f64,
    /// Width of the border of a plate that may touch anything, from 0 to less than a half.
    pub rim: f64,
}

/// All layers of a pile together, where panels count as without thickness: little, but enough to keep their order.
const IDEAL_PILE: f64 = 1e-3;
/// The border that goes with it: wider than such a pile is high, far narrower than a panel.
const IDEAL_RIM: f64 = 0.01;

/// See [`Thickness::touching`].
const TOUCHING_SHARE: f64 = 2e-5;

impl Thickness {
    /// Panels without thickness, as the limit of thin ones, so that their order in a pile still counts.
    pub fn ideal(plan: &Plan) -> Self {
        Self { thickness: IDEAL_PILE / plan.height().max(1) as f64, rim: IDEAL_RIM }
    }

    /// Panels as thick as the plan says, whose edges may touch: a border as wide as the thickness.
    pub fn of(plan: &Plan) -> Self {
        Self { thickness: plan.thickness, rim: plan.thickness }
    }

    /// So much of overlap of two cores, panel lengths, still is touching: a 50,000th of a thickness. Plates that pivot on
    /// each other's edge couldn't be told from plates that meet otherwise.
    pub fn touching(&self) -> f64 {
        (self.thickness * TOUCHING_SHARE).max(super::TOUCHING)
    }

    /// The same, if plates can be so.
    pub(super) fn checked(self) -> Result<Self, MotionError> {
        if !(self.thickness > 0.0 && self.thickness.is_finite()) {
            return Err(MotionError::Thickness { found: self.thickness });
        }
        if !(0.0..0.5).contains(&self.rim) {
            return Err(MotionError::Rim { found: self.rim });
        }
        Ok(self)
    }
}

/// Why the motion of a plan can't be followed.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum MotionError {
    /// The hinges are no tree.
    #[error(transparent)]
    Tree(#[from] TreeError),
    /// Plates must be plates.
    #[error("thickness {found} panel lengths, expected a finite number above 0")]
    Thickness {
        /// What was asked for.
        found: f64,
    },
    /// Something must be left within the border.
    #[error("rim {found} panel lengths, expected 0 to less than 0.5")]
    Rim {
        /// What was asked for.
        found: f64,
    },
    /// Piles that don't hold every panel once.
    #[error("plan: panel {panel} must lie in exactly one pile, found {found}")]
    Pile {
        /// The panel.
        panel: usize,
        /// Times that piles name it.
        found: usize,
    },
    /// A pile names what is no panel.
    #[error("plan: pile {pile} must hold some of the {panels} panels, found {found}")]
    NoPanel {
        /// Number of the pile.
        pile: usize,
        /// What it names.
        found: usize,
        /// Panels in the plan.
        panels: usize,
    },
    /// An order that doesn't open every hinge once.
    #[error("order: hinge {hinge} must stand in it exactly once, found {found} times")]
    Order {
        /// The hinge.
        hinge: usize,
        /// Times that the order names it.
        found: usize,
    },
    /// An order names what is no hinge.
    #[error("order: expected numbers of the {hinges} hinges, found {found}")]
    NoHinge {
        /// What it names.
        found: usize,
        /// Hinges in the plan.
        hinges: usize,
    },
    /// A direction that is none.
    #[error("ground: its normal must be a finite vector that isn't zero, found ({x}, {y}, {z})")]
    Ground {
        /// What was asked for.
        x: f64,
        /// What was asked for.
        y: f64,
        /// What was asked for.
        z: f64,
    },
}
