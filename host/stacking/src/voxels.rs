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
        let mut quads = Vec::new();
        let mut index = 0;
        for z in 0..self.sides[2] {
            for y in 0..self.sides[1] {
                for x in 0..self.sides[0] {
                    if self.solid[index] {
                        for (way, corners) in &FACES {
                            if !self.is_solid([x + way[0], y + way[1], z + way[2]]) {
                                quads.push(corners.map(|[a, b, c]| [x + a, y + b, z + c]));
                            }
                        }
                    }
                    index += 1;
                }
            }
        }
        quads
    }

    fn is_solid(&self, at: Point) -> bool {
        let inside = at.iter().zip(&self.sides).all(|(c, side)| (0..*side).contains(c));
        let [x, y, z] = at.map(|c| usize::try_from(c).unwrap_or(0));
        let [width, depth, _] = self.sides.map(|c| usize::try_from(c).unwrap_or(0));
        inside && self.solid[(z * depth + y) * width + x]
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
