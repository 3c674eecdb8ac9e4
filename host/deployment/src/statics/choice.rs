//! Orders and roots compared by their loads.
//!
//! Which loads depend on the order? A hinge that turns lifts all that hangs on it, as it is then, on what carries it, as that
//! is then. From the root outwards all that carries it is open and all that it carries is closed, so every such order has the same
//! loads in all turns; they differ in what holds at a panel with several hinges. Another order can do more, but none
//! changes what hinges hold in the shape itself ([`Statics::overloaded_in_shape`]). What changes all of it is the root.

use super::tipping::Support;
use super::walk::{Statics, StaticsError};
use crate::rig::Rig;
use crate::tree::Tree;
use zygote_stacking::Plan;

/// With more panels than this no other root is looked for: a weighing takes as the square of their number.
const MOST_PANELS: usize = 1_000;
/// Roots that are looked at, evenly among all.
const MOST_ROOTS: usize = 100;

/// How bad loads are: how many hinges are overloaded, and the greatest torque over its rating.
fn badness(statics: &Statics) -> (usize, f64) {
    (statics.overloaded().len(), statics.worst_first().first().map_or(0.0, super::Load::factor))
}

impl Statics {
    /// Whether fewer hinges are overloaded here than there, or as many, but less.
    pub fn is_lighter_than(&self, other: &Self) -> bool {
        let ((hinges, factor), (others, other_factor)) = (badness(self), badness(other));
        hinges < others || hinges == others && factor < other_factor
    }
}

/// The root with which the fewest hinges are overloaded, with how many; opened in the order of the tree, whatever collides. `None`
/// with more than 1,000 panels.
///
/// # Errors
/// As [`Statics::of`].
pub fn lightest_root(
    plan: &Plan,
    rig: &Rig,
    support: Support,
) -> Result<Option<(usize, usize)>, StaticsError> {
    if plan.panels() > MOST_PANELS {
        return Ok(None);
    }
    let mut best: Option<(usize, Statics)> = None;
    for root in (0..plan.panels()).step_by(plan.panels().div_ceil(MOST_ROOTS)) {
        let plan = Plan { root, ..plan.clone() };
        let order: Vec<_> = Tree::new(&plan)?.branches().iter().map(|branch| branch.hinge).collect();
        let statics = Statics::of(&plan, rig, &order, support)?;
        if best.as_ref().is_none_or(|(_, best)| statics.is_lighter_than(best)) {
            best = Some((root, statics));
        }
    }
    Ok(best.map(|(root, statics)| (root, statics.overloaded().len())))
}
