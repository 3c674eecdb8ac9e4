//! Piles from parts with few edges between them: numbers of piles, bridges, grids.

#![allow(clippy::unwrap_used, reason = "helpers of tests fail as tests do")]

use std::path::PathBuf;
use zygote_stacking::{
    Bridges, Figures, Model, Partition, Plan, PlanError, Quality, Request, Surface, check, fold, plan,
    quality,
};

fn model(name: &str) -> Model {
    Model::read(&PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../models").join(name), None).unwrap()
}

fn by_parts(piles: usize) -> Request {
    Request { piles, partition: Partition::MinCut, ..Request::default() }
}

/// The figures of a plan that breaks no rule.
fn figures(plan: &Plan) -> Figures {
    let report = check(&fold::parse(&fold::write(plan).unwrap()).unwrap());
    assert!(report.is_valid(), "K={}: {:?}", plan.piles.len(), report.lines(3));
    report.figures
}

#[test]
fn four_thousand_panels_stack_into_any_number_of_piles_with_more_bridges_than_needed() {
    for name in ["fish4000.txt", "bird4000.txt", "vehicle4000.txt"] {
        let model = model(name);
        for piles in [2, 4, 8, 10, 16, 20, 40] {
            let made = plan(&model, &Request { piles, ..Request::default() }).unwrap();
            let figures = figures(&made);
            assert_eq!(made.piles.len(), piles);
            assert!(figures.bridges > piles, "{name} K={piles}: {} bridges", figures.bridges);
            assert_eq!(figures.bridges, piles - 1 + figures.breaks, "{name} K={piles}");
            let Quality { bridges, bridge_bound, cut, beside, beside_bound, .. } = quality(&model, &made);
            assert!(bridges <= bridge_bound && bridge_bound <= beside, "{name} K={piles}");
            assert!(beside <= beside_bound && beside <= cut, "{name} K={piles}");
        }
    }
}

#[test]
fn the_fish_in_four_piles_has_a_short_cut_and_many_bridges() {
    let model = model("fish4000.txt");
    let most = plan(&model, &by_parts(4)).unwrap();
    let Quality { bridges, cut, .. } = quality(&model, &most);
    assert!(bridges >= 17, "{bridges}");
    // KaHIP's strong mode cuts 176 edges.
    assert!(cut <= 193, "{cut}");
    let least = plan(&model, &Request { bridges: Bridges::Least, ..by_parts(4) }).unwrap();
    let Figures { bridges, breaks, .. } = figures(&least);
    assert_eq!((bridges, breaks), (3, 0));
}

#[test]
fn parts_cut_fewer_edges_than_arcs() {
    let model = model("torus32.txt");
    let [parts, arcs] = [Partition::MinCut, Partition::Arcs]
        .map(|partition| quality(&model, &plan(&model, &Request { partition, ..by_parts(4) }).unwrap()));
    assert!(parts.cut < arcs.cut, "{parts:?} {arcs:?}");
}

#[test]
fn arcs_take_as_many_bridges_as_fit_or_as_few_as_do() {
    let model = model("vehicle92.txt");
    let arcs = |bridges| Request { partition: Partition::Arcs, bridges, ..by_parts(4) };
    let [most, least] =
        [Bridges::Most, Bridges::Least].map(|bridges| figures(&plan(&model, &arcs(bridges)).unwrap()));
    assert!(most.bridges > 3, "{}", most.bridges);
    assert_eq!((least.bridges, least.breaks), (3, 0));
}

#[test]
fn a_grid_that_is_given_is_kept_to_and_one_too_small_is_refused() {
    let model = model("fish144.txt");
    for partition in [Partition::MinCut, Partition::Arcs, Partition::Auto] {
        for grid in [[2, 2], [4, 1], [1, 4], [3, 2]] {
            let request = Request { partition, grid: Some(grid), ..by_parts(4) };
            let made =
                plan(&model, &request).unwrap_or_else(|error| panic!("{partition:?} {grid:?}: {error}"));
            figures(&made);
            assert!(made.piles.iter().all(|pile| {
                (0..2).all(|axis| (0..grid[axis]).contains(&usize::try_from(pile.cell[axis]).unwrap()))
            }));
        }
        let error = plan(&model, &Request { partition, grid: Some([3, 1]), ..by_parts(4) }).unwrap_err();
        assert_eq!(error.to_string(), "a grid of 3 x 1 cells, expected room for 4 piles");
    }
}

#[test]
fn parts_that_do_not_match_end_in_an_error_that_says_what_was_tried() {
    // A ribbon of six panels: the middle part meets both others at one side of its cell.
    let quads = (0..6).map(|x| [[x, 0, 0], [x + 1, 0, 0], [x + 1, 1, 0], [x, 1, 0]]).collect();
    let ribbon = Model::new("ribbon", Surface::new(quads, Vec::new()).unwrap()).unwrap();
    let error = plan(&ribbon, &by_parts(3)).unwrap_err();
    assert!(matches!(error, PlanError::NoMatch(_)));
    assert!(error.to_string().starts_with("no 3 parts that match found: tried 6 partitions"), "{error}");
}
