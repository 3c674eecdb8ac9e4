//! `zygote schedule`: a plan and a rig into a schedule, written into the plan or beside it.

use crate::failure::{Failure, OrFail};
use crate::input;
use crate::output::{say, write_file};
use anyhow::Context;
use clap::Args;
use std::path::PathBuf;
use zygote_deployment::{Kind, Limits, Millis, Order, Schedule, Tree};
use zygote_stacking::fold;

/// Arguments of `zygote schedule`.
#[derive(Args)]
pub(crate) struct Arguments {
    /// The plan
    #[arg(value_name = "PLAN.fold")]
    plan: PathBuf,
    /// The rig that is to deploy it
    #[arg(long, value_name = "RIG.toml")]
    rig: PathBuf,
    /// Most motions at once; nothing looks for collisions yet, so 1 is the safe choice
    #[arg(long, value_name = "M", default_value_t = 1, value_parser = at_least_1)]
    parallel: usize,
    /// Write the schedule here, as JSON, and leave the plan as it is
    #[arg(short, long, value_name = "SCHEDULE.json")]
    output: Option<PathBuf>,
}

fn at_least_1(text: &str) -> Result<usize, String> {
    text.parse()
        .ok()
        .filter(|count| *count >= 1)
        .ok_or_else(|| "expected a whole number, at least 1".to_owned())
}

/// Schedules, verifies what came out, and writes it.
pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let rig = input::rig(&arguments.rig)?;
    let mut plan = input::plan(&arguments.plan)?;
    let order = Order::of_tree(&Tree::new(&plan).context("no order").or_bad_input()?);
    let schedule = Schedule::plan(&plan, &rig, &order, &Limits::at_most(arguments.parallel))
        .with_context(|| format!("{}: no schedule on this rig", arguments.plan.display()))
        .or_bad_input()?;
    schedule.verify(&plan, &rig).context("a fault of this program: its own schedule is wrong").or_failed()?;
    let written = if let Some(output) = &arguments.output {
        write_file(output, schedule.to_text().or_failed()?.as_bytes())?;
        output
    } else {
        plan.schedule = Some(schedule.to_json().or_failed()?);
        write_file(&arguments.plan, &fold::write(&plan).or_failed()?)?;
        &arguments.plan
    };
    say(format_args!("{}: {}", written.display(), summary(&schedule)));
    Ok(())
}

/// What a schedule amounts to, in one line.
fn summary(schedule: &Schedule) -> String {
    let kinds: Vec<_> = Kind::ALL
        .into_iter()
        .map(|kind| (schedule.steps.iter().filter(|step| step.motion.kind() == kind).count(), kind))
        .filter(|(count, _)| *count > 0)
        .map(|(count, kind)| format!("{count} {}", kind.name()))
        .collect();
    format!(
        "{} steps ({}) on rig {} in {} ({:.2} of the lower bound), at most {} at once, drawing at most {} of {}",
        schedule.steps.len(),
        kinds.join(", "),
        schedule.rig,
        clock(schedule.makespan),
        schedule.ratio(),
        schedule.most_at_once(),
        schedule.peak_current,
        schedule.supply_limit,
    )
}

/// A time as people read it.
fn clock(time: Millis) -> String {
    let tenths = time.0.div_ceil(100);
    let minutes = tenths / 600;
    match minutes {
        0 => format!("{}.{} s", tenths / 10, tenths % 10),
        1..60 => format!("{minutes} min {} s", tenths % 600 / 10),
        60.. => format!("{} h {} min", minutes / 60, minutes % 60),
    }
}
