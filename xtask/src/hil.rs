//! `cargo xtask hil [OPTION ..]`: the serial suite under `hil-tests`, against the simulated MCU of the `zygote` binary unless the
//! options, which go to pytest, say otherwise. `cargo xtask hil-brief`: a minute of it on the emulated board.

use crate::{firmware, python, tools};
use anyhow::{Result, ensure};

/// The board whose program the emulator runs.
const BOARD: &str = "nucleo-f446re";

/// Builds `zygote`, sets up a Python environment under `target/venv`, and runs pytest in it.
pub(crate) fn run(options: &[String]) -> Result<()> {
    let suite = tools::root().join("hil-tests");
    let requirements = suite.join("requirements.txt");
    ensure!(requirements.is_file(), "{} is missing", requirements.display());

    let zygote = tools::built("zygote")?;
    let python = python::with_requirements(&tools::root().join("target/venv"), &requirements)?;
    let mut pytest = tools::command(&python);
    tools::run(pytest.args(["-m", "pytest"]).arg(&suite).args(options).env("ZYGOTE", zygote))
}

/// The tests that show in a minute whether a board works, on the program that is there.
pub(crate) fn brief() -> Result<()> {
    let program = firmware::elf_of(BOARD);
    ensure!(program.is_file(), "{} is missing: cargo xtask firmware", program.display());
    run(&["--target", "emulator", "-m", "brief"].map(String::from))
}
