//! `zygote report`: a recorded run as one HTML page.

use crate::failure::Failure;
use crate::output::{say, write_file};
use crate::recording_file;
use clap::Args;
use std::path::PathBuf;
use zygote_recording::page;

/// Arguments of `zygote report`.
#[derive(Args)]
#[command(
    after_help = "The page needs nothing else: no network, no script. It has the result, faults explained, what to do next, the schedule \
    against the clock, temperatures, current and supply, every hinge and every event."
)]
pub(crate) struct Arguments {
    /// The recording
    #[arg(value_name = "RUN.mcap")]
    recording: PathBuf,
    /// Where to write the page [default: beside the recording, .html]
    #[arg(short, long, value_name = "FILE.html")]
    output: Option<PathBuf>,
}

/// Writes the page.
pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let recording = recording_file::read(&arguments.recording)?;
    let page = page(&recording);
    let output = arguments.output.clone().unwrap_or_else(|| arguments.recording.with_extension("html"));
    write_file(&output, page.as_bytes())?;
    say(format_args!("{}: {} kB", output.display(), page.len().div_ceil(1000)));
    Ok(())
}
