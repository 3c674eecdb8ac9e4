//! Poses, extents, verdicts. What must collide where is worked out by hand in `by_hand`; `dense` compares with sampling; `waits` has what may move at once.

mod by_hand;
mod dense;
mod waits;

use super::{Body, Cuboid, Interval, Linkage, Motion, Options, OrderError, Thickness, Turn, check};
use crate::testing::real_plans;
use crate::tree::Tree;
use glam::{DAffine3, DQuat, DVec3, EulerRot};
use proptest::prelude::*;
use std::path::Path;
use zygote_stacking::{HingeKind, Model, Plan, Request};

const THICK: f64 = 0.05;
const SAME: f64 = 1e-9;

fn edges_may_touch() -> Thickness {
    Thickness { thickness: THICK, rim: THICK }
}

fn model_plan(name: &str, piles: usize) -> Plan {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../models").join(name);
    let model = Model::read(&path, None).expect("a model");
    zygote_stacking::plan(&model, &Request { piles, ..Request::default() }).expect("a plan")
}

fn from_the_root(plan: &Plan) -> Vec<usize> {
    Tree::new(plan).expect("a tree").branches().iter().map(|branch| branch.hinge).collect()
}

/// Pseudo-random numbers below a limit (a linear congruential generator).
fn below(state: &mut u64, limit: usize) -> usize {
    *state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
    (*state >> 33) as usize % limit
}

fn same(a: &[DAffine3], b: &[DAffine3]) -> bool {
    a.len() == b.len() && a.iter().zip(b).all(|(a, b)| a.abs_diff_eq(*b, SAME))
}

#[test]
fn closed_plates_fill_their_piles_layer_by_layer() {
    for plan in real_plans() {
        let poses = Linkage::new(&plan, edges_may_touch()).expect("plates").poses_at(&[]);
        for (panel, (_, height)) in plan.places().into_iter().enumerate() {
            let middle = poses[panel].transform_point3(DVec3::new(0.5, 0.5, -0.5 * THICK));
            assert!((middle.z - (height as f64 + 0.5) * THICK).abs() < SAME, "panel {panel}: {}", middle.z);
            for (corner, [x, y]) in plan.zygote[panel].iter().enumerate() {
                let own = [DVec3::ZERO, DVec3::X, DVec3::X + DVec3::Y, DVec3::Y][corner];
                let at = poses[panel].transform_point3(own);
                assert!((at.x - f64::from(*x)).hypot(at.y - f64::from(*y)) < SAME);
            }
        }
    }
}

#[test]
fn open_plates_have_their_outer_faces_on_the_squares_of_the_target() {
    for plan in real_plans() {
        let linkage = Linkage::new(&plan, edges_may_touch()).expect("plates");
        let poses = linkage.poses_at(&vec![1.0; plan.hinges.len()]);
        let target =
            |panel: usize, corner: usize| DVec3::from_array(plan.target[panel][corner].map(f64::from));
        for panel in 0..plan.panels() {
            for corner in 0..4 {
                let own = [DVec3::ZERO, DVec3::X, DVec3::X + DVec3::Y, DVec3::Y];
                let at = poses[panel].transform_point3(own[corner]);
                // Distances to three corners of the root fix a point up to a mirror image.
                for (seen_from, from) in own[..3].iter().enumerate() {
                    let root = poses[plan.root].transform_point3(*from);
                    let expected = target(panel, corner).distance(target(plan.root, seen_from));
                    assert!((at.distance(root) - expected).abs() < SAME, "panel {panel}");
                }
            }
        }
    }
}

#[test]
fn hinges_stretch_by_the_corners_that_inner_faces_miss_and_by_nothing_else() {
    let mut stretched = 0;
    for plan in real_plans() {
        let linkage = Linkage::new(&plan, edges_may_touch()).expect("plates");
        let places = plan.places();
        for (number, hinge) in plan.hinges.iter().enumerate() {
            let odd = hinge.kind == HingeKind::Fold && places[hinge.panels[0]].1 % 2 == 1;
            let expected = if odd && hinge.opening_deg != 180 { THICK * 2_f64.sqrt() } else { 0.0 };
            assert!(
                (linkage.stretch(number) - expected).abs() < SAME,
                "{}: hinge {number}",
                plan.source.model
            );
            stretched += usize::from(expected > 0.0);
        }
    }
    assert!(stretched > 0);
}

#[test]
fn a_turn_with_its_stretch_goes_from_the_closed_pose_to_the_open_one() {
    for plan in real_plans() {
        let linkage = Linkage::new(&plan, edges_may_touch()).expect("plates");
        for hinge in 0..plan.hinges.len() {
            let fractions = |fraction: f64| {
                let mut all = vec![0.0; plan.hinges.len()];
                all[hinge] = fraction;
                linkage.poses_at(&all)
            };
            for (near, end) in [(1e-12, 0.0), (1.0 - 1e-12, 1.0)] {
                assert!(same(&fractions(near), &fractions(end)), "hinge {hinge} at {end}");
            }
        }
    }
}

#[test]
fn hinges_opened_and_closed_in_any_order_leave_every_panel_where_their_state_says() {
    let mut seed = 7;
    for plan in real_plans() {
        let mut motion = Motion::new(&plan, edges_may_touch(), None).expect("plates");
        for _ in 0..100 {
            let hinge = below(&mut seed, plan.hinges.len());
            if motion.is_open(hinge) {
                motion.close(hinge);
            } else {
                motion.open(hinge);
            }
            let fractions: Vec<_> =
                (0..plan.hinges.len()).map(|hinge| f64::from(u8::from(motion.is_open(hinge)))).collect();
            assert!(same(motion.poses(), &motion.linkage().poses_at(&fractions)));
        }
    }
}

#[test]
fn a_single_strip_opens_from_the_root_without_a_collision() {
    for name in ["i14.txt", "l14.txt", "fish92.txt"] {
        let plan = model_plan(name, 1);
        let order = from_the_root(&plan);
        let report = check(&plan, &order, Thickness::ideal(&plan), &Options::default()).expect("plates");
        assert!(report.is_free(), "{name}: {:?}", report.collisions);
        assert!(report.clearance > 0.0, "{name}: {}", report.clearance);
        assert!(report.panel_pairs >= report.box_pairs);
        let mut motion = Motion::new(&plan, Thickness::ideal(&plan), None).expect("plates");
        for hinge in order {
            motion.try_open(hinge).expect("what is checked as free");
        }
    }
}

#[test]
fn an_order_that_leaves_out_repeats_or_invents_hinges_is_told_so() {
    let plan = model_plan("l14.txt", 1);
    let mut order = from_the_root(&plan);
    let last = order.pop().expect("a hinge");
    order.extend([order[0], 99]);
    let report = check(&plan, &order, Thickness::ideal(&plan), &Options::default()).expect("plates");
    assert!(!report.is_free());
    let expected = [
        OrderError::Twice { step: 12, hinge: order[0] },
        OrderError::Unknown { step: 13, hinge: 99 },
        OrderError::Missing { hinge: last },
    ];
    assert_eq!(report.order_errors, expected);
}

#[test]
fn plates_that_cannot_be_are_refused() {
    let plan = model_plan("l14.txt", 1);
    for (thickness, rim, message) in [
        (0.0, 0.0, "thickness 0 panel lengths, expected a finite number above 0"),
        (f64::NAN, 0.0, "thickness NaN panel lengths, expected a finite number above 0"),
        (0.1, 0.5, "rim 0.5 panel lengths, expected 0 to less than 0.5"),
    ] {
        let error = Motion::new(&plan, Thickness { thickness, rim }, None).expect_err(message);
        assert_eq!(error.to_string(), message);
    }
    let mut torn = plan;
    let panel = torn.piles[0].panels.pop().expect("a panel");
    let error = Linkage::new(&torn, edges_may_touch()).expect_err("a panel in no pile");
    assert_eq!(error.to_string(), format!("plan: panel {panel} must lie in exactly one pile, found 0"));
}

fn vector(size: f64) -> impl Strategy<Value = DVec3> {
    (-size..size, -size..size, -size..size).prop_map(DVec3::from)
}

fn turned(angles: DVec3) -> DQuat {
    DQuat::from_euler(EulerRot::XYZ, angles.x, angles.y, angles.z)
}

proptest! {
    #[test]
    fn extents_over_an_interval_are_those_of_all_angles_in_it(
        (centre, half, attitude) in (vector(3.0), vector(1.0), vector(3.0)),
        (anchor, axis, stretch, still_stretch) in (vector(2.0), vector(3.0), vector(0.5), any::<bool>()),
        (from, width, towards) in (0.0..4.7, 1e-6..1.57, vector(3.0)),
    ) {
        let half = [DVec3::X * half.x, DVec3::Y * half.y, DVec3::Z * half.z].map(|edge| turned(attitude) * edge);
        let stretch = if still_stretch { DVec3::ZERO } else { stretch };
        let turn = Turn::new(anchor, turned(axis) * DVec3::Z, 4.7, stretch);
        let body = Body::turning(Cuboid { centre, half }, &turn);
        let direction = turned(towards) * DVec3::Z;
        let [low, high] = body.extent(direction, &Interval::new(from, from + width));
        let (mut least, mut greatest) = (f64::INFINITY, f64::NEG_INFINITY);
        for sample in 0..=400 {
            let angle = from + width * f64::from(sample) / 400.0;
            for corner in 0..8 {
                let sign = |bit: u32| if corner >> bit & 1 == 0 { 1.0 } else { -1.0 };
                let start = centre + half[0] * sign(0) + half[1] * sign(1) + half[2] * sign(2);
                let spun = DQuat::from_axis_angle(turn.axis, angle) * (start - anchor);
                let at = (anchor + spun + stretch * (angle / 4.7)).dot(direction);
                least = least.min(at);
                greatest = greatest.max(at);
            }
        }
        prop_assert!(low <= least + SAME && high >= greatest - SAME, "{low} {least} {high} {greatest}");
        // Between samples a coordinate rises by no more than its bend allows: arms of 10 at most.
        let step: f64 = width / 400.0;
        let missed = 10.0 * step * step;
        prop_assert!(low >= least - missed - SAME && high <= greatest + missed + SAME);
    }
}
