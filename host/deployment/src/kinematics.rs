//! Where every panel is when the hinges stand anywhere between the zygote and the target, with the root fixed.

use crate::tree::{Tree, TreeError};
use glam::{DAffine3, DMat3, DQuat, DVec3};
use zygote_stacking::Plan;

/// The motion of a plan's panels.
#[derive(Debug, Clone)]
pub struct Kinematics {
    /// Panel frame to the zygote's space, for the root.
    root: usize,
    zygote_from_panel: Vec<DAffine3>,
    joints: Vec<Joint>,
    corners: Vec<[DVec3; 4]>,
    target_from_zygote: DAffine3,
}

/// A hinge as a joint from the panel nearer to the root to the one that it moves.
#[derive(Debug, Clone)]
pub(crate) struct Joint {
    pub(crate) hinge: usize,
    pub(crate) parent: usize,
    pub(crate) child: usize,
    /// Where the child is in the parent's frame, in the zygote.
    parent_from_child: DAffine3,
    /// A corner on the hinge, in the parent's frame.
    anchor: DVec3,
    /// Direction of the hinge, in the parent's frame: the parent lies on its left, seen from outside.
    axis: DVec3,
    /// Turn about the axis from the zygote to the target, radians.
    pub(crate) turn: f64,
    /// Heights of the child above the parent in their pile, along the parent's outer normal.
    pub(crate) lift: f64,
}

impl Joint {
    /// A point of the axis, in the parent's frame.
    pub(crate) fn anchor(&self) -> DVec3 {
        self.anchor
    }

    /// The axis, of length 1, in the parent's frame.
    pub(crate) fn axis(&self) -> DVec3 {
        self.axis.normalize()
    }

    /// The child's frame in the parent's, with the hinge at a fraction of its turn and such a thickness.
    pub(crate) fn parent_from_child(&self, fraction: f64, thickness: f64) -> DAffine3 {
        let turn = DQuat::from_axis_angle(self.axis(), self.turn * fraction);
        let lift = DVec3::Z * (self.lift * thickness * (1.0 - fraction));
        DAffine3::from_translation(self.anchor)
            * DAffine3::from_quat(turn)
            * DAffine3::from_translation(lift - self.anchor)
            * self.parent_from_child
    }
}

/// The frame of a panel: origin at corner 0, x along its first edge, z to its outer side.
pub(crate) fn frame(corners: &[DVec3; 4]) -> DAffine3 {
    let x = corners[1] - corners[0];
    let y = corners[3] - corners[0];
    DAffine3::from_mat3_translation(DMat3::from_cols(x, y, x.cross(y)), corners[0])
}

/// The corners of a panel in a space.
fn corners_at(pose: &DAffine3, corners: &[DVec3; 4]) -> [DVec3; 4] {
    corners.map(|corner| pose.transform_point3(corner))
}

impl Kinematics {
    /// The kinematics of a plan.
    ///
    /// # Errors
    /// [`TreeError`] if the hinges of the plan aren't a tree of all its panels.
    pub fn new(plan: &Plan) -> Result<Self, TreeError> {
        let tree = Tree::new(plan)?;
        let flat = |corner: [i32; 2]| DVec3::new(f64::from(corner[0]), f64::from(corner[1]), 0.0);
        let zygote_from_panel: Vec<_> = plan.zygote.iter().map(|panel| frame(&panel.map(flat))).collect();
        // Panels are unit squares: in their own frames all look alike, but for what a plan by hand may hold.
        let corners: Vec<[DVec3; 4]> = plan
            .zygote
            .iter()
            .zip(&zygote_from_panel)
            .map(|(panel, pose)| corners_at(&pose.inverse(), &panel.map(flat)))
            .collect();
        let mut height = vec![0.0; plan.target.len()];
        for pile in &plan.piles {
            for (h, panel) in pile.panels.iter().enumerate() {
                if let Some(height) = height.get_mut(*panel) {
                    *height = h as f64;
                }
            }
        }
        let joints = tree
            .branches()
            .iter()
            .map(|branch| {
                let hinge = &plan.hinges[branch.hinge];
                let end = usize::from(hinge.panels[0] != branch.parent);
                let edge = hinge.edges[end];
                let (start, stop) =
                    (corners[branch.parent][edge % 4], corners[branch.parent][(edge + 1) % 4]);
                let up = zygote_from_panel[branch.parent].matrix3.z_axis.z;
                Joint {
                    hinge: branch.hinge,
                    parent: branch.parent,
                    child: branch.child,
                    parent_from_child: zygote_from_panel[branch.parent].inverse()
                        * zygote_from_panel[branch.child],
                    anchor: start,
                    axis: stop - start,
                    // A positive fold angle lifts the child to the outer side, against a right-handed turn about
                    // an axis that has the parent on its left.
                    turn: f64::from(hinge.zygote_angle_deg - hinge.target_angle_deg).to_radians(),
                    lift: (height[branch.child] - height[branch.parent]) * up,
                }
            })
            .collect();
        let root = plan.root;
        let in_space = |corner: [i32; 3]| DVec3::from_array(corner.map(f64::from));
        let target_from_root = frame(&plan.target[root].map(in_space));
        let target_from_zygote = target_from_root * zygote_from_panel[root].inverse();
        Ok(Self { root, zygote_from_panel, joints, corners, target_from_zygote })
    }

    /// The joints; each comes after that of its parent.
    pub(crate) fn joints(&self) -> &[Joint] {
        &self.joints
    }

    /// The root's frame in the space of the zygote, which stands on z = 0.
    pub(crate) fn root_pose(&self, thickness: f64) -> DAffine3 {
        DAffine3::from_translation(DVec3::Z * (thickness * self.root_height()))
            * self.zygote_from_panel[self.root]
    }

    /// How many panels there are.
    pub fn panels(&self) -> usize {
        self.corners.len()
    }

    /// The rigid motion from the space of the zygote, where the root is fixed, to that of the target's coordinates.
    pub fn target_from_zygote(&self) -> DAffine3 {
        self.target_from_zygote
    }

    /// The corners of every panel in the space of the zygote.
    ///
    /// `fractions` has for each hinge how far it is from its angle in the zygote (0) to that in the target (1);
    /// a hinge that is missing there is at 0. `thickness` spreads what still lies in a pile along its normal, in
    /// panel lengths a height, and fades as a hinge opens; with 0 the panels are ideal.
    pub fn corners(&self, fractions: &[f64], thickness: f64) -> Vec<[DVec3; 4]> {
        let mut poses = self.zygote_from_panel.clone();
        if let Some(root) = poses.get_mut(self.root) {
            *root = self.root_pose(thickness);
        }
        for joint in &self.joints {
            let fraction = fractions.get(joint.hinge).copied().unwrap_or(0.0);
            poses[joint.child] = poses[joint.parent] * joint.parent_from_child(fraction, thickness);
        }
        poses.iter().zip(&self.corners).map(|(pose, corners)| corners_at(pose, corners)).collect()
    }

    /// Of every panel, how much it still is a layer of a stack, from 1 in the zygote to 0 when the hinge that moves it
    /// is open; positive where the pile goes up along the panel's outer normal, negative where it goes down.
    pub(crate) fn layers(&self, fractions: &[f64]) -> Vec<f64> {
        let fraction = |hinge: usize| fractions.get(hinge).copied().unwrap_or(0.0);
        let mut layers: Vec<_> = self.zygote_from_panel.iter().map(|pose| pose.matrix3.z_axis.z).collect();
        // Nothing moves the root; it is a layer until something opens next to it.
        for joint in &self.joints {
            layers[joint.child] *= 1.0 - fraction(joint.hinge);
            if joint.parent == self.root {
                layers[self.root] *= 1.0 - fraction(joint.hinge);
            }
        }
        layers
    }

    /// The root's height above the lowest panel, so that a zygote stands on z = 0.
    fn root_height(&self) -> f64 {
        let mut height = vec![0.0_f64; self.panels()];
        for joint in &self.joints {
            height[joint.child] =
                height[joint.parent] + joint.lift * self.zygote_from_panel[joint.parent].matrix3.z_axis.z;
        }
        -height.iter().copied().fold(0.0, f64::min)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::real_plans;
    use std::collections::BTreeSet;

    /// Far above the rounding of a chain of thousands of joints, far below anything that matters.
    const SAME: f64 = 1e-9;

    fn farthest(a: &[[DVec3; 4]], b: &[[DVec3; 4]]) -> f64 {
        a.as_flattened().iter().zip(b.as_flattened()).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max)
    }

    #[test]
    fn closed_hinges_give_the_zygote_and_open_ones_the_target() {
        for plan in real_plans() {
            let kinematics = Kinematics::new(&plan).expect("a tree");
            let zygote: Vec<_> = plan
                .zygote
                .iter()
                .map(|panel| panel.map(|[x, y]| DVec3::new(f64::from(x), f64::from(y), 0.0)))
                .collect();
            assert!(farthest(&kinematics.corners(&[], 0.0), &zygote) < SAME, "{}", plan.source.model);
            let target: Vec<_> = plan
                .target
                .iter()
                .map(|panel| panel.map(|at| DVec3::from_array(at.map(f64::from))))
                .collect();
            let mut opened = kinematics.corners(&vec![1.0; plan.hinges.len()], 0.0);
            for corner in opened.as_flattened_mut() {
                *corner = kinematics.target_from_zygote().transform_point3(*corner);
            }
            assert!(
                farthest(&opened, &target) < SAME,
                "{}: {}",
                plan.source.model,
                farthest(&opened, &target)
            );
        }
    }

    #[test]
    fn a_hinge_moves_its_own_branch_and_nothing_else() {
        for plan in real_plans() {
            let kinematics = Kinematics::new(&plan).expect("a tree");
            let tree = Tree::new(&plan).expect("a tree");
            let rest = kinematics.corners(&[], 0.0);
            for branch in tree.branches() {
                if plan.hinges[branch.hinge].zygote_angle_deg == plan.hinges[branch.hinge].target_angle_deg {
                    continue;
                }
                let mut fractions = vec![0.0; plan.hinges.len()];
                fractions[branch.hinge] = 0.37;
                let moved: BTreeSet<_> = kinematics
                    .corners(&fractions, 0.0)
                    .iter()
                    .zip(&rest)
                    .enumerate()
                    .filter(|(_, (now, before))| farthest(&[**now], &[**before]) > SAME)
                    .map(|(panel, _)| panel)
                    .collect();
                let mut hanging = BTreeSet::from([branch.child]);
                // Parents come before their children.
                hanging = tree.branches().iter().fold(hanging, |mut hanging, other| {
                    if hanging.contains(&other.parent) && other.hinge != branch.hinge {
                        hanging.insert(other.child);
                    }
                    hanging
                });
                assert_eq!(moved, hanging, "{}, hinge {}", plan.source.model, branch.hinge);
            }
        }
    }

    #[test]
    fn a_closed_stack_has_each_layer_one_thickness_above_the_last_from_the_ground_up() {
        for plan in real_plans() {
            let corners = Kinematics::new(&plan).expect("a tree").corners(&[], 0.1);
            for pile in &plan.piles {
                for (height, panel) in pile.panels.iter().enumerate() {
                    for corner in corners[*panel] {
                        assert!(
                            (corner.z - height as f64 * 0.1).abs() < SAME,
                            "panel {panel} at {}",
                            corner.z
                        );
                    }
                }
            }
        }
    }

    #[test]
    fn open_panels_have_no_thickness() {
        for plan in real_plans() {
            let kinematics = Kinematics::new(&plan).expect("a tree");
            let open = vec![1.0; plan.hinges.len()];
            let (thick, ideal) = (kinematics.corners(&open, 0.1), kinematics.corners(&open, 0.0));
            let shift = thick[plan.root][0] - ideal[plan.root][0];
            let shifted: Vec<_> = ideal.iter().map(|panel| panel.map(|corner| corner + shift)).collect();
            assert!(farthest(&thick, &shifted) < SAME);
        }
    }
}
