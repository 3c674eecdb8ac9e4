//! The panels of one frame as unit squares of the lattice, from the coordinates of their vertices.

use super::report::{Report, Rule};

/// A unit square: its least corner, the axis that it stands across, and whether its outer side looks along the axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Square {
    pub(super) least: [i32; 3],
    pub(super) axis: usize,
    pub(super) sign: i32,
}

/// The panels of a frame.
pub(super) struct Frame<'a> {
    points: &'a [[i32; 3]],
    faces: &'a [[usize; 4]],
    squares: Vec<Option<Square>>,
}

impl<'a> Frame<'a> {
    /// Reads the squares; panels that are none go into the report.
    pub(super) fn new(
        name: &str,
        points: &'a [[i32; 3]],
        faces: &'a [[usize; 4]],
        report: &mut Report,
    ) -> Self {
        let squares: Vec<Option<Square>> =
            faces.iter().map(|face| unit_square(face.map(|vertex| points[vertex]))).collect();
        for (panel, square) in squares.iter().enumerate() {
            report.require(square.is_some(), Rule::UnitSquare, || {
                let corners = faces[panel].map(|vertex| points[vertex]);
                (format!("faces_vertices[{panel}]"), format!("no unit square in the {name}: {corners:?}"))
            });
        }
        Self { points, faces, squares }
    }

    /// Whether all panels are unit squares.
    pub(super) fn is_whole(&self) -> bool {
        self.squares.iter().all(Option::is_some)
    }

    /// Whether all panels lie across z.
    pub(super) fn is_flat(&self) -> bool {
        self.squares.iter().flatten().all(|square| square.axis == 2)
    }

    /// The squares of a whole frame, by panel.
    pub(super) fn squares(&self) -> impl Iterator<Item = (usize, Square)> {
        self.squares.iter().enumerate().filter_map(|(panel, square)| square.map(|square| (panel, square)))
    }

    /// The outer normal of a panel.
    pub(super) fn normal(&self, panel: usize) -> [i32; 3] {
        let mut normal = [0; 3];
        if let Some(square) = self.squares[panel] {
            normal[square.axis] = square.sign;
        }
        normal
    }

    /// The ends of a side of a panel.
    pub(super) fn ends(&self, panel: usize, side: usize) -> [[i32; 3]; 2] {
        let face = self.faces[panel];
        [self.points[face[side]], self.points[face[(side + 1) % 4]]]
    }

    /// The direction from a side of a panel into the panel.
    pub(super) fn into(&self, panel: usize, side: usize) -> [i32; 3] {
        let face = self.faces[panel];
        let (from, to) = (self.points[face[(side + 1) % 4]], self.points[face[(side + 2) % 4]]);
        [to[0] - from[0], to[1] - from[1], to[2] - from[2]]
    }
}

/// The fold angle in degrees, valley positive, of a hinge from which `into_a` and `into_b` lead into its panels.
/// `flat_onto` tells on which side of panel a panel b lies when it is folded flat onto it: 1 outer, -1 inner.
pub(super) fn fold_angle(into_a: [i32; 3], into_b: [i32; 3], normal_a: [i32; 3], flat_onto: i32) -> i32 {
    if into_a == into_b {
        return 180 * flat_onto;
    }
    90 * (0..3).map(|axis| into_b[axis] * normal_a[axis]).sum::<i32>()
}

fn unit_square([a, b, c, d]: [[i32; 3]; 4]) -> Option<Square> {
    let minus = |p: [i32; 3], q: [i32; 3]| [0, 1, 2].map(|axis| i64::from(p[axis]) - i64::from(q[axis]));
    let (u, v) = (minus(b, a), minus(c, b));
    let axis_of = |w: [i64; 3]| {
        let length: i64 = w.iter().map(|c| c.abs()).sum();
        (length == 1).then(|| w.iter().position(|c| *c != 0)).flatten()
    };
    let (along_u, along_v) = (axis_of(u)?, axis_of(v)?);
    if along_u == along_v || minus(d, c) != u.map(|c| -c) {
        return None;
    }
    let axis = 3 - along_u - along_v;
    // x, y, z in turn make a right-handed frame; any other order a left-handed one.
    let handed = if (along_u + 1) % 3 == along_v { 1 } else { -1 };
    let sign = if u[along_u] * v[along_v] * handed > 0 { 1 } else { -1 };
    Some(Square { least: [0, 1, 2].map(|k| a[k].min(c[k])), axis, sign })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_normal_follows_from_the_order_of_the_corners() {
        let up = unit_square([[0, 0, 5], [1, 0, 5], [1, 1, 5], [0, 1, 5]]).unwrap();
        assert_eq!(up, Square { least: [0, 0, 5], axis: 2, sign: 1 });
        let down = unit_square([[0, 0, 5], [0, 1, 5], [1, 1, 5], [1, 0, 5]]).unwrap();
        assert_eq!(down.sign, -1);
        let west = unit_square([[0, 0, 0], [0, 0, 1], [0, 1, 1], [0, 1, 0]]).unwrap();
        assert_eq!((west.axis, west.sign), (0, -1));
    }

    #[test]
    fn crossed_and_stretched_corners_are_no_square() {
        assert_eq!(unit_square([[0, 0, 0], [1, 1, 0], [1, 0, 0], [0, 1, 0]]), None);
        assert_eq!(unit_square([[0, 0, 0], [1, 0, 0], [2, 0, 0], [1, 0, 0]]), None);
        assert_eq!(unit_square([[0, 0, 0], [1, 0, 0], [1, 1, 0], [1, 2, 0]]), None);
    }
}
