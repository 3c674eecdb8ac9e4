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

/// How large the box of some cells is: area first, then half its circumference.
pub(super) fn compactness<'a>(cells: impl IntoIterator<Item = &'a [i32; 2]>) -> (i32, i32) {
    Bounds::of(cells).compactness()
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
    // Of every pile that stands its cell and its turns.
    let mut placed: Vec<Option<([i32; 2], usize)>> = vec![None; piles];
    placed[random.below(piles)] = Some(([0, 0], 0));
    let mut taken: BTreeSet<[i32; 2]> = BTreeSet::from([[0, 0]]);
    let mut bridges = Vec::with_capacity(piles);
    while taken.len() < piles {
        let bounds = Bounds::of(&taken);
        let mut ways: BTreeMap<usize, Vec<Way>> = BTreeMap::new();
        for (number, joint) in joints.iter().enumerate() {
            for (here, there) in [(0, 1), (1, 0)] {
                let (Some((cell, turn)), None) = (placed[joint.piles[here]], placed[joint.piles[there]])
                else {
                    continue;
                };
                let side = joint.sides[here].turned(turn);
                let [dx, dy] = side.step();
                let beyond = [cell[0] + dx, cell[1] + dy];
                if !taken.contains(&beyond) && bounds.with(beyond).fit(grid) {
                    // Turned so that the bridge is on the side across.
                    let turn = side.opposite() as usize + 4 - joint.sides[there] as usize;
                    let way = Way { joint: number, cell: beyond, turn: turn % 4 };
                    ways.entry(joint.piles[there]).or_default().push(way);
                }
            }
        }
        let fewest = ways.values().map(Vec::len).min().ok_or(taken.len())?;
        let choice: Vec<usize> =
            ways.iter().filter(|(_, list)| list.len() <= fewest + 1).map(|(pile, _)| *pile).collect();
        let pile = choice[random.below(choice.len())];
        let mut list = ways.remove(&pile).unwrap_or_default();
        random.shuffle(&mut list);
        // Mostly the most compact way; now and then any, so that another try comes out differently.
        if random.below(4) > 0 {
            list.sort_by_key(|way| bounds.with(way.cell).compactness());
        }
        let Some(way) = list.first() else { return Err(taken.len()) };
        placed[pile] = Some((way.cell, way.turn));
        taken.insert(way.cell);
        bridges.push(joints[way.joint]);
    }
    let corner = Bounds::of(&taken).low;
    let (cells, turns) =
        placed.into_iter().flatten().map(|([x, y], turn)| ([x - corner[0], y - corner[1]], turn)).unzip();
    Ok(Layout { cells, turns, bridges })
}

/// The box of some cells.
#[derive(Clone, Copy)]
struct Bounds {
    low: [i32; 2],
    high: [i32; 2],
}

impl Bounds {
    fn of<'a>(cells: impl IntoIterator<Item = &'a [i32; 2]>) -> Self {
        let none = Self { low: [i32::MAX; 2], high: [i32::MIN; 2] };
        cells.into_iter().fold(none, |bounds, cell| bounds.with(*cell))
    }

    /// The box with one more cell.
    fn with(self, cell: [i32; 2]) -> Self {
        Self {
            low: [0, 1].map(|axis| self.low[axis].min(cell[axis])),
            high: [0, 1].map(|axis| self.high[axis].max(cell[axis])),
        }
    }

    fn sides(self) -> [i32; 2] {
        [0, 1].map(|axis| self.high[axis] - self.low[axis] + 1)
    }

    /// Area first, then half the circumference.
    fn compactness(self) -> (i32, i32) {
        let [across, along] = self.sides();
        (across * along, across + along)
    }

    /// Whether it fits on a grid of so many cells, where one is given.
    fn fit(self, grid: Option<[usize; 2]>) -> bool {
        grid.is_none_or(|most| {
            self.sides().into_iter().zip(most).all(|(side, most)| side.unsigned_abs() as usize <= most)
        })
    }
}
