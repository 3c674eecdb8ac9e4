//! The schemas of the messages, as JSON Schema. Foxglove knows those of its own by their names; the rest tells plots what there is.

use serde_json::{Value, json};

/// A topic's schema.
pub(crate) struct Schema {
    pub(crate) name: &'static str,
    pub(crate) json: Value,
}

/// The schemas of all topics.
pub(crate) fn all() -> [(&'static str, Schema); 6] {
    use crate::topic::{EVENTS, FRAMES, HINGES, LOG, PANELS, TELEMETRY};
    [
        (EVENTS, event()),
        (TELEMETRY, telemetry()),
        (LOG, log()),
        (PANELS, scene_update()),
        (HINGES, scene_update()),
        (FRAMES, frame_transforms()),
    ]
}

fn object(fields: &[(&str, Value)]) -> Value {
    let properties: serde_json::Map<_, _> =
        fields.iter().map(|(name, of)| ((*name).to_owned(), of.clone())).collect();
    json!({ "type": "object", "properties": properties })
}

fn array(of: &Value) -> Value {
    json!({ "type": "array", "items": of })
}

fn number() -> Value {
    json!({ "type": "number" })
}

fn integer() -> Value {
    json!({ "type": "integer" })
}

fn string() -> Value {
    json!({ "type": "string" })
}

fn numbers(names: &[&str]) -> Value {
    object(&names.iter().map(|name| (*name, number())).collect::<Vec<_>>())
}

fn moment(title: &str) -> Value {
    let mut time = object(&[("sec", integer()), ("nsec", integer())]);
    time["title"] = title.into();
    time
}

fn event() -> Schema {
    let fields = [
        ("host_us", integer()),
        ("at_host_us", integer()),
        ("mcu_us", integer()),
        ("kind", string()),
        ("hinge", integer()),
        ("step", integer()),
        ("state", string()),
        ("peak_c", number()),
        ("fault", string()),
        ("value", integer()),
        ("limit", integer()),
        ("message", string()),
    ];
    Schema { name: "zygote.Event", json: object(&fields) }
}

fn telemetry() -> Schema {
    let reading = object(&[
        ("hinge", integer()),
        ("phase", string()),
        ("temperature_c", number()),
        ("duty", number()),
        ("opening_deg", number()),
    ]);
    let fields = [
        ("host_us", integer()),
        ("at_host_us", integer()),
        ("mcu_us", integer()),
        ("supply_v", number()),
        ("current_a", number()),
        ("opened", integer()),
        ("motions", array(&reading)),
    ];
    Schema { name: "zygote.Telemetry", json: object(&fields) }
}

fn log() -> Schema {
    let fields = [
        ("timestamp", moment("time")),
        ("level", integer()),
        ("message", string()),
        ("name", string()),
        ("file", string()),
        ("line", integer()),
    ];
    Schema { name: "foxglove.Log", json: object(&fields) }
}

fn frame_transforms() -> Schema {
    let transform = object(&[
        ("timestamp", moment("time")),
        ("parent_frame_id", string()),
        ("child_frame_id", string()),
        ("translation", numbers(&["x", "y", "z"])),
        ("rotation", numbers(&["x", "y", "z", "w"])),
    ]);
    Schema { name: "foxglove.FrameTransforms", json: object(&[("transforms", array(&transform))]) }
}

fn scene_update() -> Schema {
    let xyz = numbers(&["x", "y", "z"]);
    let pose = object(&[("position", xyz.clone()), ("orientation", numbers(&["x", "y", "z", "w"]))]);
    let colour = numbers(&["r", "g", "b", "a"]);
    let cube = object(&[("pose", pose.clone()), ("size", xyz.clone()), ("color", colour.clone())]);
    let line = object(&[
        ("type", integer()),
        ("pose", pose),
        ("thickness", number()),
        ("scale_invariant", json!({ "type": "boolean" })),
        ("points", array(&xyz)),
        ("color", colour.clone()),
        ("colors", array(&colour)),
        ("indices", array(&integer())),
    ]);
    let entity = object(&[
        ("timestamp", moment("time")),
        ("frame_id", string()),
        ("id", string()),
        ("lifetime", moment("duration")),
        ("frame_locked", json!({ "type": "boolean" })),
        ("metadata", array(&object(&[("key", string()), ("value", string())]))),
        ("arrows", array(&object(&[]))),
        ("cubes", array(&cube)),
        ("spheres", array(&object(&[]))),
        ("cylinders", array(&object(&[]))),
        ("lines", array(&line)),
        ("triangles", array(&object(&[]))),
        ("texts", array(&object(&[]))),
        ("models", array(&object(&[]))),
    ]);
    let deletion = object(&[("timestamp", moment("time")), ("type", integer()), ("id", string())]);
    let fields = [("deletions", array(&deletion)), ("entities", array(&entity))];
    Schema { name: "foxglove.SceneUpdate", json: object(&fields) }
}
