//! `cargo xtask bench calibration [--hinges N] [--broken N] [--drift N] [--first N] [--seed S] [--wide] [--verbose]`: random simulated hinges, calibrated
//! and held against what they are, then the same with a fault each, and a picture of one; with `--drift` how they are judged that change afterwards.

use crate::tools::{self, cargo};
use anyhow::{Context, Result};
use std::fs;

/// Builds and runs the bench, which has the plant; this crate has none of ours.
pub(crate) fn run(options: &[String]) -> Result<()> {
    let place = tools::root().join("target/bench/calibration");
    fs::create_dir_all(&place).with_context(|| format!("{} cannot be made", place.display()))?;
    let picture = place.join("hinge.svg");
    let mut bench = cargo();
    bench.args([
        "run",
        "--release",
        "--package",
        "zygote-calibration",
        "--example",
        "calibration_bench",
        "--",
    ]);
    bench.arg("--picture").arg(&picture).args(options).current_dir(tools::root());
    tools::run(&mut bench)?;
    println!("\nThe first hinge is drawn in {}.", picture.display());
    Ok(())
}
