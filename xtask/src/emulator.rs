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
    command.args(["nextest", "run", "--workspace", "--no-fail-fast", "--run-ignored", "only"]);
    tools::run(command.args(["-E", "binary(emulated)"]).env("ZYGOTE_BOARD_ELF", &program))
}
