//! Checks an order of opening all hinges for collisions, over the whole of every turn.

use super::collision::Collision;
use super::ground::Ground;
use super::state::{Motion, Tally};
use super::thickness::{MotionError, Thickness};
use std::fmt;
use zygote_stacking::Plan;

/// What else is checked.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Options {
    /// A plane that nothing may pass.
    pub ground: Option<Ground>,
}

/// What is wrong with an order.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum OrderError {
    /// No such hinge.
    Unknown {
        /// The place in the order, from 0.
        step: usize,
        /// What stands there.
        hinge: usize,
    },
    /// A hinge that is open already.
    Twice {
        /// The place in the order, from 0.
        step: usize,
        /// The hinge.
        hinge: usize,
    },
    /// A hinge that has to turn, but isn't opened.
    Missing {
        /// The hinge.
        hinge: usize,
    },
}

impl fmt::Display for OrderError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Unknown { step, hinge } => write!(f, "step {step}: there is no hinge {hinge}"),
            Self::Twice { step, hinge } => write!(f, "step {step}: hinge {hinge} is open already"),
            Self::Missing { hinge } => write!(f, "hinge {hinge} is never opened"),
        }
    }
}

/// What the check of an order found.
#[derive(Debug, Clone, PartialEq)]
pub struct Report {
    /// Every two blocks that meet in a step, with the step's place in the order, from 0.
    pub collisions: Vec<(usize, Collision)>,
    /// What is wrong with the order itself.
    pub order_errors: Vec<OrderError>,
    /// Two panels, one of which a step moves and the other not, summed over all steps: all of them proved apart or reported.
    pub panel_pairs: u64,
    /// Two blocks that came near enough in a step to be looked at closely, summed over all steps.
    pub box_pairs: u64,
    /// At least so far apart are any two cores, one of which moves, all through every step; panel lengths, at most
    /// [`super::LOOKED_FOR`]. Not counted: cores that touch at the start or at the end of the step (layers that leave each
    /// other, panels laid against each other), and the ground. 0 where there are collisions.
    pub clearance: f64,
}

impl Report {
    /// Whether the order opens every hinge once without a collision.
    pub fn is_free(&self) -> bool {
        self.collisions.is_empty() && self.order_errors.is_empty()
    }
}

/// Checks that opening the hinges of a plan one by one in this order causes no collision.
///
/// Any order will do: whatever is open, a hinge moves its whole branch as it is. Hinges that don't turn move nothing and
/// needn't be in the order. After a collision the check goes on as if the panels had passed through each other.
///
/// # Errors
/// See [`Motion::new`].
pub fn check(
    plan: &Plan,
    order: &[usize],
    thickness: Thickness,
    options: &Options,
) -> Result<Report, MotionError> {
    let mut motion = Motion::new(plan, thickness, options.ground)?;
    let mut tally = Tally::new();
    let (mut collisions, mut order_errors) = (Vec::new(), Vec::new());
    for (step, &hinge) in order.iter().enumerate() {
        if hinge >= motion.linkage().hinges() {
            order_errors.push(OrderError::Unknown { step, hinge });
        } else if motion.is_open(hinge) {
            order_errors.push(OrderError::Twice { step, hinge });
        } else {
            collisions.extend(motion.collisions(hinge, &mut tally).into_iter().map(|found| (step, found)));
            motion.open(hinge);
        }
    }
    let unopened = |hinge: &usize| !motion.is_open(*hinge) && motion.linkage().turn_deg(*hinge) > 0.0;
    let missing = (0..motion.linkage().hinges()).filter(unopened);
    order_errors.extend(missing.map(|hinge| OrderError::Missing { hinge }));
    let clearance = if collisions.is_empty() { tally.clearance } else { 0.0 };
    let Tally { panel_pairs, box_pairs, .. } = tally;
    Ok(Report { collisions, order_errors, panel_pairs, box_pairs, clearance })
}
