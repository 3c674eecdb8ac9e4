//! `cargo xtask emulator`: the tests that run the board's own program on the emulated chip. They need the program, which
//! `cargo xtask firmware` builds, so that all other test runs leave them out.

use crate::{firmware, tools};
use anyhow::{Result, ensure};

const BOARD: &str = "nucleo-f446re";

/// Runs them on the program that is there.
pub(crate) fn run() -> Result<()> {
    let program = firmware::elf_of(BOARD);
    ensure!(program.is_file(), "{} is missing: cargo xtask firmware", program.display());
    let nextest = tools::from_crates_io("cargo-nextest", "^0.9", &[])?;
    let mut command = tools::command(nextest);
    command.args(["nextest", "run", "--no-fail-fast", "--run-ignored", "only"]);
    // All packages, though two have such tests: with fewer, cargo would choose other features, and build everything again.
    command.arg("--workspace");
    tools::run(command.args(["--test", "emulated"]).env("ZYGOTE_BOARD_ELF", &program))
}
