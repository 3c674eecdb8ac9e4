//! Writes a plan as a FOLD file. The same plan gives the same bytes.

use super::SCHEDULE;
use super::layout_of_lines::KeyALine;
use crate::plan::{Hinge, HingeKind, Pile, Plan};
use crate::sets::Sets;
use serde::Serialize;
use serde::ser::{SerializeMap, Serializer};
use serde_json::json;
use std::io;

/// Bytes of the file for each panel, a little more than most plans need.
const BYTES_PER_PANEL: usize = 320;

/// A plan as the bytes of a `.fold` file.
///
/// # Errors
/// A schedule that JSON can't hold; nothing else in a plan can fail.
pub fn write(plan: &Plan) -> io::Result<Vec<u8>> {
    let cut = CutSurface::of(plan);
    let mut bytes = Vec::with_capacity(BYTES_PER_PANEL * plan.panels());
    File { plan, cut: &cut }
        .serialize(&mut serde_json::Serializer::with_formatter(&mut bytes, KeyALine::default()))?;
    bytes.push(b'\n');
    Ok(bytes)
}

/// The file, its keys in the order in which they stand there.
struct File<'a> {
    plan: &'a Plan,
    cut: &'a CutSurface,
}

impl Serialize for File<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let Self { plan, cut } = self;
        let mut file = serializer.serialize_map(None)?;
        file.serialize_entry("file_spec", &1.2)?;
        file.serialize_entry("file_creator", concat!("zygote ", env!("CARGO_PKG_VERSION")))?;
        file.serialize_entry("file_classes", &["singleModel"])?;
        file.serialize_entry("frame_title", "target")?;
        file.serialize_entry("frame_classes", &["foldedForm"])?;
        file.serialize_entry("frame_attributes", &["3D", "orientable"])?;
        file.serialize_entry("zygote:version", &1)?;
        file.serialize_entry("zygote:thickness", &plan.thickness)?;
        file.serialize_entry("zygote:panel_length_mm", &plan.panel_length_mm)?;
        file.serialize_entry("zygote:root", &plan.root)?;
        file.serialize_entry("zygote:ver", &plan.expansion_ratio())?;
        file.serialize_entry("zygote:source", &json!(plan.source))?;
        file.serialize_entry("zygote:piles", &Each(plan.piles.iter().map(PileEntry::of)))?;
        file.serialize_entry("zygote:hinges", &Each(plan.hinges.iter().map(HingeEntry::of)))?;
        file.serialize_entry("vertices_coords", &cut.per_vertex(&plan.target, |point| point))?;
        file.serialize_entry("faces_vertices", &cut.faces)?;
        file.serialize_entry("edges_vertices", &cut.edges)?;
        file.serialize_entry("edges_faces", &cut.edge_faces)?;
        file.serialize_entry(
            "edges_foldAngle",
            &Each(cut.of_edges(plan, |hinge| hinge.target_angle_deg, 0)),
        )?;
        file.serialize_entry(
            "edges_assignment",
            &Each(cut.of_edges(plan, |hinge| letter(hinge.target_angle_deg), "B")),
        )?;
        file.serialize_entry("file_frames", &[Zygote { plan, cut }])?;
        if let Some(schedule) = &plan.schedule {
            file.serialize_entry(SCHEDULE, schedule)?;
        }
        file.end()
    }
}

/// The zygote's frame, its keys in order.
struct Zygote<'a> {
    plan: &'a Plan,
    cut: &'a CutSurface,
}

impl Serialize for Zygote<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let Self { plan, cut } = self;
        let mut frame = serializer.serialize_map(None)?;
        frame.serialize_entry(
            "edges_assignment",
            &Each(cut.of_edges(plan, |hinge| letter(hinge.zygote_angle_deg), "B")),
        )?;
        frame.serialize_entry(
            "edges_foldAngle",
            &Each(cut.of_edges(plan, |hinge| hinge.zygote_angle_deg, 0)),
        )?;
        let layers = plan.piles.iter().flat_map(|pile| pile.panels.windows(2).enumerate());
        let orders = layers.map(|(height, pair)| (pair[1], pair[0], if height % 2 == 0 { 1 } else { -1 }));
        frame.serialize_entry("faceOrders", &Each(orders))?;
        frame.serialize_entry("frame_attributes", &["2D", "orientable"])?;
        frame.serialize_entry("frame_classes", &["foldedForm"])?;
        frame.serialize_entry("frame_inherit", &true)?;
        frame.serialize_entry("frame_parent", &0)?;
        frame.serialize_entry("frame_title", "zygote")?;
        frame.serialize_entry("vertices_coords", &cut.per_vertex(&plan.zygote, |[x, y]| [x, y, 0]))?;
        frame.end()
    }
}

/// An array, written entry by entry.
struct Each<I>(I);

impl<I: Iterator<Item: Serialize> + Clone> Serialize for Each<I> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_seq(self.0.clone())
    }
}

#[derive(Serialize)]
struct PileEntry<'a> {
    cell: [i32; 2],
    panels: &'a [usize],
}

impl<'a> PileEntry<'a> {
    fn of(pile: &'a Pile) -> Self {
        Self { cell: pile.cell, panels: &pile.panels }
    }
}

#[derive(Serialize)]
struct HingeEntry {
    kind: &'static str,
    opening_deg: u16,
    panels: [usize; 2],
    side: &'static str,
}

impl HingeEntry {
    fn of(hinge: &Hinge) -> Self {
        let kind = match hinge.kind {
            HingeKind::Fold => "fold",
            HingeKind::Bridge => "bridge",
        };
        let Hinge { opening_deg, panels, side, .. } = *hinge;
        Self { kind, opening_deg, panels, side: side.letter() }
    }
}

/// The letter that goes with a fold angle.
fn letter(angle: i16) -> &'static str {
    match angle {
        1.. => "V",
        0 => "F",
        _ => "M",
    }
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
        let mut same = Sets::new(4 * plan.panels());
        for Hinge { panels: [a, b], edges: [e, f], .. } in &plan.hinges {
            for (corner, other) in [(*e, *f + 1), (*e + 1, *f)] {
                same.join(4 * a + corner % 4, 4 * b + other % 4);
            }
        }
        let mut number = vec![usize::MAX; 4 * plan.panels()];
        let mut vertices = 0;
        let mut faces = Vec::with_capacity(plan.panels());
        for panel in 0..plan.panels() {
            faces.push([0, 1, 2, 3].map(|corner| {
                let name = same.find(4 * panel + corner);
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

    /// Something of every edge: of the hinges what they have, of the cut edges all the same.
    fn of_edges<'a, T: Copy + 'a>(
        &self,
        plan: &'a Plan,
        of: impl Fn(&Hinge) -> T + Clone + 'a,
        of_cut: T,
    ) -> impl Iterator<Item = T> + Clone {
        let cut_edges = self.edges.len() - plan.hinges.len();
        plan.hinges.iter().map(of).chain(std::iter::repeat_n(of_cut, cut_edges))
    }

    /// Positions by vertex, from positions by panel and corner.
    fn per_vertex<P: Copy>(&self, quads: &[[P; 4]], point_of: impl Fn(P) -> [i32; 3]) -> Vec<[i32; 3]> {
        let mut points = vec![[0; 3]; self.vertices];
        for (face, quad) in self.faces.iter().zip(quads) {
            for (vertex, point) in face.iter().zip(quad) {
                points[*vertex] = point_of(*point);
            }
        }
        points
    }
}
