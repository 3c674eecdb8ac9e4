//! From a model to a plan: strip, arcs, layout, hinges. The command `zygote plan` calls it.

use crate::arcs::Stack;
use crate::bridge_tree;
use crate::cuts::Cuts;
use crate::hamiltonian::{self, NoStrip, Strip};
use crate::hinges;
use crate::layout::{self, Layout};
use crate::plan::{Pile, Plan, Source};
use crate::random::Random;
use crate::readers::Model;
use crate::tree_path;

/// Strips that are tried, each from another seed, until the piles of one find room.
const STRIPS: u64 = 16;
/// Ways of cutting a strip that are tried.
const CUTS: usize = 600;
/// Layouts tried for each way of cutting a strip.
const LAYOUTS: usize = 24;

/// What is asked for.
#[derive(Debug, Clone)]
pub struct Request {
    /// Number of piles.
    pub piles: usize,
    /// The panel that stays fixed; none for the middle of the tree path.
    pub root: Option<usize>,
    /// Panel thickness over panel length.
    pub thickness: f64,
    /// Panel length in millimetres.
    pub panel_length_mm: f64,
    /// Seed of every random choice.
    pub seed: u64,
}

/// Why there is no plan.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum PlanError {
    /// Piles that can't be equally high.
    #[error("{panels} panels don't make {piles} equally high piles; the nearest numbers that do: {nearest}")]
    Indivisible {
        /// Number of panels.
        panels: usize,
        /// Number of piles asked for.
        piles: usize,
        /// Divisors of the number of panels below and above.
        nearest: String,
    },
    /// A root that is no panel.
    #[error("root panel {root}, expected a panel number from 0 to {last}")]
    Root {
        /// What was asked for.
        root: usize,
        /// The last panel.
        last: usize,
    },
    /// A length that is none.
    #[error("{what} {value}, expected a finite number above 0")]
    Length {
        /// Which length.
        what: &'static str,
        /// What was asked for.
        value: f64,
    },
    /// No strip through all panels.
    #[error(transparent)]
    NoStrip(#[from] NoStrip),
    /// No room for the piles.
    #[error(
        "no layout of {piles} piles of {height} panels found: tried {strips} strips, {cuts} ways of cutting them and \
         {layouts} layouts; at most {most} piles found a free cell; another number of piles or another seed may do"
    )]
    NoLayout {
        /// Number of piles.
        piles: usize,
        /// Panels in each.
        height: usize,
        /// Strips tried.
        strips: u64,
        /// Ways of cutting tried.
        cuts: usize,
        /// Layouts tried.
        layouts: usize,
        /// Most piles placed in any of them.
        most: usize,
    },
}

/// Plans a zygote for a model.
///
/// # Errors
/// A request that can't be met, or a search that ended without success; the message says what was tried.
pub fn plan(model: &Model, request: &Request) -> Result<Plan, PlanError> {
    let panels = model.surface.len();
    check_request(panels, request)?;
    let neighbours = model.dual.neighbours();
    let mut search = Search::new(request, panels);
    for number in 0..STRIPS {
        let seed = request.seed.wrapping_add(number.wrapping_mul(0x9E37_79B9));
        let strip = match hamiltonian::find(&neighbours, seed) {
            Ok(strip) => strip,
            // A proof, or a search that failed on the first seed already; later seeds may fail as they like.
            Err(reason) if number == 0 => return Err(reason.into()),
            Err(_) => continue,
        };
        let cuts = Cuts::of(&strip.order, request.piles, &model.dual);
        search.try_cuts(&cuts, strip.closed);
        if let Some(best) = search.best {
            return Ok(best.into_plan(&strip, &cuts, model, request));
        }
    }
    Err(PlanError::NoLayout {
        piles: request.piles,
        height: panels / request.piles,
        strips: STRIPS,
        cuts: search.cuts,
        layouts: search.layouts,
        most: search.most,
    })
}

pub(crate) fn check_request(panels: usize, request: &Request) -> Result<(), PlanError> {
    let piles = request.piles;
    let divides = |k: &usize| *k > 0 && panels.is_multiple_of(*k);
    if !divides(&piles) {
        let below = (1..piles.min(panels + 1)).rev().find(divides);
        let above = (piles + 1..=panels).find(divides);
        let list: Vec<String> = below.into_iter().chain(above).map(|k| k.to_string()).collect();
        return Err(PlanError::Indivisible { panels, piles, nearest: list.join(" and ") });
    }
    if let Some(root) = request.root.filter(|root| *root >= panels) {
        return Err(PlanError::Root { root, last: panels - 1 });
    }
    for (what, value) in [("thickness", request.thickness), ("panel length", request.panel_length_mm)] {
        if !(value.is_finite() && value > 0.0) {
            return Err(PlanError::Length { what, value });
        }
    }
    Ok(())
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
        Self { piles, height, random, best: None, cuts: 0, layouts: 0, most: 1 }
    }

    /// Tries to cut a strip at many places and to lay out the piles of each.
    fn try_cuts(&mut self, cuts: &Cuts<'_>, closed: bool) {
        let places = if closed && self.piles > 1 { self.height } else { 1 };
        let mut offsets: Vec<usize> = (0..places).collect();
        self.random.shuffle(&mut offsets);
        offsets.truncate(CUTS);
        for offset in offsets {
            self.try_offset(cuts, offset);
        }
    }

    fn try_offset(&mut self, cuts: &Cuts<'_>, offset: usize) {
        self.cuts += 1;
        let joints = cuts.joints(offset);
        for _ in 0..if self.piles == 1 { 1 } else { LAYOUTS } {
            self.layouts += 1;
            let layout = match layout::grow(self.piles, &joints, &mut self.random) {
                Ok(layout) => layout,
                Err(placed) => {
                    self.most = self.most.max(placed);
                    continue;
                }
            };
            let (area, rim) = layout::compactness(&layout.cells.iter());
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
    fn into_plan(self, strip: &Strip, cuts: &Cuts<'_>, model: &Model, request: &Request) -> Plan {
        let Self { offset, mut layout, .. } = self;
        let stack = Stack::cut(&strip.order, offset, request.piles, &model.dual);
        for (turn, pile) in layout.turns.iter_mut().zip(&stack.piles) {
            *turn += cuts.turn_of(pile[0], offset);
        }
        let target = model.surface.quads().to_vec();
        let mut facing = stack.facing;
        let mut zygote = vec![[[0; 2]; 4]; facing.len()];
        for (number, pile) in stack.piles.iter().enumerate() {
            for panel in pile {
                facing[*panel] = facing[*panel].turned(layout.turns[number]);
                zygote[*panel] = facing[*panel].corners(layout.cells[number]);
            }
        }
        let hinges = hinges::of(&stack.piles, &layout.bridges, &facing, &target, &model.dual);
        let root =
            request.root.unwrap_or_else(|| tree_path::centre(&tree_path::joined(target.len(), &hinges)).0);
        let cells = layout.cells.into_iter();
        let piles = cells.zip(stack.piles).map(|(cell, panels)| Pile { cell, panels }).collect();
        Plan {
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
        }
    }
}
