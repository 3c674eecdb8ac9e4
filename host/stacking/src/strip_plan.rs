//! The plan whose tree path is a strip: its arcs are stacked upwards and downwards in turn, and joined where the strip runs
//! on. The strip leaves no choice, so the piles find room or don't. `net_search` asks for it.

use crate::folding_map::Facing;
use crate::plan::{Hinge, HingeKind, Pile, Plan, Side, Source};
use crate::planner::Request;
use crate::readers::Model;
use crate::square::{self, Quad};
use crate::tree_path;
use std::collections::BTreeSet;

/// The plan of a strip, or nothing where two piles would stand on one cell.
pub(crate) fn of(order: &[usize], model: &Model, request: &Request) -> Option<Plan> {
    let height = order.len() / request.piles;
    let target = model.surface.quads().to_vec();
    let mut facing = vec![Facing::BOTTOM; order.len()];
    let mut hinges = Vec::with_capacity(order.len());
    let mut cells = vec![[0, 0]];
    for (along, pair) in order.windows(2).enumerate() {
        let [a, b] = [pair[0], pair[1]];
        // Neighbours in a strip are neighbours in the graph.
        let edges = model.dual.common_edges(a, b)?;
        let (arc, up) = (along / height, (along / height).is_multiple_of(2));
        if (along + 1).is_multiple_of(height) {
            let side = facing[a].side(edges[0]);
            let [dx, dy] = side.step();
            let [x, y] = cells[arc];
            cells.push([x + dx, y + dy]);
            facing[b] = facing[a].beside(edges[0], edges[1]);
            hinges.push(hinge(HingeKind::Bridge, [a, b], edges, side, 0, &target));
        } else {
            facing[b] = facing[a].folded(edges[0], edges[1]);
            let from_bottom = along % height;
            let lower = if up { from_bottom } else { height - 2 - from_bottom };
            let ([a, b], edges) = if up { ([a, b], edges) } else { ([b, a], [edges[1], edges[0]]) };
            let side = facing[a].side(edges[0]);
            hinges.push(hinge(HingeKind::Fold, [a, b], edges, side, lower, &target));
        }
    }
    if cells.iter().collect::<BTreeSet<_>>().len() < cells.len() {
        return None;
    }
    let corner = [0, 1].map(|axis| cells.iter().map(|cell| cell[axis]).min().unwrap_or(0));
    let mut zygote = vec![[[0; 2]; 4]; order.len()];
    let piles = order.chunks_exact(height).zip(&cells).enumerate().map(|(number, (arc, cell))| {
        let cell = [cell[0] - corner[0], cell[1] - corner[1]];
        let mut panels = arc.to_vec();
        if number % 2 == 1 {
            panels.reverse();
        }
        for panel in arc {
            zygote[*panel] = facing[*panel].corners(cell);
        }
        Pile { cell, panels }
    });
    let piles = piles.collect();
    let root = request.root.unwrap_or_else(|| tree_path::centre(&tree_path::joined(target.len(), &hinges)).0);
    Some(Plan {
        target,
        zygote,
        hinges,
        piles,
        root,
        thickness: request.thickness,
        panel_length_mm: request.panel_length_mm,
        source: Source {
            model: model.name.clone(),
            voxel_size: model.voxel_size,
            bounds: model.surface.bounds(),
            seed: request.seed,
            program: concat!("zygote ", env!("CARGO_PKG_VERSION")).into(),
        },
        schedule: None,
    })
}

/// A hinge between neighbours, of a fold the lower one first and its height.
pub(crate) fn hinge(
    kind: HingeKind,
    panels: [usize; 2],
    edges: [usize; 2],
    side: Side,
    height: usize,
    target: &[Quad],
) -> Hinge {
    let bend = bend(&target[panels[0]], &target[panels[1]], edges[1]);
    let over_odd = kind == HingeKind::Fold && height % 2 == 1;
    // The angle is measured where the panels touch: on the outer side, but on the inner one over odd heights.
    let opening = 180 - 90 * if over_odd { -bend } else { bend };
    Hinge {
        kind,
        panels,
        edges,
        side,
        opening_deg: opening.unsigned_abs(),
        zygote_angle_deg: match (kind, over_odd) {
            (HingeKind::Bridge, _) => 0,
            (HingeKind::Fold, false) => 180,
            (HingeKind::Fold, true) => -180,
        },
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
