//! `zygote replay`: tells a recorded run again, or shows it in the viewer's page.

use crate::failure::{Failure, OrFail};
use crate::output::say;
use crate::view::{self, SceneOf, Showing};
use crate::{input, interrupt, recording_file};
use anyhow::anyhow;
use clap::Args;
use serde::Serialize;
use serde_json::json;
use std::path::{Path, PathBuf};
use zygote_deployment::Fingerprint;
use zygote_live::{Begin, Server, expected};
use zygote_recording::{End, Recording, timeline};

/// Arguments of `zygote replay`.
#[derive(Args)]
#[command(
    after_help = "Recordings are MCAP files: Foxglove opens them too. A recording that broke off is told as far as it goes."
)]
pub(crate) struct Arguments {
    /// The recording
    #[arg(value_name = "RUN.mcap")]
    recording: PathBuf,
    /// Print what was recorded as JSON
    #[arg(long, conflicts_with = "view")]
    json: bool,
    /// Show it in the browser, with a slider over its time
    #[arg(long)]
    view: bool,
    /// Refuse a recording of another plan than this
    #[arg(long, value_name = "PLAN.fold")]
    plan: Option<PathBuf>,
    /// Port of the page's address [default: any that is free]
    #[arg(long, value_name = "N", default_value_t = 0, hide_default_value = true, requires = "view")]
    view_port: u16,
    /// Open no browser
    #[arg(long, requires = "view")]
    no_open: bool,
}

/// Prints the run, or shows it.
pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let recording = recording_file::read(&arguments.recording)?;
    if let Some(plan) = &arguments.plan {
        is_of(&arguments.recording, &recording, plan)?;
    }
    if arguments.view {
        return show(arguments, &recording);
    }
    if !arguments.json {
        say(timeline(&recording));
        return Ok(());
    }
    let cut = match &recording.end {
        End::Whole => None,
        End::Cut { why } => Some(why),
    };
    let told = json!({
        "job": recording.job,
        "identity": recording.identity,
        "cut": cut,
        "events": recording.events,
        "telemetry": recording.telemetry,
        "report": recording.report,
    });
    say(serde_json::to_string_pretty(&told).or_failed()?);
    Ok(())
}

/// The recording is of this plan.
fn is_of(path: &Path, recording: &Recording, plan: &Path) -> Result<(), Failure> {
    let (found, expected) = (Fingerprint::of(&recording.plan), Fingerprint::of(&input::plan(plan)?));
    if found == expected {
        return Ok(());
    }
    let (name, plan) = (path.display(), plan.display());
    Err(Failure::BadInput(anyhow!("{name}: is of plan {found}, expected plan {expected} of {plan}")))
}

/// A message with its type, as a page is told it of a run that goes on.
#[derive(Serialize)]
struct Message<'a, T> {
    #[serde(rename = "type")]
    kind: &'static str,
    #[serde(flatten)]
    message: &'a T,
}

fn message<T: Serialize>(kind: &'static str, message: &T) -> Result<serde_json::Value, Failure> {
    serde_json::to_value(Message { kind, message }).or_failed()
}

/// Serves the page until Ctrl-C.
fn show(arguments: &Arguments, recording: &Recording) -> Result<(), Failure> {
    let Recording { job, identity, plan, rig, schedule, open, .. } = recording;
    let named = |key: &str| job.get(key).cloned().unwrap_or_default();
    let of = (schedule.plan_crc64, Fingerprint::of(plan));
    if of.0 != of.1 {
        let name = arguments.recording.display();
        return Err(Failure::BadInput(anyhow!(
            "{name}: its schedule is for plan {}, its plan is {}",
            of.0,
            of.1
        )));
    }
    let file = PathBuf::from(named("plan"));
    let scene = SceneOf { path: &file, plan, schedule: Some(schedule), rig: Some(rig) };
    let begin = Begin {
        version: zygote_live::VERSION,
        run: 0,
        file: named("plan"),
        rig: rig.id.clone(),
        line: identity.get("line").cloned().unwrap_or_default(),
        direction: schedule.direction(),
        pace: 1.0,
        current_limit_a: rig.supply.limit.0,
        steps: expected(&schedule.rest(open)),
        open: open.iter().copied().collect(),
    };
    let mut told = vec![message("begin", &begin)?];
    for event in &recording.events {
        told.push(message("event", event)?);
    }
    for look in &recording.telemetry {
        told.push(message("look", look)?);
    }
    if let Some(report) = &recording.report {
        told.push(message("report", report)?);
    }
    if let End::Cut { why } = &recording.end {
        told.push(json!({ "type": "trouble", "told": format!("The recording isn't whole: {why}") }));
    }
    let stop = interrupt::flag()?;
    let listener = view::listen(arguments.view_port, "--view-port")?;
    let server = Server::start(listener, view::page()?, None).or_failed()?;
    server.put("/scene.json", scene.of_run(view::Run::Recording)?);
    server.put("/run.json", serde_json::to_vec(&told).or_failed()?);
    Showing { what: &arguments.recording.display(), server: &server, no_open: arguments.no_open }.tell()?;
    view::until_interrupted(&stop);
    Ok(())
}
