//! Coded sequences: what is printed is read back, and makes the same zygote and the same target again.

#![expect(clippy::unwrap_used, reason = "a model that cannot be read or planned fails the test")]

use std::path::PathBuf;
use zygote_stacking::{Model, Plan, Request, Sequence, SequenceText, check, fold};

fn planned(name: &str, piles: usize) -> Plan {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../models").join(name);
    let model = Model::read(&path, None).unwrap();
    let request = Request { piles, seed: 3, ..Request::default() };
    zygote_stacking::plan(&model, &request).unwrap()
}

type Vector = [i32; 3];

fn minus(a: Vector, b: Vector) -> Vector {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

/// Two vectors along the sides of a panel that lie on S and W in the zygote, and its outer normal: a frame that doesn't
/// depend on how the corners are numbered.
fn frame(plan: &Plan, panel: usize, cell: [i32; 2]) -> (Vector, [Vector; 3]) {
    let at = |x: i32, y: i32| {
        let corner = [cell[0] + x, cell[1] + y];
        let index = plan.zygote[panel].iter().position(|point| *point == corner).unwrap();
        plan.target[panel][index]
    };
    let (origin, x, y) = (at(0, 0), at(1, 0), at(0, 1));
    let (u, v) = (minus(x, origin), minus(y, origin));
    let cross = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
    (origin, [u, v, cross])
}

/// Every panel's frame, by cell and height, seen from the frame of the first pile's bottom panel.
fn shape(plan: &Plan) -> Vec<(Vector, [Vector; 3])> {
    let first = &plan.piles[0];
    let (origin, axes) = frame(plan, first.panels[0], first.cell);
    let seen = |v: Vector| axes.map(|axis| (0..3).map(|c| axis[c] * v[c]).sum());
    let piles = plan.piles.iter();
    let places = piles.flat_map(|pile| pile.panels.iter().map(|panel| (*panel, pile.cell)));
    places
        .map(|(panel, cell)| {
            let (at, directions) = frame(plan, panel, cell);
            (seen(minus(at, origin)), directions.map(seen))
        })
        .collect()
}

#[test]
fn a_printed_sequence_is_read_back_and_makes_the_same_zygote_and_target() {
    for (name, piles) in [
        ("cube6.txt", 1),
        ("i14.txt", 2),
        ("diagonal24.txt", 2),
        ("torus32.txt", 4),
        ("sheet12.obj", 4),
        ("fish92.txt", 2),
        ("fish144.txt", 4),
        ("fish4000.txt", 5),
    ] {
        let plan = planned(name, piles);
        let sequence = Sequence::of(&plan);
        let text = sequence.to_string();
        assert_eq!(text.lines().count(), piles, "{name}: a line a pile");
        let read = SequenceText::parse(&text).unwrap();
        assert_eq!(read.sequence, sequence, "{name}");
        assert_eq!(read.differences(&sequence), [], "{name}");
        let built = read.build(name, plan.thickness, plan.panel_length_mm);
        let report = check(&fold::parse(&fold::write(&built).unwrap()).unwrap());
        assert!(report.is_valid(), "{name}: {:?}", report.lines(2));
        assert_eq!(Sequence::of(&built), sequence, "{name}");
        assert_eq!(shape(&built), shape(&plan), "{name}");
        assert_eq!((built.hinges.len(), built.grid()), (plan.hinges.len(), plan.grid()), "{name}");
    }
}

#[test]
fn comments_blank_lines_spaces_and_the_order_of_lines_do_not_count() {
    let plan = planned("i14.txt", 2);
    let sequence = Sequence::of(&plan);
    let printed = sequence.to_string();
    let mut lines: Vec<&str> = printed.lines().collect();
    lines.reverse();
    let text = format!("# an I of three voxels\n\n  {}  \n\n{}\n", lines[0].replace(' ', "   "), lines[1]);
    assert_eq!(SequenceText::parse(&text).unwrap().differences(&sequence), []);
}

#[test]
fn a_sequence_without_a_fixed_panel_gets_the_middle_of_its_tree() {
    let text = SequenceText::parse("(0,0): E180 W180 E180 W180 .").unwrap();
    assert_eq!(text.build("strip", 0.01, 90.0).root, 2);
}

#[test]
fn what_a_text_says_otherwise_than_the_plan_is_told_with_its_place() {
    let plan = SequenceText::parse("(0,0): E180 *[N90]W180 .\n(0,1): W90 [S90]E270 .").unwrap().sequence;
    let typed = SequenceText::parse("(0,0): E180 [N90]S180 .\n(0,1): W270 [S90]E270 .").unwrap();
    let told: Vec<String> = typed.differences(&plan).iter().map(ToString::to_string).collect();
    assert_eq!(
        told,
        [
            "line 1, column 13: pile (0,0), height 1: expected [N90]W180, found [N90]S180",
            "line 2, column 8: pile (0,1), height 0: expected W90, found W270",
        ]
    );
}

#[track_caller]
fn assert_refused(text: &str, told: &str) {
    let error = SequenceText::parse(text).unwrap_err().to_string();
    assert!(error.starts_with(told), "{text:?}: expected {told:?}, found {error:?}");
}

#[test]
fn a_text_that_is_no_sequence_is_refused_with_line_and_column() {
    assert_refused("", "line 1, column 1: no pile");
    assert_refused("# nothing\n\n", "line 2, column 1: no pile");
    assert_refused("E90 .", "line 1, column 1: expected a cell such as");
    assert_refused("(0;0): .", "line 1, column 3: expected `,`");
    assert_refused("(0,x): .", "line 1, column 4: expected a whole number, found `x):`");
    assert_refused("(0,99999999999): .", "line 1, column 4: expected a whole number");
    assert_refused("(0,0) .", "line 1, column 6: expected `:`");
    assert_refused("# two\n(0,0): E90 n90 .", "line 2, column 12: expected a side E, N, W or S");
    assert_refused("(0,0): E45 .", "line 1, column 8: expected a side E, N, W or S with an angle");
    assert_refused("(0,0): E90W90 .", "line 1, column 11: expected a blank between panels, found `W90`");
    assert_refused("(0,0): [N90E90 .", "line 1, column 12: expected `]`");
    assert_refused("(0,0): E90 . W90", "line 1, column 14: the last panel of a pile");
    assert_refused("(0,0): E90 W90", "line 1, column 15: the last panel of a pile");
    assert_refused("(0,0): E90é .", "line 1, column 11: expected a blank between panels, found `é`");
}

#[test]
fn hinges_that_make_no_tree_are_refused_with_the_panel() {
    assert_refused("(0,0): E90 E90 .", "line 1, column 12: two hinges on side E of the panel at height 1");
    assert_refused("(0,0): E90 / W90 .", "line 1, column 14: no way over hinges");
    assert_refused(
        "(0,0): *E90 *.",
        "line 1, column 13: a second panel that stays fixed (`*`); the first is at line 1, column 8",
    );
    assert_refused(
        "(0,0): .\n(0,0): .",
        "line 2, column 1: a second pile on cell (0,0); the first is on line 1",
    );
    assert_refused("(0,0): E90 .\n(1,0): .", "line 2, column 1: a pile of 1 panels, expected 2");
    assert_refused("(0,0): [E180].", "line 1, column 8: a bridge to cell (1,0), where no pile stands");
    assert_refused(
        "(0,0): [E180].\n(1,0): [W90].",
        "line 1, column 8: a bridge E180 to cell (1,0), which has none such",
    );
    assert_refused(
        "(0,0): [E180].\n(1,0): .",
        "line 1, column 8: a bridge E180 to cell (1,0), which has none such",
    );
    assert_refused(
        "(0,0): [E180]N90 [E180].\n(1,0): [W180]N90 [W180].",
        "line 1, column 18: a hinge closes a loop",
    );
    assert_refused("(0,0): S90 .\n(1,0): N90 .", "line 2, column 8: no way over hinges");
}
