//! `zygote replay`: tells a recorded run again.

use crate::failure::{Failure, OrFail};
use crate::output::say;
use crate::recording_file;
use clap::Args;
use serde_json::json;
use std::path::PathBuf;
use zygote_recording::{End, timeline};

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
    #[arg(long)]
    json: bool,
}

/// Prints the run.
pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let recording = recording_file::read(&arguments.recording)?;
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
