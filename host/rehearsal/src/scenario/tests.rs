//! What a scenario file may not say, and how it is refused.
#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]

use super::*;
use std::path::Path;

const GOOD: &str = r#"version = 1
about = "a test"

[job]
model = "../../models/cube6.txt"
rig = { file = "rigs/mixed.toml" }

[[cause]]
when = { hinge = 2, above = "40 degC" }
what = { thermistor-open = { hinge = 2 } }

[expect]
outcome = "fault"
fault = "F08"
off_within = "100 ms"
"#;

fn file() -> String {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../sim/scenarios/test.toml").display().to_string()
}

/// What is said of the good scenario with something replaced; without the folders of its name.
fn refused(old: &str, new: &str) -> String {
    assert!(GOOD.contains(old), "{old}");
    let text = GOOD.replacen(old, new, 1);
    let scenario = Scenario::read(&file(), &text);
    let error = scenario.and_then(|scenario| scenario.trial()).err().unwrap();
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../sim/scenarios/").display().to_string();
    error.to_string().replace(&folder, "")
}

#[test]
fn a_good_scenario_holds_and_a_deadline_that_is_missed_does_not() {
    let verdict = Scenario::read(&file(), GOOD).unwrap().rehearse().unwrap();
    assert!(verdict.holds(), "{}", table(&[verdict]));
    for (asked, wrong) in [("100 ms", "1 ms"), ("F08", "F09"), ("\"fault\"", "\"deployed\"")] {
        let verdict = Scenario::read(&file(), &GOOD.replacen(asked, wrong, 1)).unwrap().rehearse().unwrap();
        assert_eq!(verdict.rows.iter().filter(|row| !row.holds).count(), 1, "{}", table(&[verdict]));
    }
}

#[test]
fn a_cause_that_never_comes_fails_the_scenario() {
    let text = GOOD.replacen("40 degC", "140 degC", 1).replacen("\"fault\"", "\"deployed\"", 1);
    let verdict = Scenario::read(&file(), &text).unwrap().rehearse().unwrap();
    assert!(!verdict.holds());
    assert!(table(&[verdict]).contains("cause 0: expected happens, found never happened"));
}

#[test]
fn what_can_not_be_is_refused_with_file_and_line() {
    for (old, new, said) in [
        ("version = 1", "version = 2", "test.toml:1: version: expected 1, found 2"),
        ("about", "abuot", "test.toml:2: unknown field `abuot`"),
        ("above = \"40 degC\"", "above = \"40 K\"", "test.toml:9: expected a temperature with its unit"),
        ("above = \"40 degC\"", "is = \"moving\", step = 1", "test.toml:8: when: expected one of `at`"),
        (
            "{ hinge = 2, above = \"40 degC\" }",
            "{ step = 9, is = \"done\" }",
            "test.toml:8: when.step: expected a step of the schedule, 0 to 4, found 9",
        ),
        (
            "thermistor-open = { hinge = 2",
            "thermistor-open = { hinge = 7",
            "test.toml:8: hinge: expected a hinge of the plan, 0 to 4, found 7",
        ),
        (
            "thermistor-open = { hinge = 2",
            "thermistor-open = { hinge = 3",
            "test.toml:8: hinge: expected a hinge of kind sma, found 3, which is servo",
        ),
        ("thermistor-open", "thermistor-opne", "test.toml:10: unknown variant `thermistor-opne`"),
        (
            "F08",
            "F99",
            "test.toml:12: expect.fault: expected \"none\" or a fault code as in \"F08\", found \"F99\"",
        ),
        ("off_within = \"100 ms\"", "off_within = 100", "test.toml:15: invalid type: integer `100`"),
        ("mixed.toml", "none.toml", "rigs/none.toml: cannot be read"),
    ] {
        let found = refused(old, new);
        assert!(found.starts_with(said), "{new}\nexpected {said}\nfound    {found}");
    }
}

#[test]
fn a_scenario_without_a_job_is_for_a_plan_of_ones_own() {
    let job = "[job]\nmodel = \"../../models/cube6.txt\"\nrig = { file = \"rigs/mixed.toml\" }\n";
    let found = refused(job, "");
    assert!(found.starts_with("test.toml: has no [job]"), "{found}");
}
