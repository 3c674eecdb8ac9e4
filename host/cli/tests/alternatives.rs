//! `zygote alternatives` as a user meets it.

mod scratch;

use scratch::{Scratch, model};

#[test]
fn plans_are_listed_and_written_into_a_folder_that_is_made() {
    let place = Scratch::new("alternatives_list");
    let run = place.zygote(&["alternatives", &model("fish92.txt"), "-n", "10", "--piles", "4", "-o", "many"]);
    assert_eq!(run.code, 0, "{}", run.errors);
    let mut lines = run.output.lines();
    let head = lines.next().unwrap_or_default();
    assert_eq!(
        head.split_whitespace().collect::<Vec<_>>(),
        ["plan", "seed", "cells", "depth", "bridges", "volume", "overlaps"]
    );
    assert_eq!(lines.clone().filter(|line| line.contains("2 x 2")).count(), 10, "{}", run.output);
    assert!(lines.next_back().unwrap_or_default().starts_with("10 plans from "), "{}", run.output);
    let sequences: std::collections::BTreeSet<String> = (1..=10)
        .map(|number| {
            let name = format!("many/fish92-{number:02}.fold");
            assert_eq!(place.zygote(&["check", &name]).code, 0, "{name}");
            place.zygote(&["sequence", &name]).output
        })
        .collect();
    assert_eq!(sequences.len(), 10);
}

#[test]
fn fewer_plans_than_asked_for_are_said_to_be_fewer() {
    let place = Scratch::new("alternatives_few");
    let run = place.zygote(&["alternatives", &model("cube6.txt"), "-n", "30"]);
    assert_eq!(run.code, 0, "{}", run.errors);
    assert!(run.output.contains("plans only, expected 30: 600 seeds gave no more"), "{}", run.output);
    assert!(place.files().is_empty(), "nothing is written without -o");
}

#[test]
fn numbers_that_make_no_plans_are_refused() {
    let place = Scratch::new("alternatives_refused");
    let run = place.zygote(&["alternatives", &model("cube6.txt"), "-n", "0"]);
    assert_eq!((run.code, run.errors.contains("-n 0, expected at least 1")), (2, true), "{}", run.errors);
    let run = place.zygote(&["alternatives", &model("fish92.txt"), "--piles", "3", "-o", "many"]);
    assert_eq!((run.code, run.errors.contains("nearest numbers that do")), (2, true), "{}", run.errors);
    assert!(place.files().is_empty());
}
