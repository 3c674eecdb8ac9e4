//! The hinges of a stacked zygote with their sides and angles: fold hinges within the piles, bridges between them.

use crate::dual::Dual;
use crate::folding_map::Facing;
use crate::joint::Joint;
use crate::plan::{Hinge, HingeKind, Side};
use crate::square::{self, Quad};

/// All hinges: those of every pile from the bottom up, then the bridges. `facing` is that of the turned piles.
pub(crate) fn of(
    piles: &[Vec<usize>],
    bridges: &[Joint],
    facing: &[Facing],
    target: &[Quad],
    dual: &Dual,
) -> Vec<Hinge> {
    let mut hinges = Vec::with_capacity(target.len());
    for pile in piles {
        for (height, pair) in pile.windows(2).enumerate() {
            let panels = [pair[0], pair[1]];
            // Neighbours in a strip are neighbours in the graph, so the edges are there.
            if let Some(edges) = dual.common_edges(pair[0], pair[1]) {
                let side = facing[pair[0]].side(edges[0]);
                hinges.push(hinge(HingeKind::Fold, panels, edges, side, height, target));
            }
        }
    }
    for joint in bridges {
        let side = facing[joint.panels[0]].side(joint.edges[0]);
        hinges.push(hinge(HingeKind::Bridge, joint.panels, joint.edges, side, 0, target));
    }
    hinges
}

/// A hinge between neighbours; of a fold the lower panel first, and its height.
pub(crate) fn hinge(
    kind: HingeKind,
    panels: [usize; 2],
    edges: [usize; 2],
    side: Side,
    height: usize,
    target: &[Quad],
) -> Hinge {
    let bend = bend(&target[panels[0]], &target[panels[1]], edges[1]);
    let zygote_angle_deg = match kind {
        HingeKind::Bridge => 0,
        HingeKind::Fold if height.is_multiple_of(2) => 180,
        HingeKind::Fold => -180,
    };
    // The angle is measured where the panels touch: on the outer side, but on the inner one over odd heights.
    let opening = 180 - 90 * if zygote_angle_deg < 0 { -bend } else { bend };
    Hinge {
        kind,
        panels,
        edges,
        side,
        opening_deg: opening.unsigned_abs(),
        zygote_angle_deg,
        target_angle_deg: 90 * bend,
    }
}

/// Where the second panel leads to from their common edge, seen from the first: 1 to its outer side, 0 straight on, -1 inwards.
pub(crate) fn bend(first: &Quad, second: &Quad, edge: usize) -> i16 {
    match square::dot(square::into(second, edge), square::normal(first)) {
        1.. => 1,
        0 => 0,
        _ => -1,
    }
}
