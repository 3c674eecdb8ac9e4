//! Triangle meshes and the voxels that stand for them: repair, filling, one piece, number of panels, distance. The readers
//! call it.

mod closed;
mod distance;
mod edit;
mod fill;
mod indexed;
mod nearest;
mod one_piece;
mod orient;
mod panels;
mod patch;
mod repair;
mod simple;
mod thin;
mod winding;

pub use distance::Distance;
pub use repair::Repair;

use crate::readers::{ModelProblem, Resolution};
use crate::square::{Point, Quad};
use crate::voxels::Voxels;
use closed::{Repaired, Rest};
use fill::Filled;
use nearest::{Facet, Nearest};
use winding::Hole;

/// A corner, in units of the mesh.
pub(crate) type Corner = [f64; 3];

/// Three corners, counter-clockwise from outside.
pub(crate) type Triangle = [Corner; 3];

/// Of a mesh with open edges, voxels that may as well be on the other side are at most this share of those inside.
const UNSURE_SHARE: f64 = 0.12;

/// That share is judged with so many voxels along the longest side of the box, whatever the size asked for.
const JUDGED_AT: f64 = 24.0;

/// A mesh without a voxel's centre inside is thickened when its box has a side of at least so many voxels.
const LEAST_THIN: f64 = 2.0;

/// A mesh that bounds a solid, and what was done to it so far.
pub(crate) struct Mesh {
    triangles: Vec<Triangle>,
    /// The least corner of the mesh's box.
    least: Corner,
    /// The sides of the box.
    extent: Corner,
    nearest: Nearest<Facet>,
    repairs: Vec<Repair>,
    /// Edges that stay open, and the holes that they surround.
    open_edges: usize,
    holes: Vec<Hole>,
}

/// A mesh as voxels.
pub(crate) struct Solid {
    pub(crate) voxels: Voxels,
    /// Edge of a voxel, in units of the mesh.
    pub(crate) voxel_size: f64,
    pub(crate) repairs: Vec<Repair>,
}

impl Solid {
    /// Whether a point is in a solid voxel; the point is given in voxels from the least corner of the mesh's box.
    fn holds(&self, point: Corner) -> bool {
        #[expect(clippy::cast_possible_truncation, reason = "within the box, whose sides are small numbers")]
        let voxel = point.map(|c| c.floor() as i32);
        self.voxels.solid(self.voxels.number(voxel))
    }
}

impl Mesh {
    /// Takes the triangles of a mesh, repaired where that is safe.
    ///
    /// # Errors
    /// Coordinates that are no numbers, a mesh that is not closed and doesn't tell inside from outside.
    pub(crate) fn new(triangles: Vec<Triangle>) -> Result<Self, ModelProblem> {
        let Repaired { triangles, repairs, rest } = closed::closed(triangles)?;
        let all = |axis: usize| triangles.iter().flatten().map(move |corner| corner[axis]);
        let least = [0, 1, 2].map(|axis| all(axis).fold(f64::INFINITY, f64::min));
        let extent = [0, 1, 2].map(|axis| all(axis).fold(f64::NEG_INFINITY, f64::max) - least[axis]);
        let nearest = Nearest::new(triangles.iter().copied().map(Facet).collect());
        let mut mesh = Self { triangles, least, extent, nearest, repairs, open_edges: 0, holes: Vec::new() };
        if let Some(Rest { edges, holes, refusal }) = rest {
            (mesh.open_edges, mesh.holes) = (edges, holes);
            match fill::fill(&mesh, mesh.longest() / JUDGED_AT) {
                Ok(filled) if !filled.voxels.any() => return Err(refusal),
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
    pub(crate) fn distance_of(&self, solid: &Solid, panels: &[Quad]) -> Distance {
        distance::measure(self, solid, panels)
    }

    /// The voxels of a given size, in one piece and without cavities.
    fn solid_of(&self, voxel_size: f64) -> Result<Solid, ModelProblem> {
        let Filled { voxels, unsure_share } = fill::fill(self, voxel_size)?;
        let mut repairs = self.repairs.clone();
        if !self.holes.is_empty() {
            repairs.push(Repair::Wound { edges: self.open_edges, unsure_percent: percent(unsure_share) });
        }
        let mut thick = voxels.clone();
        let put = thin::thicken(&mut thick, self, voxel_size);
        // What is smaller than two voxels all round is no shape at this size.
        let is_shape = voxels.any() || self.longest() >= LEAST_THIN * voxel_size;
        if put > 0
            && is_shape
            && let Ok(more) = one_piece::make(&mut thick, self, voxel_size)
        {
            repairs.push(Repair::Thickened { voxels: put });
            repairs.extend(more);
            return Ok(Solid { voxels: thick, voxel_size, repairs });
        }
        // Nothing is thin, or something thin hangs on nothing and can only be left out.
        let mut voxels = voxels;
        if !voxels.any() {
            let [x, y, z] = self.extent;
            return Err(ModelProblem::TooCoarse { size: voxel_size, bounds: format!("{x} x {y} x {z}") });
        }
        repairs.extend(one_piece::make(&mut voxels, self, voxel_size)?);
        Ok(Solid { voxels, voxel_size, repairs })
    }

    /// How far a point is from the mesh, in voxels; the point is given in voxels too, from the corner of the mesh's box.
    fn distance(&self, point: [f64; 3], voxel_size: f64) -> f64 {
        let point = [0, 1, 2].map(|axis| self.least[axis] + point[axis] * voxel_size);
        self.nearest.distance(point) / voxel_size
    }

    /// The triangles in voxels from the least corner of the mesh's box.
    fn in_voxels(&self, voxel_size: f64) -> impl Iterator<Item = Triangle> {
        self.triangles.iter().map(move |triangle| {
            triangle.map(|corner| [0, 1, 2].map(|axis| (corner[axis] - self.least[axis]) / voxel_size))
        })
    }

    /// Whether the mesh winds round a point, given in units of the mesh.
    fn is_inside(&self, point: Corner) -> bool {
        // A row from the point to beyond the box meets few of the triangles.
        let end = self.least[0] + 2.0 * self.extent[0] + 1.0;
        let row = self.nearest.along([point, [end, point[1], point[2]]]);
        let cones = self.holes.iter().flat_map(|hole| &hole.cone);
        let winding: i32 = row.chain(cones).map(|corners| fill::passed_beyond(corners, point)).sum();
        let open = winding::share_of(&self.holes, point);
        (f64::from(winding) - open).abs() > fill::INSIDE
    }

    /// The middle of a voxel, as a message says it.
    fn place_of(&self, voxel: Point, voxel_size: f64) -> String {
        let at = |axis: usize| self.least[axis] + (f64::from(voxel[axis]) + 0.5) * voxel_size;
        let [x, y, z] = [0, 1, 2].map(|axis| distance::rounded_at(at(axis), voxel_size));
        format!("({x}, {y}, {z})")
    }

    /// The longest side of the box.
    fn longest(&self) -> f64 {
        self.extent.into_iter().fold(0.0, f64::max)
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

/// The direction in which a triangle looks, of length 1; none has one without an area.
fn normal(&[a, b, c]: &Triangle) -> Option<Corner> {
    let normal = cross(minus(b, a), minus(c, a));
    let length = dot(normal, normal).sqrt();
    (length > 0.0).then(|| normal.map(|c| c / length))
}

/// The area of a triangle.
fn area(&[a, b, c]: &Triangle) -> f64 {
    let normal = cross(minus(b, a), minus(c, a));
    dot(normal, normal).sqrt() / 2.0
}
