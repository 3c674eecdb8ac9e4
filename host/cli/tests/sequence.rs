//! `zygote sequence` as a user meets it: printed, written, compared, read back.

mod scratch;

use scratch::{Scratch, model};

fn planned(name: &str, shape: &str, piles: &str) -> Scratch {
    let place = Scratch::new(name);
    let run = place.zygote(&["plan", &model(shape), "--piles", piles, "-o", "plan.fold"]);
    assert_eq!(run.code, 0, "{}", run.errors);
    place
}

#[test]
fn a_sequence_is_printed_with_a_line_a_pile_and_a_word_a_panel() {
    let place = planned("sequence_print", "fish92.txt", "4");
    let run = place.zygote(&["sequence", "plan.fold"]);
    assert_eq!(run.code, 0, "{}", run.errors);
    assert_eq!(run.output.lines().count(), 4);
    for line in run.output.lines() {
        assert_eq!(line.split(' ').count(), 1 + 23, "{line}");
        assert!(line.starts_with('(') && line.ends_with('.'), "{line}");
    }
    let plan = place.read("plan.fold");
    let bridges = plan.matches("\"bridge\"").count();
    assert!(bridges >= 3, "{bridges}");
    assert_eq!(run.output.matches('[').count(), 2 * bridges, "bridges are told at both ends: {}", run.output);
    assert_eq!(run.output.matches('*').count(), 1, "{}", run.output);
}

#[test]
fn a_sequence_that_was_written_makes_a_valid_plan_with_the_same_sequence() {
    let place = planned("sequence_back", "torus32.txt", "4");
    assert_eq!(place.zygote(&["sequence", "plan.fold", "-o", "torus.seq"]).code, 0);
    let run = place.zygote(&["sequence", "--parse", "torus.seq", "-o", "back.fold", "--thickness", "0.05"]);
    assert_eq!(run.code, 0, "{}", run.errors);
    assert!(run.output.starts_with("back.fold: N = 32 panels, K = 4 piles, 8 high"), "{}", run.output);
    assert_eq!(place.zygote(&["check", "back.fold"]).code, 0);
    assert_eq!(place.zygote(&["sequence", "back.fold"]).output, place.read("torus.seq"));
    assert!(place.read("back.fold").contains("\"zygote:thickness\":0.05"));
}

#[test]
fn a_text_is_compared_with_a_plan_and_every_difference_told_with_its_place() {
    let place = planned("sequence_compare", "i14.txt", "1");
    let text = place.zygote(&["sequence", "plan.fold"]).output;
    place.write("same.seq", &format!("# typed by hand\n{text}"));
    let run = place.zygote(&["sequence", "plan.fold", "--compare", "same.seq"]);
    assert_eq!(run.code, 0, "{}", run.errors);
    assert_eq!(run.output, "same.seq: the sequence of plan.fold\n");
    // The last hinge of the pile opens otherwise.
    let (first, rest) = text.split_once('\n').unwrap();
    let angle = first.rfind(char::is_numeric).unwrap() - 2;
    let other = if &first[angle..angle + 3] == "180" { "270" } else { "180" };
    let edited = format!("{}{other}{}\n{rest}", &first[..angle], &first[angle + 3..]);
    place.write("other.seq", &edited);
    let run = place.zygote(&["sequence", "plan.fold", "--compare", "other.seq"]);
    assert_eq!(run.code, 1);
    let column = first[..angle].rfind(' ').unwrap() + 2;
    assert!(run.output.starts_with(&format!("other.seq: line 1, column {column}: pile (")), "{}", run.output);
    assert!(run.errors.contains("other.seq: differs from plan.fold in 1 places"), "{}", run.errors);
}

#[test]
fn a_text_that_is_no_sequence_is_refused_with_its_place_and_leaves_no_file() {
    let place = Scratch::new("sequence_refused");
    place.write("typed.seq", "# mine\n(0,0): E90 X90 .\n");
    let run = place.zygote(&["sequence", "--parse", "typed.seq", "-o", "out.fold"]);
    assert_eq!(run.code, 2);
    assert!(run.errors.contains("typed.seq: no coded sequence"), "{}", run.errors);
    assert!(run.errors.contains("line 2, column 12: expected a side E, N, W or S"), "{}", run.errors);
    // Four right angles in a row: the fifth panel lies on the first.
    place.write("ring.seq", "(0,0): E270 W90 E270 W90 .\n");
    let run = place.zygote(&["sequence", "--parse", "ring.seq", "-o", "out.fold"]);
    assert_eq!(run.code, 1);
    assert!(run.errors.contains("ring.seq: the shape that this sequence unfolds into"), "{}", run.errors);
    assert!(run.errors.contains("overlap: "), "{}", run.errors);
    assert_eq!(place.files(), ["ring.seq", "typed.seq"]);
}

#[test]
fn options_that_do_not_go_together_are_refused() {
    let place = planned("sequence_options", "cube6.txt", "1");
    for options in [
        &["sequence"][..],
        &["sequence", "plan.fold", "--parse", "a.seq", "-o", "b.fold"],
        &["sequence", "--parse", "a.seq"],
        &["sequence", "plan.fold", "--compare", "a.seq", "-o", "b.seq"],
        &["sequence", "--parse", "a.seq", "-o", "b.fold", "--thickness", "-1"],
        &["sequence", "plan.fold", "--compare", "not_there.seq"],
        &["sequence", "not_there.fold"],
    ] {
        let run = place.zygote(options);
        assert_eq!(run.code, 2, "{options:?}: {}", run.errors);
    }
    assert_eq!(place.files(), ["plan.fold"]);
}
