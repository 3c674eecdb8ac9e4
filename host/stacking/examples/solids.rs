//! The campaign: random solids of 20 to 400 voxels planned into 1, 2, 4 and 6 piles, as a Markdown table, and every refusal
//! with its reason. `cargo xtask bench stacking` runs it.
#![expect(clippy::print_stdout, reason = "its output is what it is for")]
#![expect(clippy::unwrap_used, reason = "a tool for developers, as tests are")]

#[path = "../tests/boundary/mod.rs"]
mod boundary;
#[path = "../tests/grown/mod.rs"]
mod grown;

use std::time::Instant;

/// Solids tried, unless the first argument says another number.
const SOLIDS: u64 = 500;
const PILES: [usize; 4] = [1, 2, 4, 6];

fn main() {
    let solids = std::env::args().nth(1).map_or(SOLIDS, |number| number.parse().unwrap());
    let models: Vec<_> = (0..solids).map(grown::solid).collect();
    println!(
        "| K | N divisible by K | planned | refused | all of them, s | slowest, s |\n|---|---|---|---|---|---|"
    );
    let mut reasons = Vec::new();
    for piles in PILES {
        let (mut asked, mut refused, mut total, mut slowest) = (0, 0, 0.0, 0.0_f64);
        for (number, (growth, voxels, model)) in models.iter().enumerate() {
            let panels = model.surface().len();
            if !panels.is_multiple_of(piles) {
                continue;
            }
            let begin = Instant::now();
            let outcome = grown::attempt(model, piles, 0);
            let seconds = begin.elapsed().as_secs_f64();
            asked += 1;
            total += seconds;
            slowest = slowest.max(seconds);
            if let Err(reason) = outcome {
                refused += 1;
                reasons.push(format!(
                    "- solid {number} ({growth:?}, {voxels} voxels, N = {panels}), K = {piles}: {reason}"
                ));
            }
        }
        println!("| {piles} | {asked} | {} | {refused} | {total:.1} | {slowest:.2} |", asked - refused);
    }
    println!("\n{}", reasons.join("\n"));
}
