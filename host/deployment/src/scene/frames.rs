//! The tree of frames in which a plan's panels move, for programs that play a run: each panel's frame has its origin on the hinge that moves
//! it and its x axis along that hinge, so that a turning hinge changes the rotation of one frame only.

use super::turned_frames;
use crate::kinematics::{Joint, Kinematics};
use crate::picture::colour;
use crate::tree::TreeError;
use glam::{DAffine3, DQuat, DVec3};
use zygote_stacking::Plan;

/// Light in which outer sides are coloured: the viewer shades them.
const LIGHT: f64 = 0.6;

/// Every panel's frame in that of the panel before it.
#[derive(Debug, Clone)]
pub struct Frames {
    kinematics: Kinematics,
    /// Of each panel, its turned frame in its own.
    from_hinge: Vec<DAffine3>,
    /// Of each hinge, its joint.
    joint_of_hinge: Vec<Option<usize>>,
    /// Of each panel, its pile.
    pile_of_panel: Vec<usize>,
    root: usize,
    thickness: f64,
}

/// A place and a turn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pose {
    /// Panel lengths.
    pub translation: [f64; 3],
    /// A quaternion: x, y, z, w.
    pub rotation: [f64; 4],
}

/// A panel's frame in that of the panel before it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Link {
    /// The panel before it.
    pub parent: usize,
    /// The panel.
    pub child: usize,
    /// The child's frame in the parent's.
    pub pose: Pose,
}

impl From<DAffine3> for Pose {
    fn from(affine: DAffine3) -> Self {
        let rotation = DQuat::from_mat3(&affine.matrix3).normalize();
        Self { translation: affine.translation.to_array(), rotation: rotation.to_array() }
    }
}

impl Frames {
    /// The frames of a plan.
    ///
    /// # Errors
    /// [`TreeError`] if the hinges of the plan aren't a tree of all its panels.
    pub fn new(plan: &Plan) -> Result<Self, TreeError> {
        let kinematics = Kinematics::new(plan)?;
        let mut joint_of_hinge = vec![None; plan.hinges.len()];
        for (index, joint) in kinematics.joints().iter().enumerate() {
            joint_of_hinge[joint.hinge] = Some(index);
        }
        let from_hinge = turned_frames(plan, &kinematics);
        let pile_of_panel = plan.places().iter().map(|(pile, _)| *pile).collect();
        let (root, thickness) = (plan.root, plan.thickness);
        Ok(Self { kinematics, from_hinge, joint_of_hinge, pile_of_panel, root, thickness })
    }

    /// How many panels there are.
    pub fn panels(&self) -> usize {
        self.from_hinge.len()
    }

    /// The panel that stays fixed, and its frame in the space of the zygote.
    pub fn root(&self) -> (usize, Pose) {
        (self.root, self.kinematics.root_pose(self.thickness).into())
    }

    /// The frame of the panel that a hinge moves, with the hinge at a fraction of its way from the zygote (0) to the target (1); `None` for a
    /// hinge that the plan hasn't.
    pub fn link(&self, hinge: usize, fraction: f64) -> Option<Link> {
        let joint: &Joint = self.kinematics.joints().get((*self.joint_of_hinge.get(hinge)?)?)?;
        let pose = self.from_hinge[joint.parent].inverse()
            * joint.parent_from_child(fraction, self.thickness)
            * self.from_hinge[joint.child];
        Some(Link { parent: joint.parent, child: joint.child, pose: pose.into() })
    }

    /// The middle of a panel in its frame.
    pub fn middle(&self, panel: usize) -> Pose {
        let middle = DVec3::new(0.5, 0.5, 0.0);
        self.from_hinge
            .get(panel)
            .map_or(DAffine3::from_translation(middle), |turned| {
                // The plate lies along the panel's own frame, whichever edge carries the hinge.
                turned.inverse() * DAffine3::from_translation(middle)
            })
            .into()
    }

    /// The colour of a panel's outer side, that of its pile: linear red, green and blue from 0 to 1.
    pub fn colour(&self, panel: usize) -> [f64; 3] {
        let pile = self.pile_of_panel.get(panel).copied().unwrap_or_default();
        let [r, g, b, _] = colour::panel(pile, true, LIGHT).linear();
        [r, g, b]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::real_plans;

    /// Far above the rounding of a long chain of joints.
    const SAME: f64 = 1e-9;

    fn affine(pose: Pose) -> DAffine3 {
        DAffine3::from_rotation_translation(
            DQuat::from_array(pose.rotation),
            DVec3::from_array(pose.translation),
        )
    }

    #[test]
    fn chained_frames_put_the_middle_of_every_panel_where_the_kinematics_puts_it() {
        for plan in real_plans() {
            let frames = Frames::new(&plan).expect("a tree");
            let kinematics = Kinematics::new(&plan).expect("a tree");
            let fractions: Vec<_> = (0..plan.hinges.len())
                .map(|hinge| f64::from(u8::try_from(hinge % 5).unwrap()) / 4.0)
                .collect();
            let (root, pose) = frames.root();
            let mut space_from = vec![None; frames.panels()];
            space_from[root] = Some(affine(pose) * frames.from_hinge[root]);
            for joint in kinematics.joints() {
                let link = frames.link(joint.hinge, fractions[joint.hinge]).expect("a joint");
                let parent = space_from[link.parent].expect("parents come first");
                space_from[link.child] = Some(parent * affine(link.pose));
            }
            for (panel, corners) in kinematics.corners(&fractions, plan.thickness).iter().enumerate() {
                let middle = corners.iter().sum::<DVec3>() / 4.0;
                let found = (space_from[panel].expect("a tree") * affine(frames.middle(panel))).translation;
                assert!(found.distance(middle) < SAME, "{}: panel {panel}", plan.source.model);
            }
        }
    }

    #[test]
    fn a_turning_hinge_without_thickness_changes_the_rotation_alone() {
        let mut plan = real_plans().remove(0);
        plan.thickness = 0.0;
        let frames = Frames::new(&plan).expect("a tree");
        for hinge in 0..plan.hinges.len() {
            let [closed, open] =
                [0.0, 1.0].map(|fraction| frames.link(hinge, fraction).expect("a hinge").pose);
            let apart = DVec3::from_array(closed.translation).distance(DVec3::from_array(open.translation));
            assert!(apart < SAME, "hinge {hinge}");
        }
        assert!(frames.link(plan.hinges.len(), 0.0).is_none());
    }
}
