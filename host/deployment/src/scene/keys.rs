//! Rotation and place of a panel's node over the time of its hinge.

use super::quaternion;
use crate::kinematics::Joint;
use glam::{DAffine3, DQuat};

/// Degrees between two keys: a viewer turns evenly between them, and what fades with the turn goes along a line.
const STEP_DEG: f64 = 15.0;

/// What one property of a node is at some times.
pub(super) struct Keys {
    /// The property's name in the format.
    pub(super) path: &'static str,
    pub(super) times: Vec<f32>,
    pub(super) values: Vec<Vec<f32>>,
}

impl Keys {
    /// The keys of what a joint moves; nothing for a hinge that doesn't turn. `local` is the child's pose in its parent's frame, by
    /// the fraction of the turn.
    pub(super) fn of(joint: &Joint, (start, end): (f64, f64), local: &dyn Fn(f64) -> DAffine3) -> Vec<Self> {
        if joint.turn == 0.0 {
            return Vec::new();
        }
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "at most 270 degrees")]
        let steps = (joint.turn.to_degrees().abs() / STEP_DEG).ceil() as u32;
        let fractions: Vec<_> = (0..=steps).map(|step| f64::from(step) / f64::from(steps)).collect();
        let poses: Vec<_> = fractions.iter().map(|fraction| local(*fraction)).collect();
        #[expect(clippy::cast_possible_truncation, reason = "the format's numbers")]
        let times: Vec<_> =
            fractions.iter().map(|fraction| (start + (end - start) * fraction) as f32).collect();
        let turns = poses.iter().map(|pose| quaternion(DQuat::from_mat3(&pose.matrix3)).to_vec()).collect();
        let mut keys = vec![Self { path: "rotation", times: times.clone(), values: turns }];
        if joint.lift != 0.0 {
            let places = poses.iter().map(|pose| pose.translation.as_vec3().to_array().to_vec()).collect();
            keys.push(Self { path: "translation", times, values: places });
        }
        keys
    }
}
