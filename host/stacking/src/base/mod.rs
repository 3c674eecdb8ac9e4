//! Piles around a flat base: one panel of every pile lies in one plane of the target as its cell does, all at one height, and
//! the bridges join these alone. Bridges never move then, and every rest that a hinge moves lies on one cell: with panels of no
//! thickness nothing can collide (`docs/src/geometry.md`).
//!
//! ```text
//! patch: panels of the target that lie like the cells
//! ```

mod patch;

use crate::adjacency::Adjacency;
use crate::at_once::at_once;
use crate::dual::Dual;
use crate::folding_map::Facing;
use crate::hamiltonian::Strip;
use crate::matching::Bridged;
use crate::partition::{self, Held, Ringed};
use crate::placement::Grid;
use crate::planner::Request;
use crate::random::Random;
use crate::square::Quad;
use patch::Patch;

/// Panels looked at in all cuts for one shape of the grid, and the least and most cuts that makes.
const EFFORT: usize = 20_000;
const FEWEST: usize = 16;
const MOST: usize = 120;
/// Shapes of the grid.
const SHAPES: usize = 3;
/// Panels are held up to so far around the base; less from one patch to the next.
const RADII: [usize; 4] = [2, 1, 3, 0];

/// Why there are no piles around a base.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error(
    "no flat base for {piles} piles found: {patches} flat patches lie like the cells, parts were cut {tried} times around \
     them; {ringed} times every part had a strip, but not with the base at one height; another number of piles, --grid or \
     --seed may do"
)]
pub struct NoBase {
    /// Number of piles.
    pub piles: usize,
    /// Patches there are.
    pub patches: usize,
    /// Times that parts were cut around one.
    pub tried: usize,
    /// Of these, those with a strip in every part.
    pub ringed: usize,
}

/// Finds piles around a flat base.
///
/// # Errors
/// The search's end, which proves nothing unless there was no patch.
pub(crate) fn find(
    dual: &Dual,
    neighbours: &Adjacency,
    target: &[Quad],
    request: &Request,
) -> Result<Bridged, NoBase> {
    let piles = request.piles;
    let mut random = Random::new(request.seed, 1 << 34);
    let mut tried = NoBase { piles, patches: 0, tried: 0, ringed: 0 };
    let grids = request.grid.map_or_else(|| Grid::for_parts(piles), |grid| vec![Grid::of(grid)]);
    for grid in grids.into_iter().take(SHAPES) {
        let cells = patch::cells(grid, piles);
        let places = (0..target.len()).flat_map(|panel| (0..4).map(move |quarters| (panel, quarters)));
        let at = |(panel, quarters)| Patch::at(panel, quarters, &cells, dual, target);
        let mut patches: Vec<Patch> = places.filter_map(at).collect();
        tried.patches += patches.len();
        random.shuffle(&mut patches);
        // Cuts around one patch differ by their seeds.
        let cuts = (EFFORT / target.len()).clamp(FEWEST, MOST);
        let patches: Vec<&Patch> = patches.iter().cycle().take(cuts).collect();
        for (number, pair) in patches.chunks(2).enumerate() {
            let radius = RADII[number % RADII.len()];
            let seeds = [random.next(), random.next()];
            let around = |place: usize| {
                pair.get(place).map(|patch| around(patch, dual, neighbours, radius, seeds[place]))
            };
            let (one, other) = at_once(|| around(0), || around(1));
            let found: Vec<Around> = one.into_iter().chain(other).collect();
            tried.tried += found.len();
            tried.ringed += found.iter().filter(|around| !matches!(around, Around::NoStrips)).count();
            let bridged = found.into_iter().find_map(|around| match around {
                Around::Piles(bridged) => Some(bridged),
                Around::NoStrips | Around::NotOneHeight => None,
            });
            if let Some(bridged) = bridged {
                return Ok(*bridged);
            }
        }
    }
    Err(tried)
}

/// What parts around a patch come to.
enum Around {
    NoStrips,
    NotOneHeight,
    Piles(Box<Bridged>),
}

fn around(patch: &Patch, dual: &Dual, neighbours: &Adjacency, radius: usize, seed: u64) -> Around {
    let mut random = Random::new(seed, 0);
    let held = Held::around(neighbours, &patch.panels, radius);
    let rings = partition::split_held(neighbours, patch.panels.len(), &held, &mut random).and_then(|parts| {
        let ringed = Ringed::of(neighbours, parts, &mut random);
        partition::rings(neighbours, ringed, &held, &mut random)
    });
    let Some((_, rings)) = rings else { return Around::NoStrips };
    stacked(patch, &rings, dual).map_or(Around::NotOneHeight, |bridged| Around::Piles(Box::new(bridged)))
}

/// Opens the rings so that the base is at one height, half way up where that is possible.
fn stacked(patch: &Patch, rings: &[Strip], dual: &Dual) -> Option<Bridged> {
    let panels: usize = rings.iter().map(|ring| ring.order.len()).sum();
    let half = panels / rings.len() / 2;
    let height = base_height(patch, rings, half)?;
    let patch = if height % 2 == 0 { patch.clone() } else { patch.clone().turned_over() };
    let mut facing = vec![Facing::BOTTOM; panels];
    let mut piles = Vec::with_capacity(rings.len());
    for ((ring, base), base_facing) in rings.iter().zip(&patch.panels).zip(&patch.facing) {
        let pile = opened(ring, *base, height)?;
        facing[*base] = *base_facing;
        // A panel below is folded under as one above is folded over: both ways it is the mirror image.
        let (below, above) = pile.split_at(height);
        let down = [*base].into_iter().chain(below.iter().rev().copied());
        for way in [down.collect::<Vec<usize>>(), above.to_vec()] {
            for pair in way.windows(2) {
                let [edge, other] = dual.common_edges(pair[0], pair[1])?;
                facing[pair[1]] = facing[pair[0]].folded(edge, other);
            }
        }
        piles.push(pile);
    }
    Some(Bridged { piles, facing, cells: patch.cells, bridges: patch.bridges, breaks: Vec::new() })
}

/// The height that the base can have in all piles, the nearest to `wanted`; a cycle can have it at any.
fn base_height(patch: &Patch, rings: &[Strip], wanted: usize) -> Option<usize> {
    let mut heights: Option<Vec<usize>> = None;
    for (ring, base) in rings.iter().zip(&patch.panels).filter(|(ring, _)| !ring.closed) {
        let place = ring.order.iter().position(|panel| panel == base)?;
        let both = [place, ring.order.len() - 1 - place];
        let mut kept = heights.unwrap_or_else(|| both.to_vec());
        kept.retain(|height| both.contains(height));
        heights = Some(kept);
    }
    match heights {
        None => Some(wanted),
        Some(heights) => heights.into_iter().min_by_key(|height| height.abs_diff(wanted)),
    }
}

/// The panels of a ring from the bottom up, with one of them at a height.
fn opened(ring: &Strip, base: usize, height: usize) -> Option<Vec<usize>> {
    let mut order = ring.order.clone();
    let place = order.iter().position(|panel| *panel == base)?;
    if ring.closed {
        let count = order.len();
        order.rotate_left((place + count - height) % count);
    } else if place != height {
        order.reverse();
    }
    (order[height] == base).then_some(order)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cycle_is_opened_for_any_height_and_a_path_for_two() {
        let ring = |closed| Strip { order: vec![4, 7, 1, 0, 9], closed };
        for height in 0..5 {
            assert_eq!(opened(&ring(true), 1, height).unwrap()[height], 1);
        }
        let heights: Vec<usize> =
            (0..5).filter(|height| opened(&ring(false), 7, *height).is_some()).collect();
        assert_eq!(heights, [1, 3]);
    }
}
