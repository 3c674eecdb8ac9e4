//! Puts piles on the cells of a grid and chooses the bridges that join them: a tree of piles, each turned so that its
//! bridge faces the neighbour's cell.

use crate::joint::Joint;
use crate::random::Random;
use std::collections::{BTreeMap, BTreeSet};

/// Where the piles stand.
#[derive(Debug, Clone)]
pub(super) struct Layout {
    /// Of every pile its cell.
    pub(super) cells: Vec<[i32; 2]>,
    /// Of every pile its quarter turns counter-clockwise.
    pub(super) turns: Vec<usize>,
    /// The bridges, one less than piles.
    pub(super) bridges: Vec<Joint>,
}

/// The box of a set of cells: area first, then half its circumference.
pub(super) fn compactness<'a>(cells: &(impl Iterator<Item = &'a [i32; 2]> + Clone)) -> (i32, i32) {
    let [across, along] = [0, 1].map(|axis| {
        let values = || cells.clone().map(|cell| cell[axis]);
        values().max().unwrap_or(0) - values().min().unwrap_or(0) + 1
    });
    (across * along, across + along)
}

/// A way to add a pile: by which joint, where, and how turned.
#[derive(Clone, Copy)]
struct Way {
    joint: usize,
    cell: [i32; 2],
    turn: usize,
}

/// Adds pile after pile, the one with the fewest ways first, on a grid of so many cells where one is given; or says how many
/// it placed.
pub(super) fn grow(
    piles: usize,
    joints: &[Joint],
    grid: Option<[usize; 2]>,
    random: &mut Random,
) -> Result<Layout, usize> {
    let mut placed: BTreeMap<usize, ([i32; 2], usize)> = BTreeMap::from([(random.below(piles), ([0, 0], 0))]);
    let mut taken: BTreeSet<[i32; 2]> = BTreeSet::from([[0, 0]]);
    let mut bridges = Vec::with_capacity(piles);
    while placed.len() < piles {
        let mut ways: BTreeMap<usize, Vec<Way>> = BTreeMap::new();
        for (number, joint) in joints.iter().enumerate() {
            for (here, there) in [(0, 1), (1, 0)] {
                let (Some((cell, turn)), None) =
                    (placed.get(&joint.piles[here]), placed.get(&joint.piles[there]))
                else {
                    continue;
                };
                let side = joint.sides[here].turned(*turn);
                let [dx, dy] = side.step();
                let beyond = [cell[0] + dx, cell[1] + dy];
                if !taken.contains(&beyond) && fits(grid, &taken, beyond) {
                    // Turned so that the bridge is on the side across.
                    let turn = side.opposite() as usize + 4 - joint.sides[there] as usize;
                    let way = Way { joint: number, cell: beyond, turn: turn % 4 };
                    ways.entry(joint.piles[there]).or_default().push(way);
                }
            }
        }
        let fewest = ways.values().map(Vec::len).min().ok_or(placed.len())?;
        let choice: Vec<usize> =
            ways.iter().filter(|(_, list)| list.len() <= fewest + 1).map(|(pile, _)| *pile).collect();
        let pile = choice[random.below(choice.len())];
        let mut list = ways.remove(&pile).unwrap_or_default();
        random.shuffle(&mut list);
        // Mostly the most compact way; now and then any, so that another try comes out differently.
        if random.below(4) > 0 {
            list.sort_by_key(|way| compactness(&taken.iter().chain([&way.cell])));
        }
        let Some(way) = list.first() else { return Err(placed.len()) };
        placed.insert(pile, (way.cell, way.turn));
        taken.insert(way.cell);
        bridges.push(joints[way.joint]);
    }
    let corner = [0, 1].map(|axis| taken.iter().map(|cell| cell[axis]).min().unwrap_or(0));
    let cells = placed.values().map(|(cell, _)| [cell[0] - corner[0], cell[1] - corner[1]]).collect();
    Ok(Layout { cells, turns: placed.values().map(|(_, turn)| *turn).collect(), bridges })
}

/// Whether the cells fit on a grid with one more.
fn fits(grid: Option<[usize; 2]>, taken: &BTreeSet<[i32; 2]>, beyond: [i32; 2]) -> bool {
    grid.is_none_or(|sides| {
        (0..2).all(|axis| {
            let values = || taken.iter().chain([&beyond]).map(|cell| cell[axis]);
            let span = values().max().unwrap_or(0).abs_diff(values().min().unwrap_or(0));
            (span as usize) < sides[axis]
        })
    })
}
