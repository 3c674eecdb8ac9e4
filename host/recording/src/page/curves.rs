//! Temperatures, current and supply over the run.

use super::Html;
use super::plot::{Curve, Level, Plot};
use crate::run::Run;
use std::collections::BTreeMap;
use zygote_deployment::Motion;

/// Room around the supply's voltage, V.
const SUPPLY_ROOM: f64 = 0.2;

pub(super) fn sections(page: &mut Html, run: &Run<'_>) {
    if run.recording.telemetry.is_empty() {
        page.add("<section><h2>Curves</h2><p>Nothing was measured.</p></section>\n");
        return;
    }
    let (end_s, faults) =
        (run.end_s(), run.faults().iter().filter_map(|fault| fault.seconds).collect::<Vec<_>>());
    temperatures(page, run, end_s, &faults);
    let limit = run.recording.rig.supply.limit.0;
    let current = Curve {
        class: "amps",
        name: "measured current".to_owned(),
        points: looks(run, |look| look.current_a),
        lowest: false,
    };
    page.add("<section><h2>Current</h2>");
    Plot {
        about: "measured current over time".to_owned(),
        unit: "A",
        end_s,
        least: 0.0,
        curves: vec![current],
        levels: vec![Level { class: "bad", name: format!("limit {limit} A"), value: limit }],
        faults: faults.clone(),
    }
    .draw(page);
    page.add("</section>\n<section><h2>Supply</h2>");
    let nominal = run.recording.rig.supply.voltage.0;
    let supply = Curve {
        class: "volts",
        name: "supply voltage".to_owned(),
        points: looks(run, |look| look.supply_v),
        lowest: true,
    };
    Plot {
        about: "supply voltage over time".to_owned(),
        unit: "V",
        end_s,
        least: nominal - SUPPLY_ROOM,
        curves: vec![supply],
        levels: vec![Level { class: "muted", name: format!("without load {nominal} V"), value: nominal }],
        faults,
    }
    .draw(page);
    page.add("</section>\n");
}

fn looks(run: &Run<'_>, value: impl Fn(&crate::Telemetry) -> f64) -> Vec<(f64, f64)> {
    let looks = run.recording.telemetry.iter();
    looks.filter_map(|look| Some((run.seconds(look.mcu_us).filter(|at| *at >= 0.0)?, value(look)))).collect()
}

fn temperatures(page: &mut Html, run: &Run<'_>, end_s: f64, faults: &[f64]) {
    let mut hinges: BTreeMap<usize, Vec<(f64, f64)>> = BTreeMap::new();
    for look in &run.recording.telemetry {
        let Some(at) = run.seconds(look.mcu_us).filter(|at| *at >= 0.0) else { continue };
        for motion in &look.motions {
            if let Some(celsius) = motion.temperature_c {
                hinges.entry(motion.hinge).or_default().push((at, celsius));
            }
        }
    }
    if hinges.is_empty() {
        return;
    }
    let faulty: Vec<_> = run
        .recording
        .events
        .iter()
        .filter_map(|event| match &event.record {
            zygote_controller::Record::Fault { hinge, .. } => *hinge,
            _ => None,
        })
        .collect();
    let mut curves: Vec<_> = hinges
        .into_iter()
        .map(|(hinge, points)| {
            let class = if faulty.contains(&hinge) { "hot bad" } else { "hot" };
            Curve { class, name: format!("hinge {hinge}"), points, lowest: false }
        })
        .collect();
    // What went wrong is drawn over the others.
    curves.sort_by_key(|curve| curve.class);
    let sma = || {
        run.schedule.steps.iter().filter_map(|step| match step.motion {
            Motion::Sma(sma) => Some(sma),
            Motion::Servo(_) | Motion::Spring(_) => None,
        })
    };
    let degrees = |centi: i64| centi as f64 / 100.0;
    let target = sma().map(|sma| i64::from(sma.target.0)).max();
    let most = sma().map(|sma| i64::from(sma.max_temperature.0)).min();
    let level = |class, name: &str, value: Option<i64>| {
        value.map(|value| Level {
            class,
            name: format!("{name} {} °C", degrees(value)),
            value: degrees(value),
        })
    };
    let levels =
        [level("muted", "target", target), level("bad", "most", most)].into_iter().flatten().collect();
    page.add("<section><h2>Temperatures</h2>");
    Plot {
        about: "measured temperature of every heated hinge over time".to_owned(),
        unit: "°C",
        end_s,
        least: run.recording.rig.ambient.0.min(25.0),
        curves,
        levels,
        faults: faults.to_vec(),
    }
    .draw(page);
    page.add("</section>\n");
}
