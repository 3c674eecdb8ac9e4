//! An SVG file: scenes, captions, and the classes that they share.

use super::camera::Bounds;
use super::scene::{Paint, Scene, Shape};
use glam::DVec2;
use std::collections::BTreeMap;
use std::fmt::Write as _;

/// Units of the file for one pixel: whole numbers are shorter than decimals and still fine enough.
const UNITS: f64 = 10.0;

/// An SVG being written. Lengths are pixels.
pub(super) struct Document {
    size: DVec2,
    /// Pixels for a panel length.
    scale: f64,
    classes: BTreeMap<Paint, usize>,
    body: String,
}

impl Document {
    pub(super) fn new(size: DVec2, scale: f64) -> Self {
        Self { size: size.ceil(), scale, classes: BTreeMap::new(), body: String::new() }
    }

    /// The pixel size that `bounds` takes.
    pub(super) fn extent(&self, bounds: &Bounds) -> DVec2 {
        bounds.size() * self.scale
    }

    /// Draws a scene so that the lower left corner of `bounds`, in the scene's panel lengths, comes to `at`.
    pub(super) fn scene(&mut self, scene: &Scene, bounds: &Bounds, at: DVec2) {
        let origin = at - DVec2::new(bounds.low.x, bounds.high.y) * self.scale;
        for shape in &scene.shapes {
            let next = self.classes.len();
            let class = *self.classes.entry(shape.paint).or_insert(next);
            let path = path(shape, origin, self.scale);
            self.write(format_args!("<path class=\"{}\" d=\"{path}\"/>\n", name(class)));
        }
    }

    /// Writes a line of text, its middle at `at`.
    pub(super) fn caption(&mut self, text: &str, at: DVec2, class: &str) {
        let [x, y] = units(at);
        self.write(format_args!("<text class=\"{class}\" x=\"{x}\" y=\"{y}\">{}</text>\n", escape(text)));
    }

    /// Adds markup of the caller's own; lengths in it are [`Document::units`].
    pub(super) fn raw(&mut self, markup: std::fmt::Arguments<'_>) {
        self.write(markup);
    }

    /// A length in units of the file.
    pub(super) fn units(pixels: f64) -> i64 {
        units(DVec2::splat(pixels))[0]
    }

    /// The whole file.
    pub(super) fn finish(self, title: &str) -> String {
        let [width, height] = units(self.size);
        let mut svg = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{}\" height=\"{}\" viewBox=\"0 0 {width} {height}\">\n\
             <title>{}</title>\n<style>\n{STYLE}",
            self.size.x,
            self.size.y,
            escape(title)
        );
        for (paint, class) in &self.classes {
            let fill = paint.fill.map_or("none".to_owned(), |fill| fill.to_string());
            let width = f64::from(paint.width) / 1e3 * self.scale * UNITS;
            let _infallible = writeln!(
                svg,
                ".{}{{fill:{fill};stroke:{};stroke-width:{width:.1}}}",
                name(*class),
                paint.stroke
            );
        }
        let _infallible = write!(
            svg,
            "</style>\n<rect class=\"ground\" width=\"{width}\" height=\"{height}\" rx=\"120\"/>\n{}</svg>\n",
            self.body
        );
        svg
    }

    fn write(&mut self, markup: std::fmt::Arguments<'_>) {
        // Writing to a String can't fail.
        let _infallible = self.body.write_fmt(markup);
    }
}

/// Light and dark grounds; the panels' colours go with both.
const STYLE: &str = "\
path{stroke-linejoin:round;stroke-linecap:round}
text{font-family:Inter,'Helvetica Neue',Helvetica,Arial,sans-serif;text-anchor:middle}
.ground{fill:#f5f4f0}.head{font-size:170px;font-weight:600;fill:#2b2d31}.note{font-size:140px;fill:#6b6e75}
.mark{font-size:120px;font-weight:600;fill:#fff}
.rail{fill:#d9d7d0}.bar{fill:#6b6e75}
@media(prefers-color-scheme:dark){.ground{fill:#1c1e22}.head{fill:#e8e6e1}.note{fill:#9a9da4}.rail{fill:#34373d}.bar{fill:#9a9da4}}
";

/// A class name: letters count up, `a` to `z`, then `ba`, and so on.
fn name(mut class: usize) -> String {
    let mut letters = Vec::new();
    loop {
        letters.push(char::from(b'a' + u8::try_from(class % 26).unwrap_or(0)));
        class /= 26;
        if class == 0 {
            // A capital first, so that no class is a word of the style sheet.
            return letters.iter().rev().collect::<String>().to_uppercase();
        }
    }
}

fn units(at: DVec2) -> [i64; 2] {
    #[expect(clippy::cast_possible_truncation, reason = "pictures are far smaller than 2^63 units")]
    let whole = [(at.x * UNITS).round() as i64, (at.y * UNITS).round() as i64];
    whole
}

fn path(shape: &Shape, origin: DVec2, scale: f64) -> String {
    let mut d = String::new();
    for run in &shape.runs {
        let mut last: Option<[i64; 2]> = None;
        for point in run {
            let [x, y] = units(origin + *point * scale);
            let _infallible = match last {
                None => write!(d, "M{x} {y}l"),
                // A minus sign parts numbers by itself.
                Some([x0, y0]) => {
                    let space = if d.ends_with('l') || x < x0 { "" } else { " " };
                    let comma = if y < y0 { "" } else { " " };
                    write!(d, "{space}{}{comma}{}", x - x0, y - y0)
                }
            };
            last = Some([x, y]);
        }
        if shape.paint.fill.is_some() {
            d.push('z');
        }
    }
    d
}

fn escape(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}
