//! Inside and outside of a mesh with open edges, by its generalised winding number: the share of all directions in which it
//! stands around a point (Jacobson, Kavan, Sorkine-Hornung, *Robust inside-outside segmentation using generalized winding
//! numbers*, 2013). `repair` makes the cones, `fill` asks.
//!
//! Cones over the open edges close the mesh. Rows count how often the closed mesh winds round a centre, a whole number; the
//! cones' own share is then taken off it. So the work grows with the open edges, not with the mesh.

use super::{Corner, Triangle, cross, dot, minus};
use crate::sets::Sets;
use std::collections::{BTreeMap, BTreeSet};
use std::f64::consts::PI;

/// Tips are moved by these shares of their cone's size, so that no cone is flat: a centre on it would be on neither side.
const TIP_SHIFT: Corner = [0.009_013, 0.007_071, 0.011_547];

/// From so many radii away on, a cone's share is below 1/60 and taken from its normal alone, right to a hundredth of a turn.
const AFAR: f64 = 4.0;

/// An edge that the triangles of a mesh pass more often one way than the other.
pub(super) struct Open {
    /// As the triangles that are too many pass it.
    pub(super) ends: [usize; 2],
    /// By how many.
    pub(super) excess: usize,
}

/// Open edges that hang together, closed by a cone.
pub(super) struct Hole {
    pub(super) cone: Vec<Triangle>,
    middle: Corner,
    radius: f64,
    /// The normals of the cone's triangles, each as long as its area, in all.
    normal: Corner,
}

/// Closes a mesh: a cone over each group of open edges that hang together.
pub(super) fn holes(open: &[Open], corners: &[Corner]) -> Vec<Hole> {
    let mut groups = Sets::new(corners.len());
    for Open { ends: [a, b], .. } in open {
        groups.join(*a, *b);
    }
    let all: BTreeSet<usize> = open.iter().flat_map(|edge| edge.ends).collect();
    // Groups in the order of their lowest ends.
    let mut hole_of: BTreeMap<usize, usize> = BTreeMap::new();
    let mut members: Vec<Vec<usize>> = Vec::new();
    for end in all {
        let hole = *hole_of.entry(groups.find(end)).or_insert(members.len());
        if hole == members.len() {
            members.push(Vec::new());
        }
        members[hole].push(end);
    }
    let hole = |ends: Vec<usize>| {
        let at = || ends.iter().map(|end| corners[*end]);
        let middle = [0, 1, 2].map(|axis| at().map(|corner| corner[axis]).sum::<f64>() / ends.len() as f64);
        let radius =
            at().map(|corner| dot(minus(corner, middle), minus(corner, middle))).fold(0.0, f64::max).sqrt();
        Hole { cone: Vec::new(), middle, radius, normal: [0.0; 3] }
    };
    let mut holes: Vec<Hole> = members.into_iter().map(hole).collect();
    for Open { ends: [from, to], excess } in open {
        let hole = &mut holes[hole_of[&groups.find(*from)]];
        let tip = [0, 1, 2].map(|axis| hole.middle[axis] + hole.radius * TIP_SHIFT[axis]);
        let [a, b, c] = [corners[*to], corners[*from], tip];
        let part = cross(minus(b, a), minus(c, a));
        for _ in 0..*excess {
            hole.normal = [0, 1, 2].map(|axis| hole.normal[axis] + part[axis] / 2.0);
            hole.cone.push([a, b, c]);
        }
    }
    holes
}

/// How often the cones over all holes wind round a point. From afar a cone is as good as a small flat patch.
pub(super) fn share_of(holes: &[Hole], point: Corner) -> f64 {
    let share = |hole: &Hole| {
        let way = minus(hole.middle, point);
        let distance = dot(way, way).sqrt();
        if distance > AFAR * hole.radius {
            dot(hole.normal, way) / (4.0 * PI * distance.powi(3))
        } else {
            number(&hole.cone, point)
        }
    };
    holes.iter().map(share).sum()
}

/// How often triangles wind round a point, counter-clockwise from outside: each by its solid angle (van Oosterom, Strackee,
/// *The solid angle of a plane triangle*, 1983).
fn number(triangles: &[Triangle], point: Corner) -> f64 {
    let angle = |corners: &Triangle| {
        let [a, b, c] = corners.map(|corner| minus(corner, point));
        let [la, lb, lc] = [a, b, c].map(|v| dot(v, v).sqrt());
        let below = la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb;
        2.0 * dot(a, cross(b, c)).atan2(below)
    };
    triangles.iter().map(angle).sum::<f64>() / (4.0 * PI)
}

#[cfg(test)]
mod tests {
    use super::*;

    const CORNERS: [Corner; 4] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

    fn tetrahedron() -> Vec<Triangle> {
        [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]]
            .map(|face: [usize; 3]| face.map(|at| CORNERS[at]))
            .to_vec()
    }

    #[test]
    fn a_closed_mesh_winds_once_round_what_is_inside_and_never_round_the_rest() {
        assert!((number(&tetrahedron(), [0.2, 0.2, 0.2]) - 1.0).abs() < 1e-12);
        assert!(number(&tetrahedron(), [0.5, 0.5, 0.5]).abs() < 1e-12);
    }

    #[test]
    fn a_cone_closes_a_mesh_that_lacks_a_triangle() {
        let mut mesh = tetrahedron();
        mesh.remove(0);
        // It was 0, 2, 1; its neighbours pass the edges the other way.
        let open = [[2, 0], [1, 2], [0, 1]].map(|ends| Open { ends, excess: 1 });
        let holes = holes(&open, &CORNERS);
        assert_eq!(holes.len(), 1);
        mesh.extend(&holes[0].cone);
        assert!((number(&mesh, [0.2, 0.2, 0.2]) - 1.0).abs() < 1e-12);
        assert!(number(&mesh, [0.5, 0.5, 0.5]).abs() < 1e-12);
        for far in [[0.3, 4.0, 2.0], [-3.0, 1.0, 1.0], [0.3, 0.3, -5.0]] {
            assert!((share_of(&holes, far) - number(&holes[0].cone, far)).abs() < 0.002, "{far:?}");
        }
    }
}
