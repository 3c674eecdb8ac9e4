//! What the firmware core takes at most of a Cortex-M4F: `zygote-figures ELF CORPUS [SEQUENCES [SEED]]`, run by `cargo xtask figures`.
//! Every call is made on the emulated processor and on this machine, which must agree.
#![expect(clippy::print_stdout, clippy::print_stderr, reason = "a command speaks to its terminal")]

#[path = "../../../../../firmware/core-figures/src/call.rs"]
mod call;
#[path = "../../../../../firmware/core-figures/src/config.rs"]
mod config;
mod host;
mod pair;
mod search;
mod table;
mod target;
mod worst;

use host::Host;
use pair::Pair;
use std::error::Error;
use std::path::Path;
use std::process::ExitCode;
use std::time::Instant;
use zygote_emulator::count::Linked;

/// Random sequences, unless asked for more.
const SEQUENCES: usize = 10;
const SEED: u64 = 1;
/// Runs that come to their end in the sequences that are no chance.
const RUNS: u64 = 2;

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let parsed = |at: usize| arguments.get(at).map(|text| text.parse::<u64>()).transpose();
    let (Some(elf), Some(corpus), Ok(sequences), Ok(seed)) =
        (arguments.first(), arguments.get(1), parsed(2), parsed(3))
    else {
        eprintln!("usage: zygote-figures ELF CORPUS [SEQUENCES [SEED]]");
        return ExitCode::from(2);
    };
    let sequences = sequences.and_then(|number| usize::try_from(number).ok()).unwrap_or(SEQUENCES);
    match run(Path::new(elf), Path::new(corpus), sequences, seed.unwrap_or(SEED)) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{error}");
            ExitCode::FAILURE
        }
    }
}

fn run(elf: &Path, corpus: &Path, sequences: usize, seed: u64) -> Result<(), Box<dyn Error>> {
    let bytes = std::fs::read(elf).map_err(|error| format!("{}: {error}", elf.display()))?;
    let linked = Linked::from_elf(&bytes)?;
    let begun = Instant::now();
    let mut pair = Pair::new(linked.clone())?;
    for (name, events) in worst::sequences() {
        name.clone_into(&mut pair.sequence);
        Host::new(&mut pair)?.play(&events).map_err(|error| format!("{name}: {error}"))?;
    }
    let files =
        search::corpus(&mut pair, corpus).map_err(|error| format!("{}: {error}", corpus.display()))??;
    search::run(&mut pair, sequences, seed).map_err(|error| format!("{}: {error}", pair.sequence))?;

    let core = linked.static_named("FIGURES_CORE")?;
    println!("{}", table::times(&pair));
    println!("{}", table::stacks(&pair, &linked)?);
    println!("one core: {} bytes of RAM; flash: {} bytes", core.end - core.start, linked.flash_bytes());
    println!(
        "{} sequences, {files} files of the corpus, {sequences} random ones from seed {seed}: {} calls, {} million instructions in {:.1} s",
        worst::sequences().len(),
        pair.calls,
        pair.instructions / 1_000_000,
        begun.elapsed().as_secs_f64()
    );
    if pair.finished < RUNS {
        return Err(format!(
            "{} runs came to their end, expected {RUNS}: this isn't the worst",
            pair.finished
        )
        .into());
    }
    println!("{}", table::hold_times(&pair)?);
    table::hold_memory(&linked)
}
