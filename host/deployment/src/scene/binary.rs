//! The numbers of a scene, as the format wants them: in one buffer, each run with a view and an accessor.

use serde_json::{Value, json};

/// The format's code for a 32-bit float.
const FLOAT: u32 = 5126;

/// The format's code for what a graphics card draws.
const VERTICES: u32 = 34962;

/// The buffer so far.
#[derive(Default)]
pub(super) struct Binary {
    pub(super) bytes: Vec<u8>,
    pub(super) views: Vec<Value>,
    pub(super) accessors: Vec<Value>,
}

impl Binary {
    /// Adds numbers; gives the index of their accessor.
    pub(super) fn scalars(&mut self, numbers: &[f32]) -> usize {
        self.add("SCALAR", numbers.iter().map(std::slice::from_ref))
    }

    /// Adds rows of three or four numbers; gives the index of their accessor.
    pub(super) fn rows(&mut self, rows: &[Vec<f32>]) -> usize {
        let kind = if rows.first().is_some_and(|row| row.len() == 4) { "VEC4" } else { "VEC3" };
        self.add(kind, rows.iter().map(Vec::as_slice))
    }

    /// Adds rows of three numbers that are drawn; gives the index of their accessor.
    pub(super) fn vertices(&mut self, rows: &[Vec<f32>]) -> usize {
        let accessor = self.rows(rows);
        if let Some(view) = self.views.last_mut() {
            view["target"] = json!(VERTICES);
        }
        accessor
    }

    fn add<'a>(&mut self, kind: &str, rows: impl Iterator<Item = &'a [f32]> + Clone) -> usize {
        let offset = self.bytes.len();
        let width = rows.clone().next().map_or(0, <[f32]>::len);
        let (mut least, mut most) = (vec![f32::INFINITY; width], vec![f32::NEG_INFINITY; width]);
        let mut count = 0;
        for row in rows {
            count += 1;
            for (at, number) in row.iter().enumerate() {
                self.bytes.extend(number.to_le_bytes());
                least[at] = least[at].min(*number);
                most[at] = most[at].max(*number);
            }
        }
        self.views
            .push(json!({ "buffer": 0, "byteOffset": offset, "byteLength": self.bytes.len() - offset }));
        self.accessors.push(json!({
            "bufferView": self.views.len() - 1,
            "componentType": FLOAT,
            "count": count,
            "type": kind,
            "min": least,
            "max": most,
        }));
        self.accessors.len() - 1
    }
}
