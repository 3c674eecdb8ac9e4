//! Orders found, as a Markdown table. Arguments: `ideal` or the plates' thickness, bridges (`least`, `most`, `base`), piles
//! (as in 1,2,4), number of seeds, then names of models.
#![expect(clippy::print_stdout, reason = "its output is what it is for")]
#![expect(clippy::unwrap_used, reason = "a tool for developers, as tests are")]

use std::path::Path;
use std::time::Instant;
use zygote_deployment::motion::{Effort, Options, Thickness, check, search};
use zygote_stacking::{Bridges, Model, Plan, Request, plan};

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let bridges = match arguments[1].as_str() {
        "least" => Bridges::Least,
        "most" => Bridges::Most,
        _ => Bridges::Base,
    };
    let piles: Vec<usize> = arguments[2].split(',').map(|k| k.parse().unwrap()).collect();
    for name in &arguments[4..] {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("../../models/{name}.txt"));
        let model = Model::read(&path, None).unwrap();
        for &piles in piles.iter().filter(|k| model.surface().len().is_multiple_of(**k)) {
            for seed in 0..arguments[3].parse().unwrap() {
                let request = Request { piles, bridges, seed, ..Request::default() };
                let plan = match plan(&model, &request) {
                    Ok(plan) => plan,
                    Err(error) => {
                        println!("| {name} | {piles} | {seed} | {error} |");
                        continue;
                    }
                };
                let thickness = match arguments[0].parse::<f64>() {
                    Ok(thickness) => Thickness { thickness, rim: thickness },
                    Err(_) => Thickness::ideal(&plan),
                };
                let begin = Instant::now();
                let found = search(&plan, thickness, None, &Effort::default(), &mut |_, _| {}).unwrap();
                let seconds = begin.elapsed().as_secs_f64();
                let begin = Instant::now();
                let report =
                    check(&Plan { root: found.root, ..plan }, &found.hinges, thickness, &Options::default())
                        .unwrap();
                let checked = begin.elapsed().as_secs_f64();
                println!(
                    "| {name} | {piles} | {seed} | {:?} | {} attempts | {} blocked | {seconds:.3} s | {} collisions {checked:.3} s | {:.1e} |",
                    found.scope,
                    found.attempts,
                    found.blocked,
                    report.collisions.len(),
                    report.clearance
                );
            }
        }
    }
}
