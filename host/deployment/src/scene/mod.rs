//! The way from the zygote to the target as an animated scene in glTF 2.0, which viewers and modelling programs play as it is.
//!
//! A node a panel, hanging on the node of the panel nearer to the root, with its origin on the hinge. So the rotation of a node is
//! the turn of its hinge; its place changes only as far as the thickness of the stack fades.

mod binary;
mod frames;
mod keys;
mod plate;

#[cfg(test)]
mod tests;

pub use frames::{Frames, Link, Pose};

use crate::kinematics::{Kinematics, frame};
use crate::picture::{Timeline, TimelineError};
use binary::Binary;
use glam::{DAffine3, DQuat, DVec3};
use keys::Keys;
use serde_json::{Value, json};
use std::borrow::Cow;
use zygote_stacking::Plan;

/// Why a plan can't be written as a scene.
#[derive(Debug, thiserror::Error)]
pub enum SceneError {
    /// It can't be shown in motion.
    #[error(transparent)]
    Timeline(#[from] TimelineError),
    /// More than the 4 GiB that the format has room for.
    #[error("the scene can't be written: {0}")]
    Format(#[from] gltf::Error),
    /// A number that JSON has no word for.
    #[error("the scene can't be written: {0}")]
    Json(#[from] serde_json::Error),
}

/// A plan as a binary glTF file: panel lengths, seconds, y up, the root fixed. Times are those of the plan's schedule; without one
/// the hinges open one by one, a second each. At rest the scene is the zygote.
///
/// # Errors
/// [`SceneError`] if the plan is no tree, or its schedule isn't its own.
pub fn gltf(plan: &Plan) -> Result<Vec<u8>, SceneError> {
    write(plan, Some(&Timeline::new(plan)?))
}

/// The target alone, as it stands in the plan, at rest: for programs that don't play.
///
/// # Errors
/// [`SceneError`] if the plan is no tree.
pub fn gltf_of_target(plan: &Plan) -> Result<Vec<u8>, SceneError> {
    write(plan, None)
}

/// The scene on its way through a timeline, or without one at its end.
fn write(plan: &Plan, timeline: Option<&Timeline>) -> Result<Vec<u8>, SceneError> {
    let kinematics = Kinematics::new(plan).map_err(TimelineError::from)?;
    let mut binary = Binary::default();
    let plates = plate::plates(plan, &mut binary);
    let mut nodes: Vec<_> = (0..plan.panels())
        .map(|panel| json!({ "name": format!("panel {panel}"), "mesh": plates.mesh_of_panel[panel] }))
        .collect();
    let (rest, thickness) = if timeline.is_some() { (0.0, plan.thickness) } else { (1.0, 0.0) };
    place(&mut nodes[plan.root], kinematics.root_pose(thickness));
    let mut children = vec![Vec::new(); plan.panels()];
    let (mut channels, mut samplers) = (Vec::new(), Vec::new());
    let from_hinge = turned_frames(plan, &kinematics);
    for joint in kinematics.joints() {
        let local = |fraction: f64| {
            from_hinge[joint.parent].inverse()
                * joint.parent_from_child(fraction, plan.thickness)
                * from_hinge[joint.child]
        };
        place(&mut nodes[joint.child], local(rest));
        nodes[joint.child]["extras"] = json!({ "hinge": joint.hinge });
        children[joint.parent].push(joint.child);
        let Some(timeline) = timeline else { continue };
        let span = timeline.span(joint.hinge).unwrap_or_default();
        for keys in Keys::of(joint, span, &local) {
            channels.push(json!({
                "sampler": samplers.len(),
                "target": { "node": joint.child, "path": keys.path },
            }));
            samplers
                .push(json!({ "input": binary.scalars(&keys.times), "output": binary.rows(&keys.values) }));
        }
    }
    // A list of the format is missing rather than empty.
    for (node, children) in nodes.iter_mut().zip(children).filter(|(_, children)| !children.is_empty()) {
        node["children"] = json!(children);
    }
    // The plan's z is up, glTF's is y.
    let upright = DAffine3::from_quat(DQuat::from_rotation_x(-std::f64::consts::FRAC_PI_2));
    let (name, upright) = match timeline {
        Some(_) => ("zygote", upright),
        None => ("target", upright * kinematics.target_from_zygote()),
    };
    let mut whole = json!({ "name": name, "children": [plan.root] });
    place(&mut whole, upright);
    nodes.push(whole);
    let mut document = json!({
        "asset": { "version": "2.0", "generator": concat!("zygote ", env!("CARGO_PKG_VERSION")) },
        "scene": 0,
        "scenes": [{ "name": plan.source.model, "nodes": [plan.panels()] }],
        "nodes": nodes,
        "meshes": plates.meshes,
        "materials": plates.materials,
        "accessors": binary.accessors,
        "bufferViews": binary.views,
        "buffers": [{ "byteLength": binary.bytes.len() }],
    });
    if !channels.is_empty() {
        document["animations"] =
            json!([{ "name": "deployment", "channels": channels, "samplers": samplers }]);
    }
    let file = gltf::binary::Glb {
        header: gltf::binary::Header { magic: *b"glTF", version: 2, length: 0 },
        json: Cow::Owned(serde_json::to_vec(&document)?),
        bin: Some(Cow::Owned(binary.bytes)),
    };
    Ok(file.to_vec()?)
}

/// Of every panel the frame whose first edge is the hinge that moves it, in the panel's own frame: of a square all four look alike.
fn turned_frames(plan: &Plan, kinematics: &Kinematics) -> Vec<DAffine3> {
    let square = [DVec3::ZERO, DVec3::X, DVec3::new(1.0, 1.0, 0.0), DVec3::Y];
    let mut frames = vec![DAffine3::IDENTITY; plan.panels()];
    for joint in kinematics.joints() {
        let hinge = &plan.hinges[joint.hinge];
        let edge = hinge.edges[usize::from(hinge.panels[1] == joint.child)];
        frames[joint.child] = frame(&[0, 1, 2, 3].map(|corner| square[(edge + corner) % 4]));
    }
    frames
}

fn place(node: &mut Value, pose: DAffine3) {
    node["translation"] = json!(pose.translation.as_vec3().to_array());
    node["rotation"] = json!(quaternion(DQuat::from_mat3(&pose.matrix3)));
}

fn quaternion(turn: DQuat) -> [f32; 4] {
    turn.normalize().as_quat().to_array()
}
