//! The campaign: random solids of 10 to 60 panels in 1 to 4 piles, with panels of several thicknesses; every motion that is
//! said to be free is looked at by the dense checker, one by one and at once; so are orders at random, hinge by hinge.
//! A Markdown table, and exit code 1 where one was seen to collide. Arguments: number of solids; and a folder for
//! the free plans with their orders, and for some of the random orders, where other programs are to look at them too.
#![expect(clippy::print_stdout, reason = "its output is what it is for")]
#![expect(clippy::unwrap_used, reason = "a tool for developers, as tests are")]

#[path = "../../stacking/tests/boundary/mod.rs"]
mod boundary;

use boundary::boundary;
use serde_json::json;
use std::collections::BTreeSet;
use std::fs;
use std::path::Path;
use std::process::ExitCode;
use zygote_deployment::dense::{Setting, Verdict, verify};
use zygote_deployment::motion::{Certificate, Effort, Options, Report, Thickness, check, search, waits_for};
use zygote_deployment::{Fingerprint, Order};
use zygote_stacking::{Bridges, Model, Plan, Request, Surface, fold, plan};

/// What is tried of every plan: panels without thickness, and some thicknesses.
const PLATES: [Option<f64>; 4] = [None, Some(0.01), Some(0.05), Some(0.1)];
const PILES: [usize; 4] = [1, 2, 3, 4];
const BRIDGES: [Bridges; 3] = [Bridges::Base, Bridges::Least, Bridges::Most];
const EFFORT: Effort = Effort { other_roots: 1, backward: 2, looks: 2_000 };
/// Degrees from sample to sample, one by one and at once.
const STEP_DEG: f64 = 0.5;
const AT_ONCE: usize = 3;
/// Of so many solids one has its random orders written for other programs.
const RANDOM_FOR_OTHERS: u64 = 4;
/// Deeper collisions than this are seen between two samples; panel lengths.
const DEEP: f64 = 1e-3;

/// A seeded stream of numbers (`SplitMix64`).
struct Stream(u64);

impl Stream {
    fn below(&mut self, limit: usize) -> usize {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        usize::try_from((z ^ (z >> 31)) >> 33).unwrap() % limit
    }
}

/// The solid with a number, grown voxel by voxel; none where its surface is in pieces.
fn solid(number: u64) -> Option<Model> {
    let mut stream = Stream(number);
    let voxels = 2 + stream.below(13);
    let mut row = vec![[0; 3]];
    while row.len() < voxels {
        let mut next = row[stream.below(row.len())];
        next[stream.below(3)] += if stream.below(2) == 0 { 1 } else { -1 };
        if !row.contains(&next) {
            row.push(next);
        }
    }
    let surface = Surface::new(boundary(&BTreeSet::from_iter(row)), Vec::new()).ok()?;
    Model::new(format!("solid {number}"), surface).ok()
}

/// What came of one kind of plates and number of piles.
#[derive(Default)]
struct Tally {
    plans: usize,
    free: usize,
    steps_free: usize,
    steps_blocked: usize,
    unseen: usize,
    faults: Vec<String>,
}

/// A plan with its plates.
struct Case<'a> {
    name: String,
    plan: &'a Plan,
    plates: Thickness,
    ideal: bool,
}

impl Case<'_> {
    fn seen(&self, order: &Order, at_once: usize) -> Verdict {
        let Thickness { thickness, rim } = self.plates;
        let setting = Setting { thickness, rim, ground: None, step_deg: STEP_DEG, at_once };
        verify(self.plan, order, &setting).unwrap()
    }

    /// Looks at an order that is said to be free.
    fn free(&self, hinges: &[usize], tally: &mut Tally, folder: Option<&Path>) {
        let report = check(self.plan, hinges, self.plates, &Options::default()).unwrap();
        if !report.is_free() {
            tally.faults.push(format!("{}: free for the search, not for the check", self.name));
            return;
        }
        let order = waits_for(self.plan, hinges, self.plates).unwrap();
        let verdict = self.seen(&order, AT_ONCE);
        if let Some(meeting) = verdict.meetings.first() {
            tally.faults.push(format!("{}: proved free, but {meeting}", self.name));
        }
        let slack = verdict.clearance - report.clearance;
        if slack < -1e-9 {
            tally.faults.push(format!("{}: clearance {slack:.1e} below the proved one", self.name));
        }
        tally.free += 1;
        if let Some(folder) = folder {
            self.write(folder, &self.name, &order, &report);
        }
    }

    /// Writes the plan with an order and what was found of it.
    fn write(&self, folder: &Path, name: &str, order: &Order, report: &Report) {
        let place = |hinge: &usize| order.hinges.iter().position(|other| other == hinge).unwrap();
        let steps: Vec<_> = order
            .hinges
            .iter()
            .map(|hinge| {
                let after: Vec<_> = order.waits_for[*hinge].iter().map(place).collect();
                json!({ "hinge": hinge, "after": after })
            })
            .collect();
        let certificate = Certificate::of(report, self.plates, self.ideal, None);
        let schedule =
            json!({ "plan_crc64": Fingerprint::of(self.plan), "steps": steps, "certificate": certificate });
        let scheduled = Plan { schedule: Some(schedule), ..self.plan.clone() };
        fs::write(folder.join(format!("{name}.fold")), fold::write(&scheduled).unwrap()).unwrap();
    }

    /// Compares what is said of every hinge of an order at random with what is seen.
    fn at_random(&self, stream: &mut Stream, tally: &mut Tally, folder: Option<&Path>) {
        let mut hinges: Vec<_> = (0..self.plan.hinges.len()).collect();
        for place in (1..hinges.len()).rev() {
            hinges.swap(place, stream.below(place + 1));
        }
        let report = check(self.plan, &hinges, self.plates, &Options::default()).unwrap();
        let blocked: BTreeSet<_> = report.collisions.iter().map(|(_, collision)| collision.hinge).collect();
        let deep = report.collisions.iter().filter(|(_, collision)| collision.depth > DEEP);
        let deep: BTreeSet<_> = deep.map(|(_, collision)| collision.hinge).collect();
        let order = Order::one_by_one(hinges);
        let verdict = self.seen(&order, 0);
        if let Some(folder) = folder {
            self.write(folder, &format!("{}-random", self.name), &order, &report);
        }
        let seen: BTreeSet<_> = verdict.meetings.iter().map(|meeting| meeting.hinge).collect();
        for meeting in verdict.meetings.iter().filter(|meeting| !blocked.contains(&meeting.hinge)) {
            tally.faults.push(format!("{}: at random, proved free, but {meeting}", self.name));
        }
        for hinge in deep.difference(&seen) {
            tally.faults.push(format!("{}: hinge {hinge}: deeply blocked, but not seen so", self.name));
        }
        tally.steps_free += self.plan.hinges.len() - blocked.len();
        tally.steps_blocked += blocked.len();
        tally.unseen += blocked.difference(&seen).count();
    }
}

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let solids: u64 = arguments.first().map_or(200, |number| number.parse().unwrap());
    let folder = arguments.get(1).map(Path::new);
    let (mut kept, mut pieces) = (0, 0);
    let mut tallies: Vec<Tally> = (0..PLATES.len() * PILES.len()).map(|_| Tally::default()).collect();
    for seed in 0..solids {
        let Some(model) = solid(seed) else {
            pieces += 1;
            continue;
        };
        if !(10..=60).contains(&model.surface().len()) {
            continue;
        }
        kept += 1;
        // One kind of plates and of bridges a solid, so that solids differ as much as can be.
        let mut stream = Stream(!seed);
        let (kind, bridges) = (stream.below(PLATES.len()), BRIDGES[stream.below(BRIDGES.len())]);
        for (place, piles) in PILES.into_iter().enumerate() {
            let thickness = PLATES[kind].unwrap_or(0.01);
            let Ok(mut plan) =
                plan(&model, &Request { piles, bridges, seed, thickness, ..Request::default() })
            else {
                continue;
            };
            let plates = PLATES[kind].map_or_else(|| Thickness::ideal(&plan), |_| Thickness::of(&plan));
            let found = search(&plan, plates, None, &EFFORT, &mut |_, _| ()).unwrap();
            plan.root = found.root;
            let name = format!("solid{seed}-{piles}-{kind}");
            let case = Case { name, plan: &plan, plates, ideal: PLATES[kind].is_none() };
            let tally = &mut tallies[kind * PILES.len() + place];
            tally.plans += 1;
            if found.blocked == 0 {
                case.free(&found.hinges, tally, folder);
            }
            let for_others = folder.filter(|_| seed.is_multiple_of(RANDOM_FOR_OTHERS));
            case.at_random(&mut stream, tally, for_others);
        }
    }
    println!("Seeds 0 to {}: {kept} solids of 10 to 60 panels ({pieces} in pieces).\n", solids.max(1) - 1);
    println!(
        "| plates | K | plans | said to be free | seen otherwise | turns of random orders proved free | seen otherwise | \
         blocked | of these not seen |\n|---|---|---|---|---|---|---|---|---|"
    );
    for (number, tally) in tallies.iter().enumerate() {
        let plates = PLATES[number / PILES.len()].map_or("ideal".to_owned(), |t| format!("{t} thick"));
        let of_random = tally.faults.iter().filter(|fault| fault.contains(": at random")).count();
        println!(
            "| {plates} | {} | {} | {} | {} | {} | {of_random} | {} | {} |",
            PILES[number % PILES.len()],
            tally.plans,
            tally.free,
            tally.faults.len() - of_random,
            tally.steps_free,
            tally.steps_blocked,
            tally.unseen
        );
    }
    let faults: Vec<_> = tallies.iter().flat_map(|tally| &tally.faults).collect();
    for fault in &faults {
        println!("\n- {fault}");
    }
    if faults.is_empty() { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}
