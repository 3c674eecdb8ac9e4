//! `zygote net` as a user meets it.

mod scratch;

use scratch::{Scratch, model};

#[test]
fn a_sheet_lies_flat_without_overlaps() {
    let place = Scratch::new("net_sheet");
    assert_eq!(place.zygote(&["plan", &model("sheet12.obj"), "--piles", "4", "-o", "sheet.fold"]).code, 0);
    let run = place.zygote(&["net", "sheet.fold"]);
    assert_eq!(run.code, 0, "{}", run.errors);
    assert_eq!(
        run.output,
        "sheet.fold: flattened, 144 panels take 12 x 12\nno two panels overlap: the net can be cut from one sheet\n"
    );
}

#[test]
fn overlapping_panels_are_counted_and_drawn_with_their_number() {
    let place = Scratch::new("net_ring");
    // Four sides round one corner: the fifth panel of the net lies on the first, but in space it stands apart.
    place.write("s.seq", "(0,0): E270 N180 E180 N270 W180 .\n");
    let run = place.zygote(&["sequence", "--parse", "s.seq", "-o", "s.fold"]);
    assert_eq!(run.code, 0, "{}", run.errors);
    let run = place.zygote(&["net", "s.fold", "--svg", "net.svg"]);
    assert_eq!(run.code, 0, "{}", run.errors);
    assert!(
        run.output.contains("in 1 pairs: 1 of one pile, 0 of two piles; at most 2 panels"),
        "{}",
        run.output
    );
    let svg = place.read("net.svg");
    assert!(svg.contains("2 of 6 panels overlap: 1 pairs of one pile, 0 of two"), "{svg}");
    assert_eq!(svg.matches("class=\"mark\"").count(), 1, "{svg}");
}

#[test]
fn what_is_no_plan_is_refused_and_no_picture_drawn() {
    let place = Scratch::new("net_refused");
    place.write("list.fold", "[]");
    assert_eq!(place.zygote(&["net", "list.fold", "--svg", "net.svg"]).code, 2);
    assert_eq!(place.files(), ["list.fold"]);
}
