//! Triangle meshes and the voxels that stand for them: repair, filling, one piece, number of panels, distance. The readers
//! call it.

mod distance;
mod edit;
mod fill;
mod nearest;
mod one_piece;
mod orient;
mod panels;
mod repair;
mod simple;
mod winding;

pub use distance::Distance;
pub use repair::Repair;

use crate::readers::{ModelProblem, Resolution};
use crate::square::Quad;
use crate::voxels::Voxels;
use fill::Filled;
use nearest::{Facet, Nearest};
use repair::{Repaired, Rest};

/// A corner, in units of the mesh.
pub(crate) type Corner = [f64; 3];

/// Three corners, counter-clockwise from outside.
pub(crate) type Triangle = [Corner; 3];

/// Of a mesh with open edges, voxels that may as well be on the other side are at most this share of those inside.
const UNSURE_SHARE: f64 = 0.1;

/// That share is judged with so many voxels along the longest side of the box, whatever the size asked for.
const JUDGED_AT: f64 = 40.0;

/// A mesh that bounds a solid, and what was done to it so far.
pub(crate) struct Mesh {
    triangles: Vec<Triangle>,
    /// The least corner of the mesh's box.
    least: Corner,
    /// The sides of the box.
    extent: Corner,
    nearest: Nearest<Facet>,
    repairs: Vec<Repair>,
    /// Edges that stay open, and cones that would close them.
    open_edges: usize,
    cones: Vec<Triangle>,
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
    /// Coordinates that are no numbers, a mesh that is not closed and doesn't tell inside from outside.
    pub(crate) fn new(triangles: Vec<Triangle>) -> Result<Self, ModelProblem> {
        let Repaired { triangles, repairs, rest } = repair::closed(triangles)?;
        let all = |axis: usize| triangles.iter().flatten().map(move |corner| corner[axis]);
        let least = [0, 1, 2].map(|axis| all(axis).fold(f64::INFINITY, f64::min));
        let extent = [0, 1, 2].map(|axis| all(axis).fold(f64::NEG_INFINITY, f64::max) - least[axis]);
        let nearest = Nearest::new(triangles.iter().copied().map(Facet).collect());
        let mut mesh = Self { triangles, least, extent, nearest, repairs, open_edges: 0, cones: Vec::new() };
        if let Some(Rest { edges, cones, refusal }) = rest {
            (mesh.open_edges, mesh.cones) = (edges, cones);
            let longest = extent.into_iter().fold(0.0, f64::max);
            match fill::fill(&mesh, longest / JUDGED_AT) {
                Ok(filled) if filled.unsure_share <= UNSURE_SHARE => {}
                Ok(filled) => {
                    let (percent, most) = (percent(filled.unsure_share), percent(UNSURE_SHARE));
                    return Err(ModelProblem::Undecided { open: Box::new(refusal), percent, most });
                }
                Err(_) => return Err(refusal),
            }
        }
        Ok(mesh)
    }

    /// The voxels of a solid at a given resolution; the box's first voxel is in the least corner of the mesh's box.
    ///
    /// # Errors
    /// A size that is no length, a number of panels that can't be, more voxels than fit, no centre inside, pieces that are
    /// no crumbs.
    pub(crate) fn solid(&self, resolution: Resolution) -> Result<Solid, ModelProblem> {
        match resolution {
            Resolution::Voxel(size) => self.solid_of(size),
            Resolution::Panels(wanted) => panels::solid(self, wanted),
        }
    }

    /// How far a surface of panels is from the mesh.
    pub(crate) fn distance_of(&self, panels: &[Quad], voxel_size: f64) -> Distance {
        distance::measure(self, panels, voxel_size)
    }

    /// The voxels of a given size, in one piece and without cavities.
    fn solid_of(&self, voxel_size: f64) -> Result<Solid, ModelProblem> {
        let Filled { mut voxels, unsure_share } = fill::fill(self, voxel_size)?;
        let mut repairs = self.repairs.clone();
        if self.open_edges > 0 {
            repairs.push(Repair::Wound { edges: self.open_edges, unsure_percent: percent(unsure_share) });
        }
        repairs.extend(one_piece::make(&mut voxels, self, voxel_size)?);
        Ok(Solid { voxels, voxel_size, repairs })
    }

    /// How far a point is from the mesh, in voxels; the point is given in voxels too, from the corner of the mesh's box.
    fn distance(&self, point: [f64; 3], voxel_size: f64) -> f64 {
        let point = [0, 1, 2].map(|axis| self.least[axis] + point[axis] * voxel_size);
        self.nearest.distance(point) / voxel_size
    }

    fn area(&self) -> f64 {
        self.triangles.iter().map(area).sum()
    }
}

/// A share in percent, rounded up.
fn percent(share: f64) -> usize {
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a share of voxels, not negative"
    )]
    let percent = (100.0 * share).ceil() as usize;
    percent
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
