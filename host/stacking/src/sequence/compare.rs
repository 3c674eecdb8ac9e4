//! What two sequences differ in, place by place: a text that somebody typed, or stacked by, against a plan.

use super::error::Place;
use super::{Layer, Sequence, SequenceText};
use std::fmt::{self, Write as _};

/// A place at which a text says something else than a plan.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Difference {
    /// The place in the text; none for a pile that it doesn't have.
    pub place: Option<Place>,
    /// The cell.
    pub cell: [i32; 2],
    /// The height; none where it is about a whole pile.
    pub height: Option<usize>,
    /// What the plan has, in the words of the grammar.
    pub expected: String,
    /// What the text has.
    pub found: String,
}

impl fmt::Display for Difference {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(place) = self.place {
            write!(f, "{place}: ")?;
        }
        let [i, j] = self.cell;
        write!(f, "pile ({i},{j})")?;
        if let Some(height) = self.height {
            write!(f, ", height {height}")?;
        }
        write!(f, ": expected {}, found {}", self.expected, self.found)
    }
}

impl SequenceText {
    /// Where this text differs from a sequence. The order of the lines doesn't count, nor does the fixed panel where the text
    /// names none.
    pub fn differences(&self, expected: &Sequence) -> Vec<Difference> {
        let mut found = Vec::new();
        let on_cell = self.sequence.on_cell();
        let rootless =
            !self.sequence.columns.iter().flat_map(|column| &column.layers).any(|layer| layer.root);
        for column in &expected.columns {
            let pile = |height: usize| format!("a pile of {height} panels");
            let whole = |place, has| Difference {
                place,
                cell: column.cell,
                height: None,
                expected: pile(column.layers.len()),
                found: has,
            };
            let Some(&number) = on_cell.get(&column.cell) else {
                found.push(whole(None, "none".into()));
                continue;
            };
            let layers = &self.sequence.columns[number].layers;
            if layers.len() != column.layers.len() {
                found.push(whole(Some(self.columns[number]), pile(layers.len())));
                continue;
            }
            for (height, (here, there)) in layers.iter().zip(&column.layers).enumerate() {
                let there = Layer { root: there.root && !rootless, ..there.clone() };
                if *here != there {
                    found.push(Difference {
                        place: Some(self.layers[number][height]),
                        cell: column.cell,
                        height: Some(height),
                        expected: word(&there),
                        found: word(here),
                    });
                }
            }
        }
        let known = expected.on_cell();
        for (column, place) in self.sequence.columns.iter().zip(&self.columns) {
            if !known.contains_key(&column.cell) {
                found.push(Difference {
                    place: Some(*place),
                    cell: column.cell,
                    height: None,
                    expected: "none".into(),
                    found: format!("a pile of {} panels", column.layers.len()),
                });
            }
        }
        found
    }
}

/// A layer in the words of the grammar, but for a missing hinge, which is plain words.
fn word(layer: &Layer) -> String {
    let mut word = if layer.root { "*".to_owned() } else { String::new() };
    for bridge in &layer.bridges {
        // Writing to a String can't fail.
        let _infallible = write!(word, "[{bridge}]");
    }
    match layer.above {
        Some(above) => word + &above.to_string(),
        None if word.is_empty() => "no hinge above".into(),
        None => word + " and no hinge above",
    }
}
