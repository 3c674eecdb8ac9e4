//! The page of refusals and faults says what the table in `codes.rs` says.
#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]

use zygote_protocol::{Explanation, FaultCode, RefusalCode};

/// The rows of the page whose code begins with this letter.
fn rows_of_the_page(letter: char) -> Vec<String> {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../docs/src/faults.md");
    let page = std::fs::read_to_string(path).unwrap();
    let start = format!("| {letter}");
    let is_row = |line: &&str| {
        line.starts_with(&start) && line[start.len()..].starts_with(|c: char| c.is_ascii_digit())
    };
    page.lines().filter(is_row).map(str::to_owned).collect()
}

#[test]
fn the_page_tells_every_refusal_as_the_table_does() {
    let row = |code: &RefusalCode| {
        let Explanation { meaning, numbers, remedy, .. } = code.explanation();
        format!("| R{:02} | {code:?} | {meaning} | {numbers} | {remedy} |", code.number())
    };
    let expected: Vec<String> = RefusalCode::ALL.iter().map(row).collect();
    assert_eq!(rows_of_the_page('R'), expected);
}

#[test]
fn the_page_tells_every_fault_as_the_table_does() {
    let row = |code: &FaultCode| {
        let Explanation { meaning, numbers, position, remedy } = code.explanation();
        format!("| F{:02} | {code:?} | {meaning} | {numbers} | {position} | {remedy} |", code.number())
    };
    let expected: Vec<String> = FaultCode::ALL.iter().map(row).collect();
    assert_eq!(rows_of_the_page('F'), expected);
}

#[test]
fn numbers_follow_on_each_other_and_nothing_is_left_unsaid() {
    let faults = FaultCode::ALL.iter().map(|code| (code.number(), code.explanation()));
    assert!(faults.clone().map(|(number, _)| number).eq(1..=u16::try_from(FaultCode::ALL.len()).unwrap()));
    let refusals = RefusalCode::ALL.iter().map(|code| (code.number(), code.explanation()));
    assert!(
        refusals.clone().map(|(number, _)| number).eq(1..=u16::try_from(RefusalCode::ALL.len()).unwrap())
    );
    for (number, text) in faults.chain(refusals) {
        assert!(![text.meaning, text.position, text.remedy].contains(&""), "number {number}: {text:?}");
    }
}
