//! The schedule against the clock: a row a hinge, as it was planned and as it came.

use super::plot::{LEFT, WIDTH, fault_marks, time_axis, x};
use super::{Html, escaped};
use crate::run::Run;
use std::fmt::Write as _;
use zygote_controller::{HingeOutcome, HingeReport};
use zygote_deployment::{Kind, Step};

/// Rows are as high as fits about so many pixels, within bounds.
const HEIGHT: f64 = 900.0;
const HIGHEST: f64 = 18.0;
const LOWEST: f64 = 2.5;
/// Lower rows have no label.
const LABELLED: f64 = 8.5;
const LARGEST_FONT: f64 = 11.5;
const TOP: f64 = 8.0;
const FLOOR: f64 = 26.0;

pub(super) fn section(page: &mut Html, run: &Run<'_>) {
    let mut rows: Vec<(&Step, &HingeReport)> =
        run.schedule.steps.iter().filter_map(|step| Some((step, run.hinges.get(&step.hinge)?))).collect();
    rows.sort_by_key(|(step, _)| (step.start, step.hinge));
    if rows.is_empty() {
        return;
    }
    let row = (HEIGHT / rows.len() as f64).clamp(LOWEST, HIGHEST);
    let floor = TOP + row * rows.len() as f64;
    let end_s = run.end_s().max(seconds(run.schedule.makespan.0));
    page.add("<section><h2>Schedule against the clock</h2><p class=\"key\"><i class=\"plan\"></i>planned");
    let any = |is: &dyn Fn(&HingeReport) -> bool| rows.iter().any(|(_, hinge)| is(hinge));
    for (class, word, there) in [
        ("sma", "heated", any(&|hinge| hinge.kind == Kind::Sma)),
        ("servo", "turned", any(&|hinge| hinge.kind == Kind::Servo)),
        ("spring", "released", any(&|hinge| hinge.kind == Kind::Spring)),
        ("cool", "cooling", any(&|hinge| hinge.kind == Kind::Sma)),
        ("bad", "interrupted", any(&|hinge| hinge.outcome == HingeOutcome::Interrupted)),
    ] {
        if there {
            page.add(format_args!(" <i class=\"{class}\"></i>{word}"));
        }
    }
    page.add("</p>");
    page.add(format_args!(
        "<svg viewBox=\"0 0 {WIDTH} {:.1}\" role=\"img\" aria-label=\"planned and true times of every hinge\">",
        floor + FLOOR
    ));
    time_axis(page, end_s, TOP, floor);
    for (number, (step, hinge)) in rows.iter().enumerate() {
        bars(page, step, hinge, TOP + row * number as f64, row, (run.end_s(), end_s));
    }
    let faults: Vec<_> = run.faults().iter().filter_map(|fault| fault.seconds).collect();
    fault_marks(page, &faults, end_s, TOP, floor);
    page.add("</svg></section>\n");
}

fn seconds(ms: u64) -> f64 {
    ms as f64 / 1e3
}

fn bars(page: &mut Html, step: &Step, hinge: &HingeReport, top: f64, row: f64, (ended_s, end_s): (f64, f64)) {
    if row >= LABELLED {
        let font = row.min(LARGEST_FONT);
        page.add(format_args!(
            "<text class=\"tick end\" style=\"font-size:{font:.1}px\" x=\"{:.1}\" y=\"{:.1}\">{}</text>",
            LEFT - 7.0,
            top + row / 2.0 + font * 0.36,
            step.hinge
        ));
    }
    let gap = (row * 0.14).min(2.0);
    let bar = |class: &str, from: f64, to: f64, inset: f64| {
        let (left, right) = (x(from, end_s), x(to, end_s));
        format!(
            "<rect class=\"{class}\" x=\"{left:.1}\" y=\"{:.1}\" width=\"{:.1}\" height=\"{:.1}\"/>",
            top + gap + inset,
            (right - left).max(0.6),
            row - 2.0 * (gap + inset)
        )
    };
    let (planned, planned_end) = (seconds(step.start.0), seconds(step.opened().0));
    let mut text = format!("hinge {}: planned {planned:.1} to {planned_end:.1} s", step.hinge);
    let mut shapes = bar("plan", planned, planned_end, 0.0);
    let inset = (row - 2.0 * gap) * 0.18;
    if let Some(started) = hinge.started_s {
        let opened = hinge.opened_s.unwrap_or(ended_s);
        let class = if hinge.outcome == HingeOutcome::Interrupted { "bad" } else { hinge.kind.name() };
        shapes += &bar(class, started, opened, inset);
        // Writing to a String can't fail, here and below.
        let _infallible = write!(text, ", moved {started:.1} to {opened:.1} s");
        if let (Some(opened), Some(done)) = (hinge.opened_s, hinge.done_s)
            && done > opened
        {
            shapes += &bar("cool", opened, done, inset);
            let _infallible = write!(text, ", cool at {done:.1} s");
        }
    }
    page.add(format_args!("<g><title>{}</title>{shapes}</g>\n", escaped(text)));
}
