//! From a model to a plan: piles from parts with few edges between them or from arcs of a strip, then hinges. The command
//! `zygote plan` calls it.

use crate::arcs;
use crate::at_once::at_once;
use crate::base::{self, NoBase};
use crate::by_parts::{self, Effort, NoMatch};
use crate::hamiltonian::NoStrip;
use crate::hinges;
use crate::matching::Bridged;
use crate::plan::{HingeKind, Pile, Plan, Source};
use crate::quality::{Quality, quality};
use crate::readers::Model;
use crate::tree_path;
use std::cmp::Reverse;
use std::collections::BTreeSet;

/// Up to so many panels both ways of making piles are gone.
const FEW_PANELS: usize = 1_000;
/// With more piles than this both are gone up to more panels.
const MANY_PILES: usize = 16;
const MANY_PANELS: usize = 20_000;

/// How the piles are made.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Partition {
    /// Parts with few edges between them, each with a strip of its own.
    MinCut,
    /// Equal arcs of one strip through all panels.
    Arcs,
    /// Whichever of both comes out better.
    #[default]
    Auto,
}

/// How many bridges join the piles.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Bridges {
    /// One less than piles: no fold is broken.
    Least,
    /// As many as can be; for each one too many a fold is broken.
    #[default]
    Most,
    /// One less than piles, all in one plane of the target: they never move, and nothing that does is wider than a cell.
    Base,
}

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
    /// How the piles are made.
    pub partition: Partition,
    /// How many bridges join them.
    pub bridges: Bridges,
    /// Cells in x and in y that the piles must find room on; none for as few as can be.
    pub grid: Option<[usize; 2]>,
}

impl Default for Request {
    /// One pile of panels of 90 mm, a hundredth as thick.
    fn default() -> Self {
        Self {
            piles: 1,
            root: None,
            thickness: 0.01,
            panel_length_mm: 90.0,
            seed: 0,
            partition: Partition::default(),
            bridges: Bridges::default(),
            grid: None,
        }
    }
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
    /// A grid with too few cells.
    #[error("a grid of {across} x {along} cells, expected room for {piles} piles")]
    Grid {
        /// Cells in x.
        across: usize,
        /// Cells in y.
        along: usize,
        /// Number of piles.
        piles: usize,
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
    /// No parts whose piles match.
    #[error(transparent)]
    NoMatch(#[from] NoMatch),
    /// No flat base.
    #[error(transparent)]
    NoBase(#[from] NoBase),
    /// Neither of both ways.
    #[error("{parts}; {arcs}")]
    NeitherWay {
        /// Why not by parts.
        parts: NoMatch,
        /// Why not by arcs.
        arcs: Box<PlanError>,
    },
}

impl PlanError {
    /// Whether the search came to an end without success, so that another seed may do.
    pub(crate) fn is_luck(&self) -> bool {
        match self {
            Self::NoStrip(_)
            | Self::NoLayout { .. }
            | Self::NoMatch(_)
            | Self::NoBase(_)
            | Self::NeitherWay { .. } => true,
            Self::Indivisible { .. } | Self::Root { .. } | Self::Length { .. } | Self::Grid { .. } => false,
        }
    }
}

/// Plans a zygote for a model.
///
/// # Errors
/// A request that can't be met, or a search that ended without success; the message says what was tried.
pub fn plan(model: &Model, request: &Request) -> Result<Plan, PlanError> {
    check_request(model.surface.len(), request)?;
    let neighbours = model.dual.neighbours();
    let by_arcs = || arcs::find(&model.dual, &neighbours, request);
    let by_parts = |effort| by_parts::find(&model.dual, &neighbours, request, effort);
    let plan = |found| into_plan(found, model, request);
    if request.bridges == Bridges::Base && request.piles > 1 {
        return Ok(plan(base::find(&model.dual, &neighbours, model.surface.quads(), request)?));
    }
    match request.partition {
        Partition::Arcs => Ok(plan(by_arcs()?)),
        Partition::MinCut => Ok(plan(by_parts(Effort::Thorough)?)),
        // A single pile is a strip either way.
        Partition::Auto if request.piles == 1 => Ok(plan(by_arcs()?)),
        Partition::Auto => {
            // Arcs seldom do better, so they are looked at where that costs little, or parts may well fail.
            let panels = neighbours.len();
            let (parts, arcs) =
                if panels <= FEW_PANELS || (request.piles > MANY_PILES && panels <= MANY_PANELS) {
                    let (parts, arcs) = at_once(|| by_parts(Effort::Short), by_arcs);
                    (parts, Some(arcs))
                } else {
                    (by_parts(Effort::Short), None)
                };
            match (parts, arcs) {
                (Ok(parts), arcs) => Ok(better(model, plan(parts), arcs.and_then(Result::ok).map(plan))),
                (Err(_), arcs) => match arcs.unwrap_or_else(by_arcs) {
                    Ok(arcs) => Ok(plan(arcs)),
                    Err(arcs) => match by_parts(Effort::Thorough) {
                        Ok(parts) => Ok(plan(parts)),
                        Err(parts) => Err(PlanError::NeitherWay { arcs: Box::new(arcs), parts }),
                    },
                },
            }
        }
    }
}

/// The plan with more bridges, or of as many the one that cuts fewer edges, or else the one with the shallower tree path.
fn better(model: &Model, parts: Plan, arcs: Option<Plan>) -> Plan {
    let score = |plan: &Plan| {
        let Quality { bridges, cut, depth, .. } = quality(model, plan);
        (bridges, Reverse(cut), Reverse(depth))
    };
    match arcs {
        Some(arcs) if score(&arcs) > score(&parts) => arcs,
        _ => parts,
    }
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
    if let Some([across, along]) = request.grid.filter(|[across, along]| across * along < piles) {
        return Err(PlanError::Grid { across, along, piles });
    }
    for (what, value) in [("thickness", request.thickness), ("panel length", request.panel_length_mm)] {
        if !(value.is_finite() && value > 0.0) {
            return Err(PlanError::Length { what, value });
        }
    }
    Ok(())
}

/// The plan of piles that are joined.
pub(crate) fn into_plan(found: Bridged, model: &Model, request: &Request) -> Plan {
    let Bridged { piles, facing, cells, bridges, breaks } = found;
    let target = model.surface.quads().to_vec();
    let mut zygote = vec![[[0; 2]; 4]; facing.len()];
    for (pile, cell) in piles.iter().zip(&cells) {
        for panel in pile {
            zygote[*panel] = facing[*panel].corners(*cell);
        }
    }
    let mut hinges = hinges::of(&piles, &bridges, &facing, &target, &model.dual);
    let broken: BTreeSet<[usize; 2]> = breaks.into_iter().collect();
    hinges.retain(|hinge| hinge.kind == HingeKind::Bridge || !broken.contains(&hinge.panels));
    let root = request.root.unwrap_or_else(|| tree_path::centre(&tree_path::joined(target.len(), &hinges)).0);
    let piles = cells.into_iter().zip(piles).map(|(cell, panels)| Pile { cell, panels }).collect();
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
            distance: model.distance,
            bounds: model.surface.bounds(),
            seed: request.seed,
            program: concat!("zygote ", env!("CARGO_PKG_VERSION")).into(),
        },
        schedule: None,
    }
}
