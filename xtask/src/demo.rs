//! `cargo xtask demo`: the main job, from a shape to a deployed fish, on the simulated MCU over the real protocol.

use crate::tools::{self, cargo};
use anyhow::{Context, Result};
use std::{env, fs};

const MODEL: &str = "models/fish92.txt";
const RIG: &str = "models/rigs/sma-160.toml";

/// Plans, schedules and deploys a fish, and leaves plan, report, event log, recording and pictures in `target/demo/`, which is emptied
/// before: a recording is never overwritten.
pub(crate) fn run() -> Result<()> {
    let demo = tools::root().join("target/demo");
    if demo.exists() {
        fs::remove_dir_all(&demo).with_context(|| format!("{} cannot be emptied", demo.display()))?;
    }
    fs::create_dir_all(&demo).with_context(|| format!("{} cannot be made", demo.display()))?;
    println!("Building zygote; the first time this takes a few minutes.");
    tools::run(cargo().args(["build", "--package", "zygote-cli"]).current_dir(tools::root()))?;
    let place = |name: &str| demo.join(name).display().to_string();
    let plan = place("fish.fold");
    zygote(&["plan", MODEL, "--piles", "4", "--free", "ideal", "--output", &plan])?;
    zygote(&["schedule", &plan, "--rig", RIG])?;
    zygote(&["check", &plan, "--motion"])?;
    zygote(&["deploy", &plan, "--rig", RIG, "--sim"])?;
    zygote(&["report", &place("fish.1.mcap"), "--output", &place("run.html")])?;
    for (view, name) in [("both", "fish.svg"), ("film", "film.svg"), ("animation", "unfold.svg")] {
        zygote(&["picture", &plan, "--view", view, "--output", &place(name)])?;
    }
    println!("\nThe fish is out. To see it unfold, open in a browser: {}", place("unfold.svg"));
    println!("How the run went: {}", place("run.html"));
    Ok(())
}

fn zygote(arguments: &[&str]) -> Result<()> {
    println!();
    let program = tools::root().join("target/debug/zygote").with_extension(env::consts::EXE_EXTENSION);
    tools::run(tools::command(program).args(arguments))
}
