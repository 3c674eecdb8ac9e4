//! A strip through all panels: a Hamiltonian cycle of the dual graph, or a path where no cycle is found.
//!
//! ```text
//! bumps:      single voxels that stick out      -> one panel each, five again at the end
//! two_factor: every panel gets two neighbours   -> many small cycles
//! faces:      exchanges around lattice vertices -> few cycles
//! exchanges:  longer alternating walks, locally -> one cycle
//! trails:     alternating walks of any length, where none nearby helps
//! ```
//!
//! A path is a cycle through one more node, the apex, that neighbours every panel: so one method finds both.

mod bumps;
mod cover;
mod cycles;
mod exchanges;
mod faces;
mod graph;
mod obstacles;
mod segments;
mod trails;
mod two_factor;

use crate::adjacency::Adjacency;
use crate::random::Random;
use graph::Graph;

/// How many seeds each search gets.
const ATTEMPTS: u64 = 6;
/// The same for one part of many.
const ATTEMPTS_IN_PART: u64 = 2;
/// Kicks without success before an attempt gives up.
const KICKS: usize = 400;
/// The same in one part of many.
const KICKS_IN_PART: usize = 40;

/// All panels in a row, each the neighbour of the next.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Strip {
    /// The panels.
    pub(crate) order: Vec<usize>,
    /// Whether the last panel is a neighbour of the first.
    pub(crate) closed: bool,
}

/// Why there is no strip.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum NoStrip {
    /// Panels at dead ends; a strip has two ends.
    #[error(
        "{count} panels have one neighbour only (panels {first:?} ...), a strip through all panels has two ends"
    )]
    DeadEnds {
        /// How many.
        count: usize,
        /// The first three.
        first: Vec<usize>,
    },
    /// The panels are coloured like a chess board, and a strip changes colour at every step.
    #[error(
        "coloured like a chess board the surface has {dark} and {light} panels, a strip needs numbers that differ by one at most"
    )]
    Colours {
        /// Panels of one colour.
        dark: usize,
        /// Panels of the other.
        light: usize,
    },
    /// The search ended without success, which proves nothing.
    #[error(
        "no strip through all {panels} panels found in {attempts} attempts: the best had {pieces} pieces; another seed may do"
    )]
    NotFound {
        /// Panels of the surface.
        panels: usize,
        /// Attempts made.
        attempts: u64,
        /// Fewest pieces reached; 0 when not even a cover by cycles was found.
        pieces: usize,
    },
}

/// Finds a strip through all panels of a connected graph.
///
/// # Errors
/// A proof that there is none, or the search's end.
pub(crate) fn find(neighbours: &Adjacency, seed: u64) -> Result<Strip, NoStrip> {
    let panels = neighbours.len();
    if panels <= 2 {
        return Ok(Strip { order: (0..panels).collect(), closed: false });
    }
    let cycle_possible = obstacles::look_for(neighbours)?;
    let flat = bumps::flatten(neighbours);
    let mut fewest = usize::MAX;
    let mut attempts = 0;
    for with_apex in [false, true] {
        if !with_apex && !cycle_possible {
            continue;
        }
        let whole = Graph::new(neighbours, with_apex);
        let without_bumps = flat.as_ref().map(|flat| Graph::new(&flat.neighbours, with_apex));
        for (graph, flat) in without_bumps.iter().zip([flat.as_ref()]).chain([(&whole, None)]) {
            for attempt in 0..ATTEMPTS {
                attempts += 1;
                let mut random = Random::new(seed, 2 * attempt + u64::from(with_apex));
                match search(graph, KICKS, &mut random) {
                    Ok(strip) => return Ok(if let Some(flat) = flat { flat.raised(&strip) } else { strip }),
                    Err(pieces) => fewest = fewest.min(pieces),
                }
            }
        }
    }
    let pieces = if fewest == usize::MAX { 0 } else { fewest };
    Err(NoStrip::NotFound { panels, attempts, pieces })
}

/// Finds a cycle through all panels of a part, or a path where no cycle is asked for, with little effort: there are other
/// parts. It keeps to the edges of the lanes as far as they can be kept.
pub(crate) fn find_in_part(
    neighbours: &Adjacency,
    lanes: &[(usize, usize)],
    closed: bool,
    seed: u64,
) -> Option<Strip> {
    if neighbours.len() <= 2 {
        return (!closed).then(|| Strip { order: (0..neighbours.len()).collect(), closed: false });
    }
    if !obstacles::look_for(neighbours).is_ok_and(|cycle_possible| cycle_possible || !closed) {
        return None;
    }
    let attempt = |graph: &Graph<'_>| {
        (0..ATTEMPTS_IN_PART)
            .find_map(|attempt| search(graph, KICKS_IN_PART, &mut Random::new(seed, 2 * attempt)).ok())
    };
    let without_bumps = || {
        let flat = bumps::flatten(neighbours)?;
        Some(flat.raised(&attempt(&Graph::new(&flat.neighbours, !closed))?))
    };
    attempt(&Graph::new(neighbours, !closed).along(lanes)).or_else(without_bumps)
}

/// One attempt; where it fails it says in how many pieces the best cover was.
fn search(graph: &Graph<'_>, kicks: usize, random: &mut Random) -> Result<Strip, usize> {
    let mut cover = two_factor::find(graph, random).ok_or(usize::MAX)?;
    faces::merge(graph, &mut cover);
    match exchanges::merge(graph, &mut cover, kicks, random) {
        1 => Ok(Strip { order: cover.order(graph.apex()), closed: graph.apex().is_none() }),
        pieces => Err(pieces),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A flat sheet of panels.
    pub(super) fn sheet(width: usize, depth: usize) -> Adjacency {
        let number = |x: usize, y: usize| y * width + x;
        let mut neighbours = Adjacency::without_edges(width * depth);
        for y in 0..depth {
            for x in 0..width {
                if x + 1 < width {
                    neighbours.join(number(x, y), number(x + 1, y));
                }
                if y + 1 < depth {
                    neighbours.join(number(x, y), number(x, y + 1));
                }
            }
        }
        neighbours
    }

    pub(super) fn assert_strip(neighbours: &Adjacency, strip: &Strip) {
        let mut sorted = strip.order.clone();
        sorted.sort_unstable();
        assert_eq!(sorted, (0..neighbours.len()).collect::<Vec<_>>());
        assert!(strip.order.windows(2).all(|pair| neighbours[pair[0]].contains(&pair[1])));
        if strip.closed {
            assert!(neighbours[strip.order[0]].contains(&strip.order[strip.order.len() - 1]));
        }
    }

    #[test]
    fn an_even_sheet_has_a_cycle_and_an_odd_one_a_path() {
        for (width, depth) in [(2, 2), (4, 5), (12, 12), (30, 41)] {
            let neighbours = sheet(width, depth);
            let strip = find(&neighbours, 1).unwrap();
            assert!(strip.closed);
            assert_strip(&neighbours, &strip);
        }
        for (width, depth) in [(1, 1), (1, 2), (1, 7), (3, 3), (5, 9), (21, 31)] {
            let neighbours = sheet(width, depth);
            let strip = find(&neighbours, 1).unwrap();
            assert!(!strip.closed);
            assert_strip(&neighbours, &strip);
        }
    }

    #[test]
    fn the_same_seed_finds_the_same_strip_and_others_find_others() {
        let neighbours = sheet(12, 12);
        assert_eq!(find(&neighbours, 7), find(&neighbours, 7));
        assert_ne!(find(&neighbours, 7), find(&neighbours, 8));
    }

    #[test]
    fn a_cross_of_five_panels_has_too_many_dead_ends() {
        let cross = [vec![1, 2, 3, 4], vec![0], vec![0], vec![0], vec![0]].into_iter().collect();
        assert_eq!(find(&cross, 0), Err(NoStrip::DeadEnds { count: 4, first: vec![1, 2, 3] }));
    }

    #[test]
    fn a_sheet_with_three_more_dark_panels_than_light_ones_has_no_strip() {
        // 5 x 5 less two light panels in the middle of opposite sides: 13 dark, 10 light.
        let neighbours = sheet(5, 5);
        let gone = [11, 13];
        let kept: Vec<usize> = (0..25).filter(|n| !gone.contains(n)).collect();
        let renumbered: Adjacency = kept
            .iter()
            .map(|n| neighbours[*n].iter().filter_map(|m| kept.iter().position(|k| k == m)))
            .collect();
        assert_eq!(find(&renumbered, 0), Err(NoStrip::Colours { dark: 13, light: 10 }));
    }
}
