//! `zygote fold`: the schedule of a plan backwards, from the shape to the stack.

use crate::failure::{Failure, OrFail};
use crate::input;
use crate::output::{say, write_file};
use anyhow::Context;
use clap::Args;
use std::path::PathBuf;

/// Arguments of `zygote fold`.
#[derive(Args)]
#[command(
    after_help = "Every hinge must be a servo: shape-memory and spring hinges open once, and don't close by themselves. The \
    schedule is that of the plan, last hinge first, each from its angle in the shape to that in the stack."
)]
pub(crate) struct Arguments {
    /// The plan, with its schedule
    #[arg(value_name = "PLAN.fold")]
    plan: PathBuf,
    /// The rig that is to fold it
    #[arg(long, value_name = "RIG.toml")]
    rig: PathBuf,
    /// A schedule beside the plan
    #[arg(long, value_name = "SCHEDULE.json")]
    schedule: Option<PathBuf>,
    /// Where to write the way back, as JSON
    #[arg(short, long, value_name = "FOLD.json")]
    output: PathBuf,
}

/// Verifies the way there, and writes the way back.
pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let rig = input::rig(&arguments.rig)?;
    let plan = input::plan(&arguments.plan)?;
    let schedule = input::schedule(&arguments.plan, &plan, &rig, arguments.schedule.as_deref())?;
    let back = schedule
        .reversed()
        .with_context(|| format!("{}: can't be folded up again", arguments.plan.display()))
        .or_bad_input()?;
    back.verify_reversed(&plan, &rig)
        .context("a fault of this program: its own way back is wrong")
        .or_failed()?;
    write_file(&arguments.output, back.to_text().or_failed()?.as_bytes())?;
    say(format_args!(
        "{}: {} steps back on rig {} in {}, drawing at most {} of {}",
        arguments.output.display(),
        back.steps.len(),
        back.rig,
        back.makespan,
        back.peak_current,
        back.supply_limit
    ));
    Ok(())
}
