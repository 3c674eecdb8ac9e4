//! Plates and hinges in the space of the zygote. A panel's motion is the product of the motions of the hinges between it and
//! the root, each about its axis in the zygote; so layers that still lie on each other share one motion.

use super::{DenseError, Setting};
use glam::{DAffine3, DMat3, DVec3};
use zygote_stacking::{HingeKind, Plan};

/// Angles of the plan and shapes of its target may differ by rounding.
const ROUNDING: f64 = 1e-9;

/// A hinge, from the panel nearer to the root to the one that it moves.
#[derive(Debug, Clone)]
pub(super) struct Joint {
    pub(super) hinge: usize,
    pub(super) parent: usize,
    pub(super) child: usize,
    /// On the axis, in the zygote.
    pub(super) anchor: DVec3,
    axis: DVec3,
    /// Radians, 0 or more.
    pub(super) turn: f64,
    /// Shift over the whole turn.
    pub(super) stretch: DVec3,
    /// The whole motion, as zygote and target have it.
    whole: DAffine3,
}

/// A panel in a pile, and the hinge to the one above it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Layer {
    pub(super) panel: usize,
    pub(super) fold: Option<usize>,
}

/// All plates of a plan.
#[derive(Debug)]
pub(super) struct Plates {
    pub(super) thickness: f64,
    pub(super) rim: f64,
    /// Every branch in one piece, from the root out.
    joints: Vec<Joint>,
    /// Of every joint the end of its branch.
    ends: Vec<usize>,
    /// Of every hinge its joint.
    pub(super) joint_of: Vec<usize>,
    /// Cell and layers.
    pub(super) piles: Vec<([f64; 2], Vec<Layer>)>,
}

/// The rigid motion from a panel's place in the zygote to that in the target.
fn to_target(zygote: &[DVec3; 4], target: &[DVec3; 4]) -> DAffine3 {
    let frame = |corners: &[DVec3; 4]| {
        let (x, y) = (corners[1] - corners[0], corners[3] - corners[0]);
        DAffine3::from_mat3_translation(DMat3::from_cols(x, y, x.cross(y)), corners[0])
    };
    frame(target) * frame(zygote).inverse()
}

impl Plates {
    pub(super) fn new(plan: &Plan, setting: &Setting) -> Result<Self, DenseError> {
        let (thickness, rim) = (setting.thickness, setting.rim);
        let places = plan.places();
        let mut hinges_at = vec![Vec::new(); plan.panels()];
        for (number, hinge) in plan.hinges.iter().enumerate() {
            for panel in hinge.panels {
                hinges_at[panel].push(number);
            }
        }
        let mut joints: Vec<Joint> = Vec::with_capacity(plan.hinges.len());
        let mut reached = vec![false; plan.panels()];
        reached[plan.root] = true;
        // Depth first, so that a branch is in one piece.
        let mut ahead: Vec<(usize, usize)> = hinges_at[plan.root].iter().map(|h| (*h, plan.root)).collect();
        while let Some((number, parent)) = ahead.pop() {
            let [a, b] = plan.hinges[number].panels;
            let child = if a == parent { b } else { a };
            if std::mem::replace(&mut reached[child], true) {
                return Err(DenseError::Tree { panel: child });
            }
            joints.push(joint(plan, &places, thickness, number, parent, child)?);
            ahead.extend(hinges_at[child].iter().filter(|h| **h != number).map(|h| (*h, child)));
        }
        if let Some(panel) = reached.iter().position(|reached| !reached) {
            return Err(DenseError::Tree { panel });
        }
        let mut joint_of = vec![0; joints.len()];
        let mut mover = vec![None; plan.panels()];
        for (place, joint) in joints.iter().enumerate() {
            joint_of[joint.hinge] = place;
            mover[joint.child] = Some(place);
        }
        let mut ends: Vec<_> = (1..=joints.len()).collect();
        for place in (0..joints.len()).rev() {
            if let Some(before) = mover[joints[place].parent] {
                ends[before] = ends[before].max(ends[place]);
            }
        }
        let mut fold_above = vec![None; plan.panels()];
        for (number, hinge) in plan.hinges.iter().enumerate() {
            if hinge.kind == HingeKind::Fold {
                fold_above[hinge.panels[0]] = Some(number);
            }
        }
        let layer = |panel: &usize| Layer { panel: *panel, fold: fold_above[*panel] };
        let piles = plan
            .piles
            .iter()
            .map(|pile| (pile.cell.map(f64::from), pile.panels.iter().map(layer).collect()))
            .collect();
        Ok(Self { thickness, rim, joints, ends, joint_of, piles })
    }

    pub(super) fn joint(&self, place: usize) -> &Joint {
        &self.joints[place]
    }

    /// The joints from this one outwards.
    pub(super) fn branch(&self, place: usize) -> &[Joint] {
        &self.joints[place..self.ends[place]]
    }
}

fn joint(
    plan: &Plan,
    places: &[(usize, usize)],
    thickness: f64,
    number: usize,
    parent: usize,
    child: usize,
) -> Result<Joint, DenseError> {
    let hinge = &plan.hinges[number];
    // Outer faces are on top of even heights and at the bottom of odd ones.
    let zygote = |panel: usize| {
        let z = (places[panel].1 | 1) as f64 * thickness;
        plan.zygote[panel].map(|[x, y]| DVec3::new(f64::from(x), f64::from(y), z))
    };
    let target = |panel: usize| plan.target[panel].map(|at| DVec3::from_array(at.map(f64::from)));
    let up = if places[parent].1.is_multiple_of(2) { DVec3::Z } else { DVec3::NEG_Z };
    let corners = zygote(parent);
    let edge = hinge.edges[usize::from(hinge.panels[0] != parent)];
    let (start, stop) = (corners[edge % 4], corners[(edge + 1) % 4]);
    let away = (start + stop - corners[0] - corners[2]).normalize();
    let mut anchor = start;
    if hinge.kind == HingeKind::Fold {
        // Where the two layers touch.
        anchor.z = (places[hinge.panels[0]].1 + 1) as f64 * thickness;
    }
    // The child lifts to the parent's outer side as the fold angle rises.
    let lifts = f64::from(hinge.target_angle_deg - hinge.zygote_angle_deg).to_radians();
    let axis = away.cross(up) * if lifts < 0.0 { -1.0 } else { 1.0 };
    let turn = lifts.abs();
    let whole = to_target(&corners, &target(parent)).inverse() * to_target(&zygote(child), &target(child));
    if !whole.matrix3.abs_diff_eq(DMat3::from_axis_angle(axis, turn), ROUNDING) {
        return Err(DenseError::Angles { hinge: number });
    }
    let stretch = whole.transform_point3(anchor) - anchor;
    Ok(Joint { hinge: number, parent, child, anchor, axis, turn, stretch, whole })
}

impl Joint {
    /// The motion at a fraction of the whole.
    pub(super) fn at(&self, fraction: f64) -> DAffine3 {
        if fraction >= 1.0 {
            return self.whole;
        }
        let turned = DMat3::from_axis_angle(self.axis, self.turn * fraction);
        let shift = self.anchor - turned * self.anchor + self.stretch * fraction;
        DAffine3::from_mat3_translation(turned, shift)
    }

    /// Brings the child to where the parent and the fraction have it.
    pub(super) fn place(&self, fraction: f64, motions: &mut [DAffine3]) {
        motions[self.child] =
            if fraction > 0.0 { motions[self.parent] * self.at(fraction) } else { motions[self.parent] };
    }
}
