//! A plot over the time of the run, as SVG.

use super::{Html, axis, escaped};
use std::fmt::Write as _;

/// Pixels of the drawing; the page scales it.
pub(super) const WIDTH: f64 = 960.0;
pub(super) const LEFT: f64 = 52.0;
const RIGHT: f64 = 14.0;
const TOP: f64 = 12.0;
const FLOOR: f64 = 26.0;
const HEIGHT: f64 = 230.0;
/// Points further apart than this are two curves: nothing was measured between them, s.
const GAP_S: f64 = 1.5;
/// So many columns show all that a screen can.
const COLUMNS: f64 = 480.0;

/// A line through points of time and value.
pub(super) struct Curve {
    /// Its class in the style.
    pub(super) class: &'static str,
    /// What is shown when somebody points at it.
    pub(super) name: String,
    pub(super) points: Vec<(f64, f64)>,
    /// Where many points share a column, the lowest of them is the one that matters.
    pub(super) lowest: bool,
}

/// A value that stays.
pub(super) struct Level {
    pub(super) class: &'static str,
    pub(super) name: String,
    pub(super) value: f64,
}

/// What is drawn.
pub(super) struct Plot {
    pub(super) about: String,
    pub(super) unit: &'static str,
    pub(super) end_s: f64,
    pub(super) least: f64,
    pub(super) curves: Vec<Curve>,
    pub(super) levels: Vec<Level>,
    /// Times at which something went wrong.
    pub(super) faults: Vec<f64>,
}

/// Where a time is, from the left.
pub(super) fn x(at: f64, end_s: f64) -> f64 {
    LEFT + (WIDTH - LEFT - RIGHT) * at / end_s.max(1e-3)
}

/// Lines up and down at round times, with their labels under `floor`.
pub(super) fn time_axis(page: &mut Html, end_s: f64, top: f64, floor: f64) {
    for (at, label) in axis::times(end_s, 10.0) {
        let x = x(at, end_s);
        page.add(format_args!(
            "<line class=\"grid\" x1=\"{x:.1}\" y1=\"{top:.1}\" x2=\"{x:.1}\" y2=\"{floor:.1}\"/>\
             <text class=\"tick mid\" x=\"{x:.1}\" y=\"{:.1}\">{label}</text>",
            floor + 16.0
        ));
    }
}

/// Lines where something went wrong.
pub(super) fn fault_marks(page: &mut Html, faults: &[f64], end_s: f64, top: f64, floor: f64) {
    for at in faults {
        let x = x(*at, end_s);
        page.add(format_args!(
            "<line class=\"faultline\" x1=\"{x:.1}\" y1=\"{top:.1}\" x2=\"{x:.1}\" y2=\"{floor:.1}\"><title>fault at {at:.2} s</title></line>"
        ));
    }
}

impl Plot {
    pub(super) fn draw(&self, page: &mut Html) {
        let (low, high) = self.range();
        let floor = HEIGHT - FLOOR;
        let y = |value: f64| floor - (floor - TOP) * (value - low) / (high - low);
        page.add(format_args!(
            "<svg viewBox=\"0 0 {WIDTH} {HEIGHT}\" role=\"img\" aria-label=\"{}\">",
            escaped(&self.about)
        ));
        time_axis(page, self.end_s, TOP, floor);
        for (value, label) in axis::values(low, high, 6.0) {
            let y = y(value);
            page.add(format_args!(
                "<line class=\"grid\" x1=\"{LEFT}\" y1=\"{y:.1}\" x2=\"{:.1}\" y2=\"{y:.1}\"/>\
                 <text class=\"tick end\" x=\"{:.1}\" y=\"{:.1}\">{label}</text>",
                WIDTH - RIGHT,
                LEFT - 7.0,
                y + 4.0
            ));
        }
        page.add(format_args!("<text class=\"tick\" x=\"2\" y=\"{:.1}\">{}</text>", TOP + 2.0, self.unit));
        for curve in &self.curves {
            let path = self.path(curve, y);
            page.add(format_args!(
                "<path class=\"curve {}\" d=\"{path}\"><title>{}</title></path>",
                curve.class,
                escaped(&curve.name)
            ));
        }
        for Level { class, name, value } in &self.levels {
            let y = y(*value);
            page.add(format_args!(
                "<line class=\"level {class}\" x1=\"{LEFT}\" y1=\"{y:.1}\" x2=\"{0:.1}\" y2=\"{y:.1}\"/>\
                 <text class=\"tick end {class}\" x=\"{0:.1}\" y=\"{1:.1}\">{2}</text>",
                WIDTH - RIGHT,
                y - 4.0,
                escaped(name)
            ));
        }
        fault_marks(page, &self.faults, self.end_s, TOP, floor);
        page.add("</svg>\n");
    }

    fn range(&self) -> (f64, f64) {
        let points = self.curves.iter().flat_map(|curve| curve.points.iter().map(|(_, value)| *value));
        let values = points.chain(self.levels.iter().map(|level| level.value));
        let (low, high) = values
            .fold((self.least, f64::NEG_INFINITY), |(low, high), value| (low.min(value), high.max(value)));
        let high = if high > low { high } else { low + 1.0 };
        (low, high + 0.06 * (high - low))
    }

    /// The highest or lowest point of each column, in pieces where nothing was measured between.
    fn path(&self, curve: &Curve, y: impl Fn(f64) -> f64) -> String {
        let column = self.end_s.max(1e-3) / COLUMNS;
        let mut kept: Vec<(f64, f64)> = Vec::new();
        let mut begin = f64::NEG_INFINITY;
        for (at, value) in &curve.points {
            match kept.last_mut() {
                Some(last) if at - begin < column => {
                    if (*value > last.1) != curve.lowest {
                        *last = (*at, *value);
                    }
                }
                _ => {
                    begin = *at;
                    kept.push((*at, *value));
                }
            }
        }
        let mut path = String::new();
        let mut before = f64::NEG_INFINITY;
        for (at, value) in kept {
            let pen = if at - before > GAP_S.max(2.5 * column) { 'M' } else { 'L' };
            // Writing to a String can't fail.
            let _infallible = write!(path, "{pen}{:.1} {:.1}", x(at, self.end_s), y(value));
            before = at;
        }
        path
    }
}
