//! Seeded random solids of one piece and without cavities, for the campaign (`examples/solids.rs`) and its short version
//! among the tests: lumps, tendrils, thin plates, and dense boxes full of tunnels and of edges where two sheets touch.

use super::boundary::{Voxel, boundary};
use std::collections::BTreeSet;
use zygote_stacking::{Model, Request, Surface, SurfaceError, fold, plan};

/// How a solid grows.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Growth {
    Lump,
    Tendrils,
    Plate,
    Tunnels,
}

const GROWTHS: [Growth; 4] = [Growth::Lump, Growth::Tendrils, Growth::Plate, Growth::Tunnels];
/// Voxels of a solid, from and to.
const FEWEST: usize = 20;
const MOST: usize = 400;

/// A seeded stream of numbers (`SplitMix64`).
struct Stream(u64);

impl Stream {
    fn below(&mut self, limit: usize) -> usize {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        usize::try_from((z ^ (z >> 31)) >> 33).unwrap() % limit
    }
}

/// The solid with a number: how it grew, its voxels, and its model. A solid whose surface is in pieces grows again.
pub(crate) fn solid(number: u64) -> (Growth, usize, Model) {
    let mut stream = Stream(number);
    loop {
        let growth = GROWTHS[usize::try_from(number).unwrap() % GROWTHS.len()];
        let voxels = without_cavities(grow(growth, FEWEST + stream.below(MOST - FEWEST + 1), &mut stream));
        if voxels.len() > MOST {
            continue;
        }
        match Model::new(format!("solid {number}"), Surface::new(boundary(&voxels), Vec::new()).unwrap()) {
            Ok(model) => return (growth, voxels.len(), model),
            Err(SurfaceError::Pieces { .. }) => {}
            Err(error) => panic!("solid {number}: {error}"),
        }
    }
}

/// Plans a solid and checks the file that the plan makes.
///
/// # Errors
/// Why there is no plan, or what is wrong with it.
pub(crate) fn attempt(model: &Model, piles: usize, seed: u64) -> Result<(), String> {
    let request = Request { piles, seed, ..Request::default() };
    let plan = plan(model, &request).map_err(|error| error.to_string())?;
    let bytes = fold::write(&plan).map_err(|error| error.to_string())?;
    let report = fold::check(&bytes).map_err(|error| error.to_string())?;
    let whole = plan.target == model.surface().quads();
    if report.is_valid() && whole { Ok(()) } else { Err(format!("WRONG PLAN: {:?}", report.lines(3))) }
}

/// Grows to a number of voxels, each new one at a side of one that is there.
fn grow(growth: Growth, voxels: usize, stream: &mut Stream) -> BTreeSet<Voxel> {
    let mut row = vec![[0; 3]];
    let mut grown = BTreeSet::from([[0; 3]]);
    // A box that the solid fills by about 60 %.
    let side = i32::try_from((1..=MOST).find(|side| side.pow(3) * 3 >= voxels * 5).unwrap()).unwrap();
    while grown.len() < voxels {
        let from = match growth {
            Growth::Tendrils => row.len() - 1 - stream.below(row.len().min(6)),
            _ => stream.below(row.len()),
        };
        let mut next = row[from];
        next[stream.below(3)] += if stream.below(2) == 0 { 1 } else { -1 };
        let allowed = match growth {
            Growth::Lump => true,
            // Now and then from anywhere, or a tendril shut in by itself would never end.
            Growth::Tendrils => {
                if stream.below(40) == 0 {
                    let place = stream.below(row.len());
                    let anywhere = row.remove(place);
                    row.push(anywhere);
                }
                true
            }
            Growth::Plate => (0..2).contains(&next[2]),
            Growth::Tunnels => next.iter().all(|c| (0..side).contains(c)),
        };
        if allowed && grown.insert(next) {
            row.push(next);
        }
    }
    grown
}

/// Fills what can't be reached from outside.
fn without_cavities(mut solid: BTreeSet<Voxel>) -> BTreeSet<Voxel> {
    let bound = |axis: usize, far: i32| {
        let values = solid.iter().map(|voxel| voxel[axis] * far);
        (values.max().unwrap() + 1) * far
    };
    let (low, high) = ([0, 1, 2].map(|axis| bound(axis, -1)), [0, 1, 2].map(|axis| bound(axis, 1)));
    let mut outside = BTreeSet::from([low]);
    let mut open = vec![low];
    while let Some(voxel) = open.pop() {
        for (axis, step) in [(0, -1), (0, 1), (1, -1), (1, 1), (2, -1), (2, 1)] {
            let mut next = voxel;
            next[axis] += step;
            let inside = (0..3).all(|axis| (low[axis]..=high[axis]).contains(&next[axis]));
            if inside && !solid.contains(&next) && outside.insert(next) {
                open.push(next);
            }
        }
    }
    for x in low[0]..=high[0] {
        for y in low[1]..=high[1] {
            solid.extend((low[2]..=high[2]).map(|z| [x, y, z]).filter(|voxel| !outside.contains(voxel)));
        }
    }
    solid
}
