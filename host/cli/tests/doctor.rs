//! What helps a person to get going: `zygote doctor`, `zygote completions`, `zygote man`.
#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]

mod scratch;

use scratch::Scratch;
use serde_json::Value;

#[test]
fn the_doctor_tells_of_everything_whether_it_is_fine_and_what_to_do_where_it_is_not() {
    let place = Scratch::new("doctor");
    let run = place.zygote(&["doctor", "--json"]);
    assert_eq!(run.code, 0, "{}", run.errors);
    let findings: Vec<Value> = serde_json::from_str(&run.output).unwrap();
    let names: Vec<&str> = findings.iter().map(|finding| finding["what"].as_str().unwrap()).collect();
    for name in ["zygote", "viewer", "probe-rs", "python3", "chromium"] {
        assert!(names.contains(&name), "{name} isn't in {names:?}");
    }
    for finding in &findings {
        assert_eq!(finding["is_fine"].as_bool().unwrap(), finding["remedy"].is_null(), "{finding}");
    }
}

#[test]
fn a_board_that_does_not_answer_is_told_and_the_doctor_fails() {
    let place = Scratch::new("doctor_without_board");
    let run = place.zygote(&["doctor", "--port", "/dev/no-such-port"]);
    assert_eq!(run.code, 1, "{}", run.output);
    assert!(run.output.contains("--  board"), "{}", run.output);
    assert!(run.errors.contains("the board isn't well"), "{}", run.errors);
}

#[test]
fn every_verb_has_its_page_in_the_manual() {
    let place = Scratch::new("man");
    let run = place.zygote(&["man", "pages"]);
    assert_eq!(run.code, 0, "{}", run.errors);
    let page = place.read("pages/zygote-deploy.1");
    assert!(page.contains("zygote\\-deploy") && page.contains("\\-\\-sim"), "{page}");
    assert!(place.read("pages/zygote.1").contains("zygote\\-calibrate(1)"), "it names the others");
}

#[test]
fn shells_are_told_the_verbs_and_a_shell_that_nobody_knows_is_refused() {
    let place = Scratch::new("completions");
    for shell in ["bash", "zsh", "fish"] {
        let run = place.zygote(&["completions", shell]);
        assert!(run.code == 0 && run.output.contains("rehearse"), "{shell}: {}", run.errors);
    }
    assert_eq!(place.zygote(&["completions", "teletype"]).code, 2);
}
