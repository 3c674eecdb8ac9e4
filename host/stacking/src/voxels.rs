//! A solid made of unit cubes, and the squares that bound it.

use crate::square::{Point, Quad};

/// A box of voxels; voxel (x, y, z) covers [x, x+1] x [y, y+1] x [z, z+1].
#[derive(Debug, Clone)]
pub(crate) struct Voxels {
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
    /// A box of the given sides with its voxels in the order x fastest, then y, then z.
    pub(crate) fn new(sides: Point, solid: Vec<bool>) -> Self {
        Self { sides, solid }
    }

    /// Whether any voxel is solid.
    pub(crate) fn any(&self) -> bool {
        self.solid.contains(&true)
    }

    /// The squares between solid and empty, outer side out.
    pub(crate) fn boundary(&self) -> Vec<Quad> {
        let [width, depth, _] = self.sides.map(|c| usize::try_from(c).unwrap_or(0));
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
                        quads.push(corners.map(|[a, b, c]| [x + a, y + b, z + c]));
                    }
                }
            }
        }
        quads
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
}
