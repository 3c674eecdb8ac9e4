//! What a scenario expects against what was truly the case, as a table for people.

use super::Scenario;
use super::error::ScenarioError;
use super::file::{All, ExpectTable, Open, OutcomeName, Since};
use super::resolve::At;
use crate::judge::{judge as judge_rules, seconds};
use crate::run::{Ending, Rehearsed, Trial};
use crate::witness::{Span, Witness};
use serde::Serialize;
use std::collections::BTreeSet;
use std::fmt::Write;
use zygote_controller::Outcome;
use zygote_deployment::Seconds;
use zygote_protocol::{FaultCode, Micros, State};

/// One thing that was expected.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Row {
    /// What.
    pub what: String,
    /// What was asked for.
    pub required: String,
    /// What was the case.
    pub measured: String,
    /// It was as asked for.
    pub holds: bool,
}

/// How a scenario went.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Verdict {
    /// Name of the scenario.
    pub scenario: String,
    /// The safety rule that it shows.
    pub rule: Option<String>,
    /// What went wrong first, and when.
    pub cause: String,
    /// What was expected.
    pub rows: Vec<Row>,
    /// Rules that didn't hold.
    pub breaches: Vec<String>,
}

impl Verdict {
    /// Everything was as it should be.
    pub fn holds(&self) -> bool {
        self.breaches.is_empty() && self.rows.iter().all(|row| row.holds)
    }
}

/// What is known of a fault's name.
enum Named {
    NoFault,
    Fault(FaultCode),
    Unknown,
}

fn named(name: &str) -> Named {
    if name == "none" {
        return Named::NoFault;
    }
    let number = name.strip_prefix('F').and_then(|number| number.parse::<u16>().ok());
    let code = FaultCode::ALL.iter().find(|code| Some(code.number()) == number);
    code.map_or(Named::Unknown, |code| Named::Fault(*code))
}

/// Refuses what can't be judged.
pub(super) fn check(at: At<'_>, expect: &ExpectTable) -> Result<(), ScenarioError> {
    match &expect.fault {
        Some(name) if matches!(named(name), Named::Unknown) => {
            Err(at.refuse("expect.fault", "\"none\" or a fault code as in \"F08\"", format!("{name:?}")))
        }
        _ => Ok(()),
    }
}

pub(super) fn judge(
    scenario: &Scenario,
    expect: &ExpectTable,
    trial: &Trial,
    rehearsed: &Rehearsed,
) -> Verdict {
    let mut rows = times(expect, trial, rehearsed);
    rows.push(outcome(expect, rehearsed));
    rows.extend(facts(expect, rehearsed));
    let cause = match trial.causes.first() {
        None => "none".to_owned(),
        Some(cause) => match rehearsed.script.time_of(0) {
            Some(at) => format!("{} at {:.2} s", cause.what, seconds(at)),
            None => format!("{}: never happened", cause.what),
        },
    };
    // A cause that never came shows nothing.
    let missing = (0..trial.causes.len()).filter(|index| rehearsed.script.time_of(*index).is_none());
    rows.extend(missing.map(|index| Row {
        what: format!("cause {index}"),
        required: "happens".to_owned(),
        measured: "never happened".to_owned(),
        holds: false,
    }));
    Verdict {
        scenario: scenario.name(),
        rule: scenario.rule.clone(),
        cause,
        rows,
        breaches: judge_rules(trial, rehearsed).iter().map(ToString::to_string).collect(),
    }
}

/// The deadlines.
fn times(expect: &ExpectTable, trial: &Trial, rehearsed: &Rehearsed) -> Vec<Row> {
    let witness = &rehearsed.witness;
    let cause = rehearsed.script.time_of(0).unwrap_or_default();
    let (since, name) = match expect.since {
        Since::Cause => (cause, "cause"),
        Since::Start => {
            let running = witness.states.iter().find(|(_, state)| *state == State::Running);
            (running.map_or(Micros(0), |(at, _)| *at), "start")
        }
        Since::LinkLoss => {
            let last = witness.heard.last_frame.unwrap_or_default();
            (last.plus(trial.link_timeout()), "link loss")
        }
    };
    let off = |what: &str, within: Option<Seconds>, spans: &[Span]| {
        let took = Micros(Witness::over_by(spans, since).since(since));
        within.map(|within| row_of_time(what, name, within, took))
    };
    let (heaters, heated) = match expect.heater_of {
        None => ("heaters off".to_owned(), &witness.heated),
        Some(hinge) => {
            let truth = witness.hinges.iter().find(|truth| truth.hinge == hinge);
            (format!("heater of hinge {hinge} off"), truth.map_or(&witness.heated, |truth| &truth.heated))
        }
    };
    let knows = Micros(rehearsed.ended_at.since(cause));
    [
        off(&heaters, expect.heaters_off_within, heated),
        off("all off", expect.off_within, &witness.energised),
        expect.host_knows_within.map(|within| row_of_time("host knows", "cause", within, knows)),
    ]
    .into_iter()
    .flatten()
    .collect()
}

fn row_of_time(what: &str, since: &str, within: Seconds, took: Micros) -> Row {
    let took = seconds(took);
    Row {
        what: what.to_owned(),
        required: format!("within {} of {since}", span(within.0)),
        measured: span(took),
        holds: took <= within.0 + 1e-9,
    }
}

fn span(seconds: f64) -> String {
    if seconds < 10.0 { format!("{:.0} ms", seconds * 1e3) } else { format!("{seconds:.2} s") }
}

fn outcome(expect: &ExpectTable, rehearsed: &Rehearsed) -> Row {
    let (found, said) = match &rehearsed.ending {
        Ending::Report(report) => {
            let (name, why) = match &report.outcome {
                Outcome::Deployed | Outcome::Folded => (OutcomeName::Deployed, String::new()),
                Outcome::Stopped => (OutcomeName::Stopped, String::new()),
                Outcome::Paused => (OutcomeName::Paused, String::new()),
                Outcome::Fault(why) => (OutcomeName::Fault, why.clone()),
                Outcome::Lost(why) => (OutcomeName::Lost, why.clone()),
            };
            (name, why)
        }
        Ending::Measured { done, of } => (OutcomeName::Refused, format!("{done} of {of} hinges calibrated")),
        Ending::Refused(why) => (OutcomeName::Refused, why.clone()),
        Ending::Killed => (OutcomeName::Killed, String::new()),
    };
    let says = expect.says.as_deref().unwrap_or_default();
    Row {
        what: "host".to_owned(),
        required: format!("{:?} {says}", expect.outcome).to_lowercase().trim_end().to_owned(),
        measured: if said.is_empty() { format!("{found:?}") } else { format!("{found:?}: {said}") }
            .to_lowercase(),
        holds: found == expect.outcome && said.contains(says),
    }
}

/// Fault, temperature, angles.
fn facts(expect: &ExpectTable, rehearsed: &Rehearsed) -> Vec<Row> {
    let witness = &rehearsed.witness;
    let mut rows = Vec::new();
    if let Some(name) = &expect.fault {
        let found = witness.faults.first().map(|fault| fault.code);
        let holds = match named(name) {
            Named::NoFault => found.is_none(),
            Named::Fault(code) => found == Some(code),
            Named::Unknown => false,
        };
        let measured = found.map_or("none".to_owned(), |code| format!("F{:02}", code.number()));
        rows.push(Row { what: "fault".to_owned(), required: name.clone(), measured, holds });
    }
    if let Some(most) = expect.never_above {
        let hottest = witness.hinges.iter().filter_map(|hinge| hinge.hottest).map(|(celsius, _)| celsius);
        let hottest = hottest.fold(f64::NEG_INFINITY, f64::max);
        rows.push(Row {
            what: "hottest foil".to_owned(),
            required: format!("at most {most:.1}"),
            measured: format!("{hottest:.1} degC"),
            holds: hottest <= most.0,
        });
    }
    if let Some(open) = &expect.open {
        let found: BTreeSet<_> =
            witness.hinges.iter().filter(|hinge| hinge.is_open()).map(|hinge| hinge.hinge).collect();
        let required: BTreeSet<_> = match open {
            Open::Word(All::All) => witness.hinges.iter().map(|hinge| hinge.hinge).collect(),
            Open::Hinges(hinges) => hinges.iter().copied().collect(),
        };
        let (holds, required, measured) = (found == required, format!("{required:?}"), format!("{found:?}"));
        rows.push(Row { what: "truly open".to_owned(), required, measured, holds });
    }
    rows
}

/// A line a scenario, those that failed with what failed.
pub fn table(verdicts: &[Verdict]) -> String {
    let mut lines = vec![["scenario", "rule", "cause", "required", "measured", "verdict"].map(str::to_owned)];
    lines.extend(verdicts.iter().map(cells));
    let width = |column: usize| lines.iter().map(|cells| cells[column].chars().count()).max().unwrap_or(0);
    let widths: [usize; 6] = std::array::from_fn(width);
    let mut text = String::new();
    for (at, cells) in lines.iter().enumerate() {
        let padded: Vec<_> =
            cells.iter().zip(widths).map(|(cell, width)| format!("{cell:<width$}")).collect();
        // A string takes all.
        writeln!(text, "{}", padded.join("  ").trim_end()).ok();
        let Some(verdict) = at.checked_sub(1).and_then(|at| verdicts.get(at)) else { continue };
        for row in verdict.rows.iter().filter(|row| !row.holds) {
            writeln!(text, "    {}: expected {}, found {}", row.what, row.required, row.measured).ok();
        }
        for breach in &verdict.breaches {
            writeln!(text, "    {breach}").ok();
        }
    }
    text.trim_end().to_owned()
}

/// A scenario's line: the first thing that it expects stands for all.
fn cells(verdict: &Verdict) -> [String; 6] {
    let (required, measured) = verdict.rows.first().map_or_else(Default::default, |row| {
        // A host's reason is too long for a table.
        let measured = row.measured.split(':').next().unwrap_or_default();
        (format!("{} {}", row.what, row.required), measured.to_owned())
    });
    let rule = verdict.rule.clone().unwrap_or_default();
    let word = if verdict.holds() { "ok" } else { "FAILED" };
    [verdict.scenario.clone(), rule, verdict.cause.clone(), required, measured, word.to_owned()]
}
