//! Python environments under `target/`.

use crate::tools;
use anyhow::{Result, ensure};
use std::path::{Path, PathBuf};

/// The Python of the environment in `folder`, with what a requirements file names.
///
/// # Errors
/// No Python, or packages that can't be had.
pub(crate) fn with_requirements(folder: &Path, requirements: &Path) -> Result<PathBuf> {
    let python = environment(folder)?;
    tools::run(
        tools::command(&python)
            .args(["-m", "pip", "install", "--quiet", "--disable-pip-version-check", "--requirement"])
            .arg(requirements),
    )?;
    Ok(python)
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
