//! Where the borders of piles meet: the cut edges between piles on neighbouring cells.

use super::beyond;
use crate::dual::Dual;
use crate::plan::Side;

/// A cut edge between piles on neighbouring cells, seen from one of them.
#[derive(Debug, Clone, Copy)]
pub(super) struct BorderEdge {
    pub(super) panel: usize,
    pub(super) edge: usize,
    pub(super) other: usize,
    pub(super) other_edge: usize,
    pub(super) other_pile: usize,
    /// The side of the own cell beyond which the other pile stands.
    pub(super) towards: Side,
}

/// Of every one of so many panels its pile, and its place there.
pub(super) fn places<'a>(piles: impl Iterator<Item = &'a Vec<usize>>, panels: usize) -> Vec<(usize, usize)> {
    let mut places = vec![(0, 0); panels];
    for (pile, order) in piles.enumerate() {
        for (at, panel) in order.iter().enumerate() {
            places[*panel] = (pile, at);
        }
    }
    places
}

/// The border of every pile, in the order of its panels.
pub(super) fn borders<'a>(
    dual: &Dual,
    piles: impl Iterator<Item = &'a Vec<usize>>,
    places: &[(usize, usize)],
    cells: &[[i32; 2]],
) -> Vec<Vec<BorderEdge>> {
    let border_edge = |panel: usize, edge: usize| {
        let across = dual.across(panel, edge)?;
        let [(pile, _), (other_pile, _)] = [panel, across.panel].map(|panel| places[panel]);
        let towards = beyond(cells[pile], cells[other_pile])?;
        Some(BorderEdge { panel, edge, other: across.panel, other_edge: across.edge, other_pile, towards })
    };
    let border = |order: &Vec<usize>| {
        let edges = order.iter().flat_map(|panel| (0..4).map(|edge| (*panel, edge)));
        edges.filter_map(|(panel, edge)| border_edge(panel, edge)).collect()
    };
    piles.map(border).collect()
}
