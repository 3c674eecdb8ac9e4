//! Piles from parts with few edges between them: partition, rings, placement, matching. The other way beside arcs of one
//! strip; it reaches numbers of piles that arcs don't.

use crate::adjacency::Adjacency;
use crate::at_once::at_once;
use crate::dual::Dual;
use crate::hamiltonian::Strip;
use crate::matching::{self, Bridged, Opener};
use crate::partition::{self, Borders, Held, Keeping, Numbering, Ringed, Weights};
use crate::placement::{self, Grid};
use crate::planner::{Bridges, Request};
use crate::random::Random;

/// How long parts that match are sought.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Effort {
    /// As long as pays while there is another way.
    Short,
    /// As long as there is some hope.
    Thorough,
}

impl Effort {
    /// Partitions tried, and shapes of the grid for each.
    fn tries(self, piles: usize) -> (usize, usize) {
        match self {
            Self::Short if piles > VERY_MANY_PILES => (1, 1),
            Self::Short if piles > MANY_PILES => (1, 2),
            Self::Short => (2, 2),
            Self::Thorough => (6, 3),
        }
    }
}

/// With more piles than this a partition takes long to match.
const MANY_PILES: usize = 16;
/// With more than this, long.
const VERY_MANY_PILES: usize = 32;
/// Panels looked at over all the times that parts are joined, and how often that is at least and at most.
const PANELS: usize = 16_000;
const FEWEST_TIMES: usize = 2;
const MOST_TIMES: usize = 12;
/// Up to so many panels every other time keeps to lanes strictly; with more that takes long.
const MOST_STRICT: usize = 20_000;
/// Steps of matching for each placement and pile: in each a pile is opened anew.
const STEPS_A_PILE: usize = 8;

/// Why there are no piles from parts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error(
    "no {piles} parts that match found: tried {partitions} partitions, {ringed} of which had a strip in every part, \
     {placements} placements and {rings} other rings in them"
)]
pub struct NoMatch {
    /// Number of piles.
    pub piles: usize,
    /// Partitions tried.
    pub partitions: usize,
    /// Those with a strip in every part.
    pub ringed: usize,
    /// Placements tried in which the parts hung together.
    pub placements: usize,
    /// Rings sought anew because piles did not match.
    pub rings: usize,
}

/// Cuts the surface into parts and joins their piles.
///
/// # Errors
/// The search's end, which proves nothing.
pub(crate) fn find(
    dual: &Dual,
    neighbours: &Adjacency,
    request: &Request,
    effort: Effort,
) -> Result<Bridged, NoMatch> {
    let piles = request.piles;
    let mut random = Random::new(request.seed, 1 << 33);
    let all: Vec<usize> = (0..neighbours.len()).collect();
    let mut tried = NoMatch { piles, partitions: 0, ringed: 0, placements: 0, rings: 0 };
    let grids = request.grid.map_or_else(|| Grid::for_parts(piles), |grid| vec![Grid::of(grid)]);
    let (partitions, shapes) = effort.tries(piles);
    for _ in 0..partitions {
        tried.partitions += 1;
        let Some(ringed) = ringed(neighbours, &all, piles, &mut random) else { continue };
        let Some((parts, rings)) = partition::rings(neighbours, ringed, &Held::none(), &mut random) else {
            continue;
        };
        tried.ringed += 1;
        let weights = Weights::between(&parts, neighbours);
        for grid in grids.iter().take(shapes) {
            let placement = placement::place(&weights, *grid, &mut random);
            if !placement.worth.whole() {
                continue;
            }
            tried.placements += 1;
            let placed = Placed { dual, neighbours, parts: &parts, cells: &placement.cells, request };
            if let Some(bridged) = placed.best(&rings, &weights, &mut tried, &mut random) {
                return Ok(bridged);
            }
        }
    }
    Err(tried)
}

/// Two partitions, made at once: the one of which more parts have a ring, or else the one that cuts fewer edges.
fn ringed(neighbours: &Adjacency, all: &[usize], piles: usize, random: &mut Random) -> Option<Ringed> {
    let partition = |seed: u64| {
        let mut random = Random::new(seed, 2);
        let parts = partition::split(neighbours, all, piles, &mut random)?;
        Some(Ringed::of(neighbours, parts, &mut random))
    };
    let seeds = [random.next(), random.next()];
    let (one, other) = at_once(|| partition(seeds[0]), || partition(seeds[1]));
    one.into_iter()
        .chain(other)
        .min_by_key(|ringed| (ringed.lack(), Weights::between(&ringed.parts, neighbours).total()))
}

/// Parts on their cells.
struct Placed<'a> {
    dual: &'a Dual,
    neighbours: &'a Adjacency,
    parts: &'a [Vec<usize>],
    cells: &'a [[i32; 2]],
    request: &'a Request,
}

impl Placed<'_> {
    /// Joins the parts several times, each time with other rings, two at once, and takes the one with most bridges.
    fn best(
        &self,
        rings: &[Strip],
        weights: &Weights,
        tried: &mut NoMatch,
        random: &mut Random,
    ) -> Option<Bridged> {
        let times = (PANELS / self.neighbours.len()).clamp(FEWEST_TIMES, MOST_TIMES);
        let times = times.next_multiple_of(2);
        let seeds: Vec<u64> = (0..times).map(|_| random.next()).collect();
        let join = |number: usize| self.joined(rings, weights, number, seeds[number]);
        let mut all: Vec<(Option<Bridged>, usize)> = Vec::with_capacity(times);
        for pair in 0..times / 2 {
            let (one, other) = at_once(|| join(2 * pair), || join(2 * pair + 1));
            let failed = one.0.is_none() && other.0.is_none();
            all.extend([one, other]);
            if failed {
                break;
            }
        }
        tried.rings += all.iter().map(|(_, rings)| rings).sum::<usize>();
        let found: Vec<Bridged> = all.into_iter().filter_map(|(bridged, _)| bridged).collect();
        let most = found.iter().map(|bridged| bridged.bridges.len()).max()?;
        // Errors add up along the tree path, so of as many bridges the shallower tree.
        found.into_iter().filter(|bridged| bridged.bridges.len() == most).min_by_key(Bridged::depth)
    }

    /// Opens the rings so that they match, and builds the bridges. While the piles hang together in groups only, piles
    /// beside another group are opened anew. Says how many other rings that took.
    fn joined(
        &self,
        rings: &[Strip],
        weights: &Weights,
        number: usize,
        seed: u64,
    ) -> (Option<Bridged>, usize) {
        let mut random = Random::new(seed, 1);
        let random = &mut random;
        let strictly = number % 2 == 1 && self.neighbours.len() <= MOST_STRICT;
        let keeping = if strictly { Keeping::Strictly } else { Keeping::Loosely };
        let borders = Borders::of(self.dual, self.parts);
        let mut numbering = Numbering::new(self.neighbours.len());
        let mut other = |pile: usize, along_borders: bool, random: &mut Random| {
            let beside = |part: usize| along_borders && distance(self.cells[pile], self.cells[part]) == 1;
            let lanes = borders.lanes(&self.parts[pile], beside);
            partition::again(self.neighbours, &self.parts[pile], &lanes, keeping, &mut numbering, random)
        };
        let mut rings = rings.to_vec();
        if self.request.bridges == Bridges::Most {
            for (pile, ring) in rings.iter_mut().enumerate() {
                if let Some(along) = other(pile, true, random) {
                    *ring = along;
                }
            }
        }
        let mut opener = Opener::new(self.dual, &rings, self.cells, self.request.bridges);
        opener.open_all(first(&rings, weights), random);
        let mut others = 0;
        for step in 0..STEPS_A_PILE * self.parts.len() {
            let Some((pile, beside)) = opener.groups().border(random) else {
                opener.better(random);
                return (matching::bridge(self.dual, opener.matched(), self.request.bridges), others);
            };
            // A ring along a straight border shows it one side only, others show it more.
            let ring = if step % 2 == 0 { None } else { other(pile, false, random) };
            others += usize::from(ring.is_some());
            opener.join(pile, beside, ring, random);
        }
        (None, others)
    }
}

/// How many cells apart two cells are.
fn distance(a: [i32; 2], b: [i32; 2]) -> u32 {
    a[0].abs_diff(b[0]) + a[1].abs_diff(b[1])
}

/// The pile to begin with: one that can't be opened anywhere, else the one with most cut edges.
fn first(rings: &[Strip], weights: &Weights) -> usize {
    let edges = |pile: usize| (0..rings.len()).map(|other| weights.of(pile, other)).sum::<usize>();
    (0..rings.len()).max_by_key(|pile| (!rings[*pile].closed, edges(*pile))).unwrap_or(0)
}
