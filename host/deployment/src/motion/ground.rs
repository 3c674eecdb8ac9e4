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
            let stands = || {
                cores.iter().all(|core| plane.above(place_from_target.transform_point3(*core)) >= -TOUCHING)
            };
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::motion::{Effort, Options, check, free_plan};
    use crate::testing::real_plans;
    use std::path::Path;
    use zygote_stacking::{Bridges, Model, Request, Surface};

    fn model(name: &str) -> Model {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("../../models/{name}.txt"));
        Model::read(&path, None).expect("a model")
    }

    const UPSIDE_DOWN: Ground = Ground { normal: DVec3::NEG_Z };

    #[test]
    fn no_closed_shape_stands_on_the_bottom_of_its_stack() {
        // Panels at the bottom have their outer sides up, so the shape is below them.
        for plan in real_plans() {
            for thickness in [Thickness::ideal(&plan), Thickness::of(&plan)] {
                let roots = Ground::TABLE.roots(&plan, thickness).expect("plates");
                assert!(roots.is_empty(), "{}: {roots:?}", plan.source.model);
            }
        }
    }

    #[test]
    fn an_odd_stack_on_its_head_stands_on_its_top_layer() {
        let mut some = 0;
        for (name, piles) in [("l14", 1), ("l14", 2), ("fish92", 2), ("fish92", 4)] {
            let request = Request { piles, bridges: Bridges::Base, ..Request::default() };
            let plan = zygote_stacking::plan(&model(name), &request).expect("a plan");
            let roots = UPSIDE_DOWN.roots(&plan, Thickness::ideal(&plan)).expect("plates");
            let tops: Vec<_> = plan.piles.iter().filter_map(|pile| pile.panels.last().copied()).collect();
            assert!(roots.iter().all(|root| tops.contains(root)), "{name}");
            assert!(plan.height() % 2 == 1 || roots.is_empty(), "{name}");
            some += roots.len();
        }
        assert!(some > 0);
    }

    #[test]
    fn a_sheet_stands_on_a_table_by_the_bottom_of_its_stack() {
        let quads = (0..4).map(|x| [[x, 0, 0], [x + 1, 0, 0], [x + 1, 1, 0], [x, 1, 0]]).collect();
        let model =
            Model::new("row", Surface::new(quads, Vec::new()).expect("a surface")).expect("one piece");
        let plan = zygote_stacking::plan(&model, &Request::default()).expect("a plan");
        let roots = Ground::TABLE.roots(&plan, Thickness::of(&plan)).expect("plates");
        assert_eq!(roots, [plan.piles[0].panels[0]]);
    }

    #[test]
    fn whatever_root_is_left_out_meets_the_ground() {
        for plan in real_plans() {
            let thickness = Thickness::ideal(&plan);
            for normal in [DVec3::X, DVec3::NEG_Y, DVec3::NEG_Z, DVec3::Z] {
                let ground = Ground { normal };
                let roots = ground.roots(&plan, thickness).expect("plates");
                for root in (0..plan.panels()).filter(|root| !roots.contains(root)) {
                    let plan = Plan { root, ..plan.clone() };
                    let tree = crate::tree::Tree::new(&plan).expect("a tree");
                    let order: Vec<_> = tree.branches().iter().map(|branch| branch.hinge).collect();
                    let report = check(&plan, &order, thickness, &Options { ground: Some(ground) });
                    assert!(!report.expect("plates").is_free(), "{} {root} {normal}", plan.source.model);
                }
            }
        }
    }

    #[test]
    fn a_plan_is_found_that_opens_above_a_wall_and_above_the_table_of_a_stack_on_its_head() {
        let request = Request { piles: 2, bridges: Bridges::Base, ..Request::default() };
        for normal in [DVec3::NEG_X, DVec3::NEG_Z] {
            let ground = Some(Ground { normal });
            let plates = crate::motion::Plates::Ideal;
            let free = free_plan(&model("l14"), &request, plates, ground, 5, &mut |_, _| {}).expect("a plan");
            assert_eq!((free.found.blocked, free.found.root), (0, free.plan.root));
            let thickness = Thickness::ideal(&free.plan);
            let report =
                check(&free.plan, &free.found.hinges, thickness, &Options { ground }).expect("plates");
            assert!(report.is_free(), "{:?}", report.collisions.first());
        }
    }

    #[test]
    fn without_a_root_that_stands_the_search_still_tells_the_least_bad_order() {
        let plan = &real_plans()[1];
        let effort = Effort { other_roots: 3, backward: 1, looks: 100 };
        let thickness = Thickness::ideal(plan);
        let found = super::super::search(plan, thickness, Some(Ground::TABLE), &effort, &mut |_, _| {})
            .expect("plates");
        assert!(found.blocked > 0 && found.hinges.len() == plan.hinges.len());
        assert_eq!(found.root, plan.root);
    }
}
