//! A recording as one HTML page that needs nothing else: no script, no font, no network. Light or dark, as the reader's system is.

mod axis;
mod curves;
mod drift;
mod gantt;
mod hinges;
mod plot;

use crate::reader::{End, Recording};
use crate::run::{Ended, Run};
use crate::timeline::goal;
use crate::told;
use std::fmt::{Display, Write as _};
use zygote_controller::HingeOutcome;

const STYLE: &str = include_str!("style.css");

/// The page.
pub fn page(recording: &Recording) -> String {
    let run = Run::new(recording);
    let mut page = Html::default();
    let title = format!("{} on {}", about(recording, "plan"), recording.rig.id);
    page.add(format_args!(
        "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\
         <title>{} - zygote</title>\n<style>\n{STYLE}</style></head>\n<body><main>\n",
        escaped(&title)
    ));
    head(&mut page, &run, &title);
    tiles(&mut page, &run);
    faults(&mut page, &run);
    page.add(format_args!(
        "<section class=\"next\"><h2>What to do next</h2><p>{}.</p></section>\n",
        options_marked(&run.next())
    ));
    gantt::section(&mut page, &run);
    curves::sections(&mut page, &run);
    hinges::section(&mut page, &run);
    drift::section(&mut page, &run);
    events(&mut page, &run);
    page.add(format_args!(
        "<footer>Recorded by {}. Times are seconds of the run by the MCU's clock.</footer>\n</main></body></html>\n",
        escaped(about(recording, "program"))
    ));
    page.text
}

/// The page so far.
#[derive(Default)]
struct Html {
    text: String,
}

impl Html {
    fn add(&mut self, what: impl Display) {
        // Writing to a String can't fail.
        let _infallible = write!(self.text, "{what}");
    }
}

/// Text as HTML shows it.
fn escaped(text: impl Display) -> String {
    let mut escaped = String::new();
    for letter in text.to_string().chars() {
        match letter {
            '&' => escaped.push_str("&amp;"),
            '<' => escaped.push_str("&lt;"),
            '>' => escaped.push_str("&gt;"),
            '"' => escaped.push_str("&quot;"),
            other => escaped.push(other),
        }
    }
    escaped
}

/// A sentence with its command-line options in one piece each.
fn options_marked(text: &str) -> String {
    let word = |word: &str| {
        if word.starts_with("--") { format!("<code>{}</code>", escaped(word)) } else { escaped(word) }
    };
    capitalised(&text.split(' ').map(word).collect::<Vec<_>>().join(" "))
}

fn capitalised(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map(|first| first.to_uppercase().chain(letters).collect()).unwrap_or_default()
}

fn about<'a>(recording: &'a Recording, key: &str) -> &'a str {
    recording.job.get(key).map_or("", String::as_str)
}

fn head(page: &mut Html, run: &Run<'_>, title: &str) {
    let (class, badge) = match run.outcome() {
        Ended::Well(how) => ("good", how),
        Ended::Early(how) => ("warn", how),
        Ended::Badly(_) => ("bad", format!("not {}", goal(run))),
        Ended::Unknown => ("warn", "end unknown".to_owned()),
    };
    let recording = run.recording;
    let identity = |key: &str| escaped(recording.identity.get(key).map_or("", String::as_str));
    page.add(format_args!(
        "<header><h1>{}</h1><span class=\"badge {class}\">{}</span>\n<p class=\"sub\">{} panels in {} piles. Board {} with firmware {} on \
         {}. {}.</p>\n",
        escaped(title),
        escaped(badge),
        recording.plan.panels(),
        recording.plan.piles.len(),
        identity("board"),
        identity("firmware"),
        identity("line"),
        escaped(capitalised(about(recording, "started"))),
    ));
    if let Some(scenario) = recording.job.get("scenario") {
        page.add(format_args!(
            "<p class=\"sub\">What went wrong was asked for by {}.</p>\n",
            escaped(scenario)
        ));
    }
    if let End::Cut { why } = &recording.end {
        page.add(format_args!(
            "<p class=\"note\">The recording isn't whole: {}. What is shown here is what was saved.</p>\n",
            escaped(why)
        ));
    }
    page.add("</header>\n");
}

fn tiles(page: &mut Html, run: &Run<'_>) {
    let opened = run.count(HingeOutcome::Opened);
    let looks = &run.recording.telemetry;
    let peak = run.hinges.values().filter_map(|hinge| hinge.peak_c).fold(f64::NEG_INFINITY, f64::max);
    let hottest = looks
        .iter()
        .flat_map(|look| look.motions.iter().filter_map(|motion| motion.temperature_c))
        .fold(peak, f64::max);
    let current = looks.iter().map(|look| look.current_a).fold(f64::NEG_INFINITY, f64::max);
    let supply = looks.iter().map(|look| look.supply_v).fold(f64::INFINITY, f64::min);
    let duration = run.recording.report.as_ref().map_or_else(|| run.end_s(), |report| report.duration_s);
    #[expect(clippy::cast_precision_loss, reason = "a makespan is far below 2^52 ms")]
    let expected = run.schedule.makespan.0 as f64 / 1e3;
    page.add("<div class=\"tiles\">");
    let mut tile = |name: &str, figure: String, beside: String| {
        page.add(format_args!("<div><b>{figure}</b><span>{name}</span><small>{beside}</small></div>"));
    };
    tile("hinges at their angle", format!("{opened} / {}", run.hinges.len()), String::new());
    tile("duration", format!("{duration:.1} s"), format!("scheduled {expected:.1} s to the last angle"));
    if hottest.is_finite() {
        tile("hottest hinge", format!("{hottest:.1} °C"), String::new());
    }
    if current.is_finite() {
        let limit = run.recording.rig.supply.limit.0;
        tile("highest current", format!("{current:.2} A"), format!("limit {limit:.2} A"));
        let nominal = run.recording.rig.supply.voltage.0;
        tile("lowest supply", format!("{supply:.2} V"), format!("without load {nominal:.2} V"));
    }
    page.add("</div>\n");
}

fn faults(page: &mut Html, run: &Run<'_>) {
    if let (Ended::Badly(why), true) = (run.outcome(), run.faults().is_empty()) {
        page.add(format_args!(
            "<section class=\"fault\"><h2>What went wrong</h2><p>{}</p></section>\n",
            escaped(why)
        ));
    }
    for fault in run.faults() {
        let at = fault.seconds.map(|at| format!(" at {at:.2} s")).unwrap_or_default();
        page.add(format_args!(
            "<section class=\"fault\"><h2>{}{at}</h2><p>{}.</p><dl><dt>Meaning</dt><dd>{}</dd><dt>Position trusted</dt><dd>{}</dd>\
             <dt>What to do</dt><dd>{}</dd></dl></section>\n",
            escaped(&fault.code),
            escaped(&fault.sentence),
            escaped(fault.text.meaning),
            escaped(fault.text.position),
            escaped(fault.text.remedy),
        ));
    }
}

fn events(page: &mut Html, run: &Run<'_>) {
    let events = &run.recording.events;
    page.add(format_args!("<details><summary>Events ({})</summary><table class=\"events\">", events.len()));
    for event in events {
        let Some((level, sentence)) = told::sentence(&event.record) else { continue };
        let class = match level {
            told::Level::Info => "",
            told::Level::Warning => " class=\"warn\"",
            told::Level::Error => " class=\"bad\"",
        };
        let at = run.seconds_of(&event.record).map_or_else(String::new, |at| format!("{at:.2}"));
        page.add(format_args!("<tr{class}><td class=\"n\">{at}</td><td>{}</td></tr>\n", escaped(sentence)));
    }
    page.add("</table></details>\n");
}
