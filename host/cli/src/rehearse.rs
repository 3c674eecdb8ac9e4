//! `zygote rehearse`: scenario files, with the real controller over the real protocol on the simulator.

use crate::failure::{Failure, OrFail};
use crate::output::say;
use anyhow::anyhow;
use clap::Args;
use std::path::PathBuf;
use zygote_rehearsal::Scenario;
use zygote_rehearsal::scenario::table;

/// Arguments of `zygote rehearse`.
#[derive(Args)]
pub(crate) struct Arguments {
    /// Scenario files, or folders of them
    #[arg(value_name = "FILE", required = true)]
    files: Vec<PathBuf>,
    /// Print the verdicts as JSON
    #[arg(long)]
    json: bool,
}

/// Prints a line a scenario; succeeds only when all hold.
pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let mut verdicts = Vec::new();
    for path in &arguments.files {
        for scenario in Scenario::find(path).or_bad_input()? {
            verdicts.push(scenario.rehearse().or_bad_input()?);
        }
    }
    if arguments.json {
        say(serde_json::to_string_pretty(&verdicts).or_failed()?);
    } else {
        say(table(&verdicts));
    }
    let failed = verdicts.iter().filter(|verdict| !verdict.holds()).count();
    match (failed, verdicts.len()) {
        (_, 0) => Err(Failure::BadInput(anyhow!("no scenario file there"))),
        (0, _) => Ok(()),
        (_, all) => Err(Failure::Failed(anyhow!("{failed} of {all} scenarios failed"))),
    }
}
