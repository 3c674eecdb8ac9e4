//! Verdicts of the sampler: on motions that are free, on motions that aren't, and against the prover.

use super::{
    DenseError, Meeting, Other, Scheduled, Setting, Verdict, verify, verify_with, verify_with_jumps,
};
use crate::motion::{self, Effort, Ground, Options, Thickness, check, search, waits_for};
use crate::order::Order;
use crate::schedule::Fingerprint;
use crate::testing::real_plans;
use crate::tree::Tree;
use std::path::Path;
use zygote_stacking::{Bridges, Model, Plan, Request};

const EFFORT: Effort = Effort { other_roots: 6, backward: 0, looks: 0 };

fn setting(plates: Thickness) -> Setting {
    Setting { thickness: plates.thickness, rim: plates.rim, ground: None, step_deg: 2.0, at_once: 3 }
}

fn model_plan(name: &str, piles: usize, bridges: Bridges) -> Plan {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../models").join(name);
    let model = Model::read(&path, None).expect("a model");
    zygote_stacking::plan(&model, &Request { piles, bridges, ..Request::default() }).expect("a plan")
}

#[test]
fn what_is_proved_free_looks_free_one_by_one_and_at_once() {
    let mut plans = real_plans();
    plans.extend([1, 2].map(|piles| model_plan("fish92.txt", piles, Bridges::Least)));
    plans.push(model_plan("vehicle92.txt", 4, Bridges::Base));
    let mut free = 0;
    for mut plan in plans {
        let plates = Thickness::ideal(&plan);
        let found = search(&plan, plates, None, &EFFORT, &mut |_, _| ()).expect("plates");
        plan.root = found.root;
        let report = check(&plan, &found.hinges, plates, &Options::default()).expect("plates");
        if !report.is_free() {
            continue;
        }
        free += 1;
        let order = waits_for(&plan, &found.hinges, plates).expect("an order");
        let verdict = verify(&plan, &order, &setting(plates)).expect("an order");
        assert!(verdict.is_free(), "{}: {:?}", plan.source.model, verdict.meetings);
        // What is proved of all angles holds for samples.
        assert!(verdict.clearance >= report.clearance - 1e-9, "{} {}", verdict.clearance, report.clearance);
        assert!(verdict.samples > 0 && verdict.pairs > 0);
    }
    assert!(free >= 5, "{free}");
}

/// A meeting as hinge and panels.
fn who(hinge: usize, panel: usize, other: usize) -> (usize, usize, usize) {
    (hinge, panel, other)
}

#[test]
fn what_is_seen_to_meet_the_prover_says_too_and_the_other_way_about() {
    let (mut seen, mut told, mut deep) = (0, 0, 0);
    for plan in real_plans() {
        let tree = Tree::new(&plan).expect("a tree");
        let mut hinges: Vec<_> = tree.branches().iter().map(|branch| branch.hinge).collect();
        hinges.reverse();
        let plates = Thickness::of(&plan);
        let report = check(&plan, &hinges, plates, &Options::default()).expect("plates");
        let one_by_one = Setting { at_once: 0, step_deg: 1.0, ..setting(plates) };
        let verdict = verify(&plan, &Order::one_by_one(hinges), &one_by_one).expect("an order");
        let hinges_told: Vec<_> = report.collisions.iter().map(|(_, collision)| collision.hinge).collect();
        for Meeting { hinge, panel, other, angle_deg, depth, .. } in &verdict.meetings {
            assert!(hinges_told.contains(hinge), "hinge {hinge}: panel {panel} in {other:?} at {angle_deg}");
            assert!(*depth > 0.0);
            seen += 1;
        }
        for (_, collision) in &report.collisions {
            told += 1;
            // Shallow ones may hide between samples.
            if collision.depth > 1e-3 {
                deep += 1;
                let mut hinges = verdict.meetings.iter().map(|meeting| meeting.hinge);
                assert!(hinges.any(|hinge| hinge == collision.hinge), "{collision}");
            }
        }
        let named: Vec<_> = verdict
            .meetings
            .iter()
            .filter_map(|meeting| match meeting.other {
                Other::Panel(other) => Some(who(meeting.hinge, meeting.panel, other)),
                Other::Ground => None,
            })
            .collect();
        let both = report.collisions.iter().filter(|(_, collision)| match collision.obstacle {
            motion::Obstacle::Panel(other) => named.contains(&who(collision.hinge, collision.panel, other)),
            motion::Obstacle::Ground => false,
        });
        assert!(report.collisions.is_empty() || both.count() > 0);
    }
    assert!(seen > 5 && told > 5 && deep > 3, "{seen} seen, {told} told, {deep} deep");
}

#[test]
fn hinges_let_loose_that_should_wait_are_seen_to_meet() {
    let plan = model_plan("fish92.txt", 2, Bridges::Least);
    let plates = Thickness::ideal(&plan);
    let found = search(&plan, plates, None, &EFFORT, &mut |_, _| ()).expect("plates");
    let plan = Plan { root: found.root, ..plan };
    let loose = Order { hinges: found.hinges.clone(), waits_for: vec![Vec::new(); found.hinges.len()] };
    let verdict = verify(&plan, &loose, &Setting { step_deg: 4.0, at_once: 1, ..setting(plates) });
    let verdict = verdict.expect("an order");
    assert!(verdict.meetings.iter().all(|meeting| meeting.at_once), "one by one it is free");
    assert!(!verdict.is_free());
    assert!(verdict.meetings[0].to_string().contains("others moving too"));
}

#[test]
fn boxes_found_near_each_other_give_the_verdict_of_all_pairs() {
    let mut meetings = 0;
    for name in ["fish92.txt", "torus32.txt"] {
        let plan = model_plan(name, 2, Bridges::Least);
        let tree = Tree::new(&plan).expect("a tree");
        let order = Order::of_tree(&tree);
        let plates = Thickness { thickness: 0.05, rim: 0.05 };
        let coarse = Setting { step_deg: 10.0, at_once: 1, ..setting(plates) };
        let every = verify_with(&plan, &order, &[], &coarse, usize::MAX).expect("an order");
        let near = verify_with(&plan, &order, &[], &coarse, 0).expect("an order");
        assert!(near.pairs <= every.pairs);
        assert_eq!(near, Verdict { pairs: near.pairs, ..every });
        meetings += near.meetings.len();
    }
    assert!(meetings > 10, "{meetings}");
}

#[test]
fn panels_that_dip_under_the_table_are_seen() {
    let mut dipped = 0;
    for plan in real_plans() {
        let tree = Tree::new(&plan).expect("a tree");
        let hinges: Vec<_> = tree.branches().iter().map(|branch| branch.hinge).collect();
        let plates = Thickness::of(&plan);
        let options = Options { ground: Some(Ground::TABLE) };
        let report = check(&plan, &hinges, plates, &options).expect("plates");
        let table = Setting { ground: Some([0.0, 0.0, 2.0]), at_once: 0, step_deg: 1.0, ..setting(plates) };
        let verdict = verify(&plan, &Order::one_by_one(hinges), &table).expect("an order");
        let mut told: Vec<_> = report
            .collisions
            .iter()
            .filter(|(_, collision)| collision.obstacle == motion::Obstacle::Ground && collision.depth > 1e-3)
            .map(|(_, collision)| collision.hinge)
            .collect();
        told.sort_unstable();
        told.dedup();
        let in_ground = verdict.meetings.iter().filter(|meeting| meeting.other == Other::Ground);
        let mut seen: Vec<_> = in_ground.filter(|m| m.depth > 1e-3).map(|meeting| meeting.hinge).collect();
        seen.dedup();
        assert_eq!(seen, told, "{}", plan.source.model);
        dipped += seen.len();
    }
    assert!(dipped > 3, "{dipped}");
}

#[test]
fn orders_and_numbers_without_sense_are_refused() {
    let plan = model_plan("l14.txt", 1, Bridges::Least);
    let order = Order::of_tree(&Tree::new(&plan).expect("a tree"));
    let good = setting(Thickness::of(&plan));
    let refused = |order: &Order, setting: &Setting| verify(&plan, order, setting).expect_err("no sense");
    for (setting, message) in [
        (
            Setting { step_deg: 0.0, ..good.clone() },
            "step: expected a finite number of degrees above 0, found 0",
        ),
        (Setting { rim: 0.5, ..good.clone() }, "rim: expected 0 to less than 0.5, found 0.5"),
        (
            Setting { ground: Some([0.0; 3]), ..good.clone() },
            "ground: expected a normal of a finite length above 0, found 0",
        ),
    ] {
        assert_eq!(refused(&order, &setting).to_string(), message);
    }
    let first = order.hinges[0];
    let last = *order.hinges.last().expect("a hinge");
    let mut lacking = order.clone();
    lacking.hinges.pop();
    assert_eq!(refused(&lacking, &good), DenseError::Order { hinge: last });
    let mut waiting_for_later = order;
    waiting_for_later.waits_for[first] = vec![last];
    assert_eq!(refused(&waiting_for_later, &good), DenseError::Order { hinge: first });
    let mut torn = plan.clone();
    torn.hinges[3].target_angle_deg = 90 - torn.hinges[3].target_angle_deg;
    let order = Order::of_tree(&Tree::new(&torn).expect("a tree"));
    assert_eq!(verify(&torn, &order, &good).expect_err("torn"), DenseError::Angles { hinge: 3 });
}

#[test]
fn a_schedule_s_motion_is_read_with_its_waits_and_its_certificate() {
    let plan = model_plan("l14.txt", 1, Bridges::Least);
    let order = Order::of_tree(&Tree::new(&plan).expect("a tree"));
    let place = |hinge: &usize| order.hinges.iter().position(|other| other == hinge).expect("a place");
    let steps: Vec<_> = order
        .hinges
        .iter()
        .map(|hinge| {
            let after: Vec<_> = order.waits_for[*hinge].iter().map(place).collect();
            serde_json::json!({ "hinge": hinge, "after": after, "channel": 3 })
        })
        .collect();
    let certificate = serde_json::json!({
        "thickness": 0.05, "rim": 0.01, "ideal": false, "panel_pairs": 4, "box_pairs": 2, "clearance": 0.01
    });
    let crc = Fingerprint::of(&plan);
    let mut file = serde_json::json!({ "plan_crc64": crc, "steps": steps, "certificate": &certificate });
    let read = Scheduled::read(&plan, &file).expect("a schedule");
    assert_eq!(read.order, order);
    let read = serde_json::to_value(read.certificate.expect("a certificate")).expect("JSON");
    assert_eq!(read, certificate);
    file["steps"][4]["after"] = serde_json::json!([99]);
    let refused = Scheduled::read(&plan, &file).expect_err("step 99");
    assert_eq!(refused, DenseError::Order { hinge: order.hinges[4] });
    let other = model_plan("i14.txt", 1, Bridges::Least);
    let refused = Scheduled::read(&other, &file).expect_err("another plan").to_string();
    assert!(refused.starts_with(&format!("schedule: made for plan {crc}, this is plan ")), "{refused}");
    let refused = Scheduled::read(&plan, &serde_json::json!({ "steps": [] })).expect_err("none").to_string();
    assert_eq!(refused, "schedule: missing field `plan_crc64`");
}

#[test]
fn springs_among_heaters_and_servos_jump_without_meeting_what_moves() {
    let (mut springs, mut plans) = (0, 0);
    for (name, piles) in [("l14.txt", 1), ("l14.txt", 2), ("fish92.txt", 2), ("vehicle92.txt", 4)] {
        let plan = model_plan(name, piles, Bridges::Base);
        let plates = Thickness::ideal(&plan);
        let found = search(&plan, plates, None, &Effort::default(), &mut |_, _| ()).expect("plates");
        assert_eq!((found.blocked, found.root), (0, plan.root));
        let order = waits_for(&plan, &found.hinges, plates).expect("an order");
        let mut text =
            crate::testing::rig_text("").replace("= 16", "= 100").replace("servos = 4", "servos = 100");
        text = text.replace("springs = 2", "springs = 100");
        for hinge in 0..plan.hinges.len() {
            let kind = ["spring", "sma", "servo"][hinge % 3];
            for part in ["[[hinge]]\nhinge = ", &hinge.to_string(), "\nkind = \"", kind, "\"\n"] {
                text.push_str(part);
            }
        }
        let rig = crate::rig::Rig::read("rig.toml", &text).expect("a good rig");
        let limits = crate::schedule::Limits::default();
        let schedule = crate::schedule::Schedule::plan(&plan, &rig, &order, &limits).expect("a schedule");
        assert!(schedule.most_at_once() > 1);
        let scheduled = Scheduled::read(&plan, &schedule.to_json().expect("JSON")).expect("a schedule");
        let own: Vec<_> = (0..plan.hinges.len()).step_by(3).collect();
        let mut told = scheduled.springs.clone();
        told.sort_unstable();
        assert_eq!(told, own);
        let often = Setting { at_once: 12, ..setting(plates) };
        let verdict =
            verify_with_jumps(&plan, &scheduled.order, &scheduled.springs, &often).expect("an order");
        assert!(verdict.is_free(), "{name} in {piles}: {:?}", verdict.meetings);
        springs += scheduled.springs.len();
        plans += 1;
    }
    assert!(springs > 50 && plans == 4);
}

#[test]
fn springs_let_loose_are_seen_to_jump_into_what_moves() {
    let plan = model_plan("fish92.txt", 2, Bridges::Least);
    let plates = Thickness::ideal(&plan);
    let found = search(&plan, plates, None, &EFFORT, &mut |_, _| ()).expect("plates");
    let plan = Plan { root: found.root, ..plan };
    let loose = Order { hinges: found.hinges.clone(), waits_for: vec![Vec::new(); found.hinges.len()] };
    let jumping: Vec<_> = (0..plan.hinges.len()).step_by(3).collect();
    let often = Setting { at_once: 2, step_deg: 4.0, ..setting(plates) };
    let verdict = verify_with_jumps(&plan, &loose, &jumping, &often).expect("an order");
    assert!(verdict.meetings.iter().any(|meeting| meeting.at_once && jumping.contains(&meeting.hinge)));
}
