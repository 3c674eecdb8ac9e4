//! The test that a mesh is closed, and the repairs that cannot change what it bounds at the scale of a voxel.

use super::winding::{self, Hole, Open};
use super::{Corner, Triangle, area, cross, dot, minus, orient};
use crate::readers::ModelProblem;
use std::collections::{BTreeMap, HashMap};
use std::fmt;

/// Corners closer than this share of the box's diagonal are one corner written twice: files with six digits round so far.
const WELD_SHARE: f64 = 1e-5;

/// A hole is closed unasked when its corners are so near to one plane, as a share of the box's diagonal ...
const FLAT_SHARE: f64 = 0.01;

/// ... and its patch has at most this share of the mesh's area.
const HOLE_SHARE: f64 = 0.01;

/// What was changed to make a model of a mesh.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Repair {
    /// Triangles with two corners in one place.
    Degenerate(usize),
    /// Triangles that were there before.
    Duplicate(usize),
    /// Corners that were moved onto their neighbours.
    Welded(usize),
    /// Triangles that were inside out against their neighbours.
    Turned(usize),
    /// Open edges that stay: inside is what the mesh winds round more than half.
    Wound {
        /// How many.
        edges: usize,
        /// Voxels whose winding number is between a quarter and three quarters, in percent of those inside, rounded up.
        unsure_percent: usize,
    },
    /// Small flat holes.
    Closed {
        /// How many.
        holes: usize,
        /// The open edges around them.
        edges: usize,
    },
    /// Cavities that can't be seen from outside.
    Filled {
        /// How many.
        cavities: usize,
        /// The voxels in them.
        voxels: usize,
    },
    /// Parts without a voxel's centre inside, which would be missing.
    Thickened {
        /// The voxels put there.
        voxels: usize,
    },
    /// Pieces that hang together by parts thinner than a voxel.
    Joined {
        /// How many.
        pieces: usize,
        /// The voxels put between them.
        voxels: usize,
    },
    /// Voxels put or taken to come to a number of panels.
    Edited {
        /// How many.
        voxels: usize,
        /// The panels before.
        panels: usize,
    },
    /// Crumbs off the solid.
    Dropped {
        /// How many.
        pieces: usize,
        /// The voxels in them.
        voxels: usize,
    },
}

impl fmt::Display for Repair {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Degenerate(count) => write!(f, "dropped {count} triangles without area"),
            Self::Duplicate(count) => write!(f, "dropped {count} triangles that were there before"),
            Self::Welded(count) => write!(f, "joined {count} corners to others in almost the same place"),
            Self::Turned(count) => {
                write!(f, "turned over {count} triangles that were inside out against their neighbours")
            }
            Self::Wound { edges, unsure_percent } => write!(
                f,
                "left {edges} open edges and took for inside what the mesh winds round more than half; \
                 {unsure_percent} % of the voxels could as well be outside"
            ),
            Self::Closed { holes, edges } => write!(f, "closed {holes} small holes of {edges} edges in all"),
            Self::Filled { cavities, voxels } => {
                write!(f, "filled {cavities} cavities ({voxels} voxels) that can't be seen from outside")
            }
            Self::Thickened { voxels } => {
                write!(f, "put {voxels} voxels where parts of the mesh are too thin for a voxel's centre")
            }
            Self::Joined { pieces, voxels } => {
                write!(f, "joined {pieces} pieces by {voxels} voxels where the mesh is thinner than a voxel")
            }
            Self::Edited { voxels, panels } => {
                write!(
                    f,
                    "put or took {voxels} voxels at the surface of {panels} panels to come to the number asked for"
                )
            }
            Self::Dropped { pieces, voxels } => {
                write!(f, "dropped {pieces} crumbs ({voxels} voxels) that hang on nothing")
            }
        }
    }
}

/// A mesh by numbers of corners.
struct Indexed {
    corners: Vec<Corner>,
    triangles: Vec<[usize; 3]>,
}

/// An edge that isn't passed as often one way as the other: it runs as the triangles that are too many pass it.
struct Loose {
    ends: [usize; 2],
    /// By how many.
    excess: usize,
    /// In how many triangles it is.
    triangles: usize,
}

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
        let mut changed = Indexed { corners: mesh.corners.clone(), triangles: mesh.triangles.clone() };
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
    /// Gives one number to corners in one place.
    fn new(triangles: &[Triangle]) -> Self {
        let mut numbers: HashMap<[u64; 3], usize> = HashMap::new();
        let mut mesh = Self { corners: Vec::new(), triangles: Vec::with_capacity(triangles.len()) };
        for triangle in triangles {
            mesh.triangles.push(triangle.map(|corner| {
                // Adding 0 makes +0 of -0, so that equal corners have equal bits.
                let corner = corner.map(|c| c + 0.0);
                *numbers.entry(corner.map(f64::to_bits)).or_insert_with(|| {
                    mesh.corners.push(corner);
                    mesh.corners.len() - 1
                })
            }));
        }
        mesh
    }

    fn at(&self, triangle: &[usize; 3]) -> Triangle {
        triangle.map(|number| self.corners[number])
    }

    /// Where two corners coincide, the edges cancel each other. Three corners in a row are kept: their neighbours need them.
    fn drop_degenerate(&mut self) -> usize {
        let before = self.triangles.len();
        self.triangles.retain(|[a, b, c]| a != b && b != c && c != a);
        before - self.triangles.len()
    }

    fn loose(&self) -> Vec<Loose> {
        let mut passes: Vec<([usize; 2], bool)> = Vec::with_capacity(3 * self.triangles.len());
        for triangle in &self.triangles {
            for side in 0..3 {
                let (from, to) = (triangle[side], triangle[(side + 1) % 3]);
                passes.push(([from.min(to), from.max(to)], from < to));
            }
        }
        passes.sort_unstable();
        let mut loose = Vec::new();
        for passes in passes.chunk_by(|a, b| a.0 == b.0) {
            let [low, high] = passes[0].0;
            let there = passes.iter().filter(|(_, upwards)| *upwards).count();
            let back = passes.len() - there;
            if there != back {
                let ends = if there > back { [low, high] } else { [high, low] };
                loose.push(Loose { ends, excess: there.abs_diff(back), triangles: passes.len() });
            }
        }
        loose
    }

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

    /// A patch for each hole, or nothing if any isn't small, flat and on its own.
    fn patches(&self, loose: &[Loose]) -> Option<Vec<Vec<[usize; 3]>>> {
        let mut next: BTreeMap<usize, usize> = BTreeMap::new();
        for edge in loose {
            // Two edges away from one corner could be paired in two ways.
            if edge.excess != 1 || edge.triangles != 1 || next.insert(edge.ends[0], edge.ends[1]).is_some() {
                return None;
            }
        }
        let total: f64 = self.triangles.iter().map(|triangle| area(&self.at(triangle))).sum();
        let mut patches = Vec::new();
        while let Some((start, mut corner)) = next.pop_first() {
            let mut rim = vec![start];
            while corner != start {
                rim.push(corner);
                corner = next.remove(&corner)?;
            }
            // The patch runs against the triangles at the rim. Flat, it winds rightly whatever the shape of the hole.
            let patch: Vec<[usize; 3]> = rim[1..].windows(2).map(|pair| [start, pair[1], pair[0]]).collect();
            let patch_area: f64 = patch.iter().map(|triangle| area(&self.at(triangle))).sum();
            if patch_area > HOLE_SHARE * total || !self.is_flat(&rim) {
                return None;
            }
            patches.push(patch);
        }
        Some(patches)
    }

    fn is_flat(&self, rim: &[usize]) -> bool {
        let at = |place: usize| self.corners[rim[place % rim.len()]];
        let mut normal = [0.0; 3];
        for place in 0..rim.len() {
            let part = cross(minus(at(place), at(0)), minus(at(place + 1), at(0)));
            normal = [0, 1, 2].map(|axis| normal[axis] + part[axis]);
        }
        let length = dot(normal, normal).sqrt();
        let tolerance = FLAT_SHARE * self.diagonal();
        rim.len() == 3
            || (0..rim.len()).all(|place| dot(minus(at(place), at(0)), normal).abs() <= tolerance * length)
    }

    fn diagonal(&self) -> f64 {
        let side = |axis: usize| {
            let all = || self.corners.iter().map(|corner| corner[axis]);
            all().fold(f64::NEG_INFINITY, f64::max) - all().fold(f64::INFINITY, f64::min)
        };
        dot([side(0), side(1), side(2)], [side(0), side(1), side(2)]).sqrt()
    }

    fn not_closed(&self, loose: &[Loose]) -> ModelProblem {
        let open = loose.iter().filter(|edge| edge.triangles == 1).count();
        let place = |edge: &Loose| {
            let [a, b] = edge.ends.map(|end| self.corners[end]);
            if a.partial_cmp(&b).is_none_or(std::cmp::Ordering::is_le) { [a, b] } else { [b, a] }
        };
        let first = loose.iter().map(place).reduce(|a, b| if b < a { b } else { a }).unwrap_or_default();
        let [from, to] = first.map(|[x, y, z]| format!("({x}, {y}, {z})"));
        ModelProblem::NotClosed { open, unlike: loose.len() - open, from, to }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

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
