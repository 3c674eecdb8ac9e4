//! Nets: hinged panels lie side by side, and what lies on each other is counted.

#![expect(clippy::unwrap_used, reason = "a model that cannot be read or planned fails the test")]

use std::path::PathBuf;
use zygote_stacking::{Model, Net, Overlaps, Plan, Request, SequenceText};

fn planned(name: &str, piles: usize) -> Plan {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../models").join(name);
    let model = Model::read(&path, None).unwrap();
    let request = Request { piles, ..Request::default() };
    zygote_stacking::plan(&model, &request).unwrap()
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
