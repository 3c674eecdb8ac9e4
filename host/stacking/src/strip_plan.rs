//! The plan whose tree path is a strip: its arcs are stacked upwards and downwards in turn, and joined where the strip runs
//! on. The strip leaves no choice, so the piles find room or don't. `net_search` asks for it.

use crate::folding_map::Facing;
use crate::joint::Joint;
use crate::matching::Bridged;
use crate::plan::Plan;
use crate::planner::{self, Request};
use crate::readers::Model;
use std::collections::BTreeSet;

/// The plan of a strip, or nothing where two piles would stand on one cell.
pub(crate) fn of(order: &[usize], model: &Model, request: &Request) -> Option<Plan> {
    let height = order.len() / request.piles;
    let mut facing = vec![Facing::BOTTOM; order.len()];
    let mut bridges = Vec::with_capacity(request.piles);
    let mut cells = vec![[0, 0]];
    for (along, pair) in order.windows(2).enumerate() {
        let [a, b] = [pair[0], pair[1]];
        // Neighbours in a strip are neighbours in the graph.
        let edges = model.dual.common_edges(a, b)?;
        if (along + 1).is_multiple_of(height) {
            let pile = along / height;
            let side = facing[a].side(edges[0]);
            let [dx, dy] = side.step();
            let [x, y] = cells[pile];
            cells.push([x + dx, y + dy]);
            facing[b] = facing[a].beside(edges[0], edges[1]);
            let sides = [side, side.opposite()];
            bridges.push(Joint { panels: [a, b], edges, piles: [pile, pile + 1], sides });
        } else {
            facing[b] = facing[a].folded(edges[0], edges[1]);
        }
    }
    if cells.iter().collect::<BTreeSet<_>>().len() < cells.len() {
        return None;
    }
    let corner = [0, 1].map(|axis| cells.iter().map(|cell| cell[axis]).min().unwrap_or(0));
    let cells = cells.iter().map(|cell| [cell[0] - corner[0], cell[1] - corner[1]]).collect();
    let mut piles: Vec<Vec<usize>> = order.chunks_exact(height).map(<[usize]>::to_vec).collect();
    for downwards in piles.iter_mut().skip(1).step_by(2) {
        downwards.reverse();
    }
    Some(planner::into_plan(Bridged { piles, facing, cells, bridges, breaks: Vec::new() }, model, request))
}
