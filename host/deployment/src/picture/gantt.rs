//! A schedule as a Gantt chart: a row a hinge, time to the right, and below it the current that they draw together.

use super::colour;
use super::document::Document;
use super::still::title;
use crate::rig::Kind;
use crate::schedule::{Schedule, Step, VerifyError};
use crate::table::{belongs, kind_name};
use glam::DVec2;
use std::collections::BTreeMap;
use std::fmt::{Display, Write as _};
use zygote_stacking::Plan;

/// More hinges than this share rows.
const MOST_ROWS: usize = 200;
/// So many rows or fewer have their angles beside the bars.
const ROWS_WITH_ANGLES: usize = 60;

const MARGIN: f64 = 28.0;
/// Room for a title and a line under it.
const HEAD: f64 = 60.0;
/// Room for what is left of the plot.
const LABELS: f64 = 92.0;
const PLOT: f64 = 860.0;
/// Room for the figures of time.
const AXIS: f64 = 34.0;
const CURRENT: f64 = 110.0;
/// About so many pixels lie between two marks of time.
const MARK_ROOM: f64 = 80.0;
/// Spans between marks of time that people count in, seconds.
const MARKS: [f64; 17] = [
    0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 15.0, 30.0, 60.0, 120.0, 300.0, 600.0, 1800.0, 3600.0, 7200.0,
    18000.0,
];

/// A row of the chart.
struct Row<'a> {
    label: String,
    steps: Vec<&'a Step>,
}

/// The chart of a plan's schedule. With more than 200 hinges, a row is as many hinges of one node as move one after another.
///
/// # Errors
/// [`VerifyError`] if the schedule is that of another plan.
pub fn gantt(plan: &Plan, schedule: &Schedule) -> Result<String, VerifyError> {
    belongs(schedule, plan)?;
    let rows = rows(plan, schedule);
    let row_height = match rows.len() {
        0..=30 => 20.0,
        31..=60 => 15.0,
        _ => 12.0,
    };
    let top = MARGIN + HEAD;
    let floor = top + row_height * rows.len() as f64;
    let low = floor + AXIS + CURRENT;
    let size = DVec2::new(LABELS + PLOT + 2.0 * MARGIN, low + MARGIN);
    let mut chart = Chart { document: Document::new(size, 1.0), end: seconds(schedule.makespan.0).max(1e-3) };
    chart.style(row_height);
    chart.head(plan, schedule);
    for (number, row) in rows.iter().enumerate() {
        chart.row(row, number, top + row_height * number as f64, row_height, rows.len() <= ROWS_WITH_ANGLES);
    }
    chart.marks(top, floor, low);
    chart.current(schedule, low);
    Ok(chart.document.finish(&title(plan)))
}

fn seconds(milliseconds: u64) -> f64 {
    milliseconds as f64 / 1e3
}

/// The rows from the top down, by the start of their first step.
fn rows<'a>(plan: &Plan, schedule: &'a Schedule) -> Vec<Row<'a>> {
    let mut steps: Vec<_> = schedule.steps.iter().collect();
    steps.sort_by_key(|step| (step.start, step.opened(), step.hinge));
    if steps.len() <= MOST_ROWS {
        let label = |step: &Step| format!("{} {}", step.hinge, kind_name(plan.hinges[step.hinge].kind));
        return steps.into_iter().map(|step| Row { label: label(step), steps: vec![step] }).collect();
    }
    let mut lanes: BTreeMap<usize, Vec<Row>> = BTreeMap::new();
    for step in steps {
        let lanes = lanes.entry(step.node).or_default();
        let is_free = |row: &&mut Row| row.steps.last().is_none_or(|last| last.opened() <= step.start);
        match lanes.iter_mut().find(is_free) {
            Some(row) => row.steps.push(step),
            None => lanes.push(Row { label: format!("node {}", step.node), steps: vec![step] }),
        }
    }
    lanes.into_values().flatten().collect()
}

struct Chart {
    document: Document,
    /// The end of the schedule, seconds.
    end: f64,
}

impl Chart {
    fn x(&self, time: f64) -> f64 {
        MARGIN + LABELS + PLOT * time / self.end
    }

    fn style(&mut self, row_height: f64) {
        let font = Document::units((row_height * 0.8).min(12.0));
        let kinds: Vec<_> = Kind::ALL
            .iter()
            .map(|kind| format!(".{}{{fill:{}}}", kind.name(), colour::kind(*kind)))
            .collect();
        self.document.raw(format_args!(
            "<style>.row{{font-size:{font}px;text-anchor:end;fill:#6b6e75}}.small{{font-size:{font}px;fill:#6b6e75}}\
             .start{{text-anchor:start}}.end{{text-anchor:end}}.band{{fill:#8a8d95;opacity:.1}}\
             .line{{stroke:#8a8d95;stroke-opacity:.35;stroke-width:8;fill:none}}.draw{{fill:#8a8d95;opacity:.55}}\
             .limit{{stroke:#d0453a;stroke-width:14;stroke-dasharray:70 50}}.warn{{fill:#d0453a}}\
             @media(prefers-color-scheme:dark){{.row,.small{{fill:#9a9da4}}}}{}</style>\n",
            kinds.concat()
        ));
    }

    fn text(&mut self, class: &str, at: DVec2, text: impl Display) {
        self.document.caption(&text.to_string(), at, class);
    }

    fn rect(&mut self, class: &str, at: DVec2, size: DVec2, round: f64) {
        let [x, y, width, height, round] = [at.x, at.y, size.x, size.y, round].map(Document::units);
        let width = width.max(5);
        self.document.raw(format_args!(
            "<rect class=\"{class}\" x=\"{x}\" y=\"{y}\" width=\"{width}\" height=\"{height}\" rx=\"{round}\"/>\n"
        ));
    }

    fn line(&mut self, class: &str, from: DVec2, to: DVec2) {
        let [x1, y1, x2, y2] = [from.x, from.y, to.x, to.y].map(Document::units);
        self.document
            .raw(format_args!("<line class=\"{class}\" x1=\"{x1}\" y1=\"{y1}\" x2=\"{x2}\" y2=\"{y2}\"/>\n"));
    }

    /// Title, a line of figures, and the colours of the kinds that there are.
    fn head(&mut self, plan: &Plan, schedule: &Schedule) {
        let left = DVec2::new(MARGIN, MARGIN + 10.0);
        self.text("head start", left, title(plan));
        let figures = format!(
            "{} hinges on rig {} in {}, at most {} at once",
            schedule.steps.len(),
            schedule.rig,
            clock(self.end, if self.end < 60.0 { 0.1 } else { 1.0 }),
            schedule.most_at_once()
        );
        self.text("note start", left + DVec2::new(0.0, 22.0), figures);
        let mut right = MARGIN + LABELS + PLOT;
        for kind in Kind::ALL.into_iter().rev() {
            let count = schedule.steps.iter().filter(|step| step.motion.kind() == kind).count();
            if count > 0 {
                let label = format!("{count} {}", kind.name());
                right -= 7.5 * label.len() as f64;
                self.text("note start", DVec2::new(right, left.y + 22.0), &label);
                right -= 18.0;
                self.rect(kind.name(), DVec2::new(right, left.y + 11.0), DVec2::splat(12.0), 3.0);
                right -= 18.0;
            }
        }
    }

    fn row(&mut self, row: &Row, number: usize, top: f64, height: f64, angles: bool) {
        let left = MARGIN + LABELS;
        if number.is_multiple_of(2) {
            self.rect("band", DVec2::new(left, top), DVec2::new(PLOT, height), 0.0);
        }
        let base = top + height * 0.74;
        self.text("row", DVec2::new(left - 8.0, base), &row.label);
        for step in &row.steps {
            let [from, to] = [step.start, step.opened()].map(|time| self.x(seconds(time.0)));
            // A gap between two bars of a row, where there is room for one.
            let width = if to - from > 4.0 { to - from - 0.6 } else { to - from };
            let inset = height * 0.14;
            let size = DVec2::new(width, height - 2.0 * inset);
            self.rect(step.motion.kind().name(), DVec2::new(from, top + inset), size, 2.0);
            let beside = match (angles, step.from_opening_deg, step.opening_deg) {
                // Far from its label, a bar is told by its number.
                (false, ..) => step.hinge.to_string(),
                (true, from, to) if from == to => format!("stays at {to}°"),
                (true, from, to) => format!("{from}° to {to}°"),
            };
            if row.steps.len() == 1 {
                let room = if angles { 80.0 } else { 26.0 };
                let has_room = to + room < left + PLOT;
                let (class, x) = if has_room { ("small start", to + 5.0) } else { ("small end", from - 5.0) };
                self.text(class, DVec2::new(x, base), beside);
            }
        }
    }

    /// Lines at round times, and the times between the two plots.
    fn marks(&mut self, top: f64, floor: f64, low: f64) {
        let least = self.end * MARK_ROOM / PLOT;
        let longest = 18_000.0 * (least / 18_000.0).ceil();
        let span = MARKS.into_iter().find(|span| *span >= least).unwrap_or(longest);
        let mut mark = 0.0;
        let mut time = 0.0;
        while time <= self.end * (1.0 + 1e-9) {
            let x = self.x(time);
            self.line("line", DVec2::new(x, top), DVec2::new(x, floor));
            self.line("line", DVec2::new(x, low - CURRENT), DVec2::new(x, low));
            self.text("note", DVec2::new(x, floor + 21.0), clock(time, span));
            mark += 1.0;
            time = mark * span;
        }
    }

    /// The sum of currents, and the limit.
    fn current(&mut self, schedule: &Schedule, low: f64) {
        let mut changes: Vec<(u64, bool, i128)> = Vec::with_capacity(2 * schedule.steps.len());
        for step in &schedule.steps {
            let (current, hold) = (i128::from(step.current.0), i128::from(step.hold_current.0));
            changes.push((step.start.0, true, current));
            changes.push((step.opened().0, false, hold - current));
        }
        // What ends at a moment ends before what starts at it.
        changes.sort_unstable();
        let limit = schedule.supply_limit.0 as f64;
        let most = (schedule.peak_current.0 as f64).max(limit).max(1.0) * 1.12;
        let y = |milliamps: f64| low - CURRENT * milliamps / most;
        let [left, right] = [self.x(0.0), self.x(self.end)];
        let mut drawn: i128 = 0;
        let mut path = format!("M{} {}", Document::units(left), Document::units(low));
        for (time, _, change) in changes {
            drawn += change;
            let x = self.x(seconds(time));
            let _infallible = write!(path, "H{}V{}", Document::units(x), Document::units(y(drawn as f64)));
        }
        let _infallible = write!(path, "H{}V{}z", Document::units(right), Document::units(low));
        self.document.raw(format_args!("<path class=\"draw\" d=\"{path}\"/>\n"));
        self.line("line", DVec2::new(left, low), DVec2::new(right, low));
        self.line("limit", DVec2::new(left, y(limit)), DVec2::new(right, y(limit)));
        let amps = |milliamps: f64| format!("{} A", (milliamps / 10.0).round() / 100.0);
        let at = |height: f64| DVec2::new(left - 8.0, height + 5.0);
        self.text("note end warn", at(y(limit)), format!("limit {}", amps(limit)));
        let peak = schedule.peak_current.0 as f64;
        // Not into the lines of text for the limit and for 0.
        let beside = y(peak).clamp(y(limit) + 17.0, low - 22.0);
        self.text("note end", at(beside), format!("peak {}", amps(peak)));
        self.text("note end", at(low - 5.0), "0 A");
    }
}

/// A time as people read it, with tenths where marks are nearer than a second.
fn clock(time: f64, span: f64) -> String {
    if span < 1.0 {
        return format!("{time:.1} s");
    }
    let whole = time.round();
    let (hours, minutes) = ((whole / 3600.0).floor(), (whole / 60.0).floor() % 60.0);
    if hours > 0.0 { format!("{hours} h {minutes:02} min") } else { format!("{minutes}:{:02}", whole % 60.0) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rig::Rig;
    use crate::testing::{real_plans, rig_text, strip};
    use crate::{Limits, Order, Tree};

    fn scheduled(plan: &Plan, parallel: usize) -> Schedule {
        let extra = "[[hinge]]\nhinge = 0\nkind = \"servo\"\n[[hinge]]\nhinge = 1\nkind = \"spring\"\n";
        let text = rig_text(extra).replace("heaters = 16", "heaters = 400");
        let rig = Rig::read("rig.toml", &text).expect("a good rig");
        let order = Order::of_tree(&Tree::new(plan).expect("a tree"));
        Schedule::plan(plan, &rig, &order, &Limits::at_most(parallel)).expect("a schedule")
    }

    /// A number of an attribute, in pixels.
    fn number(tag: &str, name: &str) -> f64 {
        let from = tag.find(&format!(" {name}=\"")).expect("the attribute") + name.len() + 3;
        tag[from..].split('"').next().expect("a value").parse::<f64>().expect("a number") / 10.0
    }

    #[test]
    fn every_hinge_has_a_bar_of_its_kind_as_long_as_its_time() {
        let plan = real_plans().remove(1);
        let schedule = scheduled(&plan, 3);
        let svg = gantt(&plan, &schedule).expect("a chart");
        let bars = |kind: &str| {
            svg.lines().filter(|line| line.starts_with(&format!("<rect class=\"{kind}\""))).count()
        };
        // One more each stands for its colour.
        assert_eq!([bars("sma"), bars("servo"), bars("spring")], [plan.hinges.len() - 2 + 1, 2, 2]);
        let step = schedule.steps.iter().find(|step| step.hinge == 1).expect("a step");
        let bar =
            svg.lines().filter(|line| line.starts_with("<rect class=\"spring\"")).nth(1).expect("a bar");
        let scale = PLOT / seconds(schedule.makespan.0);
        assert!((number(bar, "x") - MARGIN - LABELS - seconds(step.start.0) * scale).abs() < 0.1);
        assert!((number(bar, "width") - seconds(step.duration.0) * scale).abs() < 0.8);
        assert!(!svg.contains("NaN") && !svg.contains("inf"));
    }

    #[test]
    fn the_profile_returns_to_what_is_held_and_never_passes_the_limit() {
        let plan = real_plans().remove(1);
        let schedule = scheduled(&plan, 12);
        let svg = gantt(&plan, &schedule).expect("a chart");
        let path = svg.lines().find(|line| line.starts_with("<path class=\"draw\"")).expect("a profile");
        let limit = svg.lines().find(|line| line.starts_with("<line class=\"limit\"")).expect("a limit");
        let heights: Vec<f64> = path
            .split('V')
            .skip(1)
            .map(|rest| {
                rest.split(|c: char| !c.is_ascii_digit()).next().expect("digits").parse().expect("a number")
            })
            .collect();
        assert_eq!(heights.len(), 2 * schedule.steps.len() + 1);
        let top = heights.iter().copied().fold(f64::INFINITY, f64::min);
        assert!(top / 10.0 >= number(limit, "y1") - 0.1, "the profile goes above the limit");
        // At the end the one servo holds its 10 mA.
        let [.., held, floor] = heights[..] else { panic!("a profile") };
        let per_milliamp = CURRENT * 10.0 / (2000.0 * 1.12);
        assert!((floor - held - 10.0 * per_milliamp).abs() <= 1.0, "{held}, {floor}");
    }

    #[test]
    fn of_many_hinges_those_of_a_node_that_follow_each_other_share_a_row() {
        let plan = strip(300);
        let schedule = scheduled(&plan, 1);
        let rows = rows(&plan, &schedule);
        assert_eq!((rows.len(), rows[0].steps.len()), (1, 299));
        assert!(rows[0].steps.windows(2).all(|pair| pair[0].opened() <= pair[1].start));
        assert!(gantt(&plan, &schedule).expect("a chart").contains(">node 0<"));
    }

    #[test]
    fn times_are_told_by_the_span_of_the_marks() {
        assert_eq!(
            [clock(0.3, 0.1), clock(75.0, 15.0), clock(39_660.0, 60.0)],
            ["0.3 s", "1:15", "11 h 01 min"]
        );
    }

    #[test]
    fn a_schedule_of_another_plan_is_not_drawn() {
        let plans = real_plans();
        assert!(gantt(&plans[1], &scheduled(&plans[0], 1)).is_err());
    }
}
