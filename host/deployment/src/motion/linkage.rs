//! A plan's panels as thick plates and its hinges as joints between them: what never changes while they move.

use super::thickness::{MotionError, Thickness};
use super::turning::Turn;
use crate::kinematics::frame;
use crate::tree::Tree;
use glam::{DAffine3, DVec3};
use zygote_stacking::{HingeKind, Plan};

/// A hinge as a joint from the panel nearer to the root to the one that it moves. All in the parent's frame.
#[derive(Debug, Clone)]
struct Joint {
    hinge: usize,
    parent: usize,
    child: usize,
    /// Where the child is in the zygote.
    closed: DAffine3,
    /// Where the child is in the target.
    open: DAffine3,
    /// A point of the physical axis.
    anchor: DVec3,
    /// Direction of the physical axis, a unit vector; the turn about it isn't negative.
    axis: DVec3,
    /// Radians, 0 or more.
    turn: f64,
    /// Besides the turn, the hinge gives way by so much: it shifts the child evenly over the turn.
    stretch: DVec3,
}

/// The joints of a plan between thick plates.
///
/// The frame of a panel has its origin at corner 0, x along edge 0 and z to the outer side; the outer face is at z = 0.
/// Space is that of the zygote, in panel lengths: height h of a pile fills z from h t to (h + 1) t. The root stands still.
#[derive(Debug, Clone)]
pub struct Linkage {
    thickness: Thickness,
    root: usize,
    root_pose: DAffine3,
    /// Parents before children, every branch in one piece.
    joints: Vec<Joint>,
    /// Of every hinge its joint.
    joint_of: Vec<usize>,
    /// Of every joint the end of its branch among the joints.
    branch_end: Vec<usize>,
    /// Of every panel the joint that moves it; `None` for the root.
    mover: Vec<Option<usize>>,
    piles: Vec<Vec<Layer>>,
}

/// A panel in a pile.
#[derive(Debug, Clone, Copy)]
pub(super) struct Layer {
    pub(super) panel: usize,
    /// The hinge to the panel above it; none where the fold is broken, or at the top.
    pub(super) fold: Option<usize>,
}

/// The heights of all panels, if every one lies in exactly one pile.
fn heights(plan: &Plan) -> Result<Vec<usize>, MotionError> {
    let panels = plan.panels();
    let mut heights = vec![0; panels];
    let mut times = vec![0; panels];
    for (number, pile) in plan.piles.iter().enumerate() {
        for (height, panel) in pile.panels.iter().enumerate() {
            let (Some(at), Some(count)) = (heights.get_mut(*panel), times.get_mut(*panel)) else {
                return Err(MotionError::NoPanel { pile: number, found: *panel, panels });
            };
            *at = height;
            *count += 1;
        }
    }
    match times.iter().position(|times| *times != 1) {
        Some(panel) => Err(MotionError::Pile { panel, found: times[panel] }),
        None => Ok(heights),
    }
}

impl Linkage {
    /// The joints of a plan between plates so thick.
    ///
    /// # Errors
    /// [`MotionError`] if plates can't be so thick, if the hinges aren't a tree of all panels, or if a panel doesn't lie in
    /// exactly one pile.
    pub fn new(plan: &Plan, thickness: Thickness) -> Result<Self, MotionError> {
        let thickness = thickness.checked()?;
        let t = thickness.thickness;
        let tree = Tree::new(plan)?;
        let height = heights(plan)?;
        let zygote: Vec<_> = plan
            .zygote
            .iter()
            .zip(&height)
            .map(|(corners, height)| {
                // Even heights have their outer face on top, odd ones at the bottom: both at an odd number of layers.
                let z = (height | 1) as f64 * t;
                frame(&corners.map(|[x, y]| DVec3::new(f64::from(x), f64::from(y), z)))
            })
            .collect();
        let target: Vec<_> = plan
            .target
            .iter()
            .map(|corners| frame(&corners.map(|at| DVec3::from_array(at.map(f64::from)))))
            .collect();
        let joints: Vec<_> = tree
            .branches()
            .iter()
            .map(|branch| {
                let hinge = &plan.hinges[branch.hinge];
                let end = usize::from(hinge.panels[0] != branch.parent);
                let edge = hinge.edges[end];
                let corner = |corner: usize| {
                    let [x, y] = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]][corner % 4];
                    DVec3::new(x, y, 0.0)
                };
                let (start, stop) = (corner(edge), corner(edge + 1));
                // Over odd heights the inner faces touch, so there the plates turn about their common edge.
                let inner = hinge.kind == HingeKind::Fold && height[hinge.panels[0]] % 2 == 1;
                let anchor = if inner { start - DVec3::Z * t } else { start };
                let closed = zygote[branch.parent].inverse() * zygote[branch.child];
                let open = target[branch.parent].inverse() * target[branch.child];
                // A positive fold angle lifts the child to the outer side, against a right-handed turn about an axis
                // that has the parent on its left.
                let turn_deg = f64::from(hinge.zygote_angle_deg - hinge.target_angle_deg);
                let axis = if turn_deg < 0.0 { start - stop } else { stop - start };
                let mut joint = Joint {
                    hinge: branch.hinge,
                    parent: branch.parent,
                    child: branch.child,
                    closed,
                    open,
                    anchor,
                    axis,
                    turn: turn_deg.abs().to_radians(),
                    stretch: DVec3::ZERO,
                };
                joint.stretch = open.translation - joint.turned(1.0).translation;
                // What is left of exact squares after a sine is rounding.
                if joint.stretch.length() < super::TOUCHING {
                    joint.stretch = DVec3::ZERO;
                }
                joint
            })
            .collect();
        let mut joint_of = vec![0; plan.hinges.len()];
        let mut mover = vec![None; plan.panels()];
        for (number, joint) in joints.iter().enumerate() {
            joint_of[joint.hinge] = number;
            mover[joint.child] = Some(number);
        }
        // Depth first, so the branch of a joint ends where the last of its children's does.
        let mut branch_end: Vec<_> = (1..=joints.len()).collect();
        for number in (0..joints.len()).rev() {
            if let Some(before) = mover[joints[number].parent] {
                branch_end[before] = branch_end[before].max(branch_end[number]);
            }
        }
        let mut fold_above = vec![None; plan.panels()];
        for (number, hinge) in plan.hinges.iter().enumerate() {
            if hinge.kind == HingeKind::Fold {
                fold_above[hinge.panels[0]] = Some(number);
            }
        }
        let layer = |panel: &usize| Layer { panel: *panel, fold: fold_above[*panel] };
        let piles = plan.piles.iter().map(|pile| pile.panels.iter().map(layer).collect()).collect();
        let (root, root_pose) = (plan.root, zygote[plan.root]);
        Ok(Self { thickness, root, root_pose, joints, joint_of, branch_end, mover, piles })
    }

    /// How many panels there are.
    pub fn panels(&self) -> usize {
        self.mover.len()
    }

    /// How many hinges there are.
    pub fn hinges(&self) -> usize {
        self.joints.len()
    }

    /// The plates.
    pub fn thickness(&self) -> Thickness {
        self.thickness
    }

    /// How far a hinge turns from the zygote to the target, degrees, 0 or more.
    ///
    /// # Panics
    /// If there is no such hinge; so do all methods that take one.
    pub fn turn_deg(&self, hinge: usize) -> f64 {
        self.joint(hinge).turn.to_degrees()
    }

    /// By how much a hinge must give way, in panel lengths, so that the outer faces end where the target has them.
    pub fn stretch(&self, hinge: usize) -> f64 {
        self.joint(hinge).stretch.length()
    }

    /// The panels that a hinge moves, from the hinge outwards.
    pub fn moved(&self, hinge: usize) -> impl Iterator<Item = usize> + '_ {
        self.branch(hinge).iter().map(|joint| joint.child)
    }

    /// Where every panel is, its frame in space, when every hinge is as far as `fractions` says: 0 closed, 1 open. A hinge
    /// that is missing there is closed.
    pub fn poses_at(&self, fractions: &[f64]) -> Vec<DAffine3> {
        let mut poses = vec![self.root_pose; self.panels()];
        for joint in &self.joints {
            let fraction = fractions.get(joint.hinge).copied().unwrap_or(0.0);
            poses[joint.child] = poses[joint.parent] * joint.at(fraction);
        }
        poses
    }

    /// The turn of a hinge in space, when its parent is where `poses` has it.
    pub fn turn(&self, hinge: usize, poses: &[DAffine3]) -> Turn {
        let joint = self.joint(hinge);
        let parent = &poses[joint.parent];
        Turn::new(
            parent.transform_point3(joint.anchor),
            parent.transform_vector3(joint.axis),
            joint.turn,
            parent.transform_vector3(joint.stretch),
        )
    }

    /// Puts the panels that a hinge moves where they belong.
    pub(super) fn place(&self, hinge: usize, open: &[bool], poses: &mut [DAffine3]) {
        for joint in self.branch(hinge) {
            let parent_from_child = if open[joint.hinge] { &joint.open } else { &joint.closed };
            poses[joint.child] = poses[joint.parent] * *parent_from_child;
        }
    }

    /// Whether a hinge moves a panel.
    pub(super) fn moves(&self, hinge: usize, panel: usize) -> bool {
        let first = self.joint_of[hinge];
        self.mover[panel].is_some_and(|mover| (first..self.branch_end[first]).contains(&mover))
    }

    pub(super) fn piles(&self) -> &[Vec<Layer>] {
        &self.piles
    }

    pub(super) fn child(&self, hinge: usize) -> usize {
        self.joint(hinge).child
    }

    /// The panel that never moves.
    pub fn root(&self) -> usize {
        self.root
    }

    fn joint(&self, hinge: usize) -> &Joint {
        &self.joints[self.joint_of[hinge]]
    }

    fn branch(&self, hinge: usize) -> &[Joint] {
        let first = self.joint_of[hinge];
        &self.joints[first..self.branch_end[first]]
    }
}

impl Joint {
    /// Where the child is in the parent's frame at a fraction of the turn; at 0 and 1 without rounding.
    fn at(&self, fraction: f64) -> DAffine3 {
        match fraction {
            0.0 => self.closed,
            1.0 => self.open,
            _ => self.turned(fraction),
        }
    }

    /// The same, by its turn and its stretch.
    fn turned(&self, fraction: f64) -> DAffine3 {
        DAffine3::from_translation(self.anchor + self.stretch * fraction)
            * DAffine3::from_axis_angle(self.axis, self.turn * fraction)
            * DAffine3::from_translation(-self.anchor)
            * self.closed
    }
}
