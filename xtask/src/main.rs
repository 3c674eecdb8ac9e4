//! What CI runs and a developer runs: `cargo xtask VERB`. One file a verb; `test` (or `ci`) is all of them.
#![expect(clippy::print_stdout, clippy::print_stderr, reason = "a command speaks to its terminal")]

mod arrows;
mod bench;
mod campaign;
mod demo;
mod docs;
mod emulator;
mod figures;
mod firmware;
mod fuzz;
mod hil;
mod lint;
mod mutants;
mod parts;
mod probe;
mod python;
mod sections;
mod stack;
mod tests;
mod tools;
mod tutorial;
mod viewer;

use parts::Part;
use std::process::ExitCode;

/// The parts of `cargo xtask test`, cheapest first; each is a verb of its own.
const PARTS: &[Part] = &[
    // First, so that what is built after it embeds it.
    Part { verb: "page", about: "the viewer's page, built (npm)", run: viewer::page },
    Part { verb: "lint", about: "formatting and clippy", run: lint::run },
    Part { verb: "arrows", about: "which crate may use which", run: arrows::run },
    Part { verb: "unit", about: "unit and integration tests (nextest)", run: tests::unit },
    Part { verb: "doctest", about: "examples in the documentation", run: tests::doc },
    Part { verb: "docs", about: "the book (mdBook)", run: docs::run },
    Part { verb: "tutorial", about: "every command of the book's tutorial", run: tutorial::run },
    Part { verb: "hil", about: "the serial suite on the simulated MCU (pytest)", run: || hil::run(&[]) },
    Part { verb: "browser", about: "the viewer's page, in a real browser", run: viewer::test },
    Part { verb: "firmware", about: "every board, linked and within its memory", run: firmware::run },
    Part {
        verb: "figures",
        about: "what the core takes at most, counted on the emulated processor",
        run: || figures::run(&[]),
    },
    Part {
        verb: "emulator",
        about: "the board's program, as just built, on an emulated chip",
        run: emulator::run,
    },
    Part { verb: "hil-brief", about: "a minute of the serial suite on the emulated board", run: hil::brief },
];

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    if let [verb, options @ ..] = arguments.as_slice() {
        match verb.as_str() {
            "fuzz" => return told(fuzz::run(options)),
            "campaign" => return told(campaign::run(options)),
            "flash" => return told(probe::flash(options)),
            "log" => return told(probe::log(options)),
            "mutants" => return told(mutants::run(options)),
            "figures" => return told(figures::run(options)),
            "viewer" => return told(viewer::run(options)),
            "hil" => return told(hil::run(options)),
            _ => {}
        }
    }
    if let [verb, name, options @ ..] = arguments.as_slice() {
        match (verb.as_str(), name.as_str()) {
            ("bench", "stacking") => return told(bench::stacking::run(options)),
            ("bench", "deployment") => return told(bench::deployment::run(options)),
            ("bench", "calibration") => return told(bench::calibration::run(options)),
            ("bench", "motion") => return told(bench::motion::run(options)),
            _ => {}
        }
    }
    let [verb] = arguments.as_slice() else {
        eprintln!("expected one verb, got {}\n{}", arguments.len(), usage());
        return ExitCode::from(2);
    };
    let result = match (verb.as_str(), PARTS.iter().find(|part| part.verb == verb)) {
        ("test" | "ci", _) => parts::run_all(PARTS),
        ("demo", _) => demo::run(),
        (_, Some(part)) => (part.run)(),
        (_, None) => {
            eprintln!("unknown verb `{verb}`\n{}", usage());
            return ExitCode::from(2);
        }
    };
    told(result)
}

fn told(result: anyhow::Result<()>) -> ExitCode {
    match result {
        Ok(()) => ExitCode::SUCCESS,
        // Without the backtrace that `Debug` may add.
        Err(error) => {
            eprintln!("{error:#}");
            ExitCode::FAILURE
        }
    }
}

fn usage() -> String {
    let parts: Vec<String> = PARTS.iter().map(|part| format!("  {:<9} {}", part.verb, part.about)).collect();
    format!(
        "usage: cargo xtask VERB\n  demo      a fish, from voxels to deployed on the simulated MCU\n  bench stacking [--large] [--peers]\n            how long planning takes, measured\n  bench deployment [--peers]\n            how short schedules are, measured\n  bench calibration [--hinges N] [--broken N] [--seed S] [--wide] [--verbose]\n            how true calibrations are, of sound hinges and broken ones\n  campaign [--runs N] [--seed S] | --replay SEED:NUMBER\n            random deployments with random faults on the simulated MCU, judged by the physics\n  bench motion [--large] [--peers] [--solids N]\n            motions without collisions, found, seen and measured\n  fuzz [--seconds N] [TARGET ..]\n            every fuzz target, a minute each\n  flash [BOARD]\n            build the firmware, program a board through probe-rs\n  log [BOARD]\n            print the log of the running board\n  hil [OPTION ..]\n            the serial suite; OPTIONs go to pytest: --target emulator, --level smoke\n  mutants [--package core|protocol] [OPTION ..]\n            which breaks of the code no test sees; OPTIONs go to cargo-mutants\n  viewer [--test]\n            the page of `zygote view`, which the next build of zygote embeds; its tests\n  test, ci  everything below\n{}",
        parts.join("\n")
    )
}
