//! Unit squares of the integer lattice: the shape of every panel.

use std::fmt;

/// A point of the lattice, in panel lengths.
pub(crate) type Point = [i32; 3];

/// The corners of a panel, counter-clockwise seen from outside.
pub(crate) type Quad = [Point; 4];

/// The vector from `from` to `to`.
pub(crate) fn vector(from: Point, to: Point) -> Point {
    [to[0] - from[0], to[1] - from[1], to[2] - from[2]]
}

/// The opposite vector.
pub(crate) fn opposite(v: Point) -> Point {
    v.map(|c| -c)
}

/// The scalar product.
pub(crate) fn dot(u: Point, v: Point) -> i32 {
    u[0] * v[0] + u[1] * v[1] + u[2] * v[2]
}

/// The outer normal of a unit square.
pub(crate) fn normal(quad: &Quad) -> Point {
    let (u, v) = (vector(quad[0], quad[1]), vector(quad[1], quad[2]));
    [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]
}

/// The direction that leads from an edge into the square. Edge `e` runs from corner `e` to corner `e + 1`.
pub(crate) fn into(quad: &Quad, edge: usize) -> Point {
    vector(quad[(edge + 1) % 4], quad[(edge + 2) % 4])
}

/// Whether four points are the corners of a unit square, in order.
pub(crate) fn is_unit(quad: &Quad) -> bool {
    // 64 bits: corners that somebody wrote far apart must not overflow the difference.
    let wide = quad.map(|p| p.map(i64::from));
    let side = |i: usize| [0, 1, 2].map(|axis| wide[(i + 1) % 4][axis] - wide[i][axis]);
    let (u, v) = (side(0), side(1));
    let length = |v: [i64; 3]| v.iter().map(|c| c.abs()).sum::<i64>();
    let across = |i: usize| u[i] * v[i];
    length(u) == 1 && length(v) == 1 && across(0) + across(1) + across(2) == 0 && side(2) == u.map(|c| -c)
}

/// The least corner of a square: with its normal, a name for the place that it takes.
pub(crate) fn least_corner(quad: &Quad) -> Point {
    [0, 1, 2].map(|axis| quad[0][axis].min(quad[2][axis]))
}

/// A number that names a point and one of up to eight things that it may have.
fn name(point: Point, which: usize) -> u128 {
    // Shifted by 2^31 the coordinates keep their order as numbers without a sign.
    let place = point.iter().fold(0, |place, c| place << 32 | u128::from(c.cast_unsigned() ^ (1 << 31)));
    place << 3 | which as u128
}

/// A number that names the lattice edge between two points.
pub(crate) fn edge_name(p: Point, q: Point) -> u128 {
    let axis = (0..3).find(|axis| p[*axis] != q[*axis]);
    name(p.min(q), axis.unwrap_or_default())
}

/// A number that names the place of a unit square and its outer side.
pub(crate) fn place_name(quad: &Quad) -> u128 {
    let normal = normal(quad);
    let which = (0..3).find(|axis| normal[*axis] != 0).unwrap_or_default();
    name(least_corner(quad), 2 * which + usize::from(normal[which] > 0))
}

/// Prints a lattice point the way people write it.
pub(crate) struct At(pub(crate) Point);

impl fmt::Display for At {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [x, y, z] = self.0;
        write!(f, "({x}, {y}, {z})")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SQUARE: Quad = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]];

    #[test]
    fn a_square_counter_clockwise_from_above_has_its_normal_up() {
        assert!(is_unit(&SQUARE));
        assert_eq!(normal(&SQUARE), [0, 0, 1]);
        assert_eq!(into(&SQUARE, 0), [0, 1, 0]);
    }

    #[test]
    fn crossed_corners_and_long_sides_are_no_unit_square() {
        assert!(!is_unit(&[[0, 0, 0], [1, 1, 0], [1, 0, 0], [0, 1, 0]]));
        assert!(!is_unit(&[[0, 0, 0], [2, 0, 0], [2, 1, 0], [0, 1, 0]]));
        assert!(!is_unit(&[[i32::MIN, 0, 0], [i32::MAX, 0, 0], [1, 1, 0], [0, 1, 0]]));
    }
}
