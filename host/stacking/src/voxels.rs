//! A solid made of unit cubes, and the squares that bound it.

use crate::square::{Point, Quad};

/// A box of voxels; voxel (x, y, z) covers [x, x+1] x [y, y+1] x [z, z+1].
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Voxels {
    /// The first voxel of the box.
    least: Point,
    sides: Point,
    solid: Vec<bool>,
}

/// The corners of each side of the voxel at the origin, counter-clockwise from outside, and the way to the voxel beyond.
const FACES: [(Point, Quad); 6] = [
    ([-1, 0, 0], [[0, 0, 0], [0, 0, 1], [0, 1, 1], [0, 1, 0]]),
    ([1, 0, 0], [[1, 0, 0], [1, 1, 0], [1, 1, 1], [1, 0, 1]]),
    ([0, -1, 0], [[0, 0, 0], [1, 0, 0], [1, 0, 1], [0, 0, 1]]),
    ([0, 1, 0], [[0, 1, 0], [0, 1, 1], [1, 1, 1], [1, 1, 0]]),
    ([0, 0, -1], [[0, 0, 0], [0, 1, 0], [1, 1, 0], [1, 0, 0]]),
    ([0, 0, 1], [[0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]]),
];

impl Voxels {
    /// A box of the given sides from the origin on, with its voxels in the order x fastest, then y, then z.
    pub(crate) fn new(sides: Point, solid: Vec<bool>) -> Self {
        Self { least: [0; 3], sides, solid }
    }

    /// The same solid in a box that has so many empty voxels more on every side.
    pub(crate) fn padded(&self, margin: i32) -> Self {
        let sides = self.sides.map(|side| side + 2 * margin);
        let empty = sides.iter().map(|side| usize::try_from(*side).unwrap_or(0)).product();
        let mut padded = Self { least: self.least.map(|c| c - margin), sides, solid: vec![false; empty] };
        for (number, _) in self.solid.iter().enumerate().filter(|(_, solid)| **solid) {
            let target = padded.number(self.at(number));
            padded.solid[target] = true;
        }
        padded
    }

    /// Whether any voxel is solid.
    pub(crate) fn any(&self) -> bool {
        self.solid.contains(&true)
    }

    /// How many voxels the box has.
    pub(crate) fn len(&self) -> usize {
        self.solid.len()
    }

    /// The place of a voxel by its number.
    pub(crate) fn at(&self, number: usize) -> Point {
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_possible_wrap,
            reason = "below a side, an i32"
        )]
        let [x, y, z] = {
            let [width, depth, _] = self.sides.map(|side| usize::try_from(side).unwrap_or(1));
            [number % width, number / width % depth, number / width / depth].map(|c| c as i32)
        };
        [x + self.least[0], y + self.least[1], z + self.least[2]]
    }

    /// Whether a voxel is solid, by its number.
    pub(crate) fn solid(&self, number: usize) -> bool {
        self.solid[number]
    }

    /// Makes a voxel solid or empty, by its number.
    pub(crate) fn set(&mut self, number: usize, solid: bool) {
        self.solid[number] = solid;
    }

    /// What to add to a voxel's number for a step; right for voxels that have a neighbour there in the box.
    pub(crate) fn stride(&self, [x, y, z]: Point) -> isize {
        let [width, depth, _] = self.sides.map(|side| isize::try_from(side).unwrap_or(0));
        let [x, y, z] = [x, y, z].map(|c| isize::try_from(c).unwrap_or(0));
        (z * depth + y) * width + x
    }

    /// Whether a voxel is in the outermost layer of the box.
    pub(crate) fn is_rim(&self, number: usize) -> bool {
        let place = self.at(number);
        (0..3).any(|axis| {
            let c = place[axis] - self.least[axis];
            c == 0 || c == self.sides[axis] - 1
        })
    }

    /// How many squares lie between solid and empty. The outermost layer of the box is empty.
    pub(crate) fn panels(&self) -> usize {
        let steps = [[1, 0, 0], [0, 1, 0], [0, 0, 1]].map(|step| self.stride(step).unsigned_abs());
        let changes =
            |step: usize| self.solid.iter().zip(&self.solid[step..]).filter(|(a, b)| a != b).count();
        steps.into_iter().map(changes).sum()
    }

    /// The squares between solid and empty, outer side out.
    pub(crate) fn boundary(&self) -> Vec<Quad> {
        let [width, depth, _] = self.sides.map(|c| usize::try_from(c).unwrap_or(0));
        let [left, front, bottom] = self.least;
        let row = |y: i32, z: i32| {
            let [y, z] = [usize::try_from(y).ok()?, usize::try_from(z).ok()?];
            (y < depth).then(|| self.solid.get((z * depth + y) * width..)?.get(..width))?
        };
        let mut quads = Vec::new();
        for (z, y) in (0..self.sides[2]).flat_map(|z| (0..self.sides[1]).map(move |y| (z, y))) {
            let Some(here) = row(y, z).filter(|here| here.contains(&true)) else { continue };
            let rows = FACES.map(|([_, dy, dz], _)| row(y + dy, z + dz));
            for (x, at) in (0..self.sides[0]).zip(0..width).filter(|(_, at)| here[*at]) {
                for ((way, corners), row) in FACES.iter().zip(rows) {
                    let beyond = at.checked_add_signed(way[0] as isize);
                    let is_solid = beyond.zip(row).and_then(|(beyond, row)| row.get(beyond)).copied();
                    if is_solid != Some(true) {
                        quads.push(corners.map(|[a, b, c]| [x + left + a, y + front + b, z + bottom + c]));
                    }
                }
            }
        }
        quads
    }

    /// The voxel's number; the voxel is in the box.
    pub(crate) fn number(&self, at: Point) -> usize {
        let [x, y, z] = [0, 1, 2].map(|axis| usize::try_from(at[axis] - self.least[axis]).unwrap_or(0));
        let [width, depth, _] = self.sides.map(|c| usize::try_from(c).unwrap_or(0));
        (z * depth + y) * width + x
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::square;

    #[test]
    fn one_voxel_has_six_squares_that_look_outwards() {
        let quads = Voxels::new([1, 1, 1], vec![true]).boundary();
        assert_eq!(quads.len(), 6);
        for ((way, _), quad) in FACES.iter().zip(&quads) {
            assert!(square::is_unit(quad));
            assert_eq!(square::normal(quad), *way);
        }
    }

    #[test]
    fn squares_between_two_solid_voxels_are_inside() {
        assert_eq!(Voxels::new([3, 1, 1], vec![true; 3]).boundary().len(), 14);
    }

    #[test]
    fn a_wider_box_changes_no_square() {
        let voxels = Voxels::new([2, 2, 1], vec![true, true, false, true]);
        let wide = voxels.padded(2);
        assert_eq!(wide.boundary(), voxels.boundary());
        assert_eq!(wide.panels(), voxels.boundary().len());
        assert_eq!(wide.len(), 6 * 6 * 5);
        assert!((0..wide.len()).all(|number| !wide.solid(number) || !wide.is_rim(number)));
    }
}
