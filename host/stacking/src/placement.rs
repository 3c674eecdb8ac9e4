//! Puts parts on the cells of a grid so that the cut edges between neighbouring cells weigh most: the paper's hypergraph
//! G'. Exact for few parts, else greedy growth and annealing by exchanges, with a bound that says how good it may be.
//!
//! All parts must hang together by neighbouring cells that share cut edges, or no tree path joins them: so of two
//! placements the one in fewer groups is better, whatever the weights.

use crate::random::Random;

/// Up to so many cells every placement is tried.
pub(crate) const EXACT: usize = 8;
/// Exchanges tried for each pair of cells.
const EXCHANGES: usize = 60;
/// Exchanges tried at most.
const MOST_EXCHANGES: usize = 120_000;

/// Of every two parts the number of cut edges between them.
#[derive(Debug, Clone)]
pub(crate) struct Weights {
    count: usize,
    weights: Vec<usize>,
}

impl Weights {
    /// No edges between so many parts.
    pub(crate) fn new(count: usize) -> Self {
        Self { count, weights: vec![0; count * count] }
    }

    /// Adds a cut edge.
    pub(crate) fn add(&mut self, a: usize, b: usize) {
        self.weights[a * self.count + b] += 1;
        self.weights[b * self.count + a] += 1;
    }

    /// The cut edges between two parts.
    pub(crate) fn of(&self, a: usize, b: usize) -> usize {
        self.weights[a * self.count + b]
    }

    /// All cut edges.
    pub(crate) fn total(&self) -> usize {
        self.weights.iter().sum::<usize>() / 2
    }
}

/// A grid of cells, row by row.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Grid {
    pub(crate) across: usize,
    pub(crate) along: usize,
}

impl Grid {
    /// The number of cells.
    pub(crate) fn cells(self) -> usize {
        self.across * self.along
    }

    fn beside(self, cell: usize) -> impl Iterator<Item = usize> {
        let (x, y) = (cell % self.across, cell / self.across);
        let west = (x > 0).then(|| cell - 1);
        let east = (x + 1 < self.across).then_some(cell + 1);
        let south = (y > 0).then(|| cell - self.across);
        let north = (y + 1 < self.along).then_some(cell + self.across);
        [west, east, south, north].into_iter().flatten()
    }

    /// Whether piles on these cells find room.
    pub(crate) fn holds(self, cells: &[[i32; 2]]) -> bool {
        let fits = |axis: usize, side: usize| {
            cells.iter().all(|cell| usize::try_from(cell[axis]).is_ok_and(|at| at < side))
        };
        fits(0, self.across) && fits(1, self.along)
    }

    /// The smallest grids that hold so many parts, the squarest first: all of the smallest area, then some of larger ones.
    pub(crate) fn for_parts(count: usize) -> Vec<Self> {
        let mut grids: Vec<Self> = Vec::new();
        for area in count..=count + count.div_ceil(3) {
            for along in (1..=area).filter(|along| along * along <= area && area.is_multiple_of(*along)).rev()
            {
                grids.push(Self { across: area / along, along });
            }
        }
        grids
    }
}

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
    let on = if grid.cells() <= EXACT { exact(weights, grid) } else { annealed(weights, grid, random) };
    let worth = worth(weights, grid, &on);
    let mut cells = vec![[0; 2]; weights.count];
    for (cell, part) in on.iter().enumerate() {
        if let Some(part) = part {
            cells[*part] =
                [cell % grid.across, cell / grid.across].map(|at| i32::try_from(at).unwrap_or(i32::MAX));
        }
    }
    Placement { cells, worth }
}

/// What no placement on the grid exceeds. A part on a cell with d neighbours gains its d heaviest edges at most, and every
/// edge is gained by two parts; nor can there be more edges than the grid has, each one of the heaviest.
pub(crate) fn bound(weights: &Weights, grid: Grid) -> usize {
    let degrees: Vec<usize> = (0..grid.cells()).map(|cell| grid.beside(cell).count()).collect();
    let heaviest: Vec<Vec<usize>> = (0..weights.count)
        .map(|a| {
            let mut row: Vec<usize> = (0..weights.count).map(|b| weights.of(a, b)).collect();
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
        (0..weights.count).flat_map(|a| (0..a).map(move |b| weights.of(a, b))).collect();
    edges.sort_unstable_by(|a, b| b.cmp(a));
    let by_edges: usize = edges.iter().take(degrees.iter().sum::<usize>() / 2).sum();
    by_edges.min(twice / 2)
}

/// The worth of parts on cells.
fn worth(weights: &Weights, grid: Grid, on: &[Option<usize>]) -> Worth {
    let mut group: Vec<usize> = (0..weights.count).collect();
    let mut groups = weights.count;
    let mut weight = 0;
    for (cell, part) in on.iter().enumerate() {
        for other in grid.beside(cell).filter(|other| *other > cell) {
            let (Some(a), Some(b)) = (*part, on[other]) else { continue };
            let shared = weights.of(a, b);
            weight += shared;
            let (group_a, group_b) = (root(&mut group, a), root(&mut group, b));
            if shared > 0 && group_a != group_b {
                group[group_a] = group_b;
                groups -= 1;
            }
        }
    }
    Worth { less_groups: -groups.cast_signed(), weight }
}

fn root(group: &mut [usize], mut part: usize) -> usize {
    while group[part] != part {
        group[part] = group[group[part]];
        part = group[part];
    }
    part
}

/// Tries all placements.
fn exact(weights: &Weights, grid: Grid) -> Vec<Option<usize>> {
    fn fill(
        at: usize,
        on: &mut Vec<Option<usize>>,
        best: &mut Option<(Worth, Vec<Option<usize>>)>,
        weights: &Weights,
        grid: Grid,
    ) {
        if at == on.len() {
            let worth = worth(weights, grid, on);
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
            fill(at + 1, on, best, weights, grid);
            on.swap(at, other);
        }
    }
    let mut on: Vec<Option<usize>> =
        (0..grid.cells()).map(|cell| (cell < weights.count).then_some(cell)).collect();
    let mut best = None;
    fill(0, &mut on, &mut best, weights, grid);
    best.map_or(on, |(_, on)| on)
}

/// Grows a placement greedily, then anneals it.
fn annealed(weights: &Weights, grid: Grid, random: &mut Random) -> Vec<Option<usize>> {
    let mut on = greedy(weights, grid, random);
    let gain = |on: &[Option<usize>], cell: usize| -> usize {
        let Some(part) = on[cell] else { return 0 };
        grid.beside(cell).filter_map(|other| on[other]).map(|other| weights.of(part, other)).sum()
    };
    let mut now = worth(weights, grid, &on);
    let mut best = (now, on.clone());
    let cells = grid.cells();
    let exchanges = (cells * cells * EXCHANGES).min(MOST_EXCHANGES);
    // The temperature begins at the weight of a usual edge and falls to a part of one cut edge.
    let usual = (weights.total() / weights.count.max(1)).max(2) as f64;
    for step in 0..exchanges {
        let temperature = usual * (0.1 / usual).powf(step as f64 / exchanges as f64);
        let (a, b) = (random.below(cells), random.below(cells));
        if a == b {
            continue;
        }
        let before = gain(&on, a) + gain(&on, b);
        on.swap(a, b);
        let change = (gain(&on, a) + gain(&on, b)).cast_signed() - before.cast_signed();
        let chance = (change as f64 / temperature).exp();
        if chance < random.below(1 << 20) as f64 / f64::from(1 << 20) {
            on.swap(a, b);
            continue;
        }
        // Groups are looked at only where the weight says that this may be the best so far.
        now.weight = now.weight.saturating_add_signed(change);
        if now.weight > best.0.weight || (!best.0.whole() && change != 0) {
            now = worth(weights, grid, &on);
            if now > best.0 {
                best = (now, on.clone());
            }
        }
    }
    best.1
}

/// Part after part, the one that gains most on the cell where it does.
fn greedy(weights: &Weights, grid: Grid, random: &mut Random) -> Vec<Option<usize>> {
    let mut on = vec![None; grid.cells()];
    let mut waiting: Vec<usize> = (0..weights.count).collect();
    let first = waiting.swap_remove(random.below(weights.count));
    on[grid.cells() / 2] = Some(first);
    while !waiting.is_empty() {
        let mut best = (0, 0, 0);
        for cell in (0..grid.cells()).filter(|cell| on[*cell].is_none()) {
            for (number, part) in waiting.iter().enumerate() {
                let beside = grid.beside(cell).filter_map(|other| on[other]);
                // Beside another part is better than nowhere, even with no edge to it.
                let gained: usize = beside.map(|other| 1 + 64 * weights.of(*part, other)).sum();
                if gained > best.0 {
                    best = (gained, cell, number);
                }
            }
        }
        let (_, cell, number) = best;
        on[cell] = Some(waiting.swap_remove(number));
    }
    on
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
                        worth(&weights, grid, &on)
                    })
                    .max()
                    .unwrap();
                assert_eq!(placement.worth, most);
                assert!(most.weight <= bound(&weights, grid));
            }
        }
    }

    #[test]
    fn many_parts_that_are_cut_like_a_grid_hang_together_and_reach_half_the_bound() {
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
        assert!(placement.worth.weight * 2 >= bound(&weights, grid), "{:?}", placement.worth);
        assert_eq!(bound(&weights, grid), 310);
    }

    #[test]
    fn grids_are_small_and_square_first() {
        let grids = Grid::for_parts(12);
        assert_eq!(grids[..3], [(4, 3), (6, 2), (12, 1)].map(|(across, along)| Grid { across, along }));
        assert_eq!(Grid::for_parts(1)[0], Grid { across: 1, along: 1 });
    }
}
