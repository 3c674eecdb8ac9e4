//! Placement of many parts: greedy growth, then annealing by exchanges of cells.

use super::Site;
use crate::random::Random;

/// Exchanges tried for each pair of cells.
const EXCHANGES: usize = 200;
/// Exchanges tried at most.
const MOST_EXCHANGES: usize = 400_000;

/// Grows a placement greedily, then anneals it.
pub(super) fn annealed(site: &Site<'_>, random: &mut Random) -> Vec<Option<usize>> {
    let mut on = greedy(site, random);
    let cells = site.grid.cells();
    let usual = (site.weights.total() / site.parts()).max(2);
    // Parts that share an edge at all can be joined, and joined they must be.
    let worth = |weight: usize| if weight > 0 { weight + usual } else { 0 };
    let gain = |on: &[Option<usize>], cell: usize| site.beside(on, cell).map(worth).sum::<usize>();
    let mut best = (site.worth(&on), on.clone());
    let (mut energy, mut most) = (0isize, 0isize);
    // The temperature begins at the weight of a usual edge and falls to a part of one cut edge.
    let usual = usual as f64;
    let exchanges = (cells * cells * EXCHANGES).min(MOST_EXCHANGES);
    for step in 0..exchanges {
        let temperature = 0.5 * usual * (0.2 / usual).powf(step as f64 / exchanges as f64);
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
        // Groups are counted only where the sum says that this may be the best so far.
        energy += change;
        if energy > most || (!best.0.whole() && change != 0) {
            most = most.max(energy);
            let now = site.worth(&on);
            if now > best.0 {
                best = (now, on.clone());
            }
        }
    }
    best.1
}

/// Part after part, the one that gains most on the cell where it does.
fn greedy(site: &Site<'_>, random: &mut Random) -> Vec<Option<usize>> {
    let grid = site.grid;
    let mut on = vec![None; grid.cells()];
    let mut waiting: Vec<usize> = (0..site.parts()).collect();
    let first = waiting.swap_remove(random.below(waiting.len()));
    on[grid.cells() / 2] = Some(first);
    while !waiting.is_empty() {
        let mut best = (0, 0, 0);
        for cell in (0..grid.cells()).filter(|cell| on[*cell].is_none()) {
            for (number, part) in waiting.iter().enumerate() {
                let beside = grid.beside(cell).filter_map(|other| on[other]);
                // Beside another part is better than nowhere, even with no edge to it.
                let gained: usize = beside.map(|other| 1 + 64 * site.weights.of(*part, other)).sum();
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
