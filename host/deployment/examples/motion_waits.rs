//! How long it takes to find which hinges must wait for which, how much may happen at once, and how long to see it anew by
//! sampling, as a Markdown table. Arguments: `ideal` or the plates' thickness; `least`, `most` or `base` bridges; degrees from
//! sample to sample, 0 for no sampling; then names of models.
#![expect(clippy::print_stdout, reason = "its output is what it is for")]
#![expect(clippy::unwrap_used, reason = "a tool for developers, as tests are")]

use std::path::Path;
use std::time::Instant;
use zygote_deployment::dense::{Setting, verify};
use zygote_deployment::motion::{Effort, Linkage, Options, Thickness, check, search, waits_for};
use zygote_stacking::{Bridges, Model, Request, plan};

fn main() {
    let mut arguments = std::env::args().skip(1);
    let plates = arguments.next().unwrap_or_else(|| "ideal".to_owned());
    let bridges = match arguments.next().as_deref() {
        Some("most") => Bridges::Most,
        Some("base") => Bridges::Base,
        _ => Bridges::Least,
    };
    let step_deg: f64 = arguments.next().unwrap().parse().unwrap();
    println!(
        "| model | K | hinges | blocked | collisions | waits_for, ms | waits | most of one | longest chain | sampling, s | samples | pairs | meetings | clearance, proved and seen |"
    );
    println!("|---|---|---|---|---|---|---|---|---|---|---|---|---|---|");
    for name in arguments {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("../../models/{name}.txt"));
        let model = Model::read(&path, None).unwrap();
        for piles in [1, 2, 4] {
            let Ok(mut plan) = plan(&model, &Request { piles, bridges, ..Request::default() }) else {
                continue;
            };
            let thickness = match plates.parse::<f64>() {
                Ok(thickness) => Thickness { thickness, rim: thickness },
                Err(_) => Thickness::ideal(&plan),
            };
            let found = search(&plan, thickness, None, &Effort::default(), &mut |_, _| ()).unwrap();
            plan.root = found.root;
            let report = check(&plan, &found.hinges, thickness, &Options::default()).unwrap();
            let begin = Instant::now();
            let order = waits_for(&plan, &found.hinges, thickness).unwrap();
            let took = begin.elapsed().as_secs_f64() * 1e3;
            let linkage = Linkage::new(&plan, thickness).unwrap();
            let mut degrees = vec![0.0; order.hinges.len()];
            for hinge in &order.hinges {
                let waited = order.waits_for[*hinge].iter().map(|other| degrees[*other]).fold(0.0, f64::max);
                degrees[*hinge] = waited + linkage.turn_deg(*hinge);
            }
            let longest = degrees.iter().copied().fold(0.0, f64::max);
            let all: f64 = (0..degrees.len()).map(|hinge| linkage.turn_deg(hinge)).sum();
            let begin = Instant::now();
            let Thickness { thickness, rim } = thickness;
            let setting = Setting { thickness, rim, ground: None, step_deg, at_once: 1 };
            let seen = (step_deg > 0.0).then(|| verify(&plan, &order, &setting).unwrap());
            let sampling = begin.elapsed().as_secs_f64();
            let seen = seen.map_or(String::new(), |seen| {
                format!(
                    "{sampling:.2} | {} | {} | {} | {:.2e} {:.2e} |",
                    seen.samples,
                    seen.pairs,
                    seen.meetings.len(),
                    report.clearance,
                    seen.clearance
                )
            });
            println!(
                "| {name} | {piles} | {} | {} | {} | {took:.0} | {} | {} | {:.0} % of one by one | {seen}",
                found.hinges.len(),
                found.blocked,
                report.collisions.len(),
                order.waits_for.iter().map(Vec::len).sum::<usize>(),
                order.waits_for.iter().map(Vec::len).max().unwrap_or(0),
                100.0 * longest / all,
            );
        }
    }
}
