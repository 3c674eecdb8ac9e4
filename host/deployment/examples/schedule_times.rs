//! How short schedules are, as a Markdown table: models in 1, 2 and 4 piles, opened in the order of the tree, on heaters, on
//! servos that hold nothing, a little and much, and on both by turns, with a supply for 1, 4 and 16 hinges at once
//! beside what is held. Arguments: a folder for the problems as JSON, for other programs, or `-`; then names of models,
//! or `large` for a cube of some 100,000 panels.
#![expect(clippy::print_stdout, reason = "its output is what it is for")]
#![expect(clippy::unwrap_used, reason = "a tool for developers, as tests are")]

use serde_json::json;
use std::path::Path;
use std::time::Instant;
use zygote_deployment::{Limits, Millis, Order, Rig, Schedule, Tree};
use zygote_stacking::{Bridges, Model, Plan, Request, Surface, plan};

/// The defaults of a rig file on 5 V, but for what is held.
const KINDS: [Hinges; 5] = [
    Hinges { title: "sma", kinds: &["sma"], current: 200, hold: 0 },
    Hinges { title: "servo", kinds: &["servo"], current: 250, hold: 0 },
    Hinges { title: "servo, holds 10 mA", kinds: &["servo"], current: 250, hold: 10 },
    Hinges { title: "servo, holds 60 mA", kinds: &["servo"], current: 250, hold: 60 },
    Hinges { title: "both, holds 60 mA", kinds: &["sma", "servo"], current: 250, hold: 60 },
];
const AT_ONCE: [u64; 3] = [1, 4, 16];
/// Panels along the edge of the large cube.
const EDGE: i32 = 129;

/// How hinges are driven.
struct Hinges {
    title: &'static str,
    /// By turns.
    kinds: &'static [&'static str],
    /// What one draws that moves, in mA; of several kinds the most.
    current: u64,
    /// What a servo draws that is opened, in mA.
    hold: u64,
}

/// A rig with channels for all hinges, in as many nodes as that takes, and current for so many at once when all are held.
fn rig(driven: &Hinges, hinges: usize, at_once: u64) -> Rig {
    let Hinges { kinds, current, hold, .. } = driven;
    let kind_of = |hinge: usize| kinds[hinge % kinds.len()];
    let servos = (0..hinges).filter(|hinge| kind_of(*hinge) == "servo").count();
    let limit = at_once * current + hold * servos as u64;
    let head = format!(
        "version = 1\n[rig]\nid = \"bench\"\n[supply]\nvoltage = \"5 V\"\nlimit = \"{limit} mA\"\nresistance = \"0 ohm\"\n\
         [hinges]\ndefault = \"{}\"\n[servo]\ncurrent = \"{current} mA\"\nhold_current = \"{hold} mA\"\n",
        kinds[0]
    );
    let nodes = hinges.div_ceil(60_000);
    let channels = hinges.div_ceil(nodes);
    let node = |node| format!("[[node]]\nname = \"{node}\"\nheaters = {channels}\nservos = {channels}\n");
    let other = (0..hinges).filter(|hinge| kind_of(*hinge) != kinds[0]);
    let other = other.map(|hinge| format!("[[hinge]]\nhinge = {hinge}\nkind = \"{}\"\n", kind_of(hinge)));
    let text: String = [head].into_iter().chain((0..nodes).map(node)).chain(other).collect();
    Rig::read("rig.toml", &text).unwrap()
}

/// The surface of a cube.
fn cube() -> Model {
    let mut quads = Vec::new();
    for axis in 0..3 {
        for (side, u, v) in
            (0..2).flat_map(|side| (0..EDGE).flat_map(move |u| (0..EDGE).map(move |v| (side, u, v))))
        {
            let corner = |du: i32, dv: i32| {
                let mut corner = [side * EDGE; 3];
                corner[(axis + 1) % 3] = u + du;
                corner[(axis + 2) % 3] = v + dv;
                corner
            };
            let mut quad = [corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)];
            if side == 0 {
                quad.reverse();
            }
            quads.push(quad);
        }
    }
    let lines = (1..=quads.len()).collect();
    Model::new("cube", Surface::new(quads, lines).unwrap()).unwrap()
}

/// The problem and what was found, for other programs.
fn problem(name: &str, schedule: &Schedule, order: &Order) -> serde_json::Value {
    let mut steps: Vec<_> = schedule.steps.iter().collect();
    steps.sort_by_key(|step| step.hinge);
    let tasks: Vec<_> =
        steps.iter().map(|step| json!([step.duration.0, step.current.0, step.hold_current.0])).collect();
    json!({
        "name": name,
        "limit": schedule.supply_limit.0,
        "tasks": tasks,
        "waits_for": order.waits_for,
        "makespan": schedule.makespan.0,
        "lower_bound": schedule.lower_bound.0,
    })
}

/// Makespan and lower bound in seconds, and how they compare.
fn cell(schedule: &Schedule) -> String {
    let seconds = |time: Millis| time.0 as f64 / 1e3;
    let makespan = seconds(schedule.makespan);
    if schedule.makespan == schedule.lower_bound {
        format!(" {makespan:.1} | proven |")
    } else {
        format!(" {makespan:.1} / {:.1} | {:.3} |", seconds(schedule.lower_bound), schedule.ratio())
    }
}

fn rows(name: &str, piles: usize, plan: &Plan, folder: &str) {
    // A rig file with an entry for each of so many hinges is no matter of schedules.
    let few = plan.hinges.len() < 10_000;
    for driven in KINDS.into_iter().filter(|driven| few || driven.kinds.len() == 1) {
        let mut longest: f64 = 0.0;
        let mut cells = String::new();
        for at_once in AT_ONCE {
            let rig = rig(&driven, plan.hinges.len(), at_once);
            let begin = Instant::now();
            let order = Order::of_tree(&Tree::new(plan).unwrap());
            let schedule = Schedule::plan(plan, &rig, &order, &Limits::default()).unwrap();
            longest = longest.max(begin.elapsed().as_secs_f64() * 1e3);
            schedule.verify(plan, &rig).unwrap();
            cells += &cell(&schedule);
            if folder != "-" {
                let title = format!("{name}, K = {piles}, {}, for {at_once}", driven.title);
                let file = title.replace(", ", "-").replace(' ', "");
                let file = Path::new(folder).join(file).with_extension("json");
                std::fs::write(file, problem(&title, &schedule, &order).to_string()).unwrap();
            }
        }
        println!("| {name} | {piles} | {} |{cells} {longest:.1} |", driven.title);
    }
}

fn main() {
    let mut arguments = std::env::args().skip(1);
    let folder = arguments.next().unwrap_or_else(|| "-".to_owned());
    let mut names: Vec<_> = arguments.collect();
    if names.is_empty() {
        names = ["i14", "l14", "fish92", "vehicle92", "airplane92"].map(String::from).into();
    }
    let supplies = AT_ONCE.map(|at_once| format!(" supply for {at_once}, s | ratio |")).concat();
    println!("| model | K | hinges |{supplies} longest took, ms |");
    println!("|---|---|---|{}---|", "---|---|".repeat(AT_ONCE.len()));
    for name in &names {
        let own = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("../../models/{name}.txt"));
        let model = if name == "large" { cube() } else { Model::read(&own, None).unwrap() };
        for piles in [1, 2, 4] {
            if !model.surface().len().is_multiple_of(piles) {
                continue;
            }
            let request = Request { piles, bridges: Bridges::Least, ..Request::default() };
            rows(name, piles, &plan(&model, &request).unwrap(), &folder);
        }
    }
}
