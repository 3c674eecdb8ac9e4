//! How good a plan is beside others of the same model.

use crate::dual::Dual;
use crate::partition::Weights;
use crate::placement::{self, Grid};
use crate::plan::{HingeKind, Plan};
use crate::readers::Model;
use crate::tree_path;
use std::collections::{BTreeMap, BTreeSet};

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
    let bridge_bound = pairs().map(|pair| most_bridges(dual, plan, pair)).sum();
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

/// The most bridges between two piles side by side, whatever their strips: no two at one panel, so a greatest matching of the
/// cut edges, by augmenting paths (Berge 1957).
fn most_bridges(dual: &Dual, plan: &Plan, [a, b]: [usize; 2]) -> usize {
    let own: BTreeSet<usize> = plan.piles[b].panels.iter().copied().collect();
    let across = |panel: &usize| -> Vec<usize> {
        let near = (0..4).filter_map(|edge| dual.across(*panel, edge));
        near.map(|across| across.panel).filter(|panel| own.contains(panel)).collect()
    };
    let borders: Vec<Vec<usize>> =
        plan.piles[a].panels.iter().map(across).filter(|near| !near.is_empty()).collect();
    let mut mate: BTreeMap<usize, usize> = BTreeMap::new();
    (0..borders.len()).filter(|panel| augment(*panel, &borders, &mut mate, &mut BTreeSet::new())).count()
}

/// Gives a panel a mate, by giving others another one where needed. No deeper than there are panels at a border.
fn augment(
    panel: usize,
    borders: &[Vec<usize>],
    mate: &mut BTreeMap<usize, usize>,
    seen: &mut BTreeSet<usize>,
) -> bool {
    for &other in &borders[panel] {
        if !seen.insert(other) {
            continue;
        }
        let free = match mate.get(&other).copied() {
            None => true,
            Some(taken) => augment(taken, borders, mate, seen),
        };
        if free {
            mate.insert(other, panel);
            return true;
        }
    }
    false
}
