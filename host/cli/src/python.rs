//! A Python with packages of its own, for verbs that are written in Python.

use anyhow::{Context, Result, anyhow, bail, ensure};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Its oldest version, 3.11.
const OLDEST: (u32, u32) = (3, 11);
/// What it may be called; the newest first after the usual name.
const NAMES: [&str; 5] = ["python3", "python3.14", "python3.13", "python3.12", "python3.11"];
/// What the packages of an environment were installed from, so that it is done once.
const STAMP: &str = "zygote-requirements.txt";

/// The Python that is named, else the first that is new enough.
///
/// # Errors
/// Tells which were found and how old they are.
pub(crate) fn find(named: Option<&Path>) -> Result<PathBuf> {
    let wanted = format!("Python {}.{} or later", OLDEST.0, OLDEST.1);
    if let Some(named) = named {
        let version = version(named)?;
        ensure!(
            version >= OLDEST,
            "{} is Python {}.{}, expected {wanted}",
            named.display(),
            version.0,
            version.1
        );
        return Ok(named.to_owned());
    }
    let mut found = Vec::new();
    for name in NAMES {
        match version(Path::new(name)) {
            Ok(version) if version >= OLDEST => return Ok(name.into()),
            Ok((major, minor)) => found.push(format!("{name} is {major}.{minor}")),
            Err(_) => {}
        }
    }
    let there = if found.is_empty() { "none was found".to_owned() } else { found.join(", ") };
    bail!("{wanted} is needed; {there}. Install it (https://www.python.org), or name it with --python")
}

fn version(python: &Path) -> Result<(u32, u32)> {
    let asked = Command::new(python).args(["-c", "import sys; print(*sys.version_info[:2])"]).output();
    let told = asked.with_context(|| format!("cannot start {}", python.display()))?;
    let text = String::from_utf8_lossy(&told.stdout);
    let mut numbers = text.split_whitespace().map(str::parse);
    match (numbers.next(), numbers.next()) {
        (Some(Ok(major)), Some(Ok(minor))) => Ok((major, minor)),
        _ => Err(anyhow!("{} doesn't tell its version: {:?}", python.display(), text.trim())),
    }
}

/// The Python of the environment in a folder, with what a requirements file names; made where it is missing.
///
/// # Errors
/// Says what to do where it can't be made.
pub(crate) fn with_requirements(python: &Path, folder: &Path, requirements: &Path) -> Result<PathBuf> {
    let wanted = fs::read_to_string(requirements)
        .with_context(|| format!("{}: cannot be read", requirements.display()))?;
    let own = folder.join("bin/python3");
    let has_pip = || run(Command::new(&own).args(["-m", "pip", "--version"])).is_ok();
    if !has_pip() {
        run(Command::new(python).args(["-m", "venv", "--clear"]).arg(folder))
            .context("no environment for Python's packages can be made; on Debian, install python3-venv")?;
        ensure!(
            has_pip(),
            "{}: the environment has no pip; on Debian, install python3-venv",
            folder.display()
        );
    }
    let stamp = folder.join(STAMP);
    if fs::read_to_string(&stamp).is_ok_and(|installed| installed == wanted) {
        return Ok(own);
    }
    let mut install = Command::new(&own);
    install.args(["-m", "pip", "install", "--quiet", "--disable-pip-version-check", "--requirement"]);
    run(install.arg(requirements)).with_context(|| {
        format!("the packages of {} can't be installed; is there a network?", requirements.display())
    })?;
    fs::write(&stamp, wanted).with_context(|| format!("{}: cannot be written", stamp.display()))?;
    Ok(own)
}

fn run(command: &mut Command) -> Result<()> {
    let program = command.get_program().to_string_lossy().into_owned();
    let done = command.output().with_context(|| format!("cannot start {program}"))?;
    let complaint = String::from_utf8_lossy(&done.stderr);
    ensure!(done.status.success(), "{program} ended with {}: {}", done.status, complaint.trim());
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_program_that_is_no_python_is_refused_by_its_name() {
        let refused = find(Some(Path::new("true"))).map_err(|error| error.to_string());
        assert_eq!(refused, Err("true doesn't tell its version: \"\"".to_owned()));
    }
}
