//! What a cutter gets, before it is written in one format or the other: lines to cut and lines to engrave, millimetres, y up.

use crate::letters;

/// One sheet.
#[derive(Debug, Clone, PartialEq)]
pub struct Drawing {
    /// What it is.
    pub title: String,
    /// Width and height.
    pub size_mm: [f64; 2],
    /// Lines to cut through.
    pub cuts: Vec<Cut>,
    /// Lines to engrave.
    pub texts: Vec<Engraved>,
}

/// A closed line to cut.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Cut {
    /// With sides along the axes.
    Rectangle {
        /// The lower left corner.
        low: [f64; 2],
        /// The upper right corner.
        high: [f64; 2],
    },
    /// A round hole.
    Circle {
        /// Its middle.
        middle: [f64; 2],
        /// Its radius.
        radius: f64,
    },
}

/// A text to engrave, as lines.
#[derive(Debug, Clone, PartialEq)]
pub struct Engraved {
    /// What it says.
    pub text: String,
    /// Runs of points.
    pub strokes: Vec<Vec<[f64; 2]>>,
}

impl Engraved {
    pub(crate) fn new(text: String, height: f64, foot: [f64; 2], quarters: usize) -> Self {
        let strokes = letters::strokes(&text, height, foot, quarters);
        Self { text, strokes }
    }
}

impl Cut {
    /// The corners of a rectangle, counter-clockwise.
    pub(crate) fn corners([left, low]: [f64; 2], [right, high]: [f64; 2]) -> [[f64; 2]; 4] {
        [[left, low], [right, low], [right, high], [left, high]]
    }
}

/// A length to the thousandth of a millimetre, without zeros at its end.
pub(crate) fn short(value: f64) -> String {
    let text = format!("{value:.3}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" { "0".to_owned() } else { text.to_owned() }
}
