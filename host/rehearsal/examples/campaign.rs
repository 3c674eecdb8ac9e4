//! `campaign --runs N --seed S [--threads T] [--calibrate]`: random trials, judged; with `--calibrate` of calibrations. `campaign --replay SEED:NUMBER`: one of them again,
//! with a log of what happened.
#![expect(clippy::print_stdout, clippy::print_stderr, reason = "a command speaks to its terminal")]

use std::process::ExitCode;
use std::thread::available_parallelism;
use std::time::Instant;
use zygote_rehearsal::campaign::{self, Work};

const USAGE: &str = "usage: campaign [--calibrate] [--runs N] [--seed S] [--threads T], or campaign [--calibrate] --replay SEED:NUMBER";
/// Failures that are told in full.
const SHOWN: usize = 20;

fn main() -> ExitCode {
    let (calibrate, arguments): (Vec<String>, Vec<String>) =
        std::env::args().skip(1).partition(|argument| argument == "--calibrate");
    let work = if calibrate.is_empty() { Work::Deploy } else { Work::Calibrate };
    let done = match arguments.as_slice() {
        [option, trial] if option == "--replay" => replay(work, trial),
        options => run(work, options),
    };
    match done {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::FAILURE,
        Err(error) => {
            eprintln!("{error}");
            ExitCode::from(2)
        }
    }
}

fn run(work: Work, options: &[String]) -> Result<bool, Box<dyn std::error::Error>> {
    let threads = available_parallelism().map_or(1, usize::from);
    let (mut runs, mut seed, mut threads) = (10_000, 1, threads);
    for pair in options.chunks(2) {
        match pair {
            [name, value] if name == "--runs" => runs = value.parse()?,
            [name, value] if name == "--seed" => seed = value.parse()?,
            [name, value] if name == "--threads" => threads = value.parse()?,
            _ => return Err(USAGE.into()),
        }
    }
    let start = Instant::now();
    let summary = campaign::run(work, seed, runs, threads)?;
    println!("seed {seed}: {summary}");
    println!("{:.1} s on {threads} threads", start.elapsed().as_secs_f64());
    for failure in summary.failures.iter().take(SHOWN) {
        println!("\n--replay {seed}:{} (fingerprint {:016x})", failure.number, failure.fingerprint);
        for breach in &failure.breaches {
            println!("  {breach}");
        }
    }
    Ok(summary.failures.is_empty())
}

fn replay(work: Work, trial: &str) -> Result<bool, Box<dyn std::error::Error>> {
    let (seed, number) = trial.split_once(':').ok_or(USAGE)?;
    let (trial, rehearsed, breaches) = campaign::replay(work, seed.parse()?, number.parse()?, true)?;
    println!("{:#?}", trial.schedule.steps);
    println!("{:#?}\n{:#?}\n{:#?}", trial.plant, trial.causes, trial.line);
    for line in rehearsed.witness.log() {
        println!("{line}");
    }
    println!("{:#?}", rehearsed.ending);
    println!("fingerprint {:016x}", campaign::fingerprint(&rehearsed));
    for breach in &breaches {
        println!("broken: {breach}");
    }
    Ok(breaches.is_empty())
}
