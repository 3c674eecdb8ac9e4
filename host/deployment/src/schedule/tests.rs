//! Schedules of small and of random trees.

use super::*;
use crate::order::Order;
use crate::rig::Rig;
use crate::testing::{rig_text, strip, tree_plan};
use crate::tree::Tree;
use proptest::prelude::*;
use zygote_stacking::{HingeKind, Plan};

fn rig(extra: &str) -> Rig {
    Rig::read("rig.toml", &rig_text(extra)).expect("a good rig")
}

/// A change to a schedule.
type Change = fn(&mut Schedule);

/// A rig of 200 channels a kind in which every third hinge is a servo and every fifth a spring.
fn wide_rig(hinges: usize, limit: &str) -> Rig {
    let mut text = rig_text("").replace("2 A", limit).replace("= 16", "= 200").replace("= 4", "= 200");
    text = text.replace("springs = 2", "springs = 200");
    for hinge in 0..hinges {
        let kind = if hinge % 5 == 4 {
            "spring"
        } else if hinge % 3 == 2 {
            "servo"
        } else {
            continue;
        };
        for part in ["[[hinge]]\nhinge = ", &hinge.to_string(), "\nkind = \"", kind, "\"\n"] {
            text.push_str(part);
        }
    }
    Rig::read("wide.toml", &text).expect("a good rig")
}

/// In the order of the tree, at most `parallel` at once.
fn planned(plan: &Plan, rig: &Rig, parallel: usize) -> Result<Schedule, SchedulingError> {
    Schedule::plan(plan, rig, &Order::of_tree(&Tree::new(plan)?), &Limits::at_most(parallel))
}

fn random_tree() -> impl Strategy<Value = Plan> {
    prop::collection::vec((any::<prop::sample::Index>(), prop::bool::weighted(0.2)), 1..120).prop_map(
        |nodes| {
            // Mostly strips, as plans are: the parent is one of the last two panels.
            let parents: Vec<_> = nodes
                .iter()
                .enumerate()
                .map(|(i, (parent, _))| i - parent.index(4).min(i).saturating_sub(2))
                .collect();
            let kinds: Vec<_> = nodes
                .iter()
                .map(|(_, bridge)| if *bridge { HingeKind::Bridge } else { HingeKind::Fold })
                .collect();
            tree_plan(&parents, &kinds)
        },
    )
}

#[test]
fn one_at_a_time_each_step_follows_the_one_before() {
    let plan = strip(14);
    let schedule = planned(&plan, &rig(""), 1).expect("a schedule");
    schedule.verify(&plan, &rig("")).expect("a good schedule");
    for (index, step) in schedule.steps.iter().enumerate() {
        assert_eq!(step.hinge, index, "a strip opens from the root to the tip");
        assert_eq!(step.after, (index > 0).then(|| index - 1).into_iter().collect::<Vec<_>>());
        assert_eq!(step.start.0, step.duration.0 * index as u64);
        assert_eq!(step.current, Milliamps(200), "5 V over 25 ohm");
    }
    assert_eq!(schedule.peak_current, Milliamps(200));
    assert_eq!(schedule.makespan.0, 13 * schedule.steps[0].duration.0);
}

#[test]
fn strips_are_opened_one_after_the_other_and_bridges_last() {
    use HingeKind::{Bridge, Fold};
    // Panel 0 carries a bridge to 1 - 3 and a strip 2 - 4 - 5.
    let plan = tree_plan(&[0, 0, 1, 2, 4], &[Bridge, Fold, Fold, Fold, Fold]);
    let order: Vec<_> =
        Tree::new(&plan).expect("a tree").branches().iter().map(|branch| branch.child).collect();
    assert_eq!(order, [2, 4, 5, 1, 3]);
    let schedule = planned(&plan, &rig(""), 1).expect("a schedule");
    assert_eq!(schedule.steps.iter().map(|step| step.hinge).collect::<Vec<_>>(), [1, 3, 4, 0, 2]);
    assert_eq!((schedule.steps[3].from_opening_deg, schedule.steps[0].from_opening_deg), (180, 0));
}

#[test]
fn two_strips_on_two_lanes_take_half_the_time() {
    let parents: Vec<_> = [0, 0].into_iter().chain(1..13).collect();
    let plan = tree_plan(&parents, &[HingeKind::Fold; 14]);
    let one = planned(&plan, &rig(""), 1).expect("a schedule");
    let two = planned(&plan, &rig(""), 2).expect("a schedule");
    two.verify(&plan, &rig("")).expect("a good schedule");
    assert_eq!(two.makespan.0 * 2, one.makespan.0);
    assert_eq!(two.peak_current, Milliamps(400));
}

#[test]
fn a_current_limit_keeps_lanes_empty() {
    let plan = tree_plan(&[0; 8], &[HingeKind::Fold; 8]);
    let narrow = Rig::read("rig.toml", &rig_text("").replace("2 A", "650 mA")).expect("a good rig");
    let schedule = planned(&plan, &narrow, 8).expect("a schedule");
    schedule.verify(&plan, &narrow).expect("a good schedule");
    assert_eq!(schedule.peak_current, Milliamps(600));
    assert_eq!(schedule.makespan.0, 3 * schedule.steps[0].duration.0);
    // The MCU holds back what the supply has no room for; which hinge it waits for doesn't matter.
    assert!(schedule.steps.iter().all(|step| step.after.is_empty()));
}

#[test]
fn servos_that_hold_until_nothing_is_left_are_refused() {
    let plan = strip(5);
    let extra = "[hinges]\ndefault = \"servo\"\n[servo]\ncurrent = \"1 A\"\nhold_current = \"600 mA\"\n";
    let error = planned(&plan, &rig(extra), 1).expect_err("2 x 0.6 A + 1 A");
    insta::assert_snapshot!(error, @"hinge 2 needs 1000 mA, but of the supply limit of 2000 mA the hinges that hold their angle leave only 800 mA; raise supply.limit or lower servo.hold_current");
}

#[test]
fn a_schedule_comes_back_from_its_json() {
    let plan = strip(20);
    let rig = wide_rig(19, "4 A");
    let schedule = planned(&plan, &rig, 3).expect("a schedule");
    let text = schedule.to_text().expect("text");
    assert_eq!(Schedule::from_text(&text).expect("a good schedule"), schedule);
    assert_eq!(Schedule::from_json(&schedule.to_json().expect("JSON")).expect("a good schedule"), schedule);
}

#[test]
fn the_json_of_a_schedule_is_this() {
    let plan = strip(4);
    let extra =
        "[[hinge]]\nhinge = 1\nkind = \"servo\"\n[[hinge]]\nhinge = 2\nkind = \"spring\"\nchannel = 1\n";
    insta::assert_snapshot!(planned(&plan, &rig(extra), 1).expect("a schedule").to_text().expect("text"));
}

#[test]
fn a_schedule_of_another_version_or_with_a_stray_key_is_refused() {
    let text = planned(&strip(3), &rig(""), 1).expect("a schedule").to_text().expect("text");
    let refusal = |text: &str| Schedule::from_text(text).expect_err("no good schedule").to_string();
    insta::assert_snapshot!(refusal(&text.replace("\"version\": 2", "\"version\": 7")), @"schedule: expected version 2, found 7; make it anew with `zygote schedule`");
    insta::assert_snapshot!(refusal(&text.replace("\"version\": 2", "\"version\": 1")), @"schedule: expected version 2, found 1; make it anew with `zygote schedule`");
    insta::assert_snapshot!(refusal("[]"), @"schedule: expected version 2, found none; make it anew with `zygote schedule`");
    let stray = refusal(&text.replacen("\"hold_ms\"", "\"held_ms\"", 1));
    assert!(stray.contains("unknown field `held_ms`"), "{stray}");
    let short = refusal(&text.replacen("\"plan_crc64\": \"", "\"plan_crc64\": \"x", 1));
    assert!(short.contains("expected 16 lower-case hexadecimal digits, found \"x"), "{short}");
}

#[test]
fn a_schedule_of_another_plan_is_refused_with_both_fingerprints() {
    let (plan, other) = (strip(5), strip(6));
    let schedule = planned(&plan, &rig(""), 1).expect("a schedule");
    let error = schedule.verify(&other, &rig("")).expect_err("another plan").to_string();
    for fingerprint in [Fingerprint::of(&plan), Fingerprint::of(&other)] {
        assert!(error.contains(&fingerprint.to_string()), "{error}");
    }
    let mut moved = plan.clone();
    moved.target[3][1][2] += 1;
    assert!(matches!(schedule.verify(&moved, &rig("")), Err(VerifyError::OtherPlan { .. })));
}

#[test]
fn every_change_by_hand_is_found() {
    let plan = tree_plan(&[0, 0, 1, 2], &[HingeKind::Fold; 4]);
    let rig = rig("[[hinge]]\nhinge = 3\nkind = \"servo\"\n");
    let good = planned(&plan, &rig, 2).expect("a schedule");
    good.verify(&plan, &rig).expect("a good schedule");
    let changes: [(&str, Change); 19] = [
        ("belongs to the rig", |s| s.rig.push('2')),
        ("supply_limit_ma", |s| s.supply_limit = Milliamps(9000)),
        ("number of steps", |s| drop(s.steps.pop())),
        ("hinge should be another", |s| s.steps[1].hinge = s.steps[0].hinge),
        ("hinge should be less than 4", |s| s.steps[1].hinge = 4),
        ("rising and below", |s| s.steps[2].after = vec![2]),
        ("at most 4 steps", |s| s.steps[3].after = vec![0, 0, 1, 1, 2]),
        ("the hinge before it", |s| s.steps[2].after.clear()),
        ("start_ms should be at least", |s| s.steps[2].start = Millis(1)),
        ("order_crc64 should be", |s| s.steps[3].after = vec![0, 1]),
        ("order_crc64 should be", |s| s.order_crc64.0 += 1),
        ("lower_bound_ms should be at most", |s| s.lower_bound.0 = s.makespan.0 + 1),
        ("channel should be", |s| s.steps[0].channel = 7),
        ("it should be a", |s| s.steps[0].motion = s.steps[3].motion),
        ("first pulse should be", |s| {
            let motion = s.steps.iter_mut().find_map(|step| match &mut step.motion {
                Motion::Servo(servo) => Some(servo),
                Motion::Sma(_) | Motion::Spring(_) => None,
            });
            motion.unwrap().from.0 += 1;
        }),
        ("made by a calibration at board b 00, the rig is now driven without a calibration", |s| {
            s.calibrated_at = Some(CalibratedAt { board: "b".to_owned(), unique_id: "00".to_owned() });
        }),
        ("current_ma should be", |s| s.steps[0].current = Milliamps(1)),
        ("peak_current_ma should be", |s| s.peak_current.0 -= 1),
        ("makespan_ms should be", |s| s.makespan.0 += 1),
    ];
    for (part, change) in changes {
        let mut changed = good.clone();
        change(&mut changed);
        let error = changed.verify(&plan, &rig).expect_err(part).to_string();
        assert!(error.contains(part), "{part}: {error}");
    }
    let mut crowded = good.clone();
    crowded.parallel = Some(1);
    assert!(matches!(crowded.verify(&plan, &rig), Err(VerifyError::TooManyAtOnce { found: 2, most: 1, .. })));
}

/// What a check might have found.
fn certificate() -> Certificate {
    Certificate {
        thickness: 0.05,
        rim: 0.05,
        ideal: false,
        ground: None,
        panel_pairs: 12,
        box_pairs: 3,
        clearance: 0.01,
        collisions: Vec::new(),
    }
}

#[test]
fn another_order_than_that_of_the_tree_needs_a_certificate_and_is_then_kept() {
    let plan = strip(4);
    let order = Order::one_by_one(vec![2, 0, 1]);
    let schedule = Schedule::plan(&plan, &rig(""), &order, &Limits::default()).expect("a schedule");
    assert_eq!(schedule.steps.iter().map(|step| step.hinge).collect::<Vec<_>>(), [2, 0, 1]);
    assert_eq!((schedule.makespan, schedule.ratio()), (schedule.lower_bound, 1.0));
    let error = schedule.verify(&plan, &rig("")).expect_err("not the order of the tree").to_string();
    assert!(error.contains("the hinge before it"), "{error}");
    let certified = schedule.with_certificate(certificate());
    certified.verify(&plan, &rig("")).expect("the order that was checked");
    let text = certified.to_text().expect("text");
    assert_eq!(Schedule::from_text(&text).expect("a good schedule"), certified);
    let mut loosened = certified;
    loosened.steps[2].after.clear();
    let error = loosened.verify(&plan, &rig("")).expect_err("another order than the one checked").to_string();
    assert!(error.contains("order_crc64 should be"), "{error}");
}

#[test]
fn loads_that_are_not_those_of_the_rig_are_found() {
    use crate::statics::{Loads, Statics, Support};
    type Reweigh = fn(&mut Loads);
    let plan = &crate::testing::real_plans()[1];
    let weighs = |extra: &str| rig(&format!("[panel]\nmass = \"20 g\"\n{extra}"));
    let schedule = planned(plan, &weighs(""), 1).expect("a schedule");
    let statics = Statics::of(plan, &weighs(""), &schedule.hinges(), Support::Touching).expect("loads");
    let good = schedule.with_loads(Loads::of(&statics, &weighs("")));
    assert!(good.loads.as_ref().is_some_and(|loads| !loads.overloaded.is_empty()));
    good.verify(plan, &weighs("")).expect("what was weighed");
    assert_eq!(
        Schedule::from_text(&good.to_text().expect("text")).expect("a good schedule").hinges(),
        good.hinges()
    );
    let refusal = |rig: &Rig, change: &dyn Fn(&mut Loads)| {
        let mut changed = good.clone();
        changed.loads.as_mut().into_iter().for_each(change);
        changed.verify(plan, rig).expect_err("another weighing").to_string()
    };
    let same = &|_: &mut Loads| ();
    for (extra, key) in [
        ("[sma]\ntorque = \"1 Nm\"\n", "loads.overloaded should be []"),
        (
            "[gravity]\ndirection = [1, 0, 0]\n",
            "loads.gravity should be [1.0, 0.0, 0.0], found [0.0, 0.0, -1.0]",
        ),
    ] {
        let said = refusal(&weighs(extra), same);
        assert!(said.contains(key), "{said}");
    }
    let weightless = refusal(&rig(""), same);
    assert!(weightless.contains("loads should be left out (rig.toml: panel.mass"), "{weightless}");
    let changes: [(&str, Reweigh); 5] = [
        ("loads.panel_mass_g should be 20, found 21", |loads| loads.panel_mass_g += 1.0),
        ("loads.overloaded should be", |loads| loads.overloaded.clear()),
        ("loads.worst_factor should be", |loads| loads.worst_factor *= 0.5),
        ("loads.tips_in_step should be", |loads| loads.tips_in_step = Some(99)),
        ("loads.tipping_margin_mm should be", |loads| loads.tipping_margin_mm = Some(1e6)),
    ];
    for (key, change) in changes {
        let said = refusal(&weighs(""), &change);
        assert!(said.contains(key), "{key}: {said}");
    }
}

#[test]
fn an_order_that_is_none_is_refused_by_name() {
    let plan = strip(4);
    let refusal = |order: &Order| {
        Schedule::plan(&plan, &rig(""), order, &Limits::default()).expect_err("no order").to_string()
    };
    let mut cyclic = Order::one_by_one(vec![0, 1, 2]);
    cyclic.waits_for[0].push(2);
    insta::assert_snapshot!(refusal(&cyclic), @"order: hinge 0 is to wait for hinge 2, expected one that comes before it");
    insta::assert_snapshot!(refusal(&Order::one_by_one(vec![0, 1])), @"order: expected each of the plan's 3 hinges once, found 2 hinges, and what 2 wait for");
    let free = |hinges| Order { hinges, waits_for: vec![vec![]; 3] };
    insta::assert_snapshot!(refusal(&free(vec![0, 1, 1])), @"order: expected each of the plan's 3 hinges once, found hinge 1 again");
    insta::assert_snapshot!(refusal(&free(vec![0, 1, 7])), @"order: expected each of the plan's 3 hinges once, found hinge 7");
}

#[test]
fn of_servos_that_share_a_bus_one_moves_at_a_time() {
    let plan = tree_plan(&[0; 4], &[HingeKind::Fold; 4]);
    let rig = rig("[hinges]\ndefault = \"servo\"\n");
    let limits = Limits { one_servo_a_node: true, ..Limits::default() };
    let schedule = Schedule::plan(&plan, &rig, &Order::of_tree(&Tree::new(&plan).expect("a tree")), &limits);
    let mut schedule = schedule.expect("a schedule");
    schedule.verify(&plan, &rig).expect("a good schedule");
    assert_eq!((schedule.most_at_once(), schedule.makespan), (1, schedule.lower_bound));
    assert_eq!(schedule.steps.iter().map(|step| step.after.len()).collect::<Vec<_>>(), [0, 1, 1, 1]);
    schedule.steps[2].start = schedule.steps[1].start;
    schedule.steps[2].after.clear();
    schedule.order_crc64 = Fingerprint::of_order(&schedule.steps);
    let error = schedule.verify(&plan, &rig).expect_err("two at once").to_string();
    assert!(error.contains("when the servo of step 1 has moved"), "{error}");
}

#[test]
fn waits_for_another_node_are_named() {
    let plan = strip(20);
    let rig = rig("[[node]]\nname = \"b\"\nheaters = 16\n");
    let schedule = planned(&plan, &rig, 1).expect("a schedule");
    schedule.verify(&plan, &rig).expect("a good schedule");
    assert_eq!(schedule.nodes(), [0, 1]);
    assert_eq!(schedule.crossings(), [Crossing { step: 16, node: 1, waits_for: 15, other_node: 0 }]);
    assert!(planned(&strip(17), &rig, 1).expect("a schedule").crossings().is_empty(), "one node is enough");
}

#[test]
fn hinges_that_are_no_tree_are_refused() {
    let mut ring = strip(5);
    ring.hinges[3].panels = [0, 3];
    let error = planned(&ring, &rig(""), 1).expect_err("a ring").to_string();
    assert_eq!(error, "plan: the hinges join panel 4 to the root 0 in no way");
    let mut rootless = strip(5);
    rootless.root = 5;
    let error = planned(&rootless, &rig(""), 1).expect_err("no root").to_string();
    assert_eq!(error, "plan: the root must be one of the 5 panels, found 5");
}

proptest! {
    #[test]
    fn every_schedule_of_a_random_tree_verifies(plan in random_tree(), parallel in 1_usize..10, amps in 2_u32..6) {
        let rig = wide_rig(plan.hinges.len(), &format!("{amps} A"));
        let schedule = planned(&plan, &rig, parallel).expect("a schedule");
        schedule.verify(&plan, &rig).expect("a good schedule");
        prop_assert_eq!(&schedule, &planned(&plan, &rig, parallel).expect("the same schedule"));
        let one = planned(&plan, &rig, 1).expect("a schedule");
        prop_assert!(schedule.makespan <= one.makespan);
    }

    /// Whatever the motions really take, no more of them run at once than the lanes that were asked for.
    #[test]
    fn waiting_alone_keeps_the_number_of_motions(
        plan in random_tree(),
        parallel in 1_usize..5,
        real in prop::collection::vec(1_u64..100, 120),
    ) {
        let schedule = planned(&plan, &wide_rig(plan.hinges.len(), "6 A"), parallel).expect("a schedule");
        let mut opened: Vec<u64> = Vec::new();
        let mut spans = Vec::new();
        for (step, took) in schedule.steps.iter().zip(real) {
            let start = step.after.iter().map(|other| opened[*other]).max().unwrap_or(0);
            opened.push(start + took);
            spans.push((start, start + took));
        }
        for (time, _) in &spans {
            let at_once = spans.iter().filter(|(start, end)| start <= time && time < end).count();
            prop_assert!(at_once <= parallel, "{} motions at {}", at_once, time);
        }
    }
}
