//! `cargo xtask hil`: the serial suite under `hil-tests`, against the simulated MCU of the `zygote` binary.

use crate::tools::{self, cargo};
use anyhow::{Result, ensure};
use std::{
    env,
    path::{Path, PathBuf},
};

/// Builds `zygote`, sets up a Python environment under `target/venv`, and runs pytest in it.
pub(crate) fn run() -> Result<()> {
    let suite = tools::root().join("hil-tests");
    let requirements = suite.join("requirements.txt");
    ensure!(requirements.is_file(), "{} is missing", requirements.display());

    let target = tools::root().join("target");
    tools::run(cargo().args(["build", "--package", "zygote-cli", "--target-dir"]).arg(&target))?;
    let python = environment(&target.join("venv"))?;
    tools::run(
        tools::command(&python)
            .args(["-m", "pip", "install", "--quiet", "--disable-pip-version-check", "--requirement"])
            .arg(&requirements),
    )?;
    let zygote = target.join("debug/zygote").with_extension(env::consts::EXE_EXTENSION);
    tools::run(tools::command(&python).args(["-m", "pytest"]).arg(&suite).env("ZYGOTE", zygote))
}

/// The Python of the environment in `folder`, which is made where it is missing or broken.
fn environment(folder: &Path) -> Result<PathBuf> {
    let python = folder.join("bin/python3");
    let works = || tools::output_of(tools::command(&python).args(["-m", "pip", "--version"])).is_ok();
    if works() {
        return Ok(python);
    }
    let make =
        |interpreter| tools::run(tools::command(interpreter).args(["-m", "venv", "--clear"]).arg(folder));
    if let Err(error) = make("python3") {
        // Debian leaves the module out of its Python.
        println!("{error:#}");
        tools::apt_install(&["python3", "python3-venv"])?;
        make("/usr/bin/python3")?;
    }
    ensure!(works(), "no pip in {}", folder.display());
    Ok(python)
}
