//! One calibration as a drawing: readings, the fit, the pulses, and below what the fit misses.

use crate::fit::Fit;
use crate::pulse_plan::Purpose;
use crate::record::Record;
use core::fmt::Write;

const WIDTH: f64 = 960.0;
const LEFT: f64 = 56.0;
const RIGHT: f64 = 944.0;
const CURVES: (f64, f64) = (330.0, 30.0);
const MISSES: (f64, f64) = (510.0, 380.0);

/// A linear scale from values to pixels.
pub(crate) struct Scale {
    pub(crate) values: (f64, f64),
    pub(crate) pixels: (f64, f64),
}

impl Scale {
    pub(crate) fn at(&self, value: f64) -> f64 {
        let share = (value - self.values.0) / (self.values.1 - self.values.0);
        self.pixels.0 + share * (self.pixels.1 - self.pixels.0)
    }

    /// Round values, some six of them.
    pub(crate) fn ticks(&self) -> Vec<f64> {
        let raw = (self.values.1 - self.values.0) / 6.0;
        let decade = 10_f64.powf(raw.log10().floor());
        let step = [1.0, 2.0, 5.0, 10.0].iter().map(|m| m * decade).find(|step| *step >= raw).unwrap_or(raw);
        let first = (self.values.0 / step).ceil();
        let mut ticks = Vec::new();
        let mut tick = first * step;
        while tick <= self.values.1 {
            ticks.push(tick);
            tick = (ticks.len() as f64 + first) * step;
        }
        ticks
    }
}

/// The picture, as SVG.
pub fn picture(record: &Record, fit: &Fit) -> String {
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {WIDTH} 550\" font-family=\"sans-serif\" font-size=\"12\">\n\
         <rect width=\"{WIDTH}\" height=\"550\" fill=\"white\"/>\n"
    );
    let (Some(first), Some(last)) = (record.samples.first(), record.samples.last()) else {
        svg.push_str("</svg>\n");
        return svg;
    };
    let times = Scale { values: (first.t_s, last.t_s.max(first.t_s + 1.0)), pixels: (LEFT, RIGHT) };
    let readings = || record.samples.iter().map(|sample| sample.reading_c);
    let low = readings().fold(f64::INFINITY, f64::min).max(-50.0);
    let high = readings().fold(low + 1.0, f64::max).min(250.0);
    let curves = Scale { values: (low - 3.0, high + 5.0), pixels: CURVES };
    // Writing to a string cannot fail.
    let _ = drives(&mut svg, record, &times);
    let _ = axes(&mut svg, (&times, "s"), (&curves, "°C"));
    let _ = line(
        &mut svg,
        "#9ab",
        record.samples.iter().map(|sample| (times.at(sample.t_s), curves.at(sample.reading_c))),
    );
    let both = || record.samples.iter().zip(&fit.predicted_c);
    let _ =
        line(&mut svg, "#c33", both().map(|(sample, model_c)| (times.at(sample.t_s), curves.at(*model_c))));
    let _ = temperatures(&mut svg, fit, &curves);
    if !fit.predicted_c.is_empty() {
        let miss = |(sample, model_c): (&crate::record::Sample, &f64)| sample.reading_c - model_c;
        let most = both().map(|pair| miss(pair).abs()).fold(0.5, f64::max);
        let misses = Scale { values: (-most, most), pixels: MISSES };
        let _ = axes(&mut svg, (&times, "s"), (&misses, "K"));
        let points = both().map(|pair| (times.at(pair.0.t_s), misses.at(miss(pair))));
        let _ = line(&mut svg, "#369", points);
    }
    svg.push_str(
        "<text x=\"60\" y=\"20\"><tspan fill=\"#789\">reading</tspan>  <tspan fill=\"#c33\">fit</tspan>  \
                  <tspan fill=\"#369\">reading less fit (below)</tspan></text>\n</svg>\n",
    );
    svg
}

fn drives(svg: &mut String, record: &Record, times: &Scale) -> core::fmt::Result {
    for (index, drive) in record.drives.iter().enumerate() {
        // The first two are near to each other.
        let y = if index % 2 == 0 { 362 } else { 374 };
        let (x, end) = (times.at(drive.from_s), times.at(drive.until_s));
        let name = match drive.purpose {
            Purpose::Probe => "probe",
            Purpose::Warm => "warm",
            Purpose::Ramp => "ramp",
            Purpose::Again => "again",
            Purpose::HeldOut => "held out",
        };
        writeln!(
            svg,
            "<rect x=\"{x:.1}\" y=\"{:.1}\" width=\"{:.1}\" height=\"{:.1}\" fill=\"#fd9\" fill-opacity=\"{:.2}\"/>\
             <text x=\"{x:.1}\" y=\"{y}\" fill=\"#a70\">{name}, {:.1} %</text>",
            CURVES.1,
            end - x,
            CURVES.0 - CURVES.1,
            0.25 + 0.6 * drive.duty,
            drive.duty * 100.0
        )?;
    }
    Ok(())
}

/// Both axes, each a scale with its unit, and a line at each round value of the upright one.
pub(crate) fn axes(
    svg: &mut String,
    (along, along_unit): (&Scale, &str),
    (up, up_unit): (&Scale, &str),
) -> core::fmt::Result {
    let ((left, right), (bottom, top)) = (along.pixels, up.pixels);
    let digits = usize::from(up.values.1 - up.values.0 <= 10.0);
    for tick in up.ticks() {
        let y = up.at(tick);
        writeln!(
            svg,
            "<line x1=\"{left}\" x2=\"{right}\" y1=\"{y:.1}\" y2=\"{y:.1}\" stroke=\"#ddd\"/>\
             <text x=\"50\" y=\"{:.1}\" text-anchor=\"end\">{tick:.digits$}</text>",
            y + 4.0
        )?;
    }
    for tick in along.ticks() {
        let x = along.at(tick);
        writeln!(
            svg,
            "<text x=\"{x:.1}\" y=\"{:.1}\" text-anchor=\"middle\">{tick:.0} {along_unit}</text>",
            bottom + 16.0
        )?;
    }
    writeln!(svg, "<text x=\"50\" y=\"{:.1}\" text-anchor=\"end\">{up_unit}</text>", top - 6.0)
}

/// A dashed line at each transformation temperature that was identified.
fn temperatures(svg: &mut String, fit: &Fit, curves: &Scale) -> core::fmt::Result {
    use crate::estimate::Quantity::{AusteniteFinish, AusteniteStart, MartensiteFinish, MartensiteStart};
    let named =
        [(MartensiteFinish, "Mf"), (MartensiteStart, "Ms"), (AusteniteStart, "As"), (AusteniteFinish, "Af")];
    for (quantity, name) in named {
        let Some(at) = fit.value(quantity) else { continue };
        let y = curves.at(at.value);
        writeln!(
            svg,
            "<line x1=\"{LEFT}\" x2=\"{RIGHT}\" y1=\"{y:.1}\" y2=\"{y:.1}\" stroke=\"#285\" stroke-dasharray=\"4 4\"/>\
             <text x=\"{RIGHT}\" y=\"{:.1}\" text-anchor=\"end\" fill=\"#285\">{name} {:.1} °C</text>",
            y - 3.0,
            at.value
        )?;
    }
    Ok(())
}

fn line(svg: &mut String, colour: &str, points: impl Iterator<Item = (f64, f64)>) -> core::fmt::Result {
    write!(svg, "<polyline fill=\"none\" stroke=\"{colour}\" stroke-width=\"1.3\" points=\"")?;
    for (x, y) in points {
        write!(svg, "{x:.1},{y:.1} ")?;
    }
    writeln!(svg, "\"/>")
}
