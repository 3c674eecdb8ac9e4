//! `zygote sim`: a simulated board on a pseudo-terminal, in real time, for any program that opens a serial port.

use crate::failure::{Failure, OrFail};
use crate::output::say;
use crate::{identity, input, interrupt, sim_rig};
use clap::Args;
use std::io::{self, Write};
use std::path::PathBuf;
use zygote_sim::Pty;

/// Arguments of `zygote sim`.
#[derive(Args)]
pub(crate) struct Arguments {
    /// The rig to simulate
    #[arg(long, value_name = "RIG.toml")]
    rig: PathBuf,
    /// The plan whose hinges are on the rig; without it, every channel has a hinge that opens to 180 degrees
    #[arg(long, value_name = "PLAN.fold")]
    plan: Option<PathBuf>,
    /// The schedule, where it doesn't stand in the plan
    #[arg(long, value_name = "FILE", requires = "plan")]
    schedule: Option<PathBuf>,
}

/// Prints the device on a line of its own, then serves until Ctrl-C.
pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let rig = input::rig(&arguments.rig)?;
    let schedule = match &arguments.plan {
        Some(path) => Some(input::schedule(path, &input::plan(path)?, &rig, arguments.schedule.as_deref())?),
        None => None,
    };
    let mut board = sim_rig::board(&rig, schedule.as_ref(), identity::fresh())?;
    let stop = interrupt::flag()?;
    let pty = Pty::open().or_failed()?;
    say(pty.path().display());
    // Whoever started this program waits for that line.
    io::stdout().flush().or_failed()?;
    pty.serve(&mut board, &stop).or_failed()
}
