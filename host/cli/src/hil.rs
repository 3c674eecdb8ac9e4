//! `zygote hil`: the serial suite (`hil-tests`, in Python) on the simulator, on the emulated board or on a bench of one's own, for
//! people who don't know pytest: finds Python, sets up its packages, runs the tests, and sums them up.

use crate::failure::{Failure, OrFail};
use crate::hil_summary::Summary;
use crate::output::say;
use crate::{interrupt, python};
use anyhow::{Context, Result, anyhow, bail, ensure};
use clap::{Args, ValueEnum};
use std::env;
use std::path::{Path, PathBuf};
use std::process::Command;

/// The suite's folder in a checkout of the repository.
const SUITE: &str = "hil-tests";

/// What the tests talk to.
#[derive(Clone, Copy, ValueEnum)]
enum Target {
    /// The simulated board
    Sim,
    /// The board's own program on an emulated chip
    Emulator,
    /// A board at a serial port
    Port,
}

/// How much the tests move.
#[derive(Clone, Copy, ValueEnum)]
enum Level {
    /// No actuator moves
    Smoke,
    /// One actuator at a time, at low power
    Actuators,
    /// A run is begun and something goes wrong
    Faults,
    /// The whole shape opens
    Deployment,
    /// Many deployments
    Soak,
}

/// Arguments of `zygote hil`.
#[derive(Args)]
pub(crate) struct Arguments {
    /// What to test [default: sim, or that of the bench file]
    #[arg(long)]
    target: Option<Target>,
    /// What stands on the bench and what may be done with it; without it, that of the target
    #[arg(long, value_name = "FILE")]
    bench: Option<PathBuf>,
    /// How much may move; may be repeated [default: all that the bench allows but soak]
    #[arg(long)]
    level: Vec<Level>,
    /// The board's serial port, instead of the bench file's
    #[arg(long, value_name = "DEV")]
    port: Option<PathBuf>,
    /// The rig file, instead of the bench file's
    #[arg(long, value_name = "RIG.toml")]
    rig: Option<PathBuf>,
    /// The program for the emulated chip, instead of the bench file's
    #[arg(long, value_name = "ELF")]
    elf: Option<PathBuf>,
    /// The seed of the random tests, as an earlier run told it
    #[arg(long)]
    seed: Option<u32>,
    /// Where records go: junit.xml, record.json, and what failed tests saw
    #[arg(long, value_name = "DIR", default_value = "hil-records")]
    out: PathBuf,
    /// The suite's folder, `hil-tests` of the repository; without it, looked for from here upwards
    #[arg(long, value_name = "DIR")]
    suite: Option<PathBuf>,
    /// The Python to use, 3.11 or later
    #[arg(long, value_name = "PROGRAM")]
    python: Option<PathBuf>,
}

/// Runs the suite and prints a table.
pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let suite = find_suite(arguments.suite.as_deref()).or_bad_input()?;
    let python = environment(arguments, &suite).or_bad_input()?;
    let record = arguments.out.join("record.json");
    // Of an earlier run.
    std::fs::remove_file(&record).ok();
    // Ctrl-C is for the tests, which turn everything off and still write their record.
    interrupt::flag()?;
    let status = pytest(arguments, &suite, &python).status();
    let status = status.with_context(|| format!("cannot start {}", python.display())).or_failed()?;
    let tested = match status.code() {
        Some(0 | 1) => true,
        // Wrong options and files, of which pytest has told, or nothing to do.
        Some(4) => return Err(anyhow!("the suite can't be run like this")).or_bad_input(),
        Some(5) => return Err(anyhow!("no test is of this level and target")).or_bad_input(),
        _ => false,
    };
    let summary = Summary::read(&record).or_failed()?;
    say(summary.table());
    say(format_args!("records: {}", arguments.out.display()));
    if !tested {
        return Err(anyhow!("the tests were broken off ({status})")).or_failed();
    }
    let failed = summary.failed();
    if failed > 0 { Err(anyhow!("{failed} of {} tests failed", summary.total())).or_failed() } else { Ok(()) }
}

fn pytest(arguments: &Arguments, suite: &Path, python: &Path) -> Command {
    let mut pytest = Command::new(python);
    // Where it is run from may not be written to.
    pytest.args(["-m", "pytest", "-q", "--no-summary", "-p", "no:cacheprovider"]).arg(suite);
    pytest.arg("--out").arg(&arguments.out);
    if let Ok(zygote) = env::current_exe() {
        pytest.env("ZYGOTE", zygote);
    }
    if let Some(target) = arguments.target {
        pytest.arg("--target").arg(word(target));
    }
    for level in &arguments.level {
        pytest.arg("--level").arg(word(*level));
    }
    let paths = [
        ("--bench", &arguments.bench),
        ("--port", &arguments.port),
        ("--rig", &arguments.rig),
        ("--elf", &arguments.elf),
    ];
    for (option, path) in paths {
        if let Some(path) = path {
            pytest.arg(option).arg(path);
        }
    }
    if let Some(seed) = arguments.seed {
        pytest.args(["--seed", &seed.to_string()]);
    }
    pytest
}

fn word<T: ValueEnum>(value: T) -> String {
    value.to_possible_value().map(|value| value.get_name().to_owned()).unwrap_or_default()
}

/// The folder of the suite.
fn find_suite(named: Option<&Path>) -> Result<PathBuf> {
    let is_suite = |folder: &Path| folder.join("conftest.py").is_file();
    if let Some(named) = named {
        ensure!(is_suite(named), "{}: no serial suite, which has a conftest.py", named.display());
        return Ok(named.to_owned());
    }
    let here = env::current_dir().context("the current folder is gone")?;
    let found = here.ancestors().map(|folder| folder.join(SUITE)).find(|suite| is_suite(suite));
    found.with_context(|| {
        format!(
            "no serial suite in {} or above it: run this in a checkout of zygote's repository, or name its folder \
             {SUITE} with --suite",
            here.display()
        )
    })
}

/// A Python that has what the suite needs.
fn environment(arguments: &Arguments, suite: &Path) -> Result<PathBuf> {
    let python = python::find(arguments.python.as_deref())?;
    let requirements = suite.join("requirements.txt");
    let Some(repository) = suite.parent() else { bail!("{}: has no parent folder", suite.display()) };
    python::with_requirements(&python, &repository.join("target/venv"), &requirements)
}
