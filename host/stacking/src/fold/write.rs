//! Writes a plan as a FOLD file. The same plan gives the same bytes.

use super::SCHEDULE;
use super::layout_of_lines::KeyALine;
use crate::plan::{Hinge, HingeKind, Plan};
use serde::Serialize;
use serde_json::{Value, json};
use std::io;

/// A plan as the bytes of a `.fold` file.
///
/// # Errors
/// A schedule that JSON can't hold; nothing else in a plan can fail.
pub fn write(plan: &Plan) -> io::Result<Vec<u8>> {
    let cut = CutSurface::of(plan);
    let mut bytes = Vec::new();
    let mut writer = serde_json::Serializer::with_formatter(&mut bytes, KeyALine::default());
    serde::Serializer::collect_map(&mut writer, keys(plan, &cut))?;
    bytes.push(b'\n');
    Ok(bytes)
}

/// The keys of the file in the order in which they stand there.
fn keys(plan: &Plan, cut: &CutSurface) -> Vec<(&'static str, Value)> {
    let mut keys = vec![
        ("file_spec", json!(1.2)),
        ("file_creator", json!(concat!("zygote ", env!("CARGO_PKG_VERSION")))),
        ("file_classes", json!(["singleModel"])),
        ("frame_title", json!("target")),
        ("frame_classes", json!(["foldedForm"])),
        ("frame_attributes", json!(["3D", "orientable"])),
        ("zygote:version", json!(1)),
        ("zygote:thickness", json!(plan.thickness)),
        ("zygote:panel_length_mm", json!(plan.panel_length_mm)),
        ("zygote:root", json!(plan.root)),
        ("zygote:ver", json!(plan.expansion_ratio())),
        ("zygote:source", json!(plan.source)),
        ("zygote:piles", plan.piles.iter().map(|p| json!({"cell": p.cell, "panels": p.panels})).collect()),
        ("zygote:hinges", plan.hinges.iter().map(hinge_entry).collect()),
        ("vertices_coords", json!(cut.per_vertex(&plan.target))),
        ("faces_vertices", json!(cut.faces)),
        ("edges_vertices", json!(cut.edges)),
        ("edges_faces", json!(cut.edge_faces)),
    ];
    keys.extend(angles(plan, cut, |hinge| hinge.target_angle_deg));
    keys.push(("file_frames", json!([zygote_frame(plan, cut)])));
    keys.extend(plan.schedule.clone().map(|schedule| (SCHEDULE, schedule)));
    keys
}

fn zygote_frame(plan: &Plan, cut: &CutSurface) -> Value {
    let flat: Vec<[[i32; 3]; 4]> = plan.zygote.iter().map(|quad| quad.map(|[x, y]| [x, y, 0])).collect();
    let mut frame = json!({
        "frame_title": "zygote",
        "frame_classes": ["foldedForm"],
        "frame_attributes": ["2D", "orientable"],
        "frame_parent": 0,
        "frame_inherit": true,
        "vertices_coords": cut.per_vertex(&flat),
        "faceOrders": face_orders(plan),
    });
    for (key, value) in angles(plan, cut, |hinge| hinge.zygote_angle_deg) {
        frame[key] = value;
    }
    frame
}

fn hinge_entry(hinge: &Hinge) -> Value {
    let kind = match hinge.kind {
        HingeKind::Fold => "fold",
        HingeKind::Bridge => "bridge",
    };
    json!({
        "kind": kind, "panels": hinge.panels, "side": hinge.side.letter(), "opening_deg": hinge.opening_deg,
    })
}

/// Fold angles and the letters that go with them: of the hinges as they are, of the cut edges 0 and B.
fn angles(plan: &Plan, cut: &CutSurface, of: impl Fn(&Hinge) -> i16) -> [(&'static str, Value); 2] {
    let letter = |angle: i16| match angle {
        1.. => "V",
        0 => "F",
        _ => "M",
    };
    let borders = cut.edges.len() - plan.hinges.len();
    let angles: Vec<i16> = plan.hinges.iter().map(of).collect();
    let letters: Vec<&str> = angles.iter().map(|angle| letter(*angle)).chain(vec!["B"; borders]).collect();
    let angles: Vec<i16> = angles.into_iter().chain(vec![0; borders]).collect();
    [("edges_foldAngle", json!(angles)), ("edges_assignment", json!(letters))]
}

fn face_orders(plan: &Plan) -> Vec<(usize, usize, i8)> {
    let layers = plan.piles.iter().flat_map(|pile| pile.panels.windows(2).enumerate());
    layers.map(|(height, pair)| (pair[1], pair[0], if height % 2 == 0 { 1 } else { -1 })).collect()
}

/// The surface cut open along every edge without a hinge: panels share a vertex only through hinges.
struct CutSurface {
    faces: Vec<[usize; 4]>,
    edges: Vec<[usize; 2]>,
    edge_faces: Vec<Faces>,
    vertices: usize,
}

/// The faces at an edge.
#[derive(Serialize)]
#[serde(untagged)]
enum Faces {
    Hinge([usize; 2]),
    Cut([usize; 1]),
}

impl CutSurface {
    fn of(plan: &Plan) -> Self {
        // Corners that a hinge makes one: a forest of corners, numbered 4 * panel + corner.
        let mut same: Vec<usize> = (0..4 * plan.panels()).collect();
        for Hinge { panels: [a, b], edges: [e, f], .. } in &plan.hinges {
            for (corner, other) in [(*e, *f + 1), (*e + 1, *f)] {
                let (p, q) = (root(&mut same, 4 * a + corner % 4), root(&mut same, 4 * b + other % 4));
                same[p.max(q)] = p.min(q);
            }
        }
        let mut number = vec![usize::MAX; same.len()];
        let mut vertices = 0;
        let mut faces = Vec::with_capacity(plan.panels());
        for panel in 0..plan.panels() {
            faces.push([0, 1, 2, 3].map(|corner| {
                let name = root(&mut same, 4 * panel + corner);
                if number[name] == usize::MAX {
                    number[name] = vertices;
                    vertices += 1;
                }
                number[name]
            }));
        }
        let mut hinged = vec![[false; 4]; plan.panels()];
        let mut edges = Vec::with_capacity(3 * plan.panels() + 1);
        let mut edge_faces = Vec::with_capacity(3 * plan.panels() + 1);
        for Hinge { panels: [a, b], edges: [e, f], .. } in &plan.hinges {
            hinged[*a][*e] = true;
            hinged[*b][*f] = true;
            edges.push([faces[*a][*e], faces[*a][(e + 1) % 4]]);
            edge_faces.push(Faces::Hinge([*a, *b]));
        }
        for (panel, face) in faces.iter().enumerate() {
            for edge in (0..4).filter(|edge| !hinged[panel][*edge]) {
                edges.push([face[edge], face[(edge + 1) % 4]]);
                edge_faces.push(Faces::Cut([panel]));
            }
        }
        Self { faces, edges, edge_faces, vertices }
    }

    /// Positions by vertex, from positions by panel and corner.
    fn per_vertex(&self, quads: &[[[i32; 3]; 4]]) -> Vec<[i32; 3]> {
        let mut points = vec![[0; 3]; self.vertices];
        for (face, quad) in self.faces.iter().zip(quads) {
            for (vertex, point) in face.iter().zip(quad) {
                points[*vertex] = *point;
            }
        }
        points
    }
}

fn root(same: &mut [usize], mut corner: usize) -> usize {
    while same[corner] != corner {
        same[corner] = same[same[corner]];
        corner = same[corner];
    }
    corner
}
