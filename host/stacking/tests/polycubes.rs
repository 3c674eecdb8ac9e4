//! Random solids of voxels and random open sheets: whatever is one surface gets a plan that breaks no rule.

#![allow(clippy::unwrap_used, reason = "helpers of tests fail as tests do")]

mod boundary;
mod lump;

use boundary::boundary;
use lump::solid;
use proptest::prelude::*;
use zygote_stacking::{
    Bridges, Model, Partition, PlanError, Request, Surface, SurfaceError, check, fold, plan,
};

fn request(piles: usize, seed: u64) -> Request {
    Request { piles, seed, ..Request::default() }
}

fn assert_plans(model: &Model, seed: u64, piles: &[usize]) -> Result<(), TestCaseError> {
    for k in piles.iter().filter(|k| model.surface().len().is_multiple_of(**k)) {
        let made = plan(model, &request(*k, seed)).map_err(|error| TestCaseError::fail(error.to_string()))?;
        let bytes = fold::write(&made).map_err(|error| TestCaseError::fail(error.to_string()))?;
        let report = check(&fold::parse(&bytes).map_err(|error| TestCaseError::fail(error.to_string()))?);
        prop_assert!(report.is_valid(), "K={k}: {:?}", report.lines(3));
        prop_assert_eq!(&made.target, &model.surface().quads());
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn random_solids_stack_into_one_two_and_four_piles(
        choices in prop::collection::vec((0..1000usize, 0..6usize), 0..40),
        seed in any::<u64>(),
    ) {
        let surface = Surface::new(boundary(&solid(&choices)), Vec::new()).unwrap();
        match Model::new("polycube", surface) {
            // Voxels that enclose a cavity or touch along edges only have several surfaces: refused, and rightly so.
            Err(error) => prop_assert!(matches!(error, SurfaceError::Pieces { .. }), "{}", error),
            Ok(model) => assert_plans(&model, seed, &[1, 2, 4])?,
        }
    }

    #[test]
    fn either_way_of_making_piles_breaks_no_rule_and_gives_the_same_plan_again(
        choices in prop::collection::vec((0..1000usize, 0..6usize), 0..40),
        seed in any::<u64>(),
        partition in prop::sample::select(vec![Partition::MinCut, Partition::Arcs]),
        bridges in prop::sample::select(vec![Bridges::Least, Bridges::Most]),
        piles in prop::sample::select(vec![2usize, 3, 4, 6]),
    ) {
        let surface = Surface::new(boundary(&solid(&choices)), Vec::new()).unwrap();
        if let Ok(model) = Model::new("polycube", surface) && model.surface().len().is_multiple_of(piles) {
            let request = Request { partition, bridges, ..request(piles, seed) };
            match plan(&model, &request) {
                Err(error) => {
                    let known = matches!(error, PlanError::NoMatch(_) | PlanError::NoLayout { .. });
                    prop_assert!(known, "{}", error);
                }
                Ok(made) => {
                    let report = check(&fold::parse(&fold::write(&made).unwrap()).unwrap());
                    prop_assert!(report.is_valid(), "K={piles}: {:?}", report.lines(3));
                    prop_assert_eq!(report.figures.bridges, piles - 1 + report.figures.breaks);
                    prop_assert!(bridges == Bridges::Most || report.figures.breaks == 0);
                    prop_assert_eq!(made, plan(&model, &request).unwrap());
                }
            }
        }
    }

    #[test]
    fn random_solids_less_one_panel_are_open_sheets_that_stack_too(
        choices in prop::collection::vec((0..1000usize, 0..6usize), 0..30),
        gone in any::<prop::sample::Index>(),
        seed in any::<u64>(),
    ) {
        let mut quads = boundary(&solid(&choices));
        quads.remove(gone.index(quads.len()));
        let surface = Surface::new(quads, Vec::new()).unwrap();
        match Model::new("sheet", surface) {
            // Where two sheets touch, a panel less leaves three at an edge.
            Err(error) => {
                let known = matches!(error, SurfaceError::Pieces { .. } | SurfaceError::Crossing { .. });
                prop_assert!(known, "{}", error);
            }
            Ok(model) => assert_plans(&model, seed, &[1])?,
        }
    }
}

#[test]
fn flat_sheets_of_every_small_size_stack() {
    for (width, depth) in (1..=7).flat_map(|width| (1..=7).map(move |depth| (width, depth))) {
        let squares = (0..width).flat_map(|x| (0..depth).map(move |y| (x, y)));
        let quads =
            squares.map(|(x, y)| [[x, y, 0], [x + 1, y, 0], [x + 1, y + 1, 0], [x, y + 1, 0]]).collect();
        let model = Model::new("sheet", Surface::new(quads, Vec::new()).unwrap()).unwrap();
        for k in [1, 2].into_iter().filter(|k| model.surface().len().is_multiple_of(*k)) {
            let made: Result<_, PlanError> = plan(&model, &request(k, 0));
            let bytes =
                fold::write(&made.unwrap_or_else(|e| panic!("{width} x {depth}, K={k}: {e}"))).unwrap();
            assert!(check(&fold::parse(&bytes).unwrap()).is_valid(), "{width} x {depth}, K={k}");
        }
    }
}
