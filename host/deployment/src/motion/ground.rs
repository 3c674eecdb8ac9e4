//! The **ground**: the plane across gravity that the stack lies on. The motion lets nothing pass it, [`crate::statics`] lets
//! the whole stand on it, and [`Ground::roots`] says which panels may stay fixed above it.

use super::linkage::Linkage;
use super::thickness::{MotionError, Thickness};
use super::turning::Body;
use super::{FINEST, TOUCHING};
use crate::rig::Gravity;
use glam::{DAffine3, DVec3};
use zygote_stacking::Plan;

/// A normal that is off the direction of the layers by less than this is along it.
const UPRIGHT: f64 = 1e-9;

/// A plane that touches the zygote and that nothing may pass: a table, a wall.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ground {
    /// From the ground to the free side, in the zygote's space; of any length above 0.
    pub normal: DVec3,
}

/// The ground where it is.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Plane {
    /// To the free side, a unit vector.
    pub(crate) normal: DVec3,
    /// Of every point of the plane, along the normal.
    pub(crate) offset: f64,
}

impl Ground {
    /// A table that the zygote lies on.
    pub const TABLE: Self = Self { normal: DVec3::Z };

    /// What the zygote lies on where gravity pulls that way.
    pub fn under(gravity: &Gravity) -> Self {
        // Not negated: a 0 must not become -0 in a certificate.
        Self { normal: DVec3::ZERO - DVec3::from_array(gravity.direction) }
    }

    /// The plane along the zygote's lowest points, seen against the normal; `zygote` has the poses of its panels.
    pub(crate) fn plane(self, linkage: &Linkage, zygote: &[DAffine3]) -> Result<Plane, MotionError> {
        let DVec3 { x, y, z } = self.normal;
        let normal = self.normal.try_normalize().ok_or(MotionError::Ground { x, y, z })?;
        let plates = zygote.iter().flat_map(|pose| corners(pose, linkage.thickness().thickness, 0.0));
        let offset = plates.map(|point| point.dot(normal)).fold(f64::INFINITY, f64::min);
        Ok(Plane { normal, offset })
    }

    /// The panels that may stay fixed on this ground, the nearest to it first; with any other root something meets it.
    ///
    /// With such a root all of the target is above the ground. Where the ground lies along the layers the root is the layer
    /// that lies on it: what is between would have to turn out from under the root, so into the ground or into the root.
    ///
    /// # Errors
    /// See [`Linkage::new`]; also a normal that is no direction.
    pub fn roots(self, plan: &Plan, thickness: Thickness) -> Result<Vec<usize>, MotionError> {
        let linkage = Linkage::new(plan, thickness)?;
        let zygote = linkage.poses_at(&[]);
        let target = linkage.poses_at(&vec![1.0; linkage.hinges()]);
        let plane = self.plane(&linkage, &zygote)?;
        let Thickness { thickness, rim } = linkage.thickness();
        let cores: Vec<_> = target.iter().flat_map(|pose| corners(pose, thickness, rim)).collect();
        let along_layers = plane.normal.truncate().length() < UPRIGHT;
        let mut roots = Vec::new();
        for root in 0..plan.panels() {
            let own = corners(&zygote[root], thickness, 0.0).map(|corner| plane.above(corner));
            let height = own.into_iter().fold(f64::INFINITY, f64::min);
            let place_from_target = zygote[root] * target[root].inverse();
            let stands = || cores.iter().all(|core| plane.above(place_from_target.transform_point3(*core)) >= -TOUCHING);
            if (!along_layers || height < thickness / 2.0) && stands() {
                roots.push((height, root));
            }
        }
        roots.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        Ok(roots.into_iter().map(|(_, root)| root).collect())
    }
}

/// The corners of a plate, less a border.
fn corners(pose: &DAffine3, thickness: f64, rim: f64) -> [DVec3; 8] {
    std::array::from_fn(|corner| {
        let at = |bit: usize| if corner >> bit & 1 == 0 { rim } else { 1.0 - rim };
        let z = if corner >> 2 & 1 == 0 { 0.0 } else { -thickness };
        pose.transform_point3(DVec3::new(at(0), at(1), z))
    })
}

impl Plane {
    /// How far above the ground a point is.
    pub(crate) fn above(&self, point: DVec3) -> f64 {
        point.dot(self.normal) - self.offset
    }

    /// The least angles at which a body gets below the plane.
    pub(super) fn conflict(&self, body: &Body) -> Option<[f64; 2]> {
        let below = |interval: &_| body.extent(self.normal, interval)[0] < self.offset - TOUCHING;
        let mut piece = body.quarters().into_iter().find(below)?;
        while body.travel(&piece) > FINEST {
            // Extents are exact, so one half or the other is below.
            let [early, late] = piece.halves();
            piece = if below(&early) { early } else { late };
        }
        Some([piece.from, piece.to])
    }
}
