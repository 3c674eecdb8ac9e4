//! Nets: hinged panels lie side by side, and what lies on each other is counted.

#![expect(clippy::unwrap_used, reason = "a model that cannot be read or planned fails the test")]

use std::path::PathBuf;
use zygote_stacking::{Model, Net, NetPlan, Overlaps, Plan, Request, SequenceText, fold, plan_with_net};

fn model(name: &str) -> Model {
    Model::read(&PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../models").join(name), None).unwrap()
}

fn request(piles: usize, seed: u64) -> Request {
    Request { piles, seed, ..Request::default() }
}

fn planned(name: &str, piles: usize) -> Plan {
    zygote_stacking::plan(&model(name), &request(piles, 0)).unwrap()
}

#[test]
fn a_flat_sheet_is_its_own_net() {
    let plan = planned("sheet12.obj", 4);
    let net = Net::of(&plan);
    assert_eq!(net.bounds(), [12, 12]);
    assert_eq!(net.overlaps(&plan), Overlaps { panels: 0, pairs: 0, pairs_in_a_pile: 0, most: 1 });
}

#[test]
fn hinged_panels_share_their_edge_in_the_net_and_every_square_is_one() {
    for (name, piles) in [("fish92.txt", 2), ("torus32.txt", 4), ("diagonal24.txt", 2)] {
        let plan = planned(name, piles);
        let net = Net::of(&plan);
        for hinge in &plan.hinges {
            let [p, q] = hinge.panels.map(|panel| net.squares[panel]);
            let [e, f] = hinge.edges;
            assert_eq!((p[e], p[(e + 1) % 4]), (q[(f + 1) % 4], q[f]), "{name}");
        }
        for square in &net.squares {
            let doubled_area: i32 = (0..4)
                .map(|i| square[i][0] * square[(i + 1) % 4][1] - square[(i + 1) % 4][0] * square[i][1])
                .sum();
            assert_eq!(doubled_area, 2, "{name}: counter-clockwise, not mirrored");
        }
        let on_squares = net.on_squares();
        assert_eq!(on_squares.values().map(Vec::len).sum::<usize>(), plan.panels());
    }
}

#[test]
fn panels_on_one_square_are_counted_as_panels_and_as_pairs_by_pile() {
    // Flat sides that turn the same way four times: E, N, W, S follow each other, so the strip goes round in a ring. The folding
    // map mirrors each panel, which is why the sides read as they do.
    let strip = |text: &str| SequenceText::parse(text).unwrap().build("strip", 0.01, 90.0);
    let ring = strip("(0,0): E90 N90 E90 N90 .");
    let overlaps = Net::of(&ring).overlaps(&ring);
    assert_eq!(overlaps, Overlaps { panels: 2, pairs: 1, pairs_in_a_pile: 1, most: 2 });
    // Twice and a little round: squares with two and three panels.
    let twice = strip("(0,0): E90 N90 E90 N90 E90 N90 E90 N90 .");
    let overlaps = Net::of(&twice).overlaps(&twice);
    assert_eq!(overlaps, Overlaps { panels: 9, pairs: 3 + 3, pairs_in_a_pile: 6, most: 3 });
    // Two piles side by side: the first one's top turns over to where the second one goes on.
    let crossing = strip("(0,0): S90 [E180]N90 E90 .\n(1,0): S90 [W180]N90 E90 .");
    let overlaps = Net::of(&crossing).overlaps(&crossing);
    assert_eq!(overlaps, Overlaps { panels: 2, pairs: 1, pairs_in_a_pile: 0, most: 2 });
}

#[test]
fn small_shapes_have_a_net_without_overlaps_in_one_pile_and_in_several() {
    let shapes = [
        ("cube6.txt", [1, 2, 3]),
        ("i14.txt", [1, 2, 7]),
        ("l14.txt", [1, 2, 7]),
        ("diagonal24.txt", [1, 2, 4]),
        ("torus32.txt", [1, 2, 4]),
        ("fish92.txt", [1, 2, 4]),
        ("airplane92.txt", [1, 2, 4]),
        ("vehicle92.txt", [1, 2, 4]),
        ("fish144.txt", [1, 3, 4]),
    ];
    for (name, numbers) in shapes {
        for piles in numbers {
            for seed in [0, 1] {
                let NetPlan { plan, overlaps, starts, .. } =
                    plan_with_net(&model(name), &request(piles, seed)).unwrap();
                let told = format!("{name} in {piles} piles, seed {seed}");
                assert!(starts > 0, "{told}");
                assert_eq!(plan.piles.len(), piles, "{told}");
                assert!(fold::check(&fold::write(&plan).unwrap()).unwrap().is_valid(), "{told}");
                assert_eq!((overlaps.pairs, overlaps), (0, Net::of(&plan).overlaps(&plan)), "{told}");
            }
        }
    }
}

#[test]
fn the_same_seed_finds_the_same_net() {
    let plan = || plan_with_net(&model("fish92.txt"), &request(4, 3)).unwrap().plan;
    assert_eq!(plan(), plan());
}
