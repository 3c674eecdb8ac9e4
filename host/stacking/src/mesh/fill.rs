//! Voxels of a closed triangle mesh: a voxel is solid when the mesh winds round its centre.
//!
//! Along every row of centres the crossings with the mesh are counted with their direction. Whether a row crosses a
//! triangle is decided edge by edge, for both triangles at an edge by the same arithmetic on the same numbers: so no row
//! slips between two triangles, wherever it runs, and shells that overlap make one solid.

use super::winding::{self, Hole};
use super::{Corner, Mesh, Triangle};
use crate::readers::{ModelProblem, VOXEL_LIMIT};
use crate::voxels::Voxels;

/// Empty layers around the box: the solid may grow by one and still have an empty one around it.
const MARGIN: i32 = 2;

/// The rows of centres: all numbers in units of voxels, centres at whole numbers and a half.
struct Rows {
    sides: [usize; 3],
    /// For every voxel, by how much the winding number rises from the voxel before it in its row.
    rise: Vec<i32>,
}

/// A winding number above this is inside, as its amount: an inside-out mesh bounds the same solid.
pub(super) const INSIDE: f64 = 0.5;

/// A winding number that is so near to the limit decides nothing for sure.
const UNSURE: f64 = 0.25;

/// Voxels whose centres are inside, maybe none.
pub(super) struct Filled {
    pub(super) voxels: Voxels,
    /// Of a mesh with open edges: voxels whose centre may as well be on the other side, over voxels inside.
    pub(super) unsure_share: f64,
}

/// Fills the mesh with voxels of a given edge, the first one in the least corner of the mesh's box.
///
/// # Errors
/// A size that is no length, more voxels than fit.
pub(super) fn fill(mesh: &Mesh, size: f64) -> Result<Filled, ModelProblem> {
    if !(size.is_finite() && size > 0.0) {
        return Err(ModelProblem::VoxelSize { size });
    }
    let Mesh { triangles, least, extent, holes, .. } = mesh;
    let mut rows = Rows::new(extent.map(|length| length / size)).map_err(|found| ModelProblem::TooFine {
        size,
        found,
        limit: VOXEL_LIMIT as u128,
    })?;
    let cones = holes.iter().flat_map(|hole| &hole.cone);
    for corners in triangles.iter().chain(cones) {
        rows.cross(corners.map(|corner| [0, 1, 2].map(|axis| (corner[axis] - least[axis]) / size)));
    }
    let at = |centre: Corner| [0, 1, 2].map(|axis| least[axis] + centre[axis] * size);
    let Filled { voxels, unsure_share } = rows.filled(holes, at);
    Ok(Filled { voxels: voxels.padded(MARGIN), unsure_share })
}

/// How many whole numbers and a half lie below a length, so how many centres come before it; at most `limit`.
fn centres_before(length: f64, limit: usize) -> usize {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped to the limit first")]
    let count = (length - 0.5).ceil().clamp(0.0, limit as f64) as usize;
    count
}

impl Rows {
    /// On failure gives the number of voxels, where they are too many.
    fn new(extent: [f64; 3]) -> Result<Self, u128> {
        let sides = extent.map(|length| centres_before(length.ceil().max(1.0), VOXEL_LIMIT + 1));
        let found = sides.iter().map(|side| *side as u128).product();
        if found > VOXEL_LIMIT as u128 {
            return Err(found);
        }
        Ok(Self { sides, rise: vec![0; sides.iter().product()] })
    }

    /// Counts the crossings of one triangle with all rows.
    fn cross(&mut self, corners: Triangle) {
        let range = |axis: usize| {
            let low = corners.iter().map(|corner| corner[axis]).fold(f64::INFINITY, f64::min);
            let high = corners.iter().map(|corner| corner[axis]).fold(f64::NEG_INFINITY, f64::max);
            (low, high)
        };
        let (low_x, high_x) = range(0);
        let (low_y, high_y) = range(1);
        let (low_z, high_z) = range(2);
        let [width, depth, height] = self.sides;
        for k in centres_before(low_z, height)..centres_before(high_z, height) {
            for j in centres_before(low_y, depth)..centres_before(high_y, depth) {
                let (y, z) = (j as f64 + 0.5, k as f64 + 0.5);
                let winding: i32 = (0..3).map(|i| passes(&corners[i], &corners[(i + 1) % 3], y, z)).sum();
                if winding != 0 {
                    let x = crossing_x(&corners, y, z).clamp(low_x, high_x);
                    let i = centres_before(x, width);
                    if i < width {
                        self.rise[(k * depth + j) * width + i] += winding;
                    }
                }
            }
        }
    }

    /// The voxels that the mesh winds round. Cones over the holes were counted with it, and their share is taken off again;
    /// `at` says where a centre is in the mesh.
    fn filled(mut self, holes: &[Hole], at: impl Fn(Corner) -> Corner) -> Filled {
        let [width, depth, _] = self.sides;
        for row in self.rise.chunks_mut(width) {
            let mut winding = 0;
            for rise in row {
                winding += *rise;
                *rise = winding;
            }
        }
        let sides = self.sides.map(|side| i32::try_from(side).unwrap_or(i32::MAX));
        if holes.is_empty() {
            let solid = self.rise.iter().map(|winding| *winding != 0).collect();
            return Filled { voxels: Voxels::new(sides, solid), unsure_share: 0.0 };
        }
        let (mut inside, mut unsure) = (0_usize, 0_usize);
        let solid = self.rise.iter().enumerate().map(|(number, rise)| {
            let centre =
                [number % width, number / width % depth, number / width / depth].map(|c| c as f64 + 0.5);
            // On the way in along a row the count falls.
            let winding = (-f64::from(*rise) - winding::share_of(holes, at(centre))).abs();
            unsure += usize::from((winding - INSIDE).abs() < UNSURE);
            inside += usize::from(winding > INSIDE);
            winding > INSIDE
        });
        let voxels = Voxels::new(sides, solid.collect());
        Filled { voxels, unsure_share: unsure as f64 / inside.max(1) as f64 }
    }
}

/// Whether an edge passes the ray from (y, z) towards +y: 1 upwards in z, -1 downwards, else 0.
fn passes(from: &Corner, to: &Corner, y: f64, z: f64) -> i32 {
    let upwards = match (from[2] <= z, to[2] <= z) {
        (true, false) => true,
        (false, true) => false,
        (true, true) | (false, false) => return 0,
    };
    // Always from the lower end to the upper one: the neighbour, which passes the edge the other way, computes the same.
    let (low, high) = if upwards { (from, to) } else { (to, from) };
    let beyond = low[1] + (z - low[2]) / (high[2] - low[2]) * (high[1] - low[1]) > y;
    match (beyond, upwards) {
        (true, true) => 1,
        (true, false) => -1,
        (false, _) => 0,
    }
}

/// Whether the row from a point towards +x passes a triangle: 1 on the way out, -1 on the way in, else 0.
pub(super) fn passed_beyond(corners: &Triangle, [x, y, z]: Corner) -> i32 {
    let winding: i32 = (0..3).map(|i| passes(&corners[i], &corners[(i + 1) % 3], y, z)).sum();
    if winding != 0 && crossing_x(corners, y, z) > x { winding } else { 0 }
}

/// Where the row at (y, z) meets the plane of a triangle.
fn crossing_x(corners: &Triangle, y: f64, z: f64) -> f64 {
    let [a, b, c] = corners;
    let u = [0, 1, 2].map(|axis| b[axis] - a[axis]);
    let v = [0, 1, 2].map(|axis| c[axis] - a[axis]);
    let area = u[1] * v[2] - u[2] * v[1];
    let (dy, dz) = (y - a[1], z - a[2]);
    let (s, t) = ((dy * v[2] - dz * v[1]) / area, (u[1] * dz - u[2] * dy) / area);
    let x = a[0] + s * u[0] + t * v[0];
    // A triangle seen on edge has no area; any of its own x will do, and its neighbours make up for it.
    if x.is_finite() { x } else { a[0] }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A box with its corners at `low` and `high`, outer side out, as triangles.
    fn cuboid(low: Corner, high: Corner) -> Vec<Triangle> {
        let unit = Voxels::new([1, 1, 1], vec![true]).boundary();
        let corner = |p: [i32; 3]| [0, 1, 2].map(|axis| if p[axis] == 0 { low[axis] } else { high[axis] });
        let split = |[a, b, c, d]: [[i32; 3]; 4]| [[a, b, c], [a, c, d]];
        unit.into_iter().flat_map(split).map(|triangle| triangle.map(corner)).collect()
    }

    fn fill(triangles: Vec<Triangle>, size: f64) -> Result<Voxels, ModelProblem> {
        Ok(super::fill(&Mesh::new(triangles)?, size)?.voxels)
    }

    #[test]
    fn a_box_fills_with_as_many_voxels_as_it_is_large() {
        let voxels = fill(cuboid([-1.0, 2.0, 0.0], [5.0, 6.0, 2.0]), 2.0).unwrap();
        assert_eq!(voxels.boundary().len(), 2 * (3 * 2 + 2 + 3));
    }

    #[test]
    fn rows_that_run_along_diagonals_and_corners_neither_leak_nor_count_twice() {
        // Voxels of size 2 have their centres on the corners, edges and diagonals of smaller boxes.
        let mut mesh = cuboid([0.0; 3], [8.0; 3]);
        mesh.extend(cuboid([1.0; 3], [7.0; 3]));
        let voxels = fill(mesh.clone(), 2.0).unwrap();
        assert_eq!(voxels.boundary().len(), 6 * 16);
    }

    #[test]
    fn a_cavity_whose_shell_is_turned_inwards_stays_empty() {
        let mut mesh = cuboid([0.0; 3], [3.0; 3]);
        mesh.extend(cuboid([1.0; 3], [2.0; 3]).into_iter().map(|[a, b, c]| [a, c, b]));
        assert_eq!(fill(mesh.clone(), 1.0).unwrap().boundary().len(), 54 + 6);
    }

    #[test]
    fn sizes_that_are_no_lengths_or_too_fine_are_refused() {
        let mesh = cuboid([0.0; 3], [1.0; 3]);
        assert!(matches!(fill(mesh.clone(), 0.0), Err(ModelProblem::VoxelSize { .. })));
        assert!(matches!(fill(mesh.clone(), f64::NAN), Err(ModelProblem::VoxelSize { .. })));
        assert!(matches!(fill(mesh.clone(), 1e-9), Err(ModelProblem::TooFine { .. })));
    }
}
