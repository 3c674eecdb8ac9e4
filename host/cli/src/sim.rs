//! `zygote sim`: a simulated board on a pseudo-terminal, in real time, for any program that opens a serial port; or the
//! real board's program on an emulated chip.

use crate::failure::{Failure, OrFail};
use crate::output::say;
use crate::{identity, input, interrupt};
use anyhow::Context;
use clap::Args;
use std::io::{self, Write};
use std::path::PathBuf;
use zygote_emulator::{EmulatedBoard, Image};
use zygote_rehearsal::Scenario;
use zygote_sim::{Device, Pty};

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
    /// What goes wrong, and when
    #[arg(long, value_name = "FILE", requires = "plan")]
    scenario: Option<PathBuf>,
    /// Run this program, as built for the NUCLEO-F446RE, on an emulated chip instead of the simulated board
    #[arg(long, value_name = "ELF")]
    emulate: Option<PathBuf>,
}

/// Prints the device on a line of its own, then serves until Ctrl-C.
pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let rig = input::rig(&arguments.rig)?;
    let schedule = match &arguments.plan {
        Some(path) => Some(input::schedule(path, &input::plan(path)?, &rig, arguments.schedule.as_deref())?),
        None => None,
    };
    let image = match &arguments.emulate {
        Some(path) => Some(Image::open(path).with_context(|| path.display().to_string()).or_bad_input()?),
        None => None,
    };
    match (&arguments.scenario, schedule) {
        (Some(path), Some(schedule)) => {
            let trial = Scenario::open(path).or_bad_input()?.trial_of(rig, schedule).or_bad_input()?;
            match image {
                Some(image) => {
                    let board = EmulatedBoard::new(&image, &trial.plant, identity::fresh().into());
                    serve(&mut trial.open_on(board.or_bad_input()?))
                }
                None => serve(&mut trial.open().or_bad_input()?),
            }
        }
        (_, schedule) => {
            if let Some(image) = image {
                let board =
                    zygote_rehearsal::emulated(&image, &rig, schedule.as_ref(), identity::fresh().into());
                serve(&mut board.or_bad_input()?)
            } else {
                let board = zygote_rehearsal::board(&rig, schedule.as_ref(), identity::fresh());
                serve(&mut board.or_bad_input()?)
            }
        }
    }
}

fn serve<D: Device>(board: &mut D) -> Result<(), Failure> {
    let stop = interrupt::flag()?;
    let pty = Pty::open().or_failed()?;
    say(pty.path().display());
    // Whoever started this program waits for that line.
    io::stdout().flush().or_failed()?;
    pty.serve(board, &stop).or_failed()
}
