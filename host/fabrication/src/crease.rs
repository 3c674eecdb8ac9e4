//! The net as a crease pattern: what origami programs fold from flat, by its angles, into the shape. A plan file begins with the
//! shape already folded; programs that fold by themselves, such as Origami Simulator, want the flat state first.

use serde_json::{Value, json};
use std::io;
use zygote_stacking::{Net, Plan, fold};

/// Keys that the crease pattern has from the plan as they are.
const KEPT: [&str; 7] = [
    "file_spec",
    "file_creator",
    "faces_vertices",
    "edges_vertices",
    "edges_faces",
    "edges_foldAngle",
    "edges_assignment",
];

/// The crease pattern of a plan as the bytes of a `.fold` file; panels may lie on each other.
///
/// # Errors
/// A plan that can't be written as JSON.
pub fn crease_pattern(plan: &Plan) -> io::Result<Vec<u8>> {
    let whole: Value = serde_json::from_slice(&fold::write(plan)?)?;
    let net = Net::of(plan);
    let mut coords = vec![json!(null); 2 * plan.panels() + 2];
    for (face, square) in whole["faces_vertices"].as_array().into_iter().flatten().zip(&net.squares) {
        for (vertex, corner) in face.as_array().into_iter().flatten().zip(square) {
            let place = vertex.as_u64().and_then(|vertex| coords.get_mut(usize::try_from(vertex).ok()?));
            if let Some(place) = place {
                *place = json!(corner);
            }
        }
    }
    let mut pattern = json!({
        "file_classes": ["singleModel"],
        "frame_title": "net",
        "frame_classes": ["creasePattern"],
        "frame_attributes": ["2D", "orientable"],
        "vertices_coords": coords,
    });
    for key in KEPT {
        pattern[key] = whole[key].clone();
    }
    let mut bytes = serde_json::to_vec(&pattern)?;
    bytes.push(b'\n');
    Ok(bytes)
}
