//! `cargo xtask hil`: the serial suite under `hil-tests`, against the simulated MCU of the `zygote` binary.

use crate::{
    python,
    tools::{self, cargo},
};
use anyhow::{Result, ensure};
use std::env;

/// Builds `zygote`, sets up a Python environment under `target/venv`, and runs pytest in it.
pub(crate) fn run() -> Result<()> {
    let suite = tools::root().join("hil-tests");
    let requirements = suite.join("requirements.txt");
    ensure!(requirements.is_file(), "{} is missing", requirements.display());

    let target = tools::root().join("target");
    tools::run(cargo().args(["build", "--package", "zygote-cli", "--target-dir"]).arg(&target))?;
    let python = python::with_requirements(&target.join("venv"), &requirements)?;
    let zygote = target.join("debug/zygote").with_extension(env::consts::EXE_EXTENSION);
    tools::run(tools::command(&python).args(["-m", "pytest"]).arg(&suite).env("ZYGOTE", zygote))
}
