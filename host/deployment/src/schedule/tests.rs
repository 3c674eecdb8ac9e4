//! Schedules of small and of random trees.

use super::*;
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
    let schedule = Schedule::plan(&plan, &rig(""), 1).expect("a schedule");
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
    let schedule = Schedule::plan(&plan, &rig(""), 1).expect("a schedule");
    assert_eq!(schedule.steps.iter().map(|step| step.hinge).collect::<Vec<_>>(), [1, 3, 4, 0, 2]);
    assert_eq!((schedule.steps[3].from_opening_deg, schedule.steps[0].from_opening_deg), (180, 0));
}

#[test]
fn two_strips_on_two_lanes_take_half_the_time() {
    let parents: Vec<_> = [0, 0].into_iter().chain(1..13).collect();
    let plan = tree_plan(&parents, &[HingeKind::Fold; 14]);
    let one = Schedule::plan(&plan, &rig(""), 1).expect("a schedule");
    let two = Schedule::plan(&plan, &rig(""), 2).expect("a schedule");
    two.verify(&plan, &rig("")).expect("a good schedule");
    assert_eq!(two.makespan.0 * 2, one.makespan.0);
    assert_eq!(two.peak_current, Milliamps(400));
}

#[test]
fn a_current_limit_keeps_lanes_empty() {
    let plan = tree_plan(&[0; 8], &[HingeKind::Fold; 8]);
    let narrow = Rig::read("rig.toml", &rig_text("").replace("2 A", "650 mA")).expect("a good rig");
    let schedule = Schedule::plan(&plan, &narrow, 8).expect("a schedule");
    schedule.verify(&plan, &narrow).expect("a good schedule");
    assert_eq!(schedule.peak_current, Milliamps(600));
    assert_eq!(schedule.makespan.0, 3 * schedule.steps[0].duration.0);
    // What waited for current says for what.
    assert!(schedule.steps[3..].iter().all(|step| !step.after.is_empty()));
}

#[test]
fn servos_that_hold_until_nothing_is_left_are_refused() {
    let plan = strip(5);
    let extra = "[hinges]\ndefault = \"servo\"\n[servo]\ncurrent = \"1 A\"\nhold_current = \"600 mA\"\n";
    let error = Schedule::plan(&plan, &rig(extra), 1).expect_err("2 x 0.6 A + 1 A");
    insta::assert_snapshot!(error, @"hinge 2 needs 1000 mA, but of the supply limit of 2000 mA the hinges that hold their angle leave only 800 mA; raise supply.limit or lower servo.hold_current");
}

#[test]
fn a_schedule_comes_back_from_its_json() {
    let plan = strip(20);
    let rig = wide_rig(19, "4 A");
    let schedule = Schedule::plan(&plan, &rig, 3).expect("a schedule");
    let text = schedule.to_text().expect("text");
    assert_eq!(Schedule::from_text(&text).expect("a good schedule"), schedule);
    assert_eq!(Schedule::from_json(&schedule.to_json().expect("JSON")).expect("a good schedule"), schedule);
}

#[test]
fn the_json_of_a_schedule_is_this() {
    let plan = strip(4);
    let extra =
        "[[hinge]]\nhinge = 1\nkind = \"servo\"\n[[hinge]]\nhinge = 2\nkind = \"spring\"\nchannel = 1\n";
    insta::assert_snapshot!(
        Schedule::plan(&plan, &rig(extra), 1).expect("a schedule").to_text().expect("text")
    );
}

#[test]
fn a_schedule_of_another_version_or_with_a_stray_key_is_refused() {
    let text = Schedule::plan(&strip(3), &rig(""), 1).expect("a schedule").to_text().expect("text");
    let refusal = |text: &str| Schedule::from_text(text).expect_err("no good schedule").to_string();
    insta::assert_snapshot!(refusal(&text.replace("\"version\": 1", "\"version\": 7")), @"schedule: expected version 1, found 7; make it anew with `zygote schedule`");
    insta::assert_snapshot!(refusal("[]"), @"schedule: expected version 1, found none; make it anew with `zygote schedule`");
    let stray = refusal(&text.replacen("\"hold_ms\"", "\"held_ms\"", 1));
    assert!(stray.contains("unknown field `held_ms`"), "{stray}");
    let short = refusal(&text.replacen("\"plan_crc64\": \"", "\"plan_crc64\": \"x", 1));
    assert!(short.contains("expected 16 lower-case hexadecimal digits, found \"x"), "{short}");
}

#[test]
fn a_schedule_of_another_plan_is_refused_with_both_fingerprints() {
    let (plan, other) = (strip(5), strip(6));
    let schedule = Schedule::plan(&plan, &rig(""), 1).expect("a schedule");
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
    let good = Schedule::plan(&plan, &rig, 2).expect("a schedule");
    good.verify(&plan, &rig).expect("a good schedule");
    let changes: [(&str, Change); 14] = [
        ("belongs to the rig", |s| s.rig.push('2')),
        ("supply_limit_ma", |s| s.supply_limit = Milliamps(9000)),
        ("number of steps", |s| drop(s.steps.pop())),
        ("hinge should be another", |s| s.steps[1].hinge = s.steps[0].hinge),
        ("hinge should be less than 4", |s| s.steps[1].hinge = 4),
        ("rising and below", |s| s.steps[2].after = vec![2]),
        ("at most 4 steps", |s| s.steps[3].after = vec![0, 0, 1, 1, 2]),
        ("the hinge before it", |s| s.steps[2].after.clear()),
        ("start_ms should be at least", |s| s.steps[2].start = Millis(1)),
        ("channel should be", |s| s.steps[0].channel = 7),
        ("motion should be", |s| s.steps[0].motion = s.steps[3].motion),
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
    crowded.parallel = 1;
    assert!(matches!(crowded.verify(&plan, &rig), Err(VerifyError::TooManyAtOnce { found: 2, most: 1, .. })));
}

#[test]
fn hinges_that_are_no_tree_are_refused() {
    let mut ring = strip(5);
    ring.hinges[3].panels = [0, 3];
    let error = Schedule::plan(&ring, &rig(""), 1).expect_err("a ring").to_string();
    assert_eq!(error, "plan: the hinges join panel 4 to the root 0 in no way");
    let mut rootless = strip(5);
    rootless.root = 5;
    let error = Schedule::plan(&rootless, &rig(""), 1).expect_err("no root").to_string();
    assert_eq!(error, "plan: the root must be one of the 5 panels, found 5");
}

proptest! {
    #[test]
    fn every_schedule_of_a_random_tree_verifies(plan in random_tree(), parallel in 1_usize..10, amps in 2_u32..6) {
        let rig = wide_rig(plan.hinges.len(), &format!("{amps} A"));
        let schedule = Schedule::plan(&plan, &rig, parallel).expect("a schedule");
        schedule.verify(&plan, &rig).expect("a good schedule");
        prop_assert_eq!(&schedule, &Schedule::plan(&plan, &rig, parallel).expect("the same schedule"));
        let one = Schedule::plan(&plan, &rig, 1).expect("a schedule");
        prop_assert!(schedule.makespan <= one.makespan);
    }

    /// Whatever the motions really take, no more of them run at once than the lanes that were asked for.
    #[test]
    fn waiting_alone_keeps_the_number_of_motions(
        plan in random_tree(),
        parallel in 1_usize..5,
        real in prop::collection::vec(1_u64..100, 120),
    ) {
        let schedule = Schedule::plan(&plan, &wide_rig(plan.hinges.len(), "6 A"), parallel).expect("a schedule");
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
