//! `zygote table`: the steps of a schedule as comma-separated values, a row a hinge.

use crate::failure::{Failure, OrFail};
use crate::input;
use crate::output::{say, write_file};
use anyhow::Context;
use clap::Args;
use std::path::PathBuf;
use zygote_deployment::table;

/// Arguments of `zygote table`.
#[derive(Args)]
pub(crate) struct Arguments {
    /// The plan, with its schedule
    #[arg(value_name = "PLAN.fold")]
    plan: PathBuf,
    /// A schedule beside the plan
    #[arg(long, value_name = "SCHEDULE.json")]
    schedule: Option<PathBuf>,
    /// Write the table here instead of printing it
    #[arg(short, long, value_name = "FILE.csv")]
    output: Option<PathBuf>,
}

/// Prints or writes the table.
pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let plan = input::plan(&arguments.plan)?;
    let (name, schedule) = input::unverified_schedule(&arguments.plan, &plan, arguments.schedule.as_deref())?;
    let text = table::csv(&schedule, &plan).context(name).or_bad_input()?;
    match &arguments.output {
        Some(path) => {
            write_file(path, text.as_bytes())?;
            say(format_args!("{}: {} steps", path.display(), schedule.steps.len()));
        }
        None => say(text.trim_end()),
    }
    Ok(())
}
