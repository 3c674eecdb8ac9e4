//! Piles from parts with few edges between them: partition, rings, placement, matching. The other way beside arcs of one
//! strip; it reaches numbers of piles that arcs don't.

use crate::dual::Dual;
use crate::matching::{self, Bridged};
use crate::partition::{self, Ring};
use crate::placement::{self, Grid, Weights};
use crate::planner::Bridges;
use crate::random::Random;

/// Partitions tried.
const PARTITIONS: usize = 4;
/// Shapes of the grid tried for each partition.
const GRIDS: usize = 4;
/// Rounds of matching for each placement, and more of them for each pile: in each another ring is sought for a pile in whose
/// way the last one stood.
const ROUNDS: usize = 12;
const ROUNDS_A_PILE: usize = 2;

/// Why there are no piles from parts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error(
    "no {piles} parts that match found: tried {partitions} partitions, {ringed} of which had a strip in every part, \
     {placements} placements and {rounds} rounds of matching"
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
    /// Rounds of matching tried.
    pub rounds: usize,
}

/// Cuts the surface into parts and joins their piles.
///
/// # Errors
/// The search's end, which proves nothing.
pub(crate) fn find(
    dual: &Dual,
    neighbours: &[Vec<usize>],
    piles: usize,
    wanted: Bridges,
    grid: Option<Grid>,
    seed: u64,
) -> Result<Bridged, NoMatch> {
    let mut random = Random::new(seed, 1 << 33);
    let all: Vec<usize> = (0..neighbours.len()).collect();
    let mut tried = NoMatch { piles, partitions: 0, ringed: 0, placements: 0, rounds: 0 };
    let grids = grid.map_or_else(|| Grid::for_parts(piles), |grid| vec![grid]);
    for _ in 0..PARTITIONS {
        tried.partitions += 1;
        let Some(mut parts) = partition::split(neighbours, &all, piles, &mut random) else { continue };
        let Some(rings) = partition::rings(neighbours, &mut parts, &mut random) else { continue };
        tried.ringed += 1;
        let weights = weights(neighbours, &parts);
        for grid in grids.iter().take(GRIDS) {
            let placement = placement::place(&weights, *grid, &mut random);
            if !placement.worth.whole() {
                continue;
            }
            tried.placements += 1;
            let mut rings = rings.clone();
            for _ in 0..ROUNDS + ROUNDS_A_PILE * piles {
                tried.rounds += 1;
                let first = first(&rings, &weights);
                match matching::open(dual, &rings, &placement.cells, first, wanted) {
                    Ok(matched) => {
                        if let Some(bridged) = matching::bridge(dual, matched, wanted) {
                            return Ok(bridged);
                        }
                    }
                    Err(pair) => {
                        let pile = pair[random.below(2)];
                        if let Some(ring) = partition::again(neighbours, &parts[pile], &mut random) {
                            rings[pile] = ring;
                        }
                    }
                }
            }
        }
    }
    Err(tried)
}

/// The cut edges between parts.
pub(crate) fn weights(neighbours: &[Vec<usize>], parts: &[Vec<usize>]) -> Weights {
    let mut part_of = vec![0; neighbours.len()];
    for (number, part) in parts.iter().enumerate() {
        for panel in part {
            part_of[*panel] = number;
        }
    }
    let mut weights = Weights::new(parts.len());
    for (a, near) in neighbours.iter().enumerate() {
        for &b in near.iter().filter(|b| a < **b && part_of[a] != part_of[**b]) {
            weights.add(part_of[a], part_of[b]);
        }
    }
    weights
}

/// The pile to begin with: one that can't be opened anywhere, else the one with most cut edges.
fn first(rings: &[Ring], weights: &Weights) -> usize {
    let edges = |pile: usize| (0..rings.len()).map(|other| weights.of(pile, other)).sum::<usize>();
    (0..rings.len()).max_by_key(|pile| (!rings[*pile].closed, edges(*pile))).unwrap_or(0)
}
