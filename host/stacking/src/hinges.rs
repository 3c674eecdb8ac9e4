//! The hinges of a stacked zygote with their sides and angles: fold hinges within the piles, bridges between them.

use crate::arcs::Joint;
use crate::dual::Dual;
use crate::folding_map::Facing;
use crate::plan::{Hinge, HingeKind};
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
                let zygote_angle_deg = if height % 2 == 0 { 180 } else { -180 };
                hinges.push(hinge(HingeKind::Fold, panels, edges, zygote_angle_deg, facing, target));
            }
        }
    }
    for joint in bridges {
        hinges.push(hinge(HingeKind::Bridge, joint.panels, joint.edges, 0, facing, target));
    }
    hinges
}

fn hinge(
    kind: HingeKind,
    panels: [usize; 2],
    edges: [usize; 2],
    zygote_angle_deg: i16,
    facing: &[Facing],
    target: &[Quad],
) -> Hinge {
    let [a, b] = panels;
    // Where b leads to, seen from a: +1 to the outer side, 0 straight on, -1 to the inner side.
    let bend = square::dot(square::into(&target[b], edges[1]), square::normal(&target[a]));
    // The angle is measured where the panels touch: on the outer side, but on the inner one over odd heights.
    let touching = if zygote_angle_deg < 0 { -bend } else { bend };
    let (target_angle_deg, opening_deg) = (signed_quarter(bend), 180 - signed_quarter(touching));
    Hinge {
        kind,
        panels,
        edges,
        side: facing[a].side(edges[0]),
        opening_deg: opening_deg.unsigned_abs(),
        zygote_angle_deg,
        target_angle_deg,
    }
}

fn signed_quarter(bend: i32) -> i16 {
    match bend {
        1.. => 90,
        0 => 0,
        _ => -90,
    }
}
