//! The arrays of a plan file, read for shape: lengths, index ranges, points on the lattice. Only a file that has its shape
//! can be checked further.

use super::column::{Column, Listed};
use super::file::{FrameColumns, PlanFile};
use super::items::{Edge, EdgeFaces, Face, HingeEntry, Letter, Order};
use super::report::{Report, Rule};
use crate::plan::Pile;
use serde_json::{Map, Value};

/// How keys of the zygote's frame are called in messages.
pub(super) const ZYGOTE: &str = "file_frames[0].";

/// Keys of one object of the file that are no columns.
pub(crate) type Heads = Map<String, Value>;

/// The arrays that both frames have of their own.
pub(crate) struct FrameArrays {
    /// What stands before the keys in messages.
    pub(super) prefix: &'static str,
    pub(crate) points: Vec<[i32; 3]>,
    pub(crate) angles: Vec<f64>,
    pub(super) letters: Column<Letter>,
}

/// A plan file that has its shape.
pub(crate) struct Document {
    pub(crate) faces: Vec<[usize; 4]>,
    pub(crate) edges: Vec<[usize; 2]>,
    pub(crate) edge_faces: Vec<EdgeFaces>,
    pub(crate) target: FrameArrays,
    pub(crate) zygote: FrameArrays,
    pub(crate) hinges: Vec<HingeEntry>,
    pub(crate) piles: Vec<Pile>,
    pub(crate) thickness: f64,
    /// Whatever stands at the top level and in the zygote's frame beside the arrays.
    pub(crate) heads: Heads,
    pub(super) zygote_heads: Heads,
    pub(super) ver: Option<f64>,
    pub(super) face_orders: Column<Order>,
}

impl Document {
    /// Takes the arrays; what doesn't fit goes into the report, and then there is no document.
    pub(crate) fn read(file: PlanFile, report: &mut Report) -> Option<Self> {
        let Some(frame) = file.zygote else {
            report.add(Rule::Missing, "file_frames", "expected an array with the zygote's frame, found none");
            return None;
        };
        let mut reader = Reader { report, sound: true };
        let face_list = reader.array(file.faces, "", "faces_vertices", None)?;
        let panels = face_list.entries.len();
        if panels == 0 {
            report.add(Rule::Count, "faces_vertices", "no panels");
            return None;
        }
        let (vertex_count, edge_count) = (2 * panels + 2, 3 * panels + 1);
        let vertices = format!("numbers below 2N+2 = {vertex_count}");
        let expected = format!("4 vertex {vertices}");
        reader.each("", "faces_vertices", &face_list, &expected, |_, face| within(&face.0, vertex_count));
        let edge_list = reader.array(file.edges, "", "edges_vertices", Some(edge_count))?;
        let expected = format!("2 vertex {vertices}");
        reader.each("", "edges_vertices", &edge_list, &expected, |_, edge| within(&edge.0, vertex_count));
        let face_lists = reader.array(file.edge_faces, "", "edges_faces", Some(edge_count))?;
        reader.each(
            "",
            "edges_faces",
            &face_lists,
            "2 panel numbers in range for a hinge, 1 for a cut edge",
            |index, faces| {
                let panels_there = faces.panels();
                let wanted = if index + 1 < panels { 2 } else { 1 };
                if panels_there.len() == wanted {
                    within(panels_there, panels)
                } else {
                    Some(format!("{panels_there:?}"))
                }
            },
        );
        let (target, _, heads) = reader.frame(file.target, "", panels)?;
        let (zygote, orders, zygote_heads) = reader.frame(frame, ZYGOTE, panels)?;
        let hinges = reader.array(file.hinges, "", "zygote:hinges", Some(panels - 1))?;
        reader.each("", "zygote:hinges", &hinges, "kind, panels, side and opening_deg", |_, hinge| {
            within(&hinge.panels, panels)
        });
        let piles = reader.array(file.piles, "", "zygote:piles", None)?;
        reader.each(
            "",
            "zygote:piles",
            &piles,
            "a cell of 2 integers and panel numbers in range",
            |_, pile| {
                let far = pile.panels.iter().find(|panel| **panel >= panels)?;
                Some(format!("panel {far}"))
            },
        );
        let face_orders = reader.array(orders, ZYGOTE, "faceOrders", None)?;
        let thickness = heads.get("zygote:thickness");
        let length = thickness.and_then(Value::as_f64).filter(|t| *t > 0.0);
        let sound = reader.sound;
        let (edges, piles) = (edge_list.entries, piles.entries);
        report
            .require(!piles.is_empty() || !sound, Rule::Count, || ("zygote:piles".into(), "no piles".into()));
        report.require(length.is_some(), Rule::Shape, || {
            let found = thickness.unwrap_or(&Value::Null);
            ("zygote:thickness".into(), format!("expected t/L above 0, found {found}"))
        });
        let thickness = length.filter(|_| sound && !piles.is_empty())?;
        let ver = heads.get("zygote:ver").and_then(Value::as_f64);
        Some(Self {
            faces: face_list.entries.into_iter().map(|Face(face)| face).collect(),
            edges: edges.into_iter().map(|Edge(edge)| edge).collect(),
            edge_faces: face_lists.entries,
            target,
            zygote,
            hinges: hinges.entries,
            piles,
            thickness,
            heads,
            zygote_heads,
            ver,
            face_orders,
        })
    }

    /// The number of panels.
    pub(crate) fn panels(&self) -> usize {
        self.faces.len()
    }

    /// The number of hinges; the edges after them are cut.
    pub(crate) fn hinge_count(&self) -> usize {
        self.panels() - 1
    }
}

/// What to say of numbers that are not all below a limit.
fn within(numbers: &[usize], limit: usize) -> Option<String> {
    if numbers.iter().all(|number| *number < limit) { None } else { Some(format!("{numbers:?}")) }
}

/// Takes columns and notes what doesn't fit.
struct Reader<'a> {
    report: &'a mut Report,
    sound: bool,
}

impl Reader<'_> {
    /// The array under a key. Where it isn't one or has the wrong length, nothing further can be read.
    fn array<T>(
        &mut self,
        list: Listed<T>,
        prefix: &str,
        key: &str,
        length: Option<usize>,
    ) -> Option<Column<T>> {
        let place = || format!("{prefix}{key}");
        let wanted = length.map_or("an array".into(), |length| format!("an array of {length} entries"));
        let Some(column) = list.0 else {
            self.report.add(Rule::Missing, place(), format!("expected {wanted}, found none"));
            return None;
        };
        let found = column.entries.len();
        if length.is_some_and(|length| found != length) {
            self.report.add(Rule::Count, place(), format!("expected {wanted}, found {found} entries"));
            return None;
        }
        Some(column)
    }

    /// Looks at every entry of an array: one that is odd, or that `wrong` has something to say of, doesn't fit.
    fn each<T>(
        &mut self,
        prefix: &str,
        key: &str,
        column: &Column<T>,
        expected: &str,
        wrong: impl Fn(usize, &T) -> Option<String>,
    ) {
        for (number, entry) in column.entries.iter().enumerate() {
            let odd = if column.odd.is_empty() { None } else { column.odd.get(&number).cloned() };
            if let Some(found) = odd.or_else(|| wrong(number, entry)) {
                self.sound = false;
                let message = format!("expected {expected}, found {found}");
                self.report.add(Rule::Shape, format!("{prefix}{key}[{number}]"), message);
            }
        }
    }

    /// The arrays of a frame that have their shape, the orders as they stand, and the heads.
    fn frame(
        &mut self,
        columns: FrameColumns,
        prefix: &'static str,
        panels: usize,
    ) -> Option<(FrameArrays, Listed<Order>, Heads)> {
        let (vertex_count, edge_count) = (2 * panels + 2, 3 * panels + 1);
        let points = self.array(columns.points, prefix, "vertices_coords", Some(vertex_count))?;
        self.each(prefix, "vertices_coords", &points, "3 whole numbers: on the lattice", |_, _| None);
        let angles = self.array(columns.angles, prefix, "edges_foldAngle", Some(edge_count))?;
        self.each(prefix, "edges_foldAngle", &angles, "a number", |_, _| None);
        let letters = self.array(columns.letters, prefix, "edges_assignment", Some(edge_count))?;
        let arrays = FrameArrays {
            prefix,
            points: points.entries.into_iter().map(|point| point.0).collect(),
            angles: angles.entries.into_iter().map(|angle| angle.0).collect(),
            letters,
        };
        Some((arrays, columns.face_orders, columns.rest))
    }
}
