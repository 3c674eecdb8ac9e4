//! `zygote check`: whether a plan file keeps the rules. Exit code 0 valid, 1 it breaks a rule, 2 it can't be read.

use crate::failure::{Failure, OrFail};
use crate::output::say;
use crate::plan::summary;
use anyhow::{Context, anyhow};
use clap::Args;
use std::fs;
use std::path::PathBuf;
use zygote_stacking::fold;

/// Places listed for each broken rule.
const SHOWN_PER_RULE: usize = 5;

/// Arguments of `zygote check`.
#[derive(Args)]
pub(crate) struct Arguments {
    /// The plan
    #[arg(value_name = "PLAN.fold")]
    plan: PathBuf,
}

/// Checks a plan and lists what it breaks.
pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let name = arguments.plan.display();
    let bytes =
        fs::read(&arguments.plan).with_context(|| format!("{name}: cannot be read")).or_bad_input()?;
    let report = fold::check(&bytes).with_context(|| format!("{name}: no plan")).or_bad_input()?;
    if report.is_valid() {
        say(format_args!("{name}: valid: {}", summary(&report.figures)));
        return Ok(());
    }
    for line in report.lines(SHOWN_PER_RULE) {
        say(line);
    }
    let rules = report.violations().count();
    Err(Failure::Failed(anyhow!("{name}: breaks {rules} of the rules of a plan, listed above")))
}
