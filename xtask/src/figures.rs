//! `cargo xtask figures [SEQUENCES [SEED]]`: what the core takes at most, counted on the emulated processor and held to its budgets.

use crate::{
    firmware,
    tools::{self, cargo},
};
use anyhow::Result;

/// Builds the core for the board's processor, and calls it there.
pub(crate) fn run(options: &[String]) -> Result<()> {
    let elf = firmware::core_figures()?;
    let mut figures = cargo();
    figures.args(["run", "--quiet", "--package", "zygote-emulator", "--bin", "zygote-figures", "--"]);
    figures.arg(elf).arg(tools::root().join("fuzz/corpus/core")).args(options).current_dir(tools::root());
    tools::run(&mut figures)
}
