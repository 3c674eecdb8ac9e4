//! Piles around a flat base: the bridges lie in one plane at one height, and the plan breaks no rule.

#![allow(clippy::unwrap_used, reason = "helpers of tests fail as tests do")]

use std::collections::BTreeSet;
use std::path::PathBuf;
use zygote_stacking::{Bridges, HingeKind, Model, Plan, PlanError, Request, check, fold, plan};

fn model(name: &str) -> Model {
    Model::read(&PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../models").join(name), None).unwrap()
}

fn on_base(name: &str, piles: usize) -> Result<Plan, PlanError> {
    plan(&model(name), &Request { piles, bridges: Bridges::Base, ..Request::default() })
}

fn assert_base(plan: &Plan) {
    let report = check(&fold::parse(&fold::write(plan).unwrap()).unwrap());
    assert!(report.is_valid(), "{:?}", report.lines(3));
    let places = plan.places();
    let bridges = || plan.hinges.iter().filter(|hinge| hinge.kind == HingeKind::Bridge);
    assert_eq!(bridges().count() + 1, plan.piles.len());
    assert!(bridges().all(|bridge| bridge.opening_deg == 180), "a bridge that moves");
    let base: BTreeSet<usize> = bridges().flat_map(|bridge| bridge.panels).collect();
    assert_eq!(base.len(), plan.piles.len(), "one panel a pile");
    let heights: BTreeSet<usize> = base.iter().map(|panel| places[*panel].1).collect();
    assert_eq!(heights.len(), 1, "heights {heights:?}");
}

#[test]
fn small_models_stack_in_two_and_four_piles_around_a_base() {
    for name in ["fish92.txt", "vehicle92.txt", "airplane92.txt", "fish144.txt"] {
        for piles in [2, 4] {
            assert_base(&on_base(name, piles).unwrap_or_else(|error| panic!("{name} K={piles}: {error}")));
        }
    }
}

#[test]
fn four_thousand_panels_stack_in_four_piles_around_a_base() {
    for name in ["fish4000.txt", "bird4000.txt", "vehicle4000.txt"] {
        assert_base(&on_base(name, 4).unwrap_or_else(|error| panic!("{name}: {error}")));
    }
}

#[test]
fn a_shape_without_a_flat_patch_of_that_size_is_refused_and_says_so() {
    let Err(error) = on_base("l14.txt", 7) else { panic!("seven panels in one plane of an L") };
    assert!(error.to_string().contains("no flat base for 7 piles found: 0 flat patches"), "{error}");
}
