//! `cargo xtask hil`: the serial suite under `hil-tests`, against the simulated MCU of the `zygote` binary.

use crate::{python, tools};
use anyhow::{Result, ensure};

/// Builds `zygote`, sets up a Python environment under `target/venv`, and runs pytest in it.
pub(crate) fn run() -> Result<()> {
    let suite = tools::root().join("hil-tests");
    let requirements = suite.join("requirements.txt");
    ensure!(requirements.is_file(), "{} is missing", requirements.display());

    let zygote = tools::built("zygote")?;
    let python = python::with_requirements(&tools::root().join("target/venv"), &requirements)?;
    tools::run(tools::command(&python).args(["-m", "pytest"]).arg(&suite).env("ZYGOTE", zygote))
}
