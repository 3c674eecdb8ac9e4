//! Puts parts on the cells of a grid so that the cut edges between neighbouring cells weigh most: the paper's hypergraph
//! G'. Exact for few parts, else greedy growth and annealing by exchanges, with a bound that says how good it may be.
//!
//! All parts must hang together by neighbouring cells that share cut edges, or no tree path joins them: so of two
//! placements the one in fewer groups is better, whatever the weights.

mod anneal;
mod grid;

pub(crate) use grid::Grid;

use crate::partition::Weights;
use crate::random::Random;
use crate::sets::Sets;

/// Up to so many cells every placement is tried.
const EXACT: usize = 8;

/// How good a placement is: more is better.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Worth {
    /// The number of groups that hang together, negative.
    less_groups: isize,
    /// The weight between neighbouring cells.
    pub(crate) weight: usize,
}

impl Worth {
    /// Whether all parts hang together.
    pub(crate) fn whole(self) -> bool {
        self.less_groups == -1
    }
}

/// Of every part its cell, and the worth of that.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Placement {
    pub(crate) cells: Vec<[i32; 2]>,
    pub(crate) worth: Worth,
}

/// Places the parts on a grid that has cells enough.
pub(crate) fn place(weights: &Weights, grid: Grid, random: &mut Random) -> Placement {
    let site = Site { weights, grid };
    let on = if grid.cells() <= EXACT { exact(&site) } else { anneal::annealed(&site, random) };
    let mut cells = vec![[0; 2]; weights.parts()];
    for (cell, part) in on.iter().enumerate() {
        if let Some(part) = part {
            cells[*part] =
                [cell % grid.across, cell / grid.across].map(|at| i32::try_from(at).unwrap_or(i32::MAX));
        }
    }
    Placement { cells, worth: site.worth(&on) }
}

/// Where the parts are to stand.
struct Site<'a> {
    weights: &'a Weights,
    grid: Grid,
}

impl Site<'_> {
    fn parts(&self) -> usize {
        self.weights.parts()
    }

    /// The weight between the part on a cell and each part beside it.
    fn beside(&self, on: &[Option<usize>], cell: usize) -> impl Iterator<Item = usize> {
        let here = on[cell];
        let beside = self.grid.beside(cell).filter_map(|other| on[other]);
        beside.filter_map(move |other| Some(self.weights.of(here?, other)))
    }

    fn worth(&self, on: &[Option<usize>]) -> Worth {
        let mut groups = self.parts();
        let mut sets = Sets::new(groups);
        let mut weight = 0;
        for (cell, part) in on.iter().enumerate() {
            for other in self.grid.beside(cell).filter(|other| *other > cell) {
                let (Some(a), Some(b)) = (*part, on[other]) else { continue };
                let shared = self.weights.of(a, b);
                weight += shared;
                groups -= usize::from(shared > 0 && sets.join(a, b));
            }
        }
        Worth { less_groups: -groups.cast_signed(), weight }
    }
}

/// What no placement on the grid exceeds. A part on a cell with d neighbours gains its d heaviest edges at most, and every
/// edge is gained by two parts; nor can there be more edges than the grid has, each one of the heaviest.
pub(crate) fn bound(weights: &Weights, grid: Grid) -> usize {
    let degrees: Vec<usize> = (0..grid.cells()).map(|cell| grid.beside(cell).count()).collect();
    let heaviest: Vec<Vec<usize>> = (0..weights.parts())
        .map(|a| {
            let mut row: Vec<usize> = (0..weights.parts()).map(|b| weights.of(a, b)).collect();
            row.sort_unstable_by(|a, b| b.cmp(a));
            row
        })
        .collect();
    let mut twice = 0;
    for rank in 0..4 {
        let room = degrees.iter().filter(|degree| **degree > rank).count();
        let mut of_rank: Vec<usize> = heaviest.iter().filter_map(|row| row.get(rank).copied()).collect();
        of_rank.sort_unstable_by(|a, b| b.cmp(a));
        twice += of_rank.iter().take(room).sum::<usize>();
    }
    let mut edges: Vec<usize> =
        (0..weights.parts()).flat_map(|a| (0..a).map(move |b| weights.of(a, b))).collect();
    edges.sort_unstable_by(|a, b| b.cmp(a));
    let by_edges: usize = edges.iter().take(degrees.iter().sum::<usize>() / 2).sum();
    by_edges.min(twice / 2)
}

/// Tries all placements.
fn exact(site: &Site<'_>) -> Vec<Option<usize>> {
    fn fill(
        at: usize,
        on: &mut Vec<Option<usize>>,
        best: &mut Option<(Worth, Vec<Option<usize>>)>,
        site: &Site<'_>,
    ) {
        if at == on.len() {
            let worth = site.worth(on);
            if best.as_ref().is_none_or(|(most, _)| worth > *most) {
                *best = Some((worth, on.clone()));
            }
            return;
        }
        for other in at..on.len() {
            // Empty cells are all alike: one of them is tried here.
            if on[other].is_none() && (at..other).any(|earlier| on[earlier].is_none()) {
                continue;
            }
            on.swap(at, other);
            fill(at + 1, on, best, site);
            on.swap(at, other);
        }
    }
    let mut on: Vec<Option<usize>> =
        (0..site.grid.cells()).map(|cell| (cell < site.parts()).then_some(cell)).collect();
    let mut best = None;
    fill(0, &mut on, &mut best, site);
    best.map_or(on, |(_, on)| on)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn random_weights(count: usize, random: &mut Random) -> Weights {
        let mut weights = Weights::new(count);
        for (a, b) in (0..count).flat_map(|a| (0..a).map(move |b| (a, b))) {
            for _ in 0..[0, 0, 3, 9][random.below(4)] {
                weights.add(a, b);
            }
        }
        weights
    }

    /// All orders of the numbers below `count`, written down apart from the program's own search.
    fn orders(count: usize) -> Vec<Vec<usize>> {
        let mut orders = vec![Vec::new()];
        for number in 0..count {
            orders = orders
                .iter()
                .flat_map(|order| {
                    (0..=order.len()).map(move |at| [&order[..at], &[number], &order[at..]].concat())
                })
                .collect();
        }
        orders
    }

    #[test]
    fn few_parts_are_placed_as_well_as_can_be_and_never_above_the_bound() {
        let mut random = Random::new(5, 1);
        for (across, along, count) in [(2, 2, 4), (2, 2, 3), (3, 2, 6), (5, 1, 5), (7, 1, 7), (4, 2, 7)] {
            let grid = Grid { across, along };
            for _ in 0..6 {
                let weights = random_weights(count, &mut random);
                let placement = place(&weights, grid, &mut random);
                let most = orders(across * along)
                    .into_iter()
                    .map(|order| {
                        let on: Vec<_> = order.iter().map(|part| (*part < count).then_some(*part)).collect();
                        Site { weights: &weights, grid }.worth(&on)
                    })
                    .max()
                    .unwrap();
                assert_eq!(placement.worth, most);
                assert!(most.weight <= bound(&weights, grid));
            }
        }
    }

    #[test]
    fn many_parts_that_are_cut_like_a_grid_hang_together_and_reach_nine_tenths_of_the_bound() {
        let grid = Grid { across: 5, along: 4 };
        let mut weights = Weights::new(20);
        let mut names: Vec<usize> = (0..20).collect();
        let mut random = Random::new(3, 1);
        random.shuffle(&mut names);
        for cell in 0..20 {
            for other in grid.beside(cell).filter(|other| *other > cell) {
                for _ in 0..10 {
                    weights.add(names[cell], names[other]);
                }
            }
        }
        let placement = place(&weights, grid, &mut random);
        assert!(placement.worth.whole());
        assert!(placement.worth.weight * 10 >= bound(&weights, grid) * 9, "{:?}", placement.worth);
        assert_eq!(bound(&weights, grid), 310);
    }

    #[test]
    fn grids_are_small_and_square_first() {
        let grids = Grid::for_parts(12);
        assert_eq!(grids[..3], [(4, 3), (6, 2), (12, 1)].map(|(across, along)| Grid { across, along }));
        assert_eq!(Grid::for_parts(1)[0], Grid { across: 1, along: 1 });
    }
}
