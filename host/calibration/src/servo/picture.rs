//! A servo's calibration as a drawing: angles against pulses, and below what they are off a straight line.

use super::found::FoundServo;
use super::record::ServoRecord;
use crate::picture::{Scale, axes};
use core::fmt::Write;

const WIDTH: f64 = 720.0;
const LEFT: f64 = 56.0;
const RIGHT: f64 = 700.0;
const ANGLES: (f64, f64) = (330.0, 30.0);
const OFF_LINE: (f64, f64) = (490.0, 380.0);

/// The picture, as SVG.
pub fn servo_picture(record: &ServoRecord, found: &FoundServo) -> String {
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {WIDTH} 530\" font-family=\"sans-serif\" font-size=\"12\">\n\
         <rect width=\"{WIDTH}\" height=\"530\" fill=\"white\"/>\n"
    );
    let pulses = || record.looks.iter().map(|look| f64::from(look.pulse_us));
    let low_us = pulses().fold(f64::INFINITY, f64::min);
    let high_us = pulses().fold(low_us, f64::max);
    if low_us.is_finite() {
        let pulses = Scale { values: (low_us - 50.0, high_us + 50.0), pixels: (LEFT, RIGHT) };
        // Writing to a string cannot fail.
        let _ = draw(&mut svg, record, found, &pulses);
    }
    svg.push_str(
        "<text x=\"60\" y=\"20\"><tspan fill=\"#369\">reading</tspan>  <tspan fill=\"#c33\">pushed</tspan>  \
         <tspan fill=\"#285\">found</tspan>  <tspan fill=\"#369\">off the straight line (below)</tspan></text>\n</svg>\n",
    );
    svg
}

fn draw(svg: &mut String, record: &ServoRecord, found: &FoundServo, pulses: &Scale) -> core::fmt::Result {
    let readings = || record.looks.iter().map(|look| look.angle_deg);
    let low_deg = readings().fold(0.0, f64::min);
    let high_deg = readings().fold(270.0, f64::max);
    let angles = Scale { values: (low_deg - 10.0, high_deg + 10.0), pixels: ANGLES };
    axes(svg, (pulses, "us"), (&angles, "deg"))?;
    for stop_deg in [found.stop_low_deg, found.stop_high_deg].into_iter().flatten() {
        let y = angles.at(stop_deg);
        writeln!(
            svg,
            "<line x1=\"{LEFT}\" x2=\"{RIGHT}\" y1=\"{y:.1}\" y2=\"{y:.1}\" stroke=\"#c33\" stroke-dasharray=\"4 4\"/>\
             <text x=\"{RIGHT}\" y=\"{:.1}\" text-anchor=\"end\" fill=\"#c33\">end stop, {stop_deg:.1} deg</text>",
            y - 3.0
        )?;
    }
    for (at, look) in record.looks.iter().enumerate() {
        let (x, y) = (pulses.at(f64::from(look.pulse_us)), angles.at(look.angle_deg));
        let colour = if look.pushes { "#c33" } else { "#369" };
        writeln!(
            svg,
            "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"3\" fill=\"{colour}\"><title>{}: {} us, {:.1} deg</title></circle>",
            at + 1,
            look.pulse_us,
            look.angle_deg
        )?;
    }
    let at = |point: &super::FoundPoint| {
        (pulses.at(f64::from(point.pulse_us)), angles.at(f64::from(point.angle_deg)))
    };
    write!(svg, "<polyline fill=\"none\" stroke=\"#285\" stroke-width=\"1.3\" points=\"")?;
    for (x, y) in found.points.iter().map(at) {
        write!(svg, "{x:.1},{y:.1} ")?;
    }
    writeln!(svg, "\"/>")?;
    for point in &found.points {
        let (x, y) = at(point);
        writeln!(
            svg,
            "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"6\" fill=\"none\" stroke=\"#285\"/>\
             <text x=\"{:.1}\" y=\"{:.1}\" fill=\"#285\">{} deg: {} us</text>",
            x + 9.0,
            y + 14.0,
            point.angle_deg,
            point.pulse_us
        )?;
    }
    let Some(worst_deg) = found.worst_off_line_deg() else { return Ok(()) };
    let most_deg = worst_deg.max(1.0);
    let misses = Scale { values: (-most_deg, most_deg), pixels: OFF_LINE };
    axes(svg, (pulses, "us"), (&misses, "deg"))?;
    for (look, off_deg) in &found.off_line_deg {
        let (x, y, zero) = (pulses.at(f64::from(look.pulse_us)), misses.at(*off_deg), misses.at(0.0));
        writeln!(
            svg,
            "<line x1=\"{x:.1}\" x2=\"{x:.1}\" y1=\"{zero:.1}\" y2=\"{y:.1}\" stroke=\"#369\" stroke-width=\"2\"/>"
        )?;
    }
    Ok(())
}
