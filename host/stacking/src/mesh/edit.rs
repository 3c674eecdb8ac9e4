//! Edits a solid voxel by voxel until its surface has exactly so many panels. `panels` calls it.
//!
//! Only simple voxels are put or taken, so the solid stays one, and so does its surface. A voxel with f solid neighbours by
//! sides changes the count by 6 - 2f when it is put and by 2f - 6 when it is taken: by 2 or 4, or not at all.

use super::simple::{self, Neighbourhood};
use crate::square::Point;
use crate::voxels::Voxels;
use std::collections::{BTreeSet, HashMap};

/// What a move costs beyond the distance of its voxel's centre from the mesh, in voxels. A strip of panels hardly gets
/// past a bump or a dent of one voxel, and not easily past a notch, so these are made last and mended first.
const NEW_BUMP: f64 = 0.5;
const NEW_NOTCH: f64 = 0.25;
const OLD_BUMP: f64 = -0.25;
/// For a voxel taken off a part one voxel thick: it bares the mesh on both sides, and then the next one would go.
const THIN: f64 = 1.5;
/// A part is thin where a voxel has fewer solid neighbours of 26; at the corner of a block it has 7.
const THIN_BELOW: u32 = 6;
/// For every lattice edge more at which two sheets touch.
const TOUCHING_SHEETS: f64 = 0.5;

/// Costs as whole numbers, so that they have an order.
const PER_VOXEL: f64 = 1e6;

/// The changes of the count that a voxel can make.
const CHANGES: [i64; 5] = [-4, -2, 0, 2, 4];

/// A voxel that may change sides: its cost and its number.
type Move = (i64, usize);

/// The moves that a solid offers, by what they do to the count.
struct Moves<'a> {
    voxels: &'a mut Voxels,
    distance: &'a dyn Fn(Point) -> f64,
    around: [isize; 27],
    by_change: [BTreeSet<Move>; 5],
    /// Of every voxel on offer, where it stands in `by_change`.
    offered: HashMap<usize, (usize, i64)>,
    /// Voxels that had their turn: none has a second one, so the work ends.
    done: BTreeSet<usize>,
}

/// Edits the solid until it has `wanted` panels; tells how many voxels were put or taken, or nothing where no way was found,
/// and then the solid is of no use. `distance` is that of a voxel's centre from the mesh, in voxels. The box has two empty
/// layers around the solid, and keeps one.
pub(super) fn edit(
    voxels: &mut Voxels,
    panels: usize,
    wanted: usize,
    distance: &dyn Fn(Point) -> f64,
) -> Option<usize> {
    let mut missing = i64::try_from(wanted).ok()? - i64::try_from(panels).ok()?;
    if missing == 0 {
        return Some(0);
    }
    let mut moves = Moves::of(voxels, distance);
    while missing != 0 {
        let (number, change) = moves.best(missing)?;
        moves.make(number);
        missing -= change;
    }
    Some(moves.done.len())
}

impl<'a> Moves<'a> {
    fn of(voxels: &'a mut Voxels, distance: &'a dyn Fn(Point) -> f64) -> Self {
        let mut around = [0; 27];
        let steps = (-1..=1).flat_map(|z| (-1..=1).flat_map(move |y| (-1..=1).map(move |x| [x, y, z])));
        for (stride, step) in around.iter_mut().zip(steps) {
            *stride = voxels.stride(step);
        }
        let offered = HashMap::new();
        let mut moves =
            Self { voxels, distance, around, by_change: Default::default(), offered, done: BTreeSet::new() };
        for number in 0..moves.voxels.len() {
            moves.offer(number);
        }
        moves
    }

    /// The best move towards a count that lacks so many panels. Where none leads there straight, one that goes too far or
    /// nowhere may open a way.
    fn best(&self, missing: i64) -> Option<(usize, i64)> {
        let towards = |change: &i64| change.signum() == missing.signum();
        let cheapest = |changes: &mut dyn Iterator<Item = i64>| {
            let first = |change: i64| {
                let place = CHANGES.iter().position(|other| *other == change)?;
                self.by_change[place].first().map(|(cost, number)| (*cost, *number, change))
            };
            changes.filter_map(first).min().map(|(_, number, change)| (number, change))
        };
        let straight = CHANGES.into_iter().filter(|change| towards(change) && change.abs() <= missing.abs());
        cheapest(&mut straight.into_iter())
            .or_else(|| cheapest(&mut CHANGES.into_iter().filter(towards)))
            .or_else(|| cheapest(&mut [0].into_iter()))
    }

    /// Puts or takes a voxel, and looks anew at those around it.
    fn make(&mut self, number: usize) {
        self.voxels.set(number, !self.voxels.solid(number));
        self.done.insert(number);
        for stride in self.around {
            if let Some(number) = number.checked_add_signed(stride) {
                self.withdraw(number);
                self.offer(number);
            }
        }
    }

    fn withdraw(&mut self, number: usize) {
        if let Some((place, cost)) = self.offered.remove(&number) {
            self.by_change[place].remove(&(cost, number));
        }
    }

    /// Puts a voxel on offer where it may change sides.
    fn offer(&mut self, number: usize) {
        let Some(around) = self.neighbourhood(number) else { return };
        if !simple::is_simple(around) || self.done.contains(&number) {
            return;
        }
        let solid = self.voxels.solid(number);
        let sides = i64::from((around & simple::BY_SIDE).count_ones());
        let change = if solid { 2 * sides - 6 } else { 6 - 2 * sides };
        let Some(place) = CHANGES.iter().position(|other| *other == change) else { return };
        let (with, without) = (around | 1 << simple::CENTRE, around & !(1 << simple::CENTRE));
        let shape = match change {
            _ if solid && without.count_ones() < THIN_BELOW => THIN,
            4 => NEW_BUMP,
            2 if solid => NEW_NOTCH,
            -4 => OLD_BUMP,
            _ => 0.0,
        };
        let touching = |around| f64::from(simple::touching_sheets(around));
        let more =
            if solid { touching(without) - touching(with) } else { touching(with) - touching(without) };
        let cost = (self.distance)(self.voxels.at(number)) + shape + TOUCHING_SHEETS * more;
        #[expect(
            clippy::cast_possible_truncation,
            reason = "a distance within the box, a few thousand voxels at most"
        )]
        let cost = (cost * PER_VOXEL) as i64;
        self.by_change[place].insert((cost, number));
        self.offered.insert(number, (place, cost));
    }

    /// What is solid around a voxel that lies at the surface and not in the outermost layer.
    fn neighbourhood(&self, number: usize) -> Option<Neighbourhood> {
        let solid = self.voxels.solid(number);
        let side = |place: usize| number.checked_add_signed(self.around[place]);
        // The bits of the six sides.
        let at_surface = [4, 10, 12, 14, 16, 22].into_iter().filter_map(side);
        let mut at_surface = at_surface.filter(|next| *next < self.voxels.len());
        if !at_surface.any(|next| self.voxels.solid(next) != solid) || self.voxels.is_rim(number) {
            return None;
        }
        let mut around = 0;
        for (bit, stride) in self.around.iter().enumerate() {
            if self.voxels.solid(number.checked_add_signed(*stride)?) {
                around |= 1 << bit;
            }
        }
        Some(around)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn block(sides: Point) -> Voxels {
        let count = sides.iter().map(|side| usize::try_from(*side).unwrap()).product();
        Voxels::new(sides, vec![true; count]).padded(2)
    }

    fn edited(mut voxels: Voxels, wanted: usize) -> Option<usize> {
        let panels = voxels.boundary().len();
        let done = edit(&mut voxels, panels, wanted, &|_| 0.5)?;
        assert_eq!(voxels.boundary().len(), wanted);
        Some(done)
    }

    #[test]
    fn a_block_grows_and_shrinks_to_every_even_count_near_its_own() {
        for wanted in (150..=250).step_by(2) {
            assert!(edited(block([5, 6, 7]), wanted).is_some(), "{wanted}");
        }
        assert_eq!(edited(block([5, 6, 7]), 214), Some(0));
    }

    #[test]
    fn the_voxels_nearest_to_the_mesh_go_first() {
        let mut voxels = block([5, 5, 5]);
        let far = |[x, y, z]: Point| if [x, y, z] == [2, 2, 5] { 0.0 } else { 9.0 };
        assert_eq!(edit(&mut voxels, 150, 154, &far), Some(1));
        assert!((0..voxels.len()).any(|number| voxels.solid(number) && voxels.at(number) == [2, 2, 5]));
    }

    #[test]
    fn a_needle_keeps_its_length_while_there_is_something_else_to_take() {
        let mut voxels = block([5, 5, 5]);
        for z in 5..7 {
            let tip = voxels.number([2, 2, z]);
            voxels.set(tip, true);
        }
        let panels = voxels.panels();
        let bump = voxels.number([0, 2, 5]);
        voxels.set(bump, true);
        assert_eq!(edit(&mut voxels, panels + 4, panels, &|_| 0.5), Some(1));
        assert!(!voxels.solid(bump));
    }

    #[test]
    fn one_voxel_can_not_become_eight_panels() {
        assert_eq!(edited(block([1, 1, 1]), 8), None);
    }
}
