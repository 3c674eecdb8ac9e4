//! The `zygote` command: one file per verb, each with its arguments and its `run`.

mod alternatives;
mod assembly;
mod board_calibrations;
mod calibrate;
mod calibrate_servo;
mod calibration_files;
mod calibration_json;
mod calibration_progress;
mod calibration_report;
mod calibration_table;
mod check;
mod checked_order;
mod completions;
mod deploy;
mod doctor;
mod drift;
mod explain;
mod export;
mod failure;
mod firmware_file;
mod flash;
mod fold_back;
mod hil;
mod hil_summary;
mod identity;
mod input;
mod interrupt;
#[cfg(test)]
mod line_tests;
mod link;
mod live;
mod man;
mod net;
mod noisy_line;
mod output;
mod paced_line;
mod picture;
mod plan;
mod plan_choice;
mod python;
mod reconfigure;
mod recording_file;
mod rehearse;
mod replay;
mod report;
mod schedule;
mod sequence;
mod serve;
mod servo_protractor;
mod servo_report;
mod settings;
mod sim;
mod table;
mod tolerance;
mod torque;
mod verb;
mod view;
mod weighing;

use clap::Parser;
use std::process::ExitCode;

/// Shapes into stacks of panels, and stacks into shapes.
#[derive(Parser)]
#[command(
    name = "zygote",
    version,
    about = "Shapes into stacks of panels, and stacks into shapes",
    after_help = "Exit codes: 0 it worked, 1 it didn't, 2 the input can't be used.",
    propagate_version = true,
    arg_required_else_help = true
)]
struct Cli {
    #[command(subcommand)]
    verb: verb::Verb,
}

fn main() -> ExitCode {
    match Cli::parse().verb.run() {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => failure.report(),
    }
}
