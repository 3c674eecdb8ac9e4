//! `cargo xtask campaign [--calibrate] [--runs N] [--seed S] [--threads T]`, or `--replay SEED:NUMBER`: random rehearsals, judged.

use crate::tools::{self, cargo};
use anyhow::Result;

/// Builds the campaign for speed and hands the options on to it.
pub(crate) fn run(options: &[String]) -> Result<()> {
    let mut campaign = cargo();
    campaign.args([
        "run",
        "--quiet",
        "--release",
        "--package",
        "zygote-rehearsal",
        "--example",
        "campaign",
        "--",
    ]);
    campaign.args(options).current_dir(tools::root());
    tools::run(&mut campaign)
}
