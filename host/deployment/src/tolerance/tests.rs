//! The propagation held against closed forms, brute force and the samples.

use super::*;
use crate::kinematics::Kinematics;
use crate::testing::real_plans;
use glam::DAffine3;
use std::collections::BTreeSet;

const ERRORS: HingeErrors = HingeErrors { angle_rad: 0.002, offset: 0.0005 };

/// A flat strip of panels in a row, its root at one end.
fn row(panels: i32) -> Plan {
    let quads = (0..panels).map(|x| [[x, 0, 0], [x + 1, 0, 0], [x + 1, 1, 0], [x, 1, 0]]).collect();
    let model = Model::new("row", Surface::new(quads, Vec::new()).expect("a surface")).expect("one piece");
    let request = Request { root: Some(0), thickness: 0.05, ..Request::default() };
    zygote_stacking::plan(&model, &request).expect("a plan")
}

#[test]
fn first_order_is_the_closed_form_of_a_straight_strip() {
    let tolerance = Tolerance::of(&row(40), ERRORS, 0, 0).expect("a plan");
    assert_eq!((tolerance.depth, tolerance.cut_edges), (39, 0));
    for (m, rms) in tolerance.panel_rms.iter().enumerate() {
        // The m hinges before panel m are 1/2, 3/2, ... from its centre: their squares sum to m (4 m^2 - 1) / 12.
        let m = m as f64;
        let arms = m * (4.0 * m * m - 1.0) / 12.0;
        let exact = (ERRORS.angle_rad.powi(2) * arms + 3.0 * m * ERRORS.offset.powi(2)).sqrt();
        assert!((rms - exact).abs() < 1e-12, "panel {m}: {rms}, expected {exact}");
    }
}

#[test]
fn samples_of_small_errors_agree_with_first_order() {
    for plan in real_plans().into_iter().chain([row(12)]) {
        let name = &plan.source.model;
        let tolerance = Tolerance::of(&plan, ERRORS, 4000, 7).expect("a plan");
        for (what, spread) in [("panels", tolerance.panels), ("gaps", tolerance.gaps)] {
            let off = (spread.rms - spread.first_order_rms).abs();
            assert!(off <= 0.03 * spread.first_order_rms, "{name}, {what}: {spread:?}");
            assert!(spread.median <= spread.percentile_95 && spread.percentile_95 <= spread.greatest);
        }
        let first = Tolerance::of(&plan, ERRORS, 0, 0).expect("a plan");
        for (panel, (sampled, exact)) in tolerance.panel_rms.iter().zip(&first.panel_rms).enumerate() {
            assert!((sampled - exact).abs() <= 0.05 * exact, "{name}, panel {panel}: {sampled}, {exact}");
        }
    }
}

#[test]
fn a_gap_comes_from_the_hinges_between_its_two_panels_and_no_others() {
    for plan in real_plans() {
        let chain = Chain::new(&plan, &Tree::new(&plan).expect("a tree"));
        let cut_edges = plan.cut_edges().expect("a surface");
        assert_eq!(
            cut_edges.len(),
            2 * plan.panels() - plan.hinges.len(),
            "closed: every side has a neighbour"
        );
        let gaps = first_order::propagate(&chain, &cut_edges, ERRORS).gaps;
        let way = |mut panel: usize| {
            let mut way = BTreeSet::new();
            while let Some(joint) = chain.joints.iter().position(|joint| joint.child == panel) {
                way.insert(joint);
                panel = chain.joints[joint].parent;
            }
            way
        };
        for (cut_edge, gap) in cut_edges.iter().zip(gaps) {
            let [p, q] = cut_edge.panels.map(way);
            let squares = p.symmetric_difference(&q).map(|joint| {
                let joint = &chain.joints[*joint];
                let arm = |end: DVec3| joint.axis.cross(end - joint.anchor).length_squared();
                let arms: f64 = chain.ends(cut_edge).map(arm).iter().sum();
                ERRORS.angle_rad.powi(2) * arms / 2.0 + 3.0 * ERRORS.offset.powi(2)
            });
            let exact: f64 = squares.sum();
            assert!((gap - exact).abs() < 1e-15, "{cut_edge:?}: {gap}, expected {exact}");
        }
    }
}

#[test]
fn an_error_of_an_angle_moves_panels_as_kinematics_does() {
    const OFF: f64 = 0.3;
    for plan in real_plans() {
        let kinematics = Kinematics::new(&plan).expect("a tree");
        let tree = Tree::new(&plan).expect("a tree");
        let chain = Chain::new(&plan, &tree);
        for (number, branch) in tree.branches().iter().enumerate() {
            let hinge = &plan.hinges[branch.hinge];
            let turn = f64::from(hinge.zygote_angle_deg - hinge.target_angle_deg).to_radians();
            if turn == 0.0 {
                continue;
            }
            let mut fractions = vec![1.0; plan.hinges.len()];
            fractions[branch.hinge] += OFF / turn;
            let joint = &chain.joints[number];
            let motion = DAffine3::from_translation(joint.anchor)
                * DAffine3::from_axis_angle(joint.axis, OFF)
                * DAffine3::from_translation(-joint.anchor);
            let expected = kinematics.corners(&fractions, 0.0)[branch.child]
                .map(|corner| kinematics.target_from_zygote().transform_point3(corner));
            let moved = chain.corners[branch.child].map(|corner| motion.transform_point3(corner));
            let off = expected.iter().zip(moved).map(|(a, b)| a.distance(b)).fold(0.0, f64::max);
            assert!(off < 1e-9, "{}, hinge {}: {off}", plan.source.model, branch.hinge);
        }
    }
}

#[test]
fn the_same_seed_gives_the_same_numbers_and_exact_hinges_no_error() {
    let plan = row(5);
    let sampled = |seed| Tolerance::of(&plan, ERRORS, 50, seed).expect("a plan");
    assert_eq!(sampled(1), sampled(1));
    assert_ne!(sampled(1), sampled(2));
    let exact = HingeErrors { angle_rad: 0.0, offset: 0.0 };
    let tolerance = Tolerance::of(&plan, exact, 50, 1).expect("a plan");
    assert_eq!((tolerance.panels, tolerance.gaps), (Spread::default(), Spread::default()));
}

#[test]
fn percentiles_are_those_of_the_samples_within_a_thousandth() {
    let mut histogram = histogram::Histogram::default();
    for value in 1..=1000 {
        histogram.add(f64::from(value) * 1e-4);
    }
    let spread = histogram.spread();
    assert!((spread.median / 0.05 - 1.0).abs() < 2e-3, "{spread:?}");
    assert!((spread.percentile_95 / 0.095 - 1.0).abs() < 2e-3, "{spread:?}");
    assert!((spread.greatest - 0.1).abs() < 1e-12, "{spread:?}");
}
