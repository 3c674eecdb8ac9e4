//! A recording as lines of text: what ran, what happened when, how it ended.

use crate::reader::{End, Recording};
use crate::run::{Ended, Run};
use crate::told;
use std::fmt::Write as _;
use zygote_controller::HingeOutcome;

/// A recording for people: a head, a line an event by the run's clock, an end.
pub fn timeline(recording: &Recording) -> String {
    let run = Run::new(recording);
    let mut text = String::new();
    head(&mut text, recording);
    for event in &recording.events {
        let Some((_, sentence)) = told::sentence(&event.record) else { continue };
        let at = run.seconds_of(&event.record).map_or_else(String::new, |at| format!("{at:.2} s"));
        line(&mut text, format_args!("{at:>12}  {sentence}"));
    }
    let opened = run.count(HingeOutcome::Opened);
    let ended = match run.outcome() {
        Ended::Well(how) | Ended::Early(how) => how,
        Ended::Badly(why) => format!("not {}: {why}", goal(&run)),
        Ended::Unknown => "unknown: the recording ends before the run does".to_owned(),
    };
    line(
        &mut text,
        format_args!("result: {ended}; {opened} of {} hinges are at their angle", run.hinges.len()),
    );
    if let End::Cut { why } = &recording.end {
        line(
            &mut text,
            format_args!("the recording isn't whole ({why}): what is told here is what was saved"),
        );
    }
    // No line end after the last line: who prints it adds one.
    let _infallible = write!(text, "next: {}", run.next());
    text
}

/// What the run was to come to.
pub(crate) fn goal(run: &Run<'_>) -> &'static str {
    match run.schedule.direction() {
        zygote_deployment::Direction::Deploy => "deployed",
        zygote_deployment::Direction::Fold => "folded",
    }
}

fn head(text: &mut String, recording: &Recording) {
    let of = |map: &std::collections::BTreeMap<String, String>, key: &str| {
        map.get(key).cloned().unwrap_or_default()
    };
    let (panels, hinges) = (recording.plan.panels(), recording.plan.hinges.len());
    line(text, format_args!("plan:  {}, {panels} panels, {hinges} hinges", of(&recording.job, "plan")));
    let identity = &recording.identity;
    line(
        text,
        format_args!(
            "rig:   {} ({}), board {} with firmware {} on {}",
            recording.rig.id,
            of(&recording.job, "rig"),
            of(identity, "board"),
            of(identity, "firmware"),
            of(identity, "line"),
        ),
    );
    line(text, format_args!("when:  {}", of(&recording.job, "started")));
    if let Some(scenario) = recording.job.get("scenario") {
        line(text, format_args!("scenario: {scenario}"));
    }
}

fn line(text: &mut String, what: std::fmt::Arguments<'_>) {
    // Writing to a String can't fail.
    let _infallible = writeln!(text, "{what}");
}
