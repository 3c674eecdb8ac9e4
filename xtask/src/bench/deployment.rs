//! `cargo xtask bench deployment [--peers]`: how short schedules are, and how long it takes to find them.

use crate::python;
use crate::tools::{self, cargo};
use anyhow::{Context, Result, bail};
use std::fs;

/// Models whose schedules are compared with those of others.
const MODELS: [&str; 5] = ["i14", "l14", "fish92", "vehicle92", "airplane92"];

/// Prints the table of the models, that of 100,000 panels, and with `--peers` that of CP-SAT on the same problems.
pub(crate) fn run(options: &[String]) -> Result<()> {
    let beside_peers = match options {
        [] => false,
        [option] if option == "--peers" => true,
        _ => bail!("unknown options {options:?} of `bench deployment`, expected --peers"),
    };
    let folder = tools::root().join("target/bench/schedules");
    if folder.exists() {
        fs::remove_dir_all(&folder).with_context(|| format!("{} cannot be emptied", folder.display()))?;
    }
    fs::create_dir_all(&folder).with_context(|| format!("{} cannot be made", folder.display()))?;
    let example = |place: &str, models: &[&str]| {
        let mut example = cargo();
        example.args(["run", "--quiet", "--release", "--package", "zygote-deployment"]);
        example.args(["--example", "schedule_times", "--", place]).args(models).current_dir(tools::root());
        tools::run(&mut example)
    };
    example(&folder.to_string_lossy(), &MODELS)?;
    example("-", &["large"])?;
    if !beside_peers {
        return Ok(());
    }
    let scripts = tools::root().join("xtask/peers");
    let python = python::with_requirements(
        &tools::root().join("target/venv-schedules"),
        &scripts.join("schedules.txt"),
    )?;
    tools::run(tools::command(python).arg(scripts.join("schedules.py")).arg(&folder))
}
