//! The same graph given to others: TSP solvers for the strip, graph partitioners for the piles. `xtask/peers` holds the script.

use super::measure::Bench;
use crate::python;
use crate::tools;
use anyhow::Result;

/// Sets up a Python environment under `target` and runs the script in it.
pub(super) fn run(bench: &Bench) -> Result<()> {
    let scripts = tools::root().join("xtask/peers");
    let python = python::with_requirements(
        &tools::root().join("target/venv-peers"),
        &scripts.join("requirements.txt"),
    )?;
    tools::run(
        tools::command(python)
            .arg(scripts.join("peers.py"))
            .arg(&bench.program)
            .arg(tools::root().join("models/fish4000.txt"))
            .arg(&bench.place),
    )
}
