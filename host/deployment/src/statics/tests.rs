//! Loads and margins by hand, and against sums over all panels at sampled angles.

use super::*;
use crate::motion::{Linkage, Thickness};
use crate::rig::Rig;
use crate::testing::{real_plans, rig_text};
use crate::tree::Tree;
use glam::DVec3;
use zygote_stacking::{Model, Plan, Request, Surface};

/// Newtons that a panel of 12 g weighs.
const NEWTONS: f64 = 0.012 * 9.806_65;

fn rig(extra: &str) -> Rig {
    let text =
        rig_text(&format!("[panel]\nmass = \"12 g\"\n{extra}")).replace("heaters = 16", "heaters = 160");
    Rig::read("rig.toml", &text).expect("a good rig")
}

fn down(direction: DVec3) -> String {
    format!("[gravity]\ndirection = {:?}\n", direction.to_array())
}

/// A flat strip of four panels in a row, 100 mm long, whose root lies at the bottom of the pile, and a rig for it.
fn row() -> (Plan, Rig) {
    let quads = (0..4).map(|x| [[x, 0, 0], [x + 1, 0, 0], [x + 1, 1, 0], [x, 1, 0]]).collect();
    let model = Model::new("row", Surface::new(quads, Vec::new()).expect("a surface")).expect("one piece");
    let request = Request { root: Some(0), thickness: 0.05, panel_length_mm: 100.0, ..Request::default() };
    let plan = zygote_stacking::plan(&model, &request).expect("a plan");
    // A pile may stand on its head; then so does the rig.
    let z = if plan.piles[0].panels[0] == plan.root { -1.0 } else { 1.0 };
    (plan, rig(&down(DVec3::Z * z)))
}

/// The hinges from the root out.
fn outwards(plan: &Plan) -> Vec<usize> {
    Tree::new(plan).expect("a tree").branches().iter().map(|branch| branch.hinge).collect()
}

fn near(found: f64, expected: f64) {
    assert!((found - expected).abs() < 1e-9, "{found}, expected {expected}");
}

#[test]
fn the_first_hinge_of_a_cantilever_holds_most_when_the_last_panel_is_level() {
    let (plan, rig) = row();
    let order = outwards(&plan);
    let statics = Statics::of(&plan, &rig, &order, Support::Root).expect("loads");
    let first = statics.holding[0];
    // Arms of 1/2 and 3/2, and of 2 to the last hinge, whose panel is half a thickness beside its axis.
    let arms = 0.5 + 1.5 + 2.0 + 0.5_f64.hypot(0.025);
    near(first.torque.0.abs(), arms * 0.1 * NEWTONS);
    assert_eq!((first.hinge, first.step, first.role), (order[0], 2, Role::Holding));
    near(first.factor(), arms * 0.1 * NEWTONS / 0.034);
    near(statics.bearable_mass().expect("a load").0, 12.0 / first.factor());
    // The second one holds two panels: 1/2 and 1 to the last hinge.
    near(statics.holding[1].torque.0.abs(), (arms - 2.5) * 0.1 * NEWTONS);
    assert!(first.torque.0 < 0.0, "flat, gravity opens it further");
    // The last hinge holds one panel, as it did at the end of its turn.
    near(statics.holding[2].torque.0.abs(), 0.5 * 0.1 * NEWTONS);
    assert_eq!(statics.overloads().iter().map(|load| load.hinge).collect::<Vec<_>>(), [order[0]]);
}

#[test]
fn a_turning_stack_is_heaviest_where_its_arm_is_level() {
    let (plan, rig) = row();
    let order = outwards(&plan);
    let statics = Statics::of(&plan, &rig, &order, Support::Root).expect("loads");
    // Three layers above the axis: their middle is 1/2 across and 3/2 thicknesses up, level just before the end.
    let (across, up) = (0.5_f64, 1.5 * 0.05);
    let load = statics.turning[0];
    near(load.torque.0, -3.0 * across.hypot(up) * 0.1 * NEWTONS);
    near(load.opening.0, 180.0 - up.atan2(across).to_degrees());
}

#[test]
fn a_row_tips_when_its_second_hinge_swings_two_panels_over_the_edge() {
    let (plan, rig) = row();
    let order: Vec<_> = outwards(&plan).into_iter().rev().collect();
    for support in [Support::Root, Support::Touching] {
        let tipping = Statics::of(&plan, &rig, &order, support).expect("margins").tipping;
        // Arms from the axis: of one panel 1/2, then of two panels 1 in the middle, both half a thickness up.
        let first = 0.5 - (0.5 + 0.5_f64.hypot(0.025)) / 4.0;
        let second = 0.5 - 2.0 * (0.5 + 1.0_f64.hypot(0.025)) / 4.0;
        near(tipping.margins[0].expect("it stands").0, first * 100.0);
        near(tipping.margins[1].expect("on its root").0, second * 100.0);
        assert_eq!(tipping.first(), Some(1));
        assert_eq!(tipping.least().expect("margins").0, 2);
    }
}

#[test]
fn what_leaves_the_ground_altogether_stands_on_nothing() {
    let (plan, rig) = row();
    let mut turned = rig;
    turned.gravity.direction[2] *= -1.0;
    // The root is on top now, and the first hinge takes all others away.
    let tipping = Statics::of(&plan, &turned, &outwards(&plan), Support::Touching).expect("margins").tipping;
    assert_eq!((&tipping.margins[..], tipping.first()), (&[None; 3][..], Some(0)));
}

#[test]
fn a_rating_by_angle_is_held_against_the_torque_at_its_angle() {
    let (plan, _) = row();
    let order = outwards(&plan);
    let points = [("0 deg", 0.08), ("60 deg", 0.01), ("180 deg", 0.2)];
    let table: Vec<_> =
        points.iter().map(|(angle, torque)| format!("[\"{angle}\", \"{torque} Nm\"]")).collect();
    let rig = rig(&format!("[sma]\ntorque = [{}]\n{}", table.join(", "), down(DVec3::new(0.2, 0.1, -1.0))));
    let linkage = Linkage::new(&plan, Thickness::of(&plan)).expect("joints");
    let statics = Statics::of(&plan, &rig, &order, Support::Root).expect("loads");
    let hand = |angle: f64| {
        if angle < 60.0 { 0.08 - 0.07 * angle / 60.0 } else { 0.01 + 0.19 * (angle - 60.0) / 120.0 }
    };
    for (step, load) in statics.turning.iter().enumerate() {
        near(load.rating.0, hand(load.opening.0));
        let mut worst = 0.0_f64;
        for sample in 0..=7200 {
            let fraction = f64::from(sample) / 7200.0;
            let torque = brute(
                &linkage,
                &plan,
                &rig,
                &state(&plan, &order[..step], order[step], fraction),
                order[step],
            );
            worst = worst.max(torque.abs() / hand(180.0 * fraction));
        }
        assert!(
            load.factor() > worst - 1e-6 && load.factor() < worst + 1e-4,
            "{} and {worst}",
            load.factor()
        );
    }
}

/// How far every hinge is when some are open and one is at a fraction.
fn state(plan: &Plan, open: &[usize], turning: usize, fraction: f64) -> Vec<f64> {
    let mut fractions = vec![0.0; plan.hinges.len()];
    for hinge in open {
        fractions[*hinge] = 1.0;
    }
    fractions[turning] = fraction;
    fractions
}

/// The torque on a hinge from the work that a little turn of it takes, less that of the shift along with it.
fn brute(linkage: &Linkage, plan: &Plan, rig: &Rig, fractions: &[f64], hinge: usize) -> f64 {
    const LITTLE: f64 = 1e-5;
    let weight = DVec3::from_array(rig.gravity.direction).normalize() * NEWTONS * plan.panel_length_mm * 1e-3;
    let energy = |change: f64| {
        let mut fractions = fractions.to_vec();
        fractions[hinge] += change;
        let middle = DVec3::new(0.5, 0.5, -0.5 * plan.thickness);
        let centres = linkage.poses_at(&fractions).into_iter().map(|pose| pose.transform_point3(middle));
        -centres.map(|centre| centre.dot(weight)).sum::<f64>()
    };
    let turn = linkage.turn(hinge, &linkage.poses_at(fractions));
    let work = (energy(LITTLE) - energy(-LITTLE)) / (2.0 * LITTLE * turn.angle);
    work + turn.shift.dot(weight) * linkage.moved(hinge).count() as f64
}

#[test]
fn no_sampled_sum_over_all_panels_is_beyond_the_loads_and_each_load_is_reached() {
    let rig = rig(&down(DVec3::new(0.3, -0.5, -1.0)));
    for plan in real_plans() {
        let linkage = Linkage::new(&plan, Thickness::of(&plan)).expect("joints");
        let turns = |hinge: &usize| linkage.turn_deg(*hinge) > 0.0;
        let tree: Vec<_> = outwards(&plan).into_iter().filter(turns).collect();
        let inwards: Vec<_> = tree.iter().rev().copied().collect();
        // Every third one first, then the next ones: what holds carries what turns, and the other way round.
        let mixed: Vec<_> = (0..3).flat_map(|first| tree.iter().copied().skip(first).step_by(3)).collect();
        for order in [tree, inwards, mixed] {
            let statics = Statics::of(&plan, &rig, &order, Support::Root).expect("loads");
            let at = |load: &Load| {
                let hinge = &plan.hinges[load.turning];
                let [start, end] =
                    [crate::schedule::start_opening_deg(hinge), hinge.opening_deg].map(f64::from);
                let fraction = (load.opening.0 - start) / (end - start);
                let fractions = state(&plan, &order[..load.step], load.turning, fraction);
                brute(&linkage, &plan, &rig, &fractions, load.hinge)
            };
            for load in statics.turning.iter().chain(&statics.holding) {
                assert!((at(load) - load.torque.0).abs() < 1e-8, "{load:?}, by sums {}", at(load));
            }
            for (step, hinge) in order.iter().enumerate() {
                for sample in 0..=6 {
                    let fractions = state(&plan, &order[..step], *hinge, f64::from(sample) / 6.0);
                    let torque = |hinge| brute(&linkage, &plan, &rig, &fractions, hinge).abs();
                    assert!(torque(*hinge) <= statics.turning[step].torque.0.abs() + 1e-8);
                    for (open, load) in order[..step].iter().zip(&statics.holding) {
                        assert!(torque(*open) <= load.torque.0.abs() + 1e-8, "{load:?}");
                    }
                }
            }
        }
    }
}

#[test]
fn orders_and_rigs_that_say_too_little_are_refused() {
    let (plan, rig) = row();
    let refusal = |rig: &Rig, order: &[usize]| {
        Statics::of(&plan, rig, order, Support::Root).expect_err("no loads").to_string()
    };
    let expected = "order: step 1 must open another of the 3 hinges than those before it, found ";
    assert_eq!(refusal(&rig, &[0, 0]), format!("{expected}0"));
    assert_eq!(refusal(&rig, &[0, 3]), format!("{expected}3"));
    let light = Rig::read("rig.toml", &rig_text("")).expect("a good rig");
    let expected = "rig.toml: panel.mass: expected what a panel weighs, as in mass = \"12 g\", found none";
    assert_eq!(refusal(&light, &[0]), expected);
}

#[test]
fn what_a_hinge_holds_in_the_shape_no_order_changes() {
    let rig = rig(&down(DVec3::new(0.3, -0.5, -1.0)));
    for plan in real_plans() {
        let linkage = Linkage::new(&plan, Thickness::of(&plan)).expect("joints");
        let order = outwards(&plan);
        let mut inwards = order.clone();
        inwards.reverse();
        let [out, back] = [order, inwards].map(|order| {
            let mut loads = Statics::of(&plan, &rig, &order, Support::Root).expect("loads").in_shape;
            loads.sort_by_key(|load| load.hinge);
            loads
        });
        for (load, other) in out.iter().zip(&back) {
            assert!((load.torque.0 - other.torque.0).abs() < 1e-9, "{load:?} {other:?}");
            if linkage.turn_deg(load.hinge) > 0.0 {
                // All are open but for this one, at its end.
                let by_sums = brute(&linkage, &plan, &rig, &vec![1.0; plan.hinges.len()], load.hinge);
                assert!((load.torque.0 - by_sums).abs() < 1e-8, "{load:?}, by sums {by_sums}");
            }
        }
    }
}

#[test]
fn from_the_root_outwards_every_order_has_the_same_loads_in_all_turns() {
    let rig = rig(&down(DVec3::new(0.3, -0.5, -1.0)));
    for plan in real_plans() {
        let tree = Tree::new(&plan).expect("a tree");
        let turning = |order: &[usize]| {
            let mut loads = Statics::of(&plan, &rig, order, Support::Root).expect("loads").turning;
            loads.sort_by_key(|load| load.hinge);
            loads
        };
        // By distance from the root instead of branch by branch.
        let mut depth = vec![0; plan.hinges.len()];
        for branch in tree.branches() {
            depth[branch.hinge] = branch.before.map_or(0, |before| depth[before] + 1);
        }
        let mut wide = outwards(&plan);
        wide.sort_by_key(|hinge| depth[*hinge]);
        for (load, other) in turning(&outwards(&plan)).iter().zip(&turning(&wide)) {
            assert!((load.torque.0 - other.torque.0).abs() < 1e-9, "{load:?} {other:?}");
        }
    }
}

#[test]
fn a_row_is_borne_best_from_its_middle() {
    let (plan, rig) = row();
    let (root, overloaded) = lightest_root(&plan, &rig, Support::Root).expect("loads").expect("a small plan");
    // From the end 3 panels hang on a hinge, from the middle 2.
    assert!(plan.piles[0].panels[1..3].contains(&root), "{root}");
    let at = |root| {
        let plan = Plan { root, ..plan.clone() };
        Statics::of(&plan, &rig, &outwards(&plan), Support::Root).expect("loads")
    };
    assert_eq!(at(root).overloaded().len(), overloaded);
    assert!(at(root).is_lighter_than(&at(plan.root)) && !at(plan.root).is_lighter_than(&at(root)));
}
