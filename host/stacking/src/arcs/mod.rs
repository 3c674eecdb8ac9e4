//! Piles from arcs of one strip: the search over strips, the places to cut them and the layouts of their piles.
//!
//! ```text
//! cuts:        all ways of cutting a strip, and the bridges each allows
//! layout:      piles on cells, joined by a tree of bridges
//! bridge_tree: how deep that tree is
//! stack:       the arcs of the best way, stacked
//! ```

mod bridge_tree;
mod cuts;
mod layout;
mod stack;

use self::cuts::Cuts;
use self::layout::Layout;
use self::stack::Stack;
use crate::adjacency::Adjacency;
use crate::dual::Dual;
use crate::hamiltonian::{self, Strip};
use crate::matching::{self, Bridged, Matched};
use crate::planner::{Bridges, PlanError, Request};
use crate::random::Random;

/// Strips that are tried, each from another seed, until the piles of one find room.
const STRIPS: u64 = 16;
/// Piles laid out for each strip, over all the ways of cutting it that are tried, and the most and fewest ways.
const PILES: usize = 4_800;
const MOST_CUTS: usize = 600;
const FEWEST_CUTS: usize = 60;
/// Layouts tried for each way of cutting a strip.
const LAYOUTS: usize = 24;

/// Cuts a strip into arcs and joins their piles.
///
/// # Errors
/// No strip, or no room for the piles; the message says what was tried.
pub(crate) fn find(dual: &Dual, neighbours: &Adjacency, request: &Request) -> Result<Bridged, PlanError> {
    let mut search = Search::new(request, neighbours.len());
    for number in 0..STRIPS {
        let seed = request.seed.wrapping_add(number.wrapping_mul(0x9E37_79B9));
        let strip = match hamiltonian::find(neighbours, seed) {
            Ok(strip) => strip,
            // A proof, or a search that failed on the first seed already; later seeds may fail as they like.
            Err(reason) if number == 0 => return Err(reason.into()),
            Err(_) => continue,
        };
        let cuts = Cuts::of(&strip.order, request.piles, dual);
        search.try_cuts(&cuts, strip.closed);
        if let Some(bridged) =
            search.best.take().and_then(|best| best.into_bridged(&strip, &cuts, dual, request))
        {
            return Ok(bridged);
        }
    }
    Err(PlanError::NoLayout {
        piles: request.piles,
        height: neighbours.len() / request.piles,
        strips: STRIPS,
        cuts: search.cuts,
        layouts: search.layouts,
        most: search.most,
    })
}

/// Piles that found room.
struct Found {
    /// Where the first arc begins.
    offset: usize,
    layout: Layout,
    /// Less is better: area of the grid, half its circumference, depth of the tree path.
    score: (i32, i32, usize),
}

/// The search over the ways of cutting a strip.
struct Search {
    piles: usize,
    height: usize,
    grid: Option<[usize; 2]>,
    random: Random,
    best: Option<Found>,
    cuts: usize,
    layouts: usize,
    most: usize,
}

impl Search {
    fn new(request: &Request, panels: usize) -> Self {
        let random = Random::new(request.seed, 1 << 32);
        let (piles, height) = (request.piles, panels / request.piles);
        let grid = request.grid;
        Self { piles, height, grid, random, best: None, cuts: 0, layouts: 0, most: 1 }
    }

    /// Tries to cut a strip at many places and to lay out the piles of each.
    fn try_cuts(&mut self, cuts: &Cuts<'_>, closed: bool) {
        let places = if closed && self.piles > 1 { self.height } else { 1 };
        let mut offsets: Vec<usize> = (0..places).collect();
        self.random.shuffle(&mut offsets);
        offsets.truncate((PILES / self.piles).clamp(FEWEST_CUTS, MOST_CUTS));
        for offset in offsets {
            self.try_offset(cuts, offset);
        }
    }

    fn try_offset(&mut self, cuts: &Cuts<'_>, offset: usize) {
        self.cuts += 1;
        let joints = cuts.joints(offset);
        for _ in 0..if self.piles == 1 { 1 } else { LAYOUTS } {
            self.layouts += 1;
            let layout = match layout::grow(self.piles, &joints, self.grid, &mut self.random) {
                Ok(layout) => layout,
                Err(placed) => {
                    self.most = self.most.max(placed);
                    continue;
                }
            };
            let (area, rim) = layout::compactness(&layout.cells);
            let bridges = layout.bridges.iter().map(|joint| {
                let (_, height) = cuts.pile_and_height(joint.panels[0], offset);
                (joint.piles, height)
            });
            let depth = bridge_tree::depth(self.piles, self.height, &bridges.collect::<Vec<_>>());
            let score = (area, rim, depth);
            if self.best.as_ref().is_none_or(|best| score < best.score) {
                self.best = Some(Found { offset, layout, score });
            }
        }
    }
}

impl Found {
    fn into_bridged(self, strip: &Strip, cuts: &Cuts<'_>, dual: &Dual, request: &Request) -> Option<Bridged> {
        let Self { offset, layout: Layout { cells, mut turns, bridges }, .. } = self;
        let Stack { piles, facing } = Stack::cut(&strip.order, offset, request.piles, dual);
        for (turn, pile) in turns.iter_mut().zip(&piles) {
            *turn += cuts.turn_of(pile[0], offset);
        }
        let matched = Matched { piles, facing, turns, cells };
        match request.bridges {
            Bridges::Least | Bridges::Base => Some(matched.with(bridges)),
            Bridges::Most => matching::bridge(dual, matched, Bridges::Most),
        }
    }
}
