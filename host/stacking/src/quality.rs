//! How good a plan is beside others of the same model.

use crate::bridge_bound;
use crate::dual::Dual;
use crate::partition::Weights;
use crate::placement::{self, Grid};
use crate::plan::{HingeKind, Plan};
use crate::readers::Model;
use crate::tree_path;

/// Figures by which plans of one model compare.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Quality {
    /// Cells of the grid's box.
    pub cells: usize,
    /// Bridges.
    pub bridges: usize,
    /// What `bridges` can't exceed for these piles on these cells: a panel takes one bridge for each pile beside its own.
    pub bridge_bound: usize,
    /// Most hinges between the middle of the tree path and a panel.
    pub depth: usize,
    /// Neighbours in different piles.
    pub cut: usize,
    /// Those of them whose piles stand side by side: the weight of the placement.
    pub beside: usize,
    /// What `beside` can't exceed for these piles, wherever on a grid of these sides they stand.
    pub beside_bound: usize,
}

/// Measures a plan of a model.
pub fn quality(model: &Model, plan: &Plan) -> Quality {
    let dual: &Dual = &model.dual;
    let parts: Vec<Vec<usize>> = plan.piles.iter().map(|pile| pile.panels.clone()).collect();
    let weights = Weights::between(&parts, &dual.neighbours());
    let cell = |pile: usize| plan.piles[pile].cell;
    let near = |a: usize, b: usize| {
        let ([ax, ay], [bx, by]) = (cell(a), cell(b));
        ax.abs_diff(bx) + ay.abs_diff(by) == 1
    };
    let pairs = || (0..parts.len()).flat_map(|a| (0..a).map(move |b| [a, b])).filter(|[a, b]| near(*a, *b));
    let beside = pairs().map(|[a, b]| weights.of(a, b)).sum();
    let [across, along] = plan.grid().map(|side| usize::try_from(side).unwrap_or(0));
    let bridge_bound = pairs().map(|[a, b]| bridge_bound::between(dual, &parts[a], &parts[b])).sum();
    Quality {
        bridge_bound,
        cells: across * along,
        bridges: plan.hinges.iter().filter(|hinge| hinge.kind == HingeKind::Bridge).count(),
        depth: tree_path::centre(&tree_path::joined(plan.panels(), &plan.hinges)).1,
        cut: weights.total(),
        beside,
        beside_bound: placement::bound(&weights, Grid { across, along }),
    }
}
