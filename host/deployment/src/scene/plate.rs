//! What a panel looks like: a thin plate, its outer side in the colour of its pile, the inner side paler.

use super::binary::Binary;
use crate::picture::colour;
use glam::Vec3;
use serde_json::{Value, json};
use zygote_stacking::Plan;

/// From the edge of the panel to that of its plate, panel lengths.
const GAP: f32 = 0.012;
/// Thickness of the plate over that of a layer of the stack, so that layers stay apart.
const PART: f64 = 0.8;
/// A plate is at least so thick, panel lengths, so that it has sides.
const LEAST: f64 = 1e-3;
/// Light in which sides are coloured: the viewer shades them.
const LIGHT: f64 = 0.6;

/// The meshes of all panels.
pub(super) struct Plates {
    pub(super) meshes: Vec<Value>,
    pub(super) materials: Vec<Value>,
    pub(super) mesh_of_panel: Vec<usize>,
}

/// A mesh a pile; they share their corners.
pub(super) fn plates(plan: &Plan, binary: &mut Binary) -> Plates {
    #[expect(clippy::cast_possible_truncation, reason = "the format's numbers")]
    let half = (PART * plan.thickness / 2.0).max(LEAST) as f32;
    let [outer, inner, around] =
        [outer_side(half), inner_side(half), sides(half)].map(|faces| faces.accessors(binary));
    let (mut meshes, mut materials) = (Vec::new(), Vec::new());
    let mut mesh_of_panel = vec![0; plan.panels()];
    for (number, pile) in plan.piles.iter().enumerate() {
        for panel in &pile.panels {
            mesh_of_panel[*panel] = number;
        }
        let first = materials.len();
        materials.extend(
            [colour::panel(number, true, LIGHT), colour::panel(number, false, LIGHT), colour::edge(number)]
                .map(|colour| {
                    json!({ "pbrMetallicRoughness": {
                        "baseColorFactor": colour.linear(), "metallicFactor": 0.0, "roughnessFactor": 0.9,
                    }})
                }),
        );
        let primitives: Vec<_> = [outer, inner, around]
            .into_iter()
            .enumerate()
            .map(|(side, [position, normal])| {
                json!({ "attributes": { "POSITION": position, "NORMAL": normal }, "material": first + side })
            })
            .collect();
        meshes.push(json!({ "name": format!("pile {number}"), "primitives": primitives }));
    }
    Plates { meshes, materials, mesh_of_panel }
}

/// Triangles, each corner with its normal.
#[derive(Default)]
struct Faces {
    corners: Vec<Vec<f32>>,
    normals: Vec<Vec<f32>>,
}

impl Faces {
    /// Adds a face, counter-clockwise as seen from where it shows.
    fn add(&mut self, corners: [Vec3; 4]) {
        let normal = (corners[1] - corners[0]).cross(corners[3] - corners[0]).normalize();
        for corner in [0, 1, 2, 0, 2, 3] {
            self.corners.push(corners[corner].to_array().to_vec());
            self.normals.push(normal.to_array().to_vec());
        }
    }

    fn accessors(&self, binary: &mut Binary) -> [usize; 2] {
        [binary.vertices(&self.corners), binary.vertices(&self.normals)]
    }
}

/// The corners of the plate at a height, counter-clockwise as seen from outside.
fn square(z: f32) -> [Vec3; 4] {
    [[GAP, GAP], [1.0 - GAP, GAP], [1.0 - GAP, 1.0 - GAP], [GAP, 1.0 - GAP]].map(|[x, y]| Vec3::new(x, y, z))
}

fn outer_side(half: f32) -> Faces {
    let mut faces = Faces::default();
    faces.add(square(half));
    faces
}

fn inner_side(half: f32) -> Faces {
    let mut faces = Faces::default();
    let [a, b, c, d] = square(-half);
    faces.add([a, d, c, b]);
    faces
}

fn sides(half: f32) -> Faces {
    let mut faces = Faces::default();
    let (top, bottom) = (square(half), square(-half));
    for at in 0..4 {
        let next = (at + 1) % 4;
        faces.add([bottom[at], bottom[next], top[next], top[at]]);
    }
    faces
}
