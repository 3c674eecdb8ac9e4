//! The nearest one of many triangles or squares, found in a tree of boxes.

use super::{Corner, Triangle, cross, dot, minus};
use crate::square::Quad;
use rstar::{AABB, PointDistance, RTree, RTreeObject};

/// A set of shapes that knows how far a point is from it.
pub(super) struct Nearest<T: PointDistance + RTreeObject<Envelope = AABB<Corner>>> {
    tree: RTree<T>,
}

impl<T: PointDistance + RTreeObject<Envelope = AABB<Corner>>> Nearest<T> {
    pub(super) fn new(shapes: Vec<T>) -> Self {
        Self { tree: RTree::bulk_load(shapes) }
    }

    /// The distance to the nearest shape; infinite where there is none.
    pub(super) fn distance(&self, point: Corner) -> f64 {
        self.tree.nearest_neighbor(point).map_or(f64::INFINITY, |shape| shape.distance_2(&point).sqrt())
    }
}

impl Nearest<Facet> {
    /// The triangles whose boxes meet the line between two points that differ along one axis.
    pub(super) fn along(&self, [from, to]: [Corner; 2]) -> impl Iterator<Item = &Triangle> {
        self.tree.locate_in_envelope_intersecting(AABB::from_corners(from, to)).map(|facet| &facet.0)
    }
}

/// A triangle of the mesh.
pub(super) struct Facet(pub(super) Triangle);

impl RTreeObject for Facet {
    type Envelope = AABB<Corner>;

    fn envelope(&self) -> Self::Envelope {
        AABB::from_points(&self.0)
    }
}

impl PointDistance for Facet {
    fn distance_2(&self, point: &Corner) -> f64 {
        let [a, b, c] = self.0;
        let normal = cross(minus(b, a), minus(c, a));
        let inside =
            |from: Corner, to: Corner| dot(cross(minus(to, from), minus(*point, from)), normal) > 0.0;
        // A triangle without area has no inside: its edges are all of it.
        if inside(a, b) && inside(b, c) && inside(c, a) {
            let height = dot(minus(*point, a), normal);
            return height * height / dot(normal, normal);
        }
        let edges = [(a, b), (b, c), (c, a)].map(|(from, to)| to_segment_2(*point, from, to));
        edges.into_iter().fold(f64::INFINITY, f64::min)
    }
}

/// A panel: a square whose sides run along the axes.
pub(super) struct Square {
    least: Corner,
    greatest: Corner,
}

impl Square {
    pub(super) fn of(quad: &Quad) -> Self {
        let all = |axis: usize| quad.iter().map(move |corner| f64::from(corner[axis]));
        let least = [0, 1, 2].map(|axis| all(axis).fold(f64::INFINITY, f64::min));
        Self { least, greatest: [0, 1, 2].map(|axis| all(axis).fold(f64::NEG_INFINITY, f64::max)) }
    }
}

impl RTreeObject for Square {
    type Envelope = AABB<Corner>;

    fn envelope(&self) -> Self::Envelope {
        AABB::from_corners(self.least, self.greatest)
    }
}

impl PointDistance for Square {
    fn distance_2(&self, point: &Corner) -> f64 {
        let away =
            [0, 1, 2].map(|axis| point[axis] - point[axis].clamp(self.least[axis], self.greatest[axis]));
        dot(away, away)
    }
}

fn to_segment_2(point: Corner, from: Corner, to: Corner) -> f64 {
    let (along, offset) = (minus(to, from), minus(point, from));
    let length_2 = dot(along, along);
    let share = if length_2 > 0.0 { (dot(offset, along) / length_2).clamp(0.0, 1.0) } else { 0.0 };
    let away = minus(offset, along.map(|c| c * share));
    dot(away, away)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_point_is_as_far_from_a_triangle_as_from_its_inside_an_edge_or_a_corner() {
        let facet = Facet([[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0]]);
        for (point, expected) in [
            ([1.0, 1.0, -3.0], 3.0),
            ([2.0, -2.0, 0.0], 2.0),
            ([7.0, -4.0, 0.0], 5.0),
            ([4.0, 4.0, 0.0], 8.0_f64.sqrt()),
            ([1.0, 1.0, 0.0], 0.0),
        ] {
            assert!((facet.distance_2(&point).sqrt() - expected).abs() < 1e-12, "{point:?}");
        }
        let square = Square::of(&[[1, 0, 0], [1, 1, 0], [1, 1, 1], [1, 0, 1]]);
        assert!((square.distance_2(&[3.0, 0.5, 2.0]) - 5.0).abs() < 1e-12);
        let flat = Facet([[0.0; 3], [2.0, 0.0, 0.0], [1.0, 0.0, 0.0]]);
        assert!((flat.distance_2(&[1.0, 2.0, 0.0]) - 4.0).abs() < 1e-12);
    }
}
