//! `zygote flash`: programs a board with its firmware, through probe-rs.

use crate::failure::{Failure, OrFail};
use crate::firmware_file::{Card, card_of};
use crate::output::say;
use anyhow::{Context, Result, bail, ensure};
use clap::Args;
use std::ffi::OsStr;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Where `cargo xtask firmware` leaves the usual board's firmware, seen from the repository.
const USUAL: &str = "target/firmware/thumbv7em-none-eabihf/release/zygote-nucleo-f446re";

/// Arguments of `zygote flash`.
#[derive(Args)]
pub(crate) struct Arguments {
    /// The firmware, an ELF file
    #[arg(value_name = "ELF", default_value = USUAL)]
    elf: PathBuf,
    /// The debug probe, where there are several: VID:PID or VID:PID:SERIAL, as `probe-rs list` shows it
    #[arg(long, value_name = "PROBE")]
    probe: Option<String>,
    /// The probe-rs program
    #[arg(long, value_name = "PROGRAM", default_value = "probe-rs")]
    tool: PathBuf,
}

/// Checks the file, finds a probe, programs the chip, and starts it.
pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let card = card_of(&arguments.elf).or_bad_input()?;
    program(arguments, &card).or_failed()
}

fn program(arguments: &Arguments, card: &Card) -> Result<()> {
    let Arguments { elf, probe, tool } = arguments;
    find_probe(tool)?;
    say(format_args!("{} for {} ({})", elf.display(), card.board, card.chip));
    let chosen = probe.iter().flat_map(|probe| ["--probe", probe]);
    let common = ["--chip", &card.chip].into_iter().chain(chosen).map(OsStr::new);
    run_tool(tool, common.clone().chain([OsStr::new("--verify"), elf.as_os_str()]), "download")?;
    run_tool(tool, common, "reset")
}

/// A probe is there at all: probe-rs lists each on a line `[0]: ...`.
fn find_probe(tool: &Path) -> Result<()> {
    let listed = Command::new(tool).arg("list").output().with_context(|| {
        let tool = tool.display();
        format!("cannot start `{tool}`: install it (https://probe.rs) or name it with --tool")
    })?;
    let said = String::from_utf8_lossy(&listed.stdout);
    let complaint = String::from_utf8_lossy(&listed.stderr);
    ensure!(
        listed.status.success(),
        "`{} list` ended with {}: {}",
        tool.display(),
        listed.status,
        complaint.trim()
    );
    if !said.lines().any(|line| line.trim_start().starts_with('[')) {
        bail!(
            "no debug probe is attached: connect the board's ST-LINK by USB (on Linux its udev rules are needed too)"
        );
    }
    Ok(())
}

/// Runs a verb of probe-rs, which speaks to the terminal itself.
fn run_tool<'a>(tool: &Path, options: impl Iterator<Item = &'a OsStr>, verb: &str) -> Result<()> {
    let status = Command::new(tool).arg(verb).args(options).status();
    let status = status.with_context(|| format!("cannot start `{}`", tool.display()))?;
    ensure!(status.success(), "`{} {verb}` ended with {status}", tool.display());
    Ok(())
}
