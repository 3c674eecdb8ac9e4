//! Reconfiguration: what the list says, done to the first plan's hinges, gives the second plan's.

#![expect(clippy::unwrap_used, reason = "a model that cannot be read or planned fails the test")]

use std::collections::BTreeMap;
use std::path::PathBuf;
use zygote_stacking::{
    Action, Counts, Hinge, HingeKind, Like, LikeError, Model, Plan, Reconfiguration, ReconfigureError,
    Request, SequenceText, Side, fold, plan_like,
};

fn planned(name: &str, piles: usize, seed: u64) -> Plan {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../models").join(name);
    let model = Model::read(&path, None).unwrap();
    // Plans compare on the same cells only.
    let grid = (piles == 4).then_some([2, 2]);
    let request = Request { piles, seed, grid, ..Request::default() };
    zygote_stacking::plan(&model, &request).unwrap()
}

/// Every hinge as it is mounted: cell, height, across which side of it, opening.
type Mounting = BTreeMap<([i32; 2], usize, &'static str), (Side, u16)>;

fn mountings(plan: &Plan) -> Mounting {
    let places = plan.places();
    let mounting = |hinge: &Hinge| {
        let ends = hinge.panels.map(|panel| (plan.piles[places[panel].0].cell, places[panel].1));
        match hinge.kind {
            HingeKind::Fold => ((ends[0].0, ends[0].1, "fold"), (hinge.side, hinge.opening_deg)),
            HingeKind::Bridge => {
                let (cell, height) = ends[0].min(ends[1]);
                let side = if cell == ends[0].0 { hinge.side } else { hinge.side.opposite() };
                ((cell, height, side.letter()), (side, hinge.opening_deg))
            }
        }
    };
    plan.hinges.iter().map(mounting).collect()
}

fn done(first: &Plan, way: &Reconfiguration) -> Mounting {
    let mut moved = first.clone();
    let height = first.height();
    for pile in &mut moved.piles {
        pile.cell = way.motion.cell(pile.cell);
        if way.motion.height(0) != 0 {
            pile.panels.reverse();
        }
    }
    for hinge in &mut moved.hinges {
        hinge.side = way.motion.side(hinge.side);
        if hinge.kind == HingeKind::Fold && way.motion.height(0) != 0 {
            hinge.panels.reverse();
        }
    }
    assert_eq!(moved.height(), height);
    let mut hinges = mountings(&moved);
    for (slot, action) in &way.actions {
        let name = match slot.kind {
            zygote_stacking::SlotKind::Fold => "fold",
            zygote_stacking::SlotKind::Bridge(side) => side.letter(),
        };
        let key = (slot.cell, slot.height, name);
        match action {
            Action::Keep(mounted) => assert_eq!(hinges[&key], (mounted.side, mounted.opening_deg)),
            Action::Turn { from, to } | Action::Move { from, to } => {
                assert_eq!(
                    hinges.insert(key, (to.side, to.opening_deg)),
                    Some((from.side, from.opening_deg))
                );
            }
            Action::Remove(from) => {
                assert_eq!(hinges.remove(&key), Some((from.side, from.opening_deg)));
            }
            Action::Add(to) => assert_eq!(hinges.insert(key, (to.side, to.opening_deg)), None),
        }
    }
    hinges
}

#[test]
fn the_list_done_to_the_first_plan_gives_the_second() {
    for (first, second, piles) in [
        ("fish92.txt", "vehicle92.txt", 2),
        ("vehicle92.txt", "airplane92.txt", 4),
        ("fish144.txt", "sheet12.obj", 4),
        ("i14.txt", "l14.txt", 2),
    ] {
        let (first, second) = (planned(first, piles, 0), planned(second, piles, 5));
        let way = Reconfiguration::between(&first, &second).unwrap();
        assert_eq!(done(&first, &way), mountings(&second), "{} {}", first.source.model, second.source.model);
        let Counts { kept, turned, moved, removed, added } = way.counts;
        assert_eq!(kept + turned + moved + removed, first.hinges.len());
        assert_eq!(removed, added);
    }
}

#[test]
fn a_plan_becomes_itself_by_keeping_everything_as_it_stands() {
    let plan = planned("fish144.txt", 4, 2);
    let way = Reconfiguration::between(&plan, &plan).unwrap();
    assert_eq!(way.counts, Counts { kept: 143, ..Counts::default() });
    assert_eq!(way.motion.to_string(), "as it stands");
}

fn sequence(text: &str) -> Plan {
    SequenceText::parse(text).unwrap().build("by hand", 0.01, 90.0)
}

#[test]
fn a_stack_that_stands_turned_or_upside_down_is_turned_back_rather_than_rebuilt() {
    // An L of three cells with a bridge each way, two panels high.
    let first = sequence("(0,0): [E180]S270 [N90].\n(1,0): [W180]E90 .\n(0,1): W180 [S90].");
    // The same a quarter turn counter-clockwise and elsewhere: E becomes N, N becomes W.
    let turned = sequence("(5,5): [N180]E270 [W90].\n(5,6): [S180]N90 .\n(4,5): S180 [E90].");
    let way = Reconfiguration::between(&first, &turned).unwrap();
    assert_eq!(way.counts, Counts { kept: 5, ..Counts::default() });
    assert_eq!(way.motion.to_string(), "a quarter turn counter-clockwise");
    // The same upside down about the x axis: heights change places, N becomes S.
    let over = sequence("(0,0): [S90]N270 [E180].\n(1,0): E90 [W180].\n(0,-1): [N90]W180 .");
    let way = Reconfiguration::between(&first, &over).unwrap();
    assert_eq!(way.counts, Counts { kept: 5, ..Counts::default() });
    assert_eq!(way.motion.to_string(), "upside down about its x axis");
    assert_eq!(done(&first, &way), mountings(&over));
}

#[test]
fn an_odd_number_of_panels_is_not_turned_upside_down() {
    let first = sequence("(0,0): E90 N270 .");
    let over = sequence("(0,0): S270 E90 .");
    let way = Reconfiguration::between(&first, &over).unwrap();
    assert!(way.counts.kept < 2, "{:?}", way.counts);
    assert!(!way.motion.to_string().contains("upside down"));
}

#[test]
fn every_action_is_told_apart() {
    let first = sequence("(0,0): E90 N270 [E180]W180 S90 .\n(1,0): E90 N270 [W180]E180 N90 .");
    let second = sequence("(0,0): E90 N180 [E180]S180 W90 .\n(1,0): E90 N270 [W180]E180 N90 .");
    let way = Reconfiguration::between(&first, &second).unwrap();
    assert_eq!(way.counts, Counts { kept: 6, turned: 1, moved: 2, removed: 0, added: 0 });
    let broken = sequence("(0,0): E90 N270 [E180]W180 [E90]S90 .\n(1,0): E90 N270 [W180]/ [W90]N90 .");
    let way = Reconfiguration::between(&first, &broken).unwrap();
    assert_eq!(way.counts, Counts { kept: 8, turned: 0, moved: 0, removed: 1, added: 1 });
}

#[test]
fn stacks_of_another_form_are_refused_with_both() {
    let fish = planned("fish92.txt", 2, 0);
    let told = |second: &Plan| Reconfiguration::between(&fish, second).unwrap_err().to_string();
    assert_eq!(
        told(&planned("i14.txt", 2, 0)),
        "92 panels in the first plan and 14 in the second, expected as many"
    );
    assert_eq!(
        told(&planned("vehicle92.txt", 4, 0)),
        "2 piles in the first plan and 4 in the second, expected as many"
    );
    let row = sequence("(0,0): [E180].\n(1,0): [W180][E180].\n(2,0): [W180].");
    let corner = sequence("(0,0): [E180][N180].\n(1,0): [W180].\n(0,1): [S180].");
    assert_eq!(
        Reconfiguration::between(&row, &corner).unwrap_err().to_string(),
        "no turn brings the cells (0,0) (1,0) (2,0) of the first plan to the cells (0,0) (0,1) (1,0) of the second"
    );
}

fn like(name: &str, other: &Plan, seed: u64) -> Result<Like, LikeError> {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../models").join(name);
    let piles = other.piles.len();
    let request = Request { piles, seed, ..Request::default() };
    plan_like(&Model::read(&path, None).unwrap(), &request, other)
}

#[test]
fn a_plan_like_another_is_valid_and_moves_fewer_hinges_than_any_that_was_compared() {
    for (name, piles) in [("airplane92.txt", 2), ("vehicle92.txt", 4), ("airplane92.txt", 1)] {
        let fish = planned("fish92.txt", piles, 0);
        let Like { plan, way, tried, moved, changes } = like(name, &fish, 0).unwrap();
        let told = format!("{name} in {piles} piles");
        assert!(fold::check(&fold::write(&plan).unwrap()).unwrap().is_valid(), "{told}");
        assert_eq!(way, Reconfiguration::between(&fish, &plan).unwrap(), "{told}");
        assert!(tried > 8 && changes > 1000 && moved.len() > 1 && moved.is_sorted(), "{told}: {moved:?}");
        assert!(way.counts.effort().0 < moved[0], "{told}: {:?}, compared {moved:?}", way.counts);
        let [mut panels, mut all]: [Vec<usize>; 2] =
            [plan.piles.iter().flat_map(|pile| pile.panels.clone()).collect(), (0..92).collect()];
        panels.sort_unstable();
        all.dedup();
        assert_eq!(panels, all, "{told}");
    }
}

#[test]
fn a_shape_like_itself_comes_close_to_no_move_at_all() {
    let cube = planned("cube6.txt", 1, 0);
    assert_eq!(like("cube6.txt", &cube, 7).unwrap().way.counts.effort(), (0, 0));
    let fish = planned("fish92.txt", 2, 0);
    let itself = like("fish92.txt", &fish, 0).unwrap();
    assert_eq!((itself.way.counts.kept, itself.moved[0]), (91, 0), "the same seed gives the same plan");
}

#[test]
fn stacks_that_no_plan_of_the_shape_can_be_are_told() {
    let fish = planned("fish92.txt", 4, 0);
    assert!(matches!(like("fish144.txt", &fish, 0), Err(LikeError::Stack(ReconfigureError::Panels { .. }))));
    // Nine cells of which no two have a side in common.
    let mut row = planned("fish144.txt", 9, 0);
    for (pile, at) in row.piles.iter_mut().zip(0..) {
        pile.cell = [at, at];
    }
    let error = like("fish144.txt", &row, 0).unwrap_err();
    assert!(matches!(error, LikeError::Cells { .. }), "{error}");
    assert!(error.to_string().contains("plans has its piles on the cells (0,0) (1,1)"), "{error}");
}
