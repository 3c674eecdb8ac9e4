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

#[test]
fn a_plan_with_net_can_be_cut_from_one_sheet() {
    let place = Scratch::new("net_search");
    for piles in ["1", "4"] {
        let run = place.zygote(&["plan", &model("fish92.txt"), "--piles", piles, "--net", "-o", "fish.fold"]);
        assert_eq!(run.code, 0, "{}", run.errors);
        assert!(run.output.contains("net: no two panels overlap ("), "{}", run.output);
        let run = place.zygote(&["net", "fish.fold"]);
        assert!(
            run.output.ends_with("no two panels overlap: the net can be cut from one sheet\n"),
            "{}",
            run.output
        );
        assert_eq!(place.zygote(&["check", "fish.fold"]).code, 0);
    }
}

#[test]
fn where_no_net_is_found_the_number_of_overlaps_is_told() {
    let place = Scratch::new("net_not_found");
    // The arcs of a strip make a row of 46 cells that runs into itself wherever it was cut.
    let run = place.zygote(&["plan", &model("fish92.txt"), "--piles", "46", "--net", "-o", "fish.fold"]);
    assert_eq!(run.code, 0, "{}", run.errors);
    assert!(run.output.contains("net: none without overlaps was found (256 strips and "), "{}", run.output);
    assert!(run.output.contains("46 piles of one found no room side by side"), "{}", run.output);
    let net = place.zygote(&["net", "fish.fold"]).output;
    let pairs = |text: &str, before: &str, after: &str| -> Option<usize> {
        text.split_once(before)?.1.split_once(after)?.0.parse().ok()
    };
    let told = pairs(&run.output, "of those tried: ", " pairs of panels");
    assert!(told.is_some_and(|pairs| pairs > 0), "{}", run.output);
    assert_eq!(told, pairs(&net, "panels overlap, in ", " pairs:"), "{net}");
}
