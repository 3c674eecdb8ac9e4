//! The arrays of a plan file, read for shape: lengths, index ranges, points on the lattice. Only a file that has its shape
//! can be checked further.

use super::json::{cell, index, indices, lattice_point};
use super::report::{Report, Rule};
use crate::plan::{HingeKind, Pile, Side};
use serde_json::Value;

/// How keys of the zygote's frame are called in messages.
pub(super) const ZYGOTE: &str = "file_frames[0].";

/// The arrays that both frames have of their own.
pub(crate) struct FrameArrays {
    /// What stands before the keys in messages.
    pub(super) prefix: &'static str,
    pub(crate) points: Vec<[i32; 3]>,
    pub(crate) angles: Vec<f64>,
    pub(super) letters: Vec<Option<String>>,
}

/// An entry of `zygote:hinges`.
pub(crate) struct HingeEntry {
    pub(crate) kind: HingeKind,
    pub(crate) panels: [usize; 2],
    pub(crate) side: Side,
    pub(crate) opening_deg: u16,
}

/// A plan file that has its shape.
pub(crate) struct Document {
    pub(crate) faces: Vec<[usize; 4]>,
    pub(crate) edges: Vec<[usize; 2]>,
    /// Two panels for a hinge, one for a cut edge.
    pub(crate) edge_faces: Vec<Vec<usize>>,
    pub(crate) target: FrameArrays,
    pub(crate) zygote: FrameArrays,
    pub(crate) hinges: Vec<HingeEntry>,
    pub(crate) piles: Vec<Pile>,
    pub(crate) thickness: f64,
    pub(super) ver: Option<f64>,
    pub(super) face_orders: Vec<Value>,
}

impl Document {
    /// Reads the arrays; what doesn't fit goes into the report, and then there is no document.
    pub(crate) fn read(file: &Value, report: &mut Report) -> Option<Self> {
        let Some(frame) = file["file_frames"].get(0).filter(|frame| frame.is_object()) else {
            report.add(Rule::Missing, "file_frames", "expected an array with the zygote's frame, found none");
            return None;
        };
        let mut reader = Reader { report, sound: true };
        let face_list = reader.array(file, "", "faces_vertices", None)?;
        let panels = face_list.len();
        if panels == 0 {
            report.add(Rule::Count, "faces_vertices", "no panels");
            return None;
        }
        let (vertex_count, edge_count) = (2 * panels + 2, 3 * panels + 1);
        let vertices = format!("numbers below 2N+2 = {vertex_count}");
        let faces = reader
            .each("faces_vertices", face_list, &format!("4 vertex {vertices}"), |v| indices(v, vertex_count));
        let edge_list = reader.array(file, "", "edges_vertices", Some(edge_count))?;
        let edges = reader
            .each("edges_vertices", edge_list, &format!("2 vertex {vertices}"), |v| indices(v, vertex_count));
        let face_lists = reader.array(file, "", "edges_faces", Some(edge_count))?;
        let (hinge_faces, cut_faces) = face_lists.split_at(panels - 1);
        let pairs =
            reader.each("edges_faces", hinge_faces, "2 panel numbers in range", |v| indices::<2>(v, panels));
        let singles =
            reader.each_from(panels - 1, "edges_faces", cut_faces, "1 panel number in range", |v| {
                indices::<1>(v, panels)
            });
        let target = reader.frame(file, "", panels)?;
        let zygote = reader.frame(frame, ZYGOTE, panels)?;
        let hinge_list = reader.array(file, "", "zygote:hinges", Some(panels - 1))?;
        let hinges = reader.each("zygote:hinges", hinge_list, "kind, panels, side and opening_deg", |v| {
            hinge_entry(v, panels)
        });
        let pile_list = reader.array(file, "", "zygote:piles", None)?;
        let piles =
            reader.each("zygote:piles", pile_list, "a cell of 2 integers and panel numbers in range", |v| {
                pile_entry(v, panels)
            });
        let face_orders = reader.array(frame, ZYGOTE, "faceOrders", None)?.clone();
        let thickness = file["zygote:thickness"].as_f64().filter(|t| *t > 0.0);
        let sound = reader.sound;
        report
            .require(!piles.is_empty() || !sound, Rule::Count, || ("zygote:piles".into(), "no piles".into()));
        report.require(thickness.is_some(), Rule::Shape, || {
            ("zygote:thickness".into(), format!("expected t/L above 0, found {}", file["zygote:thickness"]))
        });
        let edge_faces = pairs.iter().map(|p| p.to_vec()).chain(singles.iter().map(|s| s.to_vec())).collect();
        let thickness = thickness.filter(|_| sound && !piles.is_empty())?;
        let ver = file["zygote:ver"].as_f64();
        Some(Self { faces, edges, edge_faces, target, zygote, hinges, piles, thickness, ver, face_orders })
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

fn hinge_entry(value: &Value, panels: usize) -> Option<HingeEntry> {
    let kind = match value["kind"].as_str()? {
        "fold" => HingeKind::Fold,
        "bridge" => HingeKind::Bridge,
        _ => return None,
    };
    let letter = value["side"].as_str()?;
    let side = Side::ALL.into_iter().find(|side| side.letter() == letter)?;
    let opening = &value["opening_deg"];
    let opening_deg =
        [90, 180, 270].into_iter().find(|degrees| opening.as_f64() == Some(f64::from(*degrees)))?;
    Some(HingeEntry { kind, panels: indices(&value["panels"], panels)?, side, opening_deg })
}

fn pile_entry(value: &Value, panels: usize) -> Option<Pile> {
    let list = value["panels"].as_array()?;
    let panels = list.iter().map(|panel| index(panel, panels)).collect::<Option<_>>()?;
    Some(Pile { cell: cell(&value["cell"])?, panels })
}

/// Reads arrays and notes what doesn't fit.
struct Reader<'a> {
    report: &'a mut Report,
    sound: bool,
}

impl Reader<'_> {
    /// The array under a key. Where it isn't one or has the wrong length, nothing further can be read.
    fn array<'v>(
        &mut self,
        frame: &'v Value,
        prefix: &str,
        key: &str,
        length: Option<usize>,
    ) -> Option<&'v Vec<Value>> {
        let place = || format!("{prefix}{key}");
        let wanted = length.map_or("an array".into(), |length| format!("an array of {length} entries"));
        let Some(list) = frame[key].as_array() else {
            self.report.add(Rule::Missing, place(), format!("expected {wanted}, found none"));
            return None;
        };
        if length.is_some_and(|length| list.len() != length) {
            self.report.add(Rule::Count, place(), format!("expected {wanted}, found {} entries", list.len()));
            return None;
        }
        Some(list)
    }

    /// The entries of an array.
    fn each<T>(
        &mut self,
        key: &str,
        list: &[Value],
        expected: &str,
        read: impl Fn(&Value) -> Option<T>,
    ) -> Vec<T> {
        self.each_from(0, key, list, expected, read)
    }

    /// The entries of a part of an array that begins at `first`.
    fn each_from<T>(
        &mut self,
        first: usize,
        key: &str,
        list: &[Value],
        expected: &str,
        read: impl Fn(&Value) -> Option<T>,
    ) -> Vec<T> {
        let mut found = Vec::with_capacity(list.len());
        for (number, value) in list.iter().enumerate() {
            if let Some(entry) = read(value) {
                found.push(entry);
            } else {
                self.sound = false;
                let message = format!("expected {expected}, found {}", shortened(value));
                self.report.add(Rule::Shape, format!("{key}[{}]", first + number), message);
            }
        }
        found
    }

    fn frame(&mut self, frame: &Value, prefix: &'static str, panels: usize) -> Option<FrameArrays> {
        let (vertex_count, edge_count) = (2 * panels + 2, 3 * panels + 1);
        let key = |name: &str| format!("{prefix}{name}");
        let points = self.array(frame, prefix, "vertices_coords", Some(vertex_count))?;
        let points =
            self.each(&key("vertices_coords"), points, "3 whole numbers: on the lattice", lattice_point);
        let angles = self.array(frame, prefix, "edges_foldAngle", Some(edge_count))?;
        let angles = self.each(&key("edges_foldAngle"), angles, "a number", Value::as_f64);
        let letters = self.array(frame, prefix, "edges_assignment", Some(edge_count))?;
        let letters = letters.iter().map(|letter| letter.as_str().map(str::to_owned)).collect();
        Some(FrameArrays { prefix, points, angles, letters })
    }
}

/// What was found, short enough for a message.
fn shortened(value: &Value) -> String {
    const LONGEST: usize = 60;
    let text = value.to_string();
    if text.chars().count() <= LONGEST {
        text
    } else {
        text.chars().take(LONGEST).chain("...".chars()).collect()
    }
}
