//! Piles from arcs of one strip: the search over strips, the places to cut them and the layouts of their piles.

use crate::arcs::{Joint, Stack};
use crate::dual::Dual;
use crate::hamiltonian::{self, NoStrip, Strip};
use crate::layout::{self, Layout};
use crate::matching::{self, Bridged, Matched};
use crate::placement::Grid;
use crate::planner::{Bridges, PlanError};
use crate::random::Random;
use crate::tree_path;
use std::cmp::Ordering;

/// Strips that are tried, each from another seed, until the piles of one find room.
const STRIPS: u64 = 16;
/// Panels looked at for each strip, over all the ways of cutting it.
const CUT_BUDGET: usize = 4_000_000;
/// Layouts tried for each way of cutting a strip.
const LAYOUTS: usize = 24;
/// Panels looked at to compare the depths of layouts that are equally compact.
const DEPTH_BUDGET: usize = 2_000_000;

/// Cuts a strip into arcs and joins their piles.
///
/// # Errors
/// No strip, or no room for the piles; the message says what was tried.
pub(crate) fn find(
    dual: &Dual,
    neighbours: &[Vec<usize>],
    piles: usize,
    wanted: Bridges,
    grid: Option<Grid>,
    seed: u64,
) -> Result<Bridged, PlanError> {
    let panels = neighbours.len();
    let mut search = Search::new(dual, piles, grid, seed, panels);
    for number in 0..STRIPS {
        let seed = seed.wrapping_add(number.wrapping_mul(0x9E37_79B9));
        match hamiltonian::find(neighbours, seed) {
            Ok(strip) => search.try_strip(&strip),
            // A proof, or a search that failed on the first seed already; later seeds may fail as they like.
            Err(reason) if number == 0 => return Err(NoStrip::into(reason)),
            Err(_) => {}
        }
        if let Some(bridged) = search.best.take().and_then(|best| best.into_bridged(dual, wanted)) {
            return Ok(bridged);
        }
    }
    Err(PlanError::NoLayout {
        piles,
        height: panels / piles,
        strips: STRIPS,
        cuts: search.cuts,
        layouts: search.layouts,
        most: search.most,
    })
}

/// Piles that found room.
struct Found {
    stack: Stack,
    layout: Layout,
    /// Less is better: area of the grid, half its circumference, depth of the tree path.
    score: (i32, i32, usize),
}

/// The search over the ways of cutting a strip.
struct Search<'a> {
    dual: &'a Dual,
    piles: usize,
    grid: Option<Grid>,
    random: Random,
    best: Option<Found>,
    cuts: usize,
    layouts: usize,
    most: usize,
    panels: usize,
    depths: usize,
}

impl<'a> Search<'a> {
    fn new(dual: &'a Dual, piles: usize, grid: Option<Grid>, seed: u64, panels: usize) -> Self {
        let random = Random::new(seed, 1 << 32);
        Self { dual, piles, grid, random, best: None, cuts: 0, layouts: 0, most: 1, panels, depths: 0 }
    }

    /// Tries to cut a strip at many places and to lay out the piles of each.
    fn try_strip(&mut self, strip: &Strip) {
        let height = self.panels / self.piles;
        let places = if strip.closed && self.piles > 1 { height } else { 1 };
        let mut offsets: Vec<usize> = (0..places).collect();
        self.random.shuffle(&mut offsets);
        offsets.truncate((CUT_BUDGET / self.panels).max(8));
        for offset in offsets {
            let stack = Stack::cut(&strip.order, offset, self.piles, self.dual);
            self.try_stack(&stack);
        }
    }

    fn try_stack(&mut self, stack: &Stack) {
        self.cuts += 1;
        let joints = stack.joints(self.dual);
        for _ in 0..if self.piles == 1 { 1 } else { LAYOUTS } {
            self.layouts += 1;
            let layout = match layout::grow(self.piles, &joints, &mut self.random) {
                Ok(layout) => layout,
                Err(placed) => {
                    self.most = self.most.max(placed);
                    continue;
                }
            };
            if self.grid.is_some_and(|grid| !grid.holds(&layout.cells)) {
                continue;
            }
            let (area, rim) = layout::compactness(&layout.cells.iter());
            let compared = self.best.as_ref().map(|best| (area, rim).cmp(&(best.score.0, best.score.1)));
            let affordable = self.depths * self.panels < DEPTH_BUDGET;
            if compared == Some(Ordering::Greater) || (compared == Some(Ordering::Equal) && !affordable) {
                continue;
            }
            self.depths += 1;
            let score = (area, rim, depth(stack, &layout.bridges));
            if self.best.as_ref().is_none_or(|best| score < best.score) {
                self.best = Some(Found { stack: stack.clone(), layout, score });
            }
        }
    }
}

/// How deep the tree path is, from its middle.
fn depth(stack: &Stack, bridges: &[Joint]) -> usize {
    let mut joined = vec![Vec::new(); stack.facing.len()];
    let folds = stack.piles.iter().flat_map(|pile| pile.windows(2)).map(|pair| [pair[0], pair[1]]);
    for [a, b] in folds.chain(bridges.iter().map(|joint| joint.panels)) {
        joined[a].push(b);
        joined[b].push(a);
    }
    tree_path::centre(&joined).1
}

impl Found {
    fn into_bridged(self, dual: &Dual, wanted: Bridges) -> Option<Bridged> {
        let Self { stack, layout, .. } = self;
        let matched =
            Matched { piles: stack.piles, facing: stack.facing, turns: layout.turns, cells: layout.cells };
        match wanted {
            Bridges::Least => Some(matched.with(layout.bridges)),
            Bridges::Most => matching::bridge(dual, matched, wanted),
        }
    }
}
