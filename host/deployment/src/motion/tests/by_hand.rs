//! Plans of a few panels where geometry on paper tells what collides, and at what angle.

use super::{THICK, edges_may_touch};
use crate::Kinematics;
use crate::motion::{Ground, Motion, Obstacle, Options, check};
use crate::testing::strip;
use zygote_stacking::{Hinge, HingeKind, Pile, Plan, Side};

/// Piles on neighbouring cells from west to east, of `height` panels each: panel `pile * height + h`. The target is what
/// the hinges make of them.
fn piles(number: usize, height: usize, hinges: Vec<Hinge>) -> Plan {
    let mut plan = strip(number * height);
    for panel in 0..number * height {
        let x = i32::try_from(panel / height).expect("few");
        plan.zygote[panel] = if (panel % height).is_multiple_of(2) {
            [[x, 0], [x + 1, 0], [x + 1, 1], [x, 1]]
        } else {
            [[x, 0], [x, 1], [x + 1, 1], [x + 1, 0]]
        };
    }
    plan.piles = (0..number)
        .map(|pile| Pile {
            cell: [i32::try_from(pile).expect("few"), 0],
            panels: (pile * height..(pile + 1) * height).collect(),
        })
        .collect();
    plan.hinges = hinges;
    plan.root = 0;
    let open = vec![1.0; plan.hinges.len()];
    #[expect(clippy::cast_possible_truncation, reason = "rounded to the lattice")]
    let target = Kinematics::new(&plan)
        .expect("a tree")
        .corners(&open, 0.0)
        .into_iter()
        .map(|corners| corners.map(|at| at.to_array().map(|coordinate| coordinate.round() as i32)));
    plan.target = target.collect();
    plan
}

/// The edge of a panel at a height that is on a side of its cell.
fn edge(height: usize, side: Side) -> usize {
    let quarters = side as usize;
    if height.is_multiple_of(2) { (quarters + 1) % 4 } else { (2 + 4 - quarters) % 4 }
}

/// A fold between a panel at a height and the one above it.
fn fold(lower: usize, height: usize, side: Side, target_angle_deg: i16) -> Hinge {
    Hinge {
        kind: HingeKind::Fold,
        panels: [lower, lower + 1],
        edges: [edge(height, side), edge(height + 1, side)],
        side,
        opening_deg: 180,
        zygote_angle_deg: if height.is_multiple_of(2) { 180 } else { -180 },
        target_angle_deg,
    }
}

/// A bridge from a panel to that in the pile east of it.
fn bridge(panels: [usize; 2], height: usize, target_angle_deg: i16) -> Hinge {
    Hinge {
        kind: HingeKind::Bridge,
        panels,
        edges: [edge(height, Side::E), edge(height, Side::W)],
        side: Side::E,
        opening_deg: 180,
        zygote_angle_deg: 0,
        target_angle_deg,
    }
}

#[test]
fn a_layer_laid_flat_onto_the_neighbouring_pile_hits_its_bottom_panel() {
    // P0 (0) below P1 (1) in the west, Q0 (2) below Q1 (3) in the east. Q1 opens flat to the east, then P1 to the east,
    // onto Q0's place. About the edge, P1's core starts with a corner one thickness off and one up: 45 degrees above the
    // plane of Q0's top face. It reaches that plane after 135 degrees, at 1.41 thicknesses from the edge, where Q0's core is.
    let hinges = vec![fold(0, 0, Side::E, 0), bridge([0, 2], 0, 0), fold(2, 0, Side::E, 0)];
    let plan = piles(2, 2, hinges);
    let report = check(&plan, &[2, 0], edges_may_touch(), &Options::default()).expect("plates");
    let [(1, found)] = report.collisions[..] else { panic!("{:?}", report.collisions) };
    assert_eq!((found.hinge, found.panel, found.obstacle), (0, 1, Obstacle::Panel(2)));
    // A 50,000th of a thickness deep still is touching: a thousandth of a degree more.
    assert!(found.from_deg <= 135.001 && found.to_deg >= 135.0, "{found}");
    assert!(found.to_deg - found.from_deg < 0.1, "{found}");
    // In the end it lies in Q0's place.
    assert!((found.depth - THICK).abs() < 1e-9, "{found}");
    assert!(report.order_errors.is_empty() && !report.is_free());

    let mut motion = Motion::new(&plan, edges_may_touch(), None).expect("plates");
    motion.try_open(2).expect("nothing in the way");
    let seen = motion.try_open(0).expect_err("Q0 in the way");
    assert_eq!((seen.hinge, seen.panel, seen.obstacle), (0, 1, Obstacle::Panel(2)));
    assert!(seen.to_deg > 135.0 && !motion.is_open(0), "{seen}");
}

#[test]
fn a_panel_cannot_leave_a_stack_from_between_two_others() {
    // B (0, 1, 2) in the west is a strip; each panel of A (3, 4, 5) in the east hangs on its neighbour. Panel 4 turns up or
    // down out of the middle. Outer sides are down at that height: +90 leads down.
    for (turn, hit) in [(90, 3), (-90, 5)] {
        let hinges = vec![
            fold(0, 0, Side::N, 0),
            fold(1, 1, Side::S, 0),
            bridge([0, 3], 0, 0),
            bridge([1, 4], 1, turn),
            bridge([2, 5], 2, 0),
        ];
        let plan = piles(2, 3, hinges);
        let motion = Motion::new(&plan, edges_may_touch(), None).expect("plates");
        let found = motion.blocked(3).expect("a collision");
        assert_eq!((found.panel, found.obstacle), (4, Obstacle::Panel(hit)), "{found}");
        let report = check(&plan, &[3], edges_may_touch(), &Options::default()).expect("plates");
        let first = report.collisions[0].1;
        assert_eq!((first.panel, first.obstacle), (4, Obstacle::Panel(hit)), "{first}");
        assert!(first.to_deg < 0.1, "{first}");
    }
}

#[test]
fn layers_that_open_away_from_each_other_go_together_and_those_that_cross_do_not() {
    for (west, east, together) in [(Side::W, Side::E, true), (Side::E, Side::W, false)] {
        let hinges = vec![fold(0, 0, west, 0), bridge([0, 2], 0, 0), fold(2, 0, east, 0)];
        let motion = Motion::new(&piles(2, 2, hinges), edges_may_touch(), None).expect("plates");
        assert_eq!(motion.together(0, 2), together);
        assert!(!motion.together(1, 2), "the bridge carries hinge 2");
    }
}

#[test]
fn a_layer_may_lie_down_on_the_table_but_not_turn_below_it() {
    let table = Options { ground: Some(Ground::TABLE) };
    let flat = piles(1, 2, vec![fold(0, 0, Side::E, 0)]);
    let report = check(&flat, &[0], edges_may_touch(), &table).expect("plates");
    assert!(report.is_free(), "{:?}", report.collisions);
    // By 270 degrees it hangs from an edge one thickness above the table, its far corner a diagonal away.
    let below = piles(1, 2, vec![fold(0, 0, Side::E, -90)]);
    let report = check(&below, &[0], edges_may_touch(), &table).expect("plates");
    let [(0, found)] = report.collisions[..] else { panic!("{:?}", report.collisions) };
    assert_eq!((found.panel, found.obstacle), (1, Obstacle::Ground));
    assert!(found.from_deg <= 180.0 + 1e-6 && found.to_deg > 180.0 && found.to_deg < 180.1, "{found}");
    assert!((found.depth - ((1.0 - THICK).hypot(THICK) - THICK)).abs() < 1e-9, "{found}");
    assert!(check(&below, &[0], edges_may_touch(), &Options::default()).expect("plates").is_free());
}

#[test]
fn a_ground_without_a_direction_is_refused() {
    let plan = piles(1, 2, vec![fold(0, 0, Side::E, 0)]);
    let ground = Some(Ground { normal: glam::DVec3::ZERO });
    let error = Motion::new(&plan, edges_may_touch(), ground).expect_err("no direction");
    assert!(error.to_string().starts_with("ground: its normal must be"), "{error}");
}
