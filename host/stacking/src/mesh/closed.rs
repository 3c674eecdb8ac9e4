//! The test that a mesh is closed, and the repairs that cannot change what it bounds at the scale of a voxel.

use super::indexed::{Indexed, Loose};
use super::repair::Repair;
use super::winding::{self, Hole, Open};
use super::{Triangle, dot, minus, orient};
use crate::readers::ModelProblem;

/// Corners closer than this share of the box's diagonal are one corner written twice: files with six digits round so far.
const WELD_SHARE: f64 = 1e-5;

/// A mesh after its repair.
pub(super) struct Repaired {
    pub(super) triangles: Vec<Triangle>,
    pub(super) repairs: Vec<Repair>,
    pub(super) rest: Option<Rest>,
}

/// What stays open.
pub(super) struct Rest {
    /// How many edges.
    pub(super) edges: usize,
    /// The holes that they surround.
    pub(super) holes: Vec<Hole>,
    /// What to say if inside and outside can't be told apart so.
    pub(super) refusal: ModelProblem,
}

/// Makes the mesh closed where that is safe: every edge is passed as often one way as the other, so it bounds a solid.
///
/// # Errors
/// A coordinate that is no number, no triangle with an area, a piece without two sides.
pub(super) fn closed(triangles: Vec<Triangle>) -> Result<Repaired, ModelProblem> {
    let not_finite = |corners: &Triangle| !corners.iter().flatten().all(|c| c.is_finite());
    if let Some(triangle) = triangles.iter().position(not_finite) {
        return Err(ModelProblem::NotFinite { triangle });
    }
    let mut repairs = Vec::new();
    let mut mesh = Indexed::new(&triangles);
    let degenerate = mesh.drop_degenerate();
    if degenerate > 0 {
        repairs.push(Repair::Degenerate(degenerate));
    }
    let mut loose = mesh.loose();
    for (attempt, repair) in [
        (
            Indexed::drop_duplicates as fn(&mut Indexed, &[Loose]) -> usize,
            Repair::Duplicate as fn(usize) -> Repair,
        ),
        (Indexed::weld, Repair::Welded),
        (Indexed::turn, Repair::Turned),
    ] {
        if loose.is_empty() {
            break;
        }
        let mut changed = mesh.clone();
        let count = attempt(&mut changed, &loose);
        let after = changed.loose();
        // A repair that repairs nothing is none.
        if after.len() < loose.len() {
            repairs.push(repair(count));
            (mesh, loose) = (changed, after);
        }
    }
    if mesh.triangles.is_empty() {
        return Err(ModelProblem::Empty { expected: "triangles with an area" });
    }
    let mut rest = None;
    if loose.iter().any(|edge| edge.triangles == 2) {
        // Two triangles pass it the same way, and turning them over didn't help: a strip with a twist.
        return Err(mesh.not_closed(&loose));
    } else if let Some(patches) = mesh.patches(&loose) {
        if !patches.is_empty() {
            repairs.push(Repair::Closed { holes: patches.len(), edges: loose.len() });
            mesh.triangles.extend(patches.into_iter().flatten());
        }
    } else {
        let open: Vec<Open> =
            loose.iter().map(|edge| Open { ends: edge.ends, excess: edge.excess }).collect();
        let holes = winding::holes(&open, &mesh.corners);
        rest = Some(Rest { edges: loose.len(), holes, refusal: mesh.not_closed(&loose) });
    }
    let triangles = mesh.triangles.iter().map(|triangle| mesh.at(triangle)).collect();
    Ok(Repaired { triangles, repairs, rest })
}

impl Indexed {
    fn drop_duplicates(&mut self, _: &[Loose]) -> usize {
        let before = self.triangles.len();
        for triangle in &mut self.triangles {
            let least = (0..3).min_by_key(|place| triangle[*place]).unwrap_or(0);
            triangle.rotate_left(least);
        }
        self.triangles.sort_unstable();
        self.triangles.dedup();
        before - self.triangles.len()
    }

    /// Joins corners at loose edges to others that are almost in the same place.
    fn weld(&mut self, loose: &[Loose]) -> usize {
        let tolerance = WELD_SHARE * self.diagonal();
        let mut rim: Vec<usize> = loose.iter().flat_map(|edge| edge.ends).collect();
        rim.sort_by(|a, b| self.corners[*a][0].total_cmp(&self.corners[*b][0]).then(a.cmp(b)));
        rim.dedup();
        let mut stands_for: Vec<usize> = (0..self.corners.len()).collect();
        let mut joined = 0;
        for (place, &here) in rim.iter().enumerate() {
            if stands_for[here] != here {
                continue;
            }
            for &there in &rim[place + 1..] {
                let away = minus(self.corners[there], self.corners[here]);
                if away[0] > tolerance {
                    break;
                }
                if stands_for[there] == there && dot(away, away) <= tolerance * tolerance {
                    stands_for[there] = here;
                    joined += 1;
                }
            }
        }
        for triangle in &mut self.triangles {
            *triangle = triangle.map(|corner| stands_for[corner]);
        }
        self.drop_degenerate();
        joined
    }

    fn turn(&mut self, _: &[Loose]) -> usize {
        orient::unite(&mut self.triangles, &self.corners).unwrap_or(0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::Corner;

    fn tetrahedron() -> Vec<Triangle> {
        let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]]
            .map(|face: [usize; 3]| face.map(|at| corners[at]))
            .to_vec()
    }

    #[test]
    fn a_closed_mesh_stays_as_it_is() {
        let Repaired { triangles, repairs, rest } = closed(tetrahedron()).unwrap();
        assert_eq!((triangles, repairs), (tetrahedron(), Vec::new()));
        assert!(rest.is_none());
    }

    #[test]
    fn a_triangle_given_twice_or_without_area_is_dropped_and_told() {
        let mut mesh = tetrahedron();
        mesh.push(mesh[1]);
        mesh.push([mesh[0][0], mesh[0][1], mesh[0][1]]);
        let Repaired { triangles: found, repairs, .. } = closed(mesh).unwrap();
        assert_eq!((found.len(), repairs), (4, vec![Repair::Degenerate(1), Repair::Duplicate(1)]));
    }

    #[test]
    fn corners_written_with_rounding_are_joined() {
        let mut mesh = tetrahedron();
        mesh[2][0][0] += 1e-6;
        mesh[3][2][2] -= 2e-6;
        assert_eq!(closed(mesh.clone()).unwrap().repairs, [Repair::Welded(2)]);
        mesh[2][0][0] += 1e-3;
        assert_eq!(closed(mesh).unwrap().rest.unwrap().edges, 4);
    }

    #[test]
    fn a_hole_is_closed_when_it_is_small_and_stays_when_it_is_not() {
        let mut mesh = tetrahedron();
        let [a, b, c] = mesh.remove(0);
        let told = closed(mesh.clone()).unwrap().rest.unwrap().refusal.to_string();
        assert!(told.starts_with("the mesh is not closed: 3 open edges"), "{told}");
        // Around a small triangular hole in the middle of that side.
        let middle = [0.3, 0.3, 0.0];
        let near = |p: Corner| [0, 1, 2].map(|axis| middle[axis] + 0.05 * (p[axis] - middle[axis]));
        for (from, to) in [(a, b), (b, c), (c, a)] {
            mesh.push([from, to, near(to)]);
            mesh.push([from, near(to), near(from)]);
        }
        let Repaired { triangles: found, repairs, .. } = closed(mesh).unwrap();
        assert_eq!(repairs, [Repair::Closed { holes: 1, edges: 3 }]);
        assert!(Indexed::new(&found).loose().is_empty());
    }

    #[test]
    fn a_coordinate_that_is_no_number_is_refused_with_its_triangle() {
        let mut mesh = tetrahedron();
        mesh[2][1][0] = f64::NAN;
        assert!(matches!(closed(mesh), Err(ModelProblem::NotFinite { triangle: 2 })));
    }
}
