//! A sheet as DXF release 12, ASCII: the least that every cutter's program reads. Two layers, CUT in red and ENGRAVE in
//! blue, of polylines and circles. The format has no unit: one unit is a millimetre.

use crate::drawing::{Cut, Drawing, short};
use std::fmt::Display;

/// The file of a sheet.
pub fn dxf(drawing: &Drawing) -> String {
    let mut file = File::default();
    file.pair(999, printable(&drawing.title));
    file.section("HEADER");
    file.pair(9, "$ACADVER").pair(1, "AC1009");
    file.pair(9, "$EXTMIN").point([0.0, 0.0]);
    file.pair(9, "$EXTMAX").point(drawing.size_mm);
    file.pair(0, "ENDSEC");
    file.section("TABLES");
    file.pair(0, "TABLE").pair(2, "LTYPE").pair(70, 1);
    file.pair(0, "LTYPE").pair(2, "CONTINUOUS").pair(70, 0).pair(3, "Solid line").pair(72, 65).pair(73, 0);
    file.pair(40, "0.0").pair(0, "ENDTAB");
    file.pair(0, "TABLE").pair(2, "LAYER").pair(70, 2);
    for (layer, colour) in [("CUT", 1), ("ENGRAVE", 5)] {
        file.pair(0, "LAYER").pair(2, layer).pair(70, 0).pair(62, colour).pair(6, "CONTINUOUS");
    }
    file.pair(0, "ENDTAB").pair(0, "ENDSEC");
    file.section("ENTITIES");
    // Engraved first: what is cut out moves.
    for stroke in drawing.texts.iter().flat_map(|text| &text.strokes) {
        file.line("ENGRAVE", stroke, false);
    }
    for cut in &drawing.cuts {
        match *cut {
            Cut::Rectangle { low, high } => file.line("CUT", &Cut::corners(low, high), true),
            Cut::Circle { middle, radius } => {
                file.pair(0, "CIRCLE").pair(8, "CUT").point(middle).pair(40, short(radius));
            }
        }
    }
    file.pair(0, "ENDSEC").pair(0, "EOF");
    file.text
}

/// Pairs of a group code and a value, a line each.
#[derive(Default)]
struct File {
    text: String,
}

impl File {
    fn pair(&mut self, code: u16, value: impl Display) -> &mut Self {
        use std::fmt::Write as _;
        // Writing to a String can't fail.
        let _infallible = write!(self.text, "{code}\r\n{value}\r\n");
        self
    }

    fn section(&mut self, name: &str) {
        self.pair(0, "SECTION").pair(2, name);
    }

    fn point(&mut self, [x, y]: [f64; 2]) -> &mut Self {
        self.pair(10, short(x)).pair(20, short(y))
    }

    fn line(&mut self, layer: &str, points: &[[f64; 2]], closed: bool) {
        self.pair(0, "POLYLINE").pair(8, layer).pair(66, 1).point([0.0, 0.0]).pair(70, u8::from(closed));
        for point in points {
            self.pair(0, "VERTEX").pair(8, layer).point(*point);
        }
        self.pair(0, "SEQEND").pair(8, layer);
    }
}

/// A title in the characters that the format has, on one line.
fn printable(text: &str) -> String {
    text.chars().map(|letter| if letter == ' ' || letter.is_ascii_graphic() { letter } else { '?' }).collect()
}
