//! What waits for what: whatever the order leaves open must be free.

use super::dense::{meet, random_plan};
use super::{below, edges_may_touch, from_the_root, model_plan};
use crate::motion::{Effort, Linkage, MotionError, Options, Thickness, check, search, waits_for};
use crate::order::Order;
use crate::testing::real_plans;
use crate::tree::Tree;
use glam::DAffine3;
use std::collections::BTreeSet;
use std::path::Path;
use zygote_stacking::{Bridges, Model, Plan, Request, Surface};

/// A plan with an order that is free one by one, and the waits of it.
struct Case {
    name: String,
    plan: Plan,
    plates: Thickness,
    order: Order,
}

fn case(name: String, mut plan: Plan, plates: Thickness) -> Option<Case> {
    let effort = Effort { other_roots: 6, backward: 1, looks: 2_000 };
    let found = search(&plan, plates, None, &effort, &mut |_, _| ()).expect("plates");
    plan.root = found.root;
    let report = check(&plan, &found.hinges, plates, &Options::default()).expect("plates");
    let order = waits_for(&plan, &found.hinges, plates).expect("an order");
    report.is_free().then_some(Case { name, plan, plates, order })
}

fn ideal(name: &str, piles: usize, bridges: Bridges) -> Case {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../models").join(name);
    let model = Model::read(&path, None).expect("a model");
    let plan = zygote_stacking::plan(&model, &Request { piles, bridges, ..Request::default() });
    let plan = plan.expect("a plan");
    let plates = Thickness::ideal(&plan);
    case(format!("{name} in {piles}"), plan, plates).expect("a free order")
}

fn cases() -> Vec<Case> {
    let mut cases: Vec<_> = ["i14.txt", "l14.txt", "fish92.txt"]
        .into_iter()
        .flat_map(|name| [1, 2].map(|piles| ideal(name, piles, Bridges::Least)))
        .collect();
    cases.push(ideal("vehicle92.txt", 4, Bridges::Base));
    for seed in 0..4 {
        for piles in [1, 2] {
            let Some(plan) = random_plan(seed, piles) else { continue };
            for plates in [Thickness::ideal(&plan), edges_may_touch()] {
                cases.extend(case(format!("solid {seed} in {piles}"), plan.clone(), plates));
            }
        }
    }
    assert!(cases.len() > 12, "{}", cases.len());
    cases
}

/// Of every hinge all that is before it, directly or not.
fn all_before(order: &Order) -> Vec<BTreeSet<usize>> {
    let mut all = vec![BTreeSet::new(); order.hinges.len()];
    for hinge in &order.hinges {
        let direct = &order.waits_for[*hinge];
        let through: Vec<_> = direct.iter().flat_map(|other: &usize| all[*other].clone()).collect();
        all[*hinge].extend(through.into_iter().chain(direct.iter().copied()));
    }
    all
}

/// Hinges that aren't open, and wait for none that isn't.
fn ready(order: &Order, open: &[bool]) -> Vec<usize> {
    (0..open.len())
        .filter(|hinge| !open[*hinge] && order.waits_for[*hinge].iter().all(|other| open[*other]))
        .collect()
}

#[test]
fn both_ends_of_a_strip_open_on_their_own_from_its_middle() {
    let quads = (0..9).map(|x| [[x, 0, 0], [x + 1, 0, 0], [x + 1, 1, 0], [x, 1, 0]]).collect();
    let model = Model::new("strip", Surface::new(quads, (1..=9).collect()).expect("a sheet")).expect("one");
    let mut plan = zygote_stacking::plan(&model, &Request::default()).expect("a plan");
    plan.root = plan.piles[0].panels[4];
    for plates in [Thickness::ideal(&plan), edges_may_touch()] {
        let order = waits_for(&plan, &from_the_root(&plan), plates).expect("an order");
        assert_eq!(order, Order::of_tree(&Tree::new(&plan).expect("a tree")));
        assert_eq!(ready(&order, &[false; 8]).len(), 2);
    }
}

#[test]
fn a_hinge_that_moves_another_keeps_its_place_before_or_behind_it() {
    for plan in real_plans() {
        // Any order, also from the tips inwards.
        let mut hinges = from_the_root(&plan);
        for _ in 0..2 {
            let order = waits_for(&plan, &hinges, edges_may_touch()).expect("an order");
            let (before, place) =
                (all_before(&order), |hinge| hinges.iter().position(|other| *other == hinge));
            let linkage = Linkage::new(&plan, edges_may_touch()).expect("plates");
            for a in 0..hinges.len() {
                for b in (0..hinges.len()).filter(|b| *b != a && linkage.moves(a, linkage.child(*b))) {
                    let (first, last) = if place(a) < place(b) { (a, b) } else { (b, a) };
                    assert!(before[last].contains(&first), "hinges {a} and {b}");
                }
            }
            hinges.reverse();
        }
    }
}

#[test]
fn no_wait_follows_from_others() {
    for Case { name, order, .. } in cases() {
        let before = all_before(&order);
        for (hinge, direct) in order.waits_for.iter().enumerate() {
            assert!(direct.is_sorted());
            for other in direct {
                assert!(!direct.iter().any(|third| before[*third].contains(other)), "{name}: {hinge}");
            }
        }
    }
}

#[test]
fn hinges_may_open_one_by_one_in_any_order_that_keeps_the_waits() {
    let mut seed = 11;
    let mut others = 0;
    for Case { name, plan, plates, order } in cases() {
        for _ in 0..12 {
            let mut open = vec![false; order.hinges.len()];
            let mut hinges = Vec::new();
            while let ready = ready(&order, &open)
                && !ready.is_empty()
            {
                let next = ready[below(&mut seed, ready.len())];
                open[next] = true;
                hinges.push(next);
            }
            others += usize::from(hinges != order.hinges);
            let report = check(&plan, &hinges, plates, &Options::default()).expect("plates");
            assert!(report.is_free(), "{name}: {:?} {:?}", report.collisions, report.order_errors);
        }
    }
    assert!(others > 50, "{others} orders unlike the first");
}

#[test]
fn hinges_that_wait_for_nothing_may_stand_at_any_angles_at_once() {
    let mut seed = 5;
    let (mut states, mut together) = (0, 0);
    for Case { name, plan, plates, order } in cases() {
        let linkage = Linkage::new(&plan, plates).expect("plates");
        for _ in 0..40 {
            // As far as chance goes, then all that may turn does.
            let mut open = vec![false; order.hinges.len()];
            for _ in 0..below(&mut seed, order.hinges.len()) {
                let ready = ready(&order, &open);
                open[ready[below(&mut seed, ready.len())]] = true;
            }
            let ready = ready(&order, &open);
            for _ in 0..4 {
                let mut fractions: Vec<_> = open.iter().map(|open| f64::from(u8::from(*open))).collect();
                for hinge in &ready {
                    fractions[*hinge] = below(&mut seed, 1001) as f64 / 1000.0;
                }
                let poses = linkage.poses_at(&fractions);
                for (a, pose) in poses.iter().enumerate() {
                    for (b, other) in poses.iter().enumerate().skip(a + 1) {
                        assert!(
                            !meet(pose, other, plates),
                            "{name}: panels {a} and {b}, {ready:?} at {fractions:?}"
                        );
                    }
                }
                states += 1;
                together += usize::from(ready.len() > 1);
            }
        }
    }
    assert!(together * 2 > states, "{together} of {states} with more than one");
}

/// Whether samples of what two hinges move, as the order has it, meet: at any two of their angles.
fn legs_meet(case: &Case, linkage: &Linkage, hinges: [usize; 2]) -> bool {
    let [first, second] = hinges.map(|hinge| {
        let moved: Vec<usize> = linkage.moved(hinge).collect();
        let mut fractions = vec![0.0; case.order.hinges.len()];
        for earlier in case.order.hinges.iter().take_while(|other| **other != hinge) {
            fractions[*earlier] = 1.0;
        }
        let pose = |sample: u32| {
            fractions[hinge] = f64::from(sample) / 24.0;
            let poses = linkage.poses_at(&fractions);
            moved.iter().map(|panel| poses[*panel]).collect::<Vec<DAffine3>>()
        };
        (0..=24).map(pose).collect::<Vec<_>>()
    });
    first.iter().flatten().any(|a| second.iter().flatten().any(|b| meet(a, b, case.plates)))
}

#[test]
fn legs_that_meet_keep_their_order_and_few_others_do() {
    let (mut ordered, mut meeting, mut free) = (0, 0, 0);
    for case in cases().into_iter().filter(|case| case.plan.panels() < 30) {
        let linkage = Linkage::new(&case.plan, case.plates).expect("plates");
        let before = all_before(&case.order);
        for (place, later) in case.order.hinges.iter().enumerate() {
            for earlier in &case.order.hinges[..place] {
                let moves = |a: usize, b: usize| linkage.moves(a, linkage.child(b));
                if moves(*earlier, *later) || moves(*later, *earlier) {
                    continue;
                }
                let meets = legs_meet(&case, &linkage, [*earlier, *later]);
                if !before[*later].contains(earlier) {
                    assert!(!meets, "{}: hinges {earlier} and {later} meet", case.name);
                    free += 1;
                } else if case.order.waits_for[*later].contains(earlier) {
                    ordered += 1;
                    meeting += usize::from(meets);
                }
            }
        }
    }
    println!("{free} pairs free, {ordered} wait, of which {meeting} meet in samples");
    assert!(free > 100 && meeting > 10, "{free} {meeting}");
    assert!(meeting * 4 >= ordered * 3, "{meeting} of {ordered}");
}

#[test]
fn an_order_that_lacks_repeats_or_invents_hinges_is_refused() {
    let plan = model_plan("l14.txt", 1);
    let hinges = from_the_root(&plan);
    let refused = |hinges: &[usize]| waits_for(&plan, hinges, edges_may_touch()).expect_err("no order");
    assert_eq!(refused(&hinges[1..]), MotionError::Order { hinge: hinges[0], found: 0 });
    assert_eq!(
        refused(&[&hinges[..], &hinges[..1]].concat()),
        MotionError::Order { hinge: hinges[0], found: 2 }
    );
    assert_eq!(refused(&[99]), MotionError::NoHinge { found: 99, hinges: 13 });
}
