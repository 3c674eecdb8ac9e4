//! Flat patches of the target that lie as cells of the grid do: one panel for every pile.

use crate::dual::Dual;
use crate::folding_map::Facing;
use crate::hinges;
use crate::joint::Joint;
use crate::placement::Grid;
use crate::plan::Side;
use crate::square::Quad;
use std::collections::VecDeque;

/// Panels in one plane, each on a cell, and the bridges that join them.
#[derive(Debug, Clone)]
pub(super) struct Patch {
    pub(super) panels: Vec<usize>,
    pub(super) cells: Vec<[i32; 2]>,
    /// Of every panel how it lies on its cell, outer side up.
    pub(super) facing: Vec<Facing>,
    /// A spanning tree, as shallow as can be; piles are numbered like panels.
    pub(super) bridges: Vec<Joint>,
}

/// So many cells of a grid in the order in which halves of them, and halves of those, hang together: slice by slice across
/// the longer side.
pub(super) fn cells(grid: Grid, count: usize) -> Vec<[i32; 2]> {
    let [across, along] = [grid.across, grid.along].map(|cells| i32::try_from(cells).unwrap_or(i32::MAX));
    let (longer, shorter) = (across.max(along), across.min(along));
    let all = (0..longer).flat_map(|slice| (0..shorter).map(move |at| [slice, at]));
    let turned = |[slice, at]: [i32; 2]| if across >= along { [slice, at] } else { [at, slice] };
    all.map(turned).take(count).collect()
}

impl Patch {
    /// The patch with a panel on the first cell that is turned by so many quarters; none where the surface isn't flat there.
    pub(super) fn at(
        first: usize,
        quarters: usize,
        cells: &[[i32; 2]],
        dual: &Dual,
        target: &[Quad],
    ) -> Option<Self> {
        let centre = cells.len() / 2;
        let mut found: Vec<Option<(usize, Facing)>> = vec![None; cells.len()];
        found[centre] = Some((first, Facing::BOTTOM.turned(quarters)));
        let mut bridges = Vec::with_capacity(cells.len());
        let mut reached = VecDeque::from([centre]);
        while let Some(here) = reached.pop_front() {
            let (panel, facing) = found[here]?;
            for side in Side::ALL {
                let [dx, dy] = side.step();
                let beyond = [cells[here][0] + dx, cells[here][1] + dy];
                let Some(there) = cells.iter().position(|cell| *cell == beyond) else { continue };
                if found[there].is_some() {
                    continue;
                }
                let edge = facing.edge(side);
                let across = dual.across(panel, edge)?;
                if hinges::bend(&target[panel], &target[across.panel], across.edge) != 0 {
                    return None;
                }
                found[there] = Some((across.panel, facing.beside(edge, across.edge)));
                bridges.push(Joint {
                    panels: [panel, across.panel],
                    edges: [edge, across.edge],
                    piles: [here, there],
                    sides: [side, side.opposite()],
                });
                reached.push_back(there);
            }
        }
        let found: Option<Vec<(usize, Facing)>> = found.into_iter().collect();
        let (panels, facing) = found?.into_iter().unzip();
        Some(Self { panels, cells: cells.to_vec(), facing, bridges })
    }

    /// The same seen from below: for a base at an odd height, where outer sides are down.
    pub(super) fn turned_over(mut self) -> Self {
        let lowest = self.cells.iter().map(|[_, y]| -y).min().unwrap_or(0);
        for [_, y] in &mut self.cells {
            *y = -*y - lowest;
        }
        for facing in &mut self.facing {
            *facing = facing.mirrored();
        }
        for bridge in &mut self.bridges {
            for (side, (pile, edge)) in bridge.sides.iter_mut().zip(bridge.piles.iter().zip(bridge.edges)) {
                *side = self.facing[*pile].side(edge);
            }
        }
        self
    }
}
