//! What was found of servos, in the words of the calibration file, as a table, and as a page for people.

use crate::calibration_report::{STYLE, escaped};
use std::collections::BTreeMap;
use std::fmt::Write;
use zygote_calibration::servo::{ANGLES_DEG, FoundServo, NotReached, servo_picture};
use zygote_controller::calibrate_servo::{ServoEnding, ServoHinge};
use zygote_deployment::{CalibratedHinge, CalibratedServo, CalibrationVerdict, NoPulse, Rig, ServoPoint};

/// A line goes through so many points.
const FEWEST_POINTS: usize = 2;

/// A hinge's part of the calibration file.
pub(crate) fn hinge_of(hinge: &ServoHinge, date: &str, firmware: &str) -> CalibratedHinge {
    let found = hinge.found();
    let (verdict, why) = judge(hinge, &found);
    CalibratedHinge {
        hinge: hinge.number,
        channel: hinge.channel,
        date: date.to_owned(),
        firmware: firmware.to_owned(),
        verdict,
        why,
        ambient: None,
        residuals: BTreeMap::new(),
        values: BTreeMap::new(),
        servo: Some(servo_of(hinge, &found, verdict)),
    }
}

/// An end of the way is no fault; a servo that goes past an angle in one step is too coarse for it.
fn judge(hinge: &ServoHinge, found: &FoundServo) -> (CalibrationVerdict, Option<String>) {
    if let Some(ServoEnding::Refused(why)) = &hinge.ending {
        return (CalibrationVerdict::Failed, Some(why.clone()));
    }
    let unmet = found.unreached.iter().find(|(_, why)| match why {
        NotReached::Coarse { .. } | NotReached::Open => true,
        NotReached::Stop { .. } | NotReached::Bound { .. } => false,
    });
    match unmet {
        _ if found.points.len() < FEWEST_POINTS => {
            let angles: Vec<_> =
                found.unreached.iter().map(|(angle, why)| format!("{angle} deg: {why}")).collect();
            let why = format!("expected two angles at the least; {}", angles.join("; "));
            (CalibrationVerdict::Failed, Some(why))
        }
        Some((angle, why)) => (CalibrationVerdict::Incomplete, Some(format!("{angle} deg: {why}"))),
        None => (CalibrationVerdict::Calibrated, None),
    }
}

fn servo_of(hinge: &ServoHinge, found: &FoundServo, verdict: CalibrationVerdict) -> CalibratedServo {
    let told = |degrees: f64| format!("{degrees:.1} deg");
    // What a servo that failed seemed to be like is nobody's value.
    let points = match verdict {
        CalibrationVerdict::Failed => &[][..],
        CalibrationVerdict::Calibrated | CalibrationVerdict::Incomplete => &found.points,
    };
    CalibratedServo {
        tolerance: told(hinge.bounds.tolerance_deg),
        worst_off_line: found.worst_off_line_deg().map(told),
        stop_low: found.stop_low_deg.map(told),
        stop_high: found.stop_high_deg.map(told),
        points: points
            .iter()
            .map(|point| ServoPoint {
                angle: format!("{} deg", point.angle_deg),
                pulse: format!("{} us", point.pulse_us),
                read: told(point.read_deg),
            })
            .collect(),
        unreached: found
            .unreached
            .iter()
            .map(|(angle, why)| NoPulse { angle: format!("{angle} deg"), why: why.to_string() })
            .collect(),
    }
}

/// The pulse of an angle, or a dash.
fn pulse(hinge: &CalibratedHinge, angle_deg: u16) -> &str {
    let angle = format!("{angle_deg} deg");
    let points = hinge.servo.iter().flat_map(|servo| &servo.points);
    points.filter(|point| point.angle == angle).map(|point| point.pulse.as_str()).next().unwrap_or("-")
}

fn off_line(hinge: &CalibratedHinge) -> &str {
    hinge.servo.as_ref().and_then(|servo| servo.worst_off_line.as_deref()).unwrap_or("-")
}

/// A row a hinge, and below it the angles that it doesn't reach.
pub(crate) fn table(hinges: &[CalibratedHinge]) -> String {
    let mut text = format!("{:>5} {:>7}", "hinge", "channel");
    for angle in ANGLES_DEG {
        // Writing to a string cannot fail.
        let _ = write!(text, " {:>8}", format!("{angle} deg"));
    }
    let _ = write!(text, " {:>8}  verdict", "off line");
    for hinge in hinges {
        let _ = write!(text, "\n{:>5} {:>7}", hinge.hinge, hinge.channel);
        for angle in ANGLES_DEG {
            let _ = write!(text, " {:>8}", pulse(hinge, angle));
        }
        let _ = write!(text, " {:>8}  {}", off_line(hinge), hinge.verdict.name());
    }
    for hinge in hinges {
        for none in hinge.servo.iter().flat_map(|servo| &servo.unreached) {
            let _ = write!(text, "\nhinge {} has no pulse for {}: {}", hinge.hinge, none.angle, none.why);
        }
    }
    text
}

/// The page.
pub(crate) fn page(rig: &Rig, date: &str, hinges: &[ServoHinge], calibrated: &[CalibratedHinge]) -> String {
    let title = format!("Servos of {}", escaped(&rig.id));
    let mut html = format!(
        "<!doctype html>\n<html lang=\"en\"><meta charset=\"utf-8\"><title>{title}</title><style>{STYLE}</style>\n\
         <h1>{title}</h1>\n<p>{date}</p>\n<table><tr><th>hinge</th><th>channel</th>"
    );
    for angle in ANGLES_DEG {
        let _ = write!(html, "<th>{angle} deg</th>");
    }
    html.push_str("<th title=\"furthest from a straight line\">off line</th><th>verdict</th></tr>\n");
    for hinge in calibrated {
        let _ = write!(html, "<tr><td>{}</td><td>{}</td>", hinge.hinge, hinge.channel);
        for angle in ANGLES_DEG {
            let _ = write!(html, "<td>{}</td>", pulse(hinge, angle));
        }
        let _ = writeln!(html, "<td>{}</td><td>{}</td></tr>", off_line(hinge), hinge.verdict.name());
    }
    html.push_str("</table>\n");
    for (hinge, calibrated) in hinges.iter().zip(calibrated) {
        let _ = writeln!(
            html,
            "<h2>Hinge {}, channel {}: {}</h2>",
            hinge.number,
            hinge.channel,
            calibrated.verdict.name()
        );
        if let Some(why) = &calibrated.why {
            let _ = writeln!(html, "<p class=\"failed\">{}</p>", escaped(why));
        }
        for none in calibrated.servo.iter().flat_map(|servo| &servo.unreached) {
            let _ = writeln!(html, "<p>{}: {}</p>", none.angle, escaped(&none.why));
        }
        html.push_str(&servo_picture(&hinge.record, &hinge.found()));
    }
    html.push_str("</html>\n");
    html
}
