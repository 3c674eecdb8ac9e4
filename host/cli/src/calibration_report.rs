//! A calibration as a page for people: a table of all hinges, and for each its curves, fit and residuals. One file, nothing else
//! is loaded.

use crate::calibration_table::{COLUMNS, key, outliers};
use std::fmt::Write;
use zygote_calibration::{Fit, picture};
use zygote_controller::calibrate::Hinge;
use zygote_deployment::{Calibrated, CalibratedHinge, Rig};

pub(crate) const STYLE: &str = "body{font:15px sans-serif;max-width:64em;margin:2em auto;padding:0 1em}\
    table{border-collapse:collapse;font-size:14px}td,th{padding:.2em .7em;text-align:right;border-bottom:1px solid #ddd}\
    .unlike{background:#fd9}.failed{color:#b00}summary{cursor:pointer;margin:.6em 0}";

/// The page.
pub(crate) fn page(
    rig: &Rig,
    date: &str,
    hinges: &[Hinge],
    fits: &[Option<Fit>],
    calibrated: &[CalibratedHinge],
) -> String {
    let title = format!("Calibration of {}", escaped(&rig.id));
    let mut html = format!(
        "<!doctype html>\n<html lang=\"en\"><meta charset=\"utf-8\"><title>{title}</title><style>{STYLE}</style>\n\
         <h1>{title}</h1>\n<p>{date}</p>\n"
    );
    overview(&mut html, calibrated);
    for ((hinge, fit), calibrated) in hinges.iter().zip(fits).zip(calibrated) {
        // Writing to a string cannot fail.
        let open = if hinges.len() == 1 { " open" } else { "" };
        let _ = writeln!(
            html,
            "<details{open}><summary>Hinge {}, channel {}: {}</summary>",
            hinge.number,
            hinge.channel,
            calibrated.verdict.name()
        );
        if let Some(why) = &calibrated.why {
            let _ = writeln!(html, "<p class=\"failed\">{}</p>", escaped(why));
        }
        values(&mut html, calibrated);
        if let Some(fit) = fit {
            html.push_str(&picture(&hinge.record, fit));
        }
        html.push_str("</details>\n");
    }
    html.push_str("</html>\n");
    html
}

fn overview(html: &mut String, calibrated: &[CalibratedHinge]) {
    html.push_str("<table><tr><th>hinge</th><th>channel</th>");
    for (quantity, head) in COLUMNS {
        let _ = write!(html, "<th title=\"{quantity}\">{head}</th>");
    }
    html.push_str("<th>verdict</th></tr>\n");
    let unlike = COLUMNS.map(|(quantity, _)| outliers(calibrated, quantity));
    for hinge in calibrated {
        let _ = write!(html, "<tr><td>{}</td><td>{}</td>", hinge.hinge, hinge.channel);
        for ((quantity, _), unlike) in COLUMNS.iter().zip(&unlike) {
            let class = if unlike.contains(&hinge.hinge) { " class=\"unlike\"" } else { "" };
            let told = match hinge.values.get(&key(*quantity)) {
                Some(Calibrated::Known { value, .. }) => value.as_str(),
                Some(Calibrated::Unknown { .. }) | None => "-",
            };
            let _ = write!(html, "<td{class}>{}</td>", escaped(told));
        }
        let _ = writeln!(html, "<td>{}</td></tr>", hinge.verdict.name());
    }
    html.push_str("</table>\n<p>Marked: unlike the other hinges.</p>\n");
}

fn values(html: &mut String, hinge: &CalibratedHinge) {
    html.push_str("<table><tr><th>value</th><th></th><th>95 % between</th><th>and</th></tr>\n");
    for (name, value) in &hinge.values {
        let name = name.replace('_', " ");
        let _ = match value {
            Calibrated::Known { value, low, high } => {
                writeln!(html, "<tr><td>{name}</td><td>{value}</td><td>{low}</td><td>{high}</td></tr>")
            }
            Calibrated::Unknown { unknown } => {
                writeln!(html, "<tr><td>{name}</td><td colspan=\"3\">{}</td></tr>", escaped(unknown))
            }
        };
    }
    for (name, value) in &hinge.residuals {
        let name = name.replace('_', " ");
        let _ = writeln!(html, "<tr><td>residuals, {name}</td><td>{value}</td><td></td><td></td></tr>");
    }
    html.push_str("</table>\n");
}

pub(crate) fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}
