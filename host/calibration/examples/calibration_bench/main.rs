//! `cargo xtask bench calibration`: random hinges on the simulated plant, calibrated and held against what they are.
//!
//! First sound hinges: how near the values come, and whether the intervals cover. Then the same hinges, each with a fault that
//! comes at some moment: how often a value is said with confidence that is wrong. With `--drift N` instead: hinges that are opened N times
//! after their calibration, as they were and changed.
#![expect(clippy::print_stdout, reason = "a table for people")]

mod drifts;
mod drive;
mod faults;
mod hinges;
mod outcome;
mod table;

use hinges::{Spread, Subject};
use outcome::Outcome;
use std::error::Error;
use std::path::Path;
use std::thread;
use zygote_calibration::Bounds;

/// Runs `work` on every number, on all processors; results in the numbers' order.
fn each<T: Send>(count: u64, work: impl Fn(u64) -> T + Sync) -> Vec<T> {
    let workers = thread::available_parallelism().map_or(1, |n| n.get() as u64);
    let work = &work;
    let mut results: Vec<(u64, T)> = thread::scope(|scope| {
        let hands: Vec<_> = (0..workers)
            .map(|first| {
                let share = (first..count).step_by(usize::try_from(workers).unwrap_or(1));
                scope.spawn(move || share.map(|number| (number, work(number))).collect::<Vec<_>>())
            })
            .collect();
        hands.into_iter().flat_map(|hand| hand.join().unwrap_or_default()).collect()
    });
    results.sort_by_key(|(number, _)| *number);
    results.into_iter().map(|(_, result)| result).collect()
}

fn main() -> Result<(), Box<dyn Error>> {
    let (mut spread, mut broken) = (Spread::Plant, None);
    let mut arguments = std::env::args().skip(1);
    let (mut hinges, mut seed, mut picture, mut verbose) = (200, 1, None, false);
    let (mut opened, mut first) = (None, 0);
    while let Some(option) = arguments.next() {
        let mut value = || arguments.next().ok_or(format!("{option}: expected a value after it"));
        match option.as_str() {
            "--hinges" => hinges = value()?.parse()?,
            "--seed" => seed = value()?.parse()?,
            "--picture" => picture = Some(value()?),
            "--broken" => broken = Some(value()?.parse()?),
            "--drift" => opened = Some(value()?.parse()?),
            "--first" => first = value()?.parse()?,
            "--wide" => spread = Spread::Wide,
            "--verbose" => verbose = true,
            _ => {
                return Err(format!(
                    "unknown option `{option}`, expected --hinges N, --first N, --broken N, --drift N, --seed S, --wide, --picture FILE or --verbose"
                )
                .into());
            }
        }
    }
    let bounds = Bounds::default();
    // Far apart, so that one seed's hinges are not another's.
    let subject = |number: u64| Subject::new(seed * 1_000_003 + first + number, spread);
    if let Some(runs) = opened {
        let all: Result<Vec<_>, String> = each(hinges, |number| {
            table::seen(&subject(number), &bounds, runs, seed + first + number, verbose)
        })
        .into_iter()
        .collect();
        table::drifts(&all?);
        return Ok(());
    }
    let sound: Result<Vec<Outcome>, String> =
        each(hinges, |number| outcome::sound(&subject(number), &bounds).map_err(|error| error.to_string()))
            .into_iter()
            .collect();
    let sound = sound?;
    if verbose {
        for (number, outcome) in sound.iter().enumerate() {
            println!("{number}: {outcome}");
        }
    }
    table::sound(&sound);
    if let Some(path) = picture {
        outcome::picture(&subject(0), &bounds, Path::new(&path))?;
    }
    let lengths: Vec<f64> = sound.iter().map(|outcome| outcome.length_s).collect();
    let broken: Result<Vec<Vec<faults::Verdict>>, String> = each(broken.unwrap_or(hinges), |number| {
        let length_s = lengths.get(usize::try_from(number).unwrap_or(0)).copied().unwrap_or(100.0);
        faults::all(&subject(number), &bounds, length_s, seed + first + number)
            .map_err(|error| error.to_string())
    })
    .into_iter()
    .collect();
    let broken = broken?;
    if verbose {
        for (number, verdicts) in broken.iter().enumerate() {
            for verdict in verdicts.iter().filter(|verdict| verdict.is_wrong()) {
                println!("{number}: {verdict}");
            }
        }
    }
    table::broken(&broken);
    Ok(())
}
