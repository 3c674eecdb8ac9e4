//! Foxglove's messages of a scene, as far as a run needs them.

use crate::stamp::Stamp;
use serde::Serialize;
use zygote_deployment::scene;

#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub(crate) struct Vector {
    x: f64,
    y: f64,
    z: f64,
}

#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub(crate) struct Quaternion {
    x: f64,
    y: f64,
    z: f64,
    w: f64,
}

#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub(crate) struct Colour {
    r: f64,
    g: f64,
    b: f64,
    a: f64,
}

#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub(crate) struct Pose {
    position: Vector,
    orientation: Quaternion,
}

#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct Cube {
    pub(crate) pose: Pose,
    pub(crate) size: Vector,
    pub(crate) color: Colour,
}

#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct Line {
    /// 0: a strip.
    pub(crate) r#type: u8,
    pub(crate) pose: Pose,
    pub(crate) thickness: f64,
    pub(crate) scale_invariant: bool,
    pub(crate) points: Vec<Vector>,
    pub(crate) color: Colour,
    pub(crate) colors: [Colour; 0],
    pub(crate) indices: [u32; 0],
}

#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct KeyValue {
    pub(crate) key: &'static str,
    pub(crate) value: String,
}

/// Something that is drawn in a frame and moves with it. The kinds of primitives that we don't draw are there, empty.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct Entity {
    pub(crate) timestamp: Stamp,
    pub(crate) frame_id: String,
    pub(crate) id: String,
    pub(crate) lifetime: Stamp,
    pub(crate) frame_locked: bool,
    pub(crate) metadata: Vec<KeyValue>,
    pub(crate) arrows: [(); 0],
    pub(crate) cubes: Vec<Cube>,
    pub(crate) spheres: [(); 0],
    pub(crate) cylinders: [(); 0],
    pub(crate) lines: Vec<Line>,
    pub(crate) triangles: [(); 0],
    pub(crate) texts: [(); 0],
    pub(crate) models: [(); 0],
}

#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct Deletion {
    pub(crate) timestamp: Stamp,
    /// 1: everything on the topic.
    pub(crate) r#type: u8,
    pub(crate) id: &'static str,
}

#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct SceneUpdate {
    pub(crate) deletions: Vec<Deletion>,
    pub(crate) entities: Vec<Entity>,
}

#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct Transform {
    pub(crate) timestamp: Stamp,
    pub(crate) parent_frame_id: String,
    pub(crate) child_frame_id: String,
    pub(crate) translation: Vector,
    pub(crate) rotation: Quaternion,
}

#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct FrameTransforms {
    pub(crate) transforms: Vec<Transform>,
}

#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct Log<'a> {
    pub(crate) timestamp: Stamp,
    pub(crate) level: u8,
    pub(crate) message: &'a str,
    pub(crate) name: &'static str,
    pub(crate) file: &'static str,
    pub(crate) line: u32,
}

/// Far finer than anything shown: short numbers make short files.
fn short(number: f64) -> f64 {
    // Adding 0 takes the sign off a zero.
    (number * 1e5).round() / 1e5 + 0.0
}

impl From<[f64; 3]> for Vector {
    fn from([x, y, z]: [f64; 3]) -> Self {
        Self { x: short(x), y: short(y), z: short(z) }
    }
}

impl From<[f64; 4]> for Quaternion {
    fn from([x, y, z, w]: [f64; 4]) -> Self {
        Self { x: short(x), y: short(y), z: short(z), w: short(w) }
    }
}

impl Colour {
    /// An opaque colour.
    pub(crate) fn opaque([r, g, b]: [f64; 3]) -> Self {
        Self { r: short(r), g: short(g), b: short(b), a: 1.0 }
    }
}

impl From<scene::Pose> for Pose {
    fn from(pose: scene::Pose) -> Self {
        Self { position: pose.translation.into(), orientation: pose.rotation.into() }
    }
}

impl Pose {
    pub(crate) fn identity() -> Self {
        Self { position: [0.0; 3].into(), orientation: [0.0, 0.0, 0.0, 1.0].into() }
    }
}

impl Entity {
    /// Something that stays until it is replaced, with nothing to be seen yet.
    pub(crate) fn new(timestamp: Stamp, frame_id: String, id: String) -> Self {
        Self {
            timestamp,
            frame_id,
            id,
            lifetime: Stamp::from_ns(0),
            frame_locked: true,
            metadata: Vec::new(),
            arrows: [],
            cubes: Vec::new(),
            spheres: [],
            cylinders: [],
            lines: Vec::new(),
            triangles: [],
            texts: [],
            models: [],
        }
    }
}
