//! Inside and outside of a mesh with open edges, by its generalised winding number: the share of all directions in which it
//! stands around a point (Jacobson, Kavan, Sorkine-Hornung, *Robust inside-outside segmentation using generalized winding
//! numbers*, 2013). `repair` makes the cones, `fill` asks.
//!
//! Cones over the open edges close the mesh. Rows count how often the closed mesh winds round a centre, a whole number; the
//! cones' own share is then taken off it. So the work grows with the open edges, not with the mesh.

use super::{Corner, Triangle, cross, dot, minus};
use std::collections::BTreeMap;
use std::f64::consts::PI;

/// Tips are moved by these shares of their cone's size, so that no cone is flat: a centre on it would be on neither side.
const TIP_SHIFT: Corner = [0.009_013, 0.007_071, 0.011_547];

/// An edge that the triangles of a mesh pass more often one way than the other.
pub(super) struct Open {
    /// As the triangles that are too many pass it.
    pub(super) ends: [usize; 2],
    /// By how many.
    pub(super) excess: usize,
}

/// Triangles that close a mesh: a cone over each group of open edges that hang together.
pub(super) fn cones(open: &[Open], corners: &[Corner]) -> Vec<Triangle> {
    let mut group: BTreeMap<usize, usize> =
        open.iter().flat_map(|edge| edge.ends).map(|end| (end, end)).collect();
    for Open { ends: [a, b], .. } in open {
        let (a, b) = (root(&group, *a), root(&group, *b));
        group.insert(a.max(b), a.min(b));
    }
    let mut members: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    for &end in group.keys() {
        members.entry(root(&group, end)).or_default().push(end);
    }
    let tips: BTreeMap<usize, Corner> =
        members.into_iter().map(|(group, ends)| (group, tip(&ends, corners))).collect();
    let mut cones = Vec::new();
    for Open { ends: [from, to], excess } in open {
        let Some(tip) = tips.get(&root(&group, *from)) else { continue };
        cones.extend(std::iter::repeat_n([corners[*to], corners[*from], *tip], *excess));
    }
    cones
}

fn root(group: &BTreeMap<usize, usize>, mut end: usize) -> usize {
    while let Some(&next) = group.get(&end).filter(|next| **next != end) {
        end = next;
    }
    end
}

/// A point near the middle of some corners.
fn tip(ends: &[usize], corners: &[Corner]) -> Corner {
    let at = || ends.iter().map(|end| corners[*end]);
    let middle = [0, 1, 2].map(|axis| at().map(|corner| corner[axis]).sum::<f64>() / ends.len() as f64);
    let size =
        at().map(|corner| dot(minus(corner, middle), minus(corner, middle))).fold(0.0, f64::max).sqrt();
    [0, 1, 2].map(|axis| middle[axis] + size * TIP_SHIFT[axis])
}

/// How often triangles wind round a point, counter-clockwise from outside: each by its solid angle (van Oosterom, Strackee,
/// *The solid angle of a plane triangle*, 1983).
pub(super) fn number(triangles: &[Triangle], point: Corner) -> f64 {
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
        let [a, b, c] = mesh.remove(0);
        let at = |corner: Corner| CORNERS.iter().position(|other| *other == corner).unwrap();
        let open: Vec<Open> =
            [[b, a], [c, b], [a, c]].into_iter().map(|ends| Open { ends: ends.map(at), excess: 1 }).collect();
        let cones = cones(&open, &CORNERS);
        assert_eq!(cones.len(), 3);
        mesh.extend(cones);
        assert!((number(&mesh, [0.2, 0.2, 0.2]) - 1.0).abs() < 1e-12);
        assert!(number(&mesh, [0.5, 0.5, 0.5]).abs() < 1e-12);
    }
}
