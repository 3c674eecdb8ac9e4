//! A sheet as SVG in millimetres: a layer to cut, red hairlines, and a layer to engrave, blue. Lines alone, so that no font is missing.

use crate::drawing::{Cut, Drawing, short};
use std::fmt::Write as _;

/// The file of a sheet.
pub fn svg(drawing: &Drawing) -> String {
    let [width, height] = drawing.size_mm;
    let (w, h) = (short(width), short(height));
    let point = |[x, y]: [f64; 2]| format!("{} {}", short(x), short(height - y));
    let run = |points: &[[f64; 2]]| points.iter().map(|at| point(*at)).collect::<Vec<_>>().join("L");
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" xmlns:inkscape=\"http://www.inkscape.org/namespaces/inkscape\" \
         width=\"{w}mm\" height=\"{h}mm\" viewBox=\"0 0 {w} {h}\" fill=\"none\" stroke-width=\"0.1\">\n<title>{}</title>\n",
        escaped(&drawing.title)
    );
    // Engraved first: what is cut out moves.
    svg.push_str(&layer("engrave", "#00f"));
    for text in &drawing.texts {
        let path: Vec<_> = text.strokes.iter().map(|stroke| format!("M{}", run(stroke))).collect();
        let _infallible =
            writeln!(svg, "<path aria-label=\"{}\" d=\"{}\"/>", escaped(&text.text), path.concat());
    }
    svg.push_str("</g>\n");
    svg.push_str(&layer("cut", "#f00"));
    for cut in &drawing.cuts {
        let _infallible = match *cut {
            Cut::Rectangle { low, high } => {
                writeln!(svg, "<path d=\"M{}z\"/>", run(&Cut::corners(low, high)))
            }
            Cut::Circle { middle: [x, y], radius } => writeln!(
                svg,
                "<circle cx=\"{}\" cy=\"{}\" r=\"{}\"/>",
                short(x),
                short(height - y),
                short(radius)
            ),
        };
    }
    svg.push_str("</g>\n</svg>\n");
    svg
}

fn layer(name: &str, colour: &str) -> String {
    format!("<g id=\"{name}\" inkscape:groupmode=\"layer\" inkscape:label=\"{name}\" stroke=\"{colour}\">\n")
}

/// Text as XML shows it.
pub(crate) fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}
