//! `cargo xtask flash [BOARD]` and `cargo xtask log [BOARD]`: a board's firmware onto the chip, and what it says.

use crate::{
    firmware,
    tools::{self, cargo},
};
use anyhow::{Context, Result, bail, ensure};
use std::{path::PathBuf, process::Command};

/// The board where none is named.
const USUAL: &str = "nucleo-f446re";

/// Builds every board, then flashes one; `zygote flash` looks at the file and finds the probe.
pub(crate) fn flash(options: &[String]) -> Result<()> {
    let (elf, more) = elf(options)?;
    firmware::run()?;
    tools::run(cargo().args(["run", "--quiet", "--package", "zygote-cli", "--", "flash"]).arg(elf).args(more))
}

/// Attaches to the running chip and prints its log, decoded with the file that was flashed.
pub(crate) fn log(options: &[String]) -> Result<()> {
    let (elf, more) = elf(options)?;
    ensure!(elf.is_file(), "no firmware at {}: run `cargo xtask flash` first", elf.display());
    let chip = firmware::chip_of(&elf)?;
    let tool = Command::new("probe-rs").arg("--version").output();
    tool.context("probe-rs is missing: install it (https://probe.rs)")?;
    tools::run(tools::command("probe-rs").args(["attach", "--chip", &chip]).args(more).arg(elf))
}

/// The file of the board that the first option names, and the other options.
fn elf(options: &[String]) -> Result<(PathBuf, &[String])> {
    let (name, more) = match options {
        [name, more @ ..] if !name.starts_with('-') => (name.as_str(), more),
        more => (USUAL, more),
    };
    let boards = firmware::boards()?;
    let names: Vec<_> = boards.iter().filter_map(|board| board.file_name()?.to_str()).collect();
    if !names.contains(&name) {
        bail!("no board `{name}`, there are {}", names.join(", "));
    }
    Ok((firmware::elf_of(name), more))
}
