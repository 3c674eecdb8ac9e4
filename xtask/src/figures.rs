//! `cargo xtask figures [SEQUENCES [SEED]]`: what the core takes at most, counted on the emulated processor and held to its budgets.

use crate::{firmware, tools};
use anyhow::Result;

/// Builds the core for the board's processor, and calls it there.
pub(crate) fn run(options: &[String]) -> Result<()> {
    let elf = firmware::core_figures()?;
    let mut figures = tools::command(tools::built("zygote-figures")?);
    tools::run(figures.arg(elf).arg(tools::root().join("fuzz/corpus/core")).args(options))
}
