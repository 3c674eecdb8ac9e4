//! Closed triangle meshes and the voxels that stand for them: repair, filling, one piece, distance. The readers call it.

mod fill;
mod nearest;
mod one_piece;
mod repair;

pub use repair::Repair;

use crate::readers::ModelProblem;
use crate::voxels::Voxels;
use nearest::{Facet, Nearest};

/// A corner, in units of the mesh.
pub(crate) type Corner = [f64; 3];

/// Three corners, counter-clockwise from outside.
pub(crate) type Triangle = [Corner; 3];

/// A closed mesh, and what was done to it so far.
pub(crate) struct Mesh {
    triangles: Vec<Triangle>,
    /// The least corner of the mesh's box.
    least: Corner,
    /// The sides of the box.
    extent: Corner,
    nearest: Nearest<Facet>,
    repairs: Vec<Repair>,
}

/// A mesh as voxels.
pub(crate) struct Solid {
    pub(crate) voxels: Voxels,
    /// Edge of a voxel, in units of the mesh.
    pub(crate) voxel_size: f64,
    pub(crate) repairs: Vec<Repair>,
}

impl Mesh {
    /// Takes the triangles of a mesh, repaired where that is safe.
    ///
    /// # Errors
    /// Coordinates that are no numbers, a mesh that is not closed.
    pub(crate) fn new(triangles: Vec<Triangle>) -> Result<Self, ModelProblem> {
        let (triangles, repairs) = repair::closed(triangles)?;
        let all = |axis: usize| triangles.iter().flatten().map(move |corner| corner[axis]);
        let least = [0, 1, 2].map(|axis| all(axis).fold(f64::INFINITY, f64::min));
        let extent = [0, 1, 2].map(|axis| all(axis).fold(f64::NEG_INFINITY, f64::max) - least[axis]);
        let nearest = Nearest::new(triangles.iter().copied().map(Facet).collect());
        Ok(Self { triangles, least, extent, nearest, repairs })
    }

    /// The voxels of a given size, in one piece and without cavities; the first one in the least corner of the mesh's box.
    ///
    /// # Errors
    /// A size that is no length, more voxels than fit, no centre inside, pieces that are no crumbs.
    pub(crate) fn solid(&self, voxel_size: f64) -> Result<Solid, ModelProblem> {
        let mut voxels = fill::fill(self, voxel_size)?;
        let mut repairs = self.repairs.clone();
        repairs.extend(one_piece::make(&mut voxels, self, voxel_size)?);
        Ok(Solid { voxels, voxel_size, repairs })
    }

    /// How far a point is from the mesh, in voxels; the point is given in voxels too, from the corner of the mesh's box.
    fn distance(&self, point: [f64; 3], voxel_size: f64) -> f64 {
        let point = [0, 1, 2].map(|axis| self.least[axis] + point[axis] * voxel_size);
        self.nearest.distance(point) / voxel_size
    }
}

/// The vector from one corner to another.
fn minus(to: Corner, from: Corner) -> Corner {
    [0, 1, 2].map(|axis| to[axis] - from[axis])
}

fn cross(u: Corner, v: Corner) -> Corner {
    [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]
}

fn dot(u: Corner, v: Corner) -> f64 {
    u[0] * v[0] + u[1] * v[1] + u[2] * v[2]
}

/// The area of a triangle.
fn area(&[a, b, c]: &Triangle) -> f64 {
    let normal = cross(minus(b, a), minus(c, a));
    dot(normal, normal).sqrt() / 2.0
}
