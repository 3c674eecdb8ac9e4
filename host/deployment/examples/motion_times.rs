//! How long it takes to follow and to check motions, as a Markdown table: all models in 1, 2 and 4 piles, opened from the root;
//! or plan files (`.fold`) in the order of their schedules, with the plates of their certificates. Arguments: `ideal` or the plates'
//! thickness, for what isn't a plan; then names of models, or paths of files of voxels or of plans. Motions of more than 20,000
//! panels are followed only, not checked. Of five checks the middle one counts.
#![expect(clippy::print_stdout, reason = "its output is what it is for")]
#![expect(clippy::unwrap_used, reason = "a tool for developers, as tests are")]

use std::fs;
use std::path::Path;
use std::time::Instant;
use zygote_deployment::Tree;
use zygote_deployment::dense::Scheduled;
use zygote_deployment::motion::{Linkage, Motion, Options, Thickness, check};
use zygote_stacking::{Bridges, Model, Plan, Request, fold, plan};

/// No more panels than this are checked: every step looks at all of them.
const CHECKED: usize = 20_000;
/// Checks of one motion.
const RUNS: usize = 5;

fn milliseconds(since: Instant) -> f64 {
    since.elapsed().as_secs_f64() * 1e3
}

fn row(name: &str, plan: &Plan, order: &[usize], thickness: Thickness) {
    let linkage = Linkage::new(plan, thickness).unwrap();
    let piles = plan.piles.len();
    let begin = Instant::now();
    let poses = linkage.poses_at(&[]);
    let for_poses = milliseconds(begin);
    assert_eq!(poses.len(), plan.panels());
    if plan.panels() > CHECKED {
        println!("| {name} | {piles} | {for_poses:.3} |");
        return;
    }
    let mut checks: Vec<_> = (0..RUNS)
        .map(|_| {
            let begin = Instant::now();
            let report = check(plan, order, thickness, &Options::default()).unwrap();
            (milliseconds(begin), report)
        })
        .collect();
    checks.sort_by(|a, b| a.0.total_cmp(&b.0));
    let (for_check, report) = checks.swap_remove(RUNS / 2);
    let mut motion = Motion::new(plan, thickness, None).unwrap();
    let begin = Instant::now();
    let blocked = order.iter().filter(|hinge| {
        let blocked = motion.try_open(**hinge).is_err();
        motion.open(**hinge);
        blocked
    });
    let blocked = blocked.count();
    let for_search = milliseconds(begin);
    let deepest = report.collisions.iter().map(|(_, collision)| collision.depth).fold(0.0, f64::max);
    let stretch = order.iter().map(|hinge| linkage.stretch(*hinge)).fold(0.0, f64::max);
    println!(
        "| {name} | {piles} | {for_poses:.3} | {for_check:.1} | {for_search:.1} | {} | {blocked} | {} | {} | {:.2e} | {deepest:.2e} | {stretch:.3} |",
        report.collisions.len(),
        report.panel_pairs,
        report.box_pairs,
        report.clearance,
    );
}

/// A plan in the order of its schedule, with the plates of its certificate.
fn scheduled(path: &Path) {
    let mut plan = fold::read(&fs::read(path).unwrap()).unwrap();
    let schedule = plan.schedule.take().unwrap();
    let Scheduled { order, certificate, .. } = Scheduled::read(&plan, &schedule).unwrap();
    let proved = certificate.unwrap();
    let thickness = Thickness { thickness: proved.thickness, rim: proved.rim };
    row(path.file_stem().unwrap().to_str().unwrap(), &plan, &order.hinges, thickness);
}

fn main() {
    let mut arguments = std::env::args().skip(1);
    let plates = arguments.next().unwrap_or_else(|| "ideal".to_owned());
    let mut names: Vec<_> = arguments.collect();
    if names.is_empty() {
        names = ["i14", "l14", "fish92", "vehicle92", "airplane92", "fish144", "fish4000"]
            .map(String::from)
            .into();
    }
    println!(
        "| model | K | poses, ms | check, ms | search, ms | collisions | hinges with one | panel pairs | box pairs | clearance | deepest | stretch |\n|---|---|---|---|---|---|---|---|---|---|---|---|"
    );
    for name in &names {
        let own = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("../../models/{name}.txt"));
        let path = if name.contains('.') { Path::new(name) } else { &own };
        if path.extension().is_some_and(|extension| extension == "fold") {
            scheduled(path);
            continue;
        }
        let model = Model::read(path, None).unwrap();
        for piles in [1, 2, 4] {
            if !model.surface().len().is_multiple_of(piles) {
                continue;
            }
            let request = Request { piles, bridges: Bridges::Least, ..Request::default() };
            let plan = plan(&model, &request).unwrap();
            let thickness = match plates.parse::<f64>() {
                Ok(thickness) => Thickness { thickness, rim: thickness },
                Err(_) => Thickness::ideal(&plan),
            };
            let tree = Tree::new(&plan).unwrap();
            let order: Vec<_> = tree.branches().iter().map(|branch| branch.hinge).collect();
            row(name, &plan, &order, thickness);
        }
    }
}
