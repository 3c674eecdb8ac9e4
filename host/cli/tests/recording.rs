//! `zygote deploy`, `replay` and `report` as a user meets them: files, their names, and what is wrong with them.
#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]

mod scratch;

use scratch::{Run, Scratch, model};
use serde_json::Value;

const RIG: &str = "rigs/sma-bench.toml";

/// A planned and scheduled model of fourteen panels.
fn scheduled(name: &str) -> Scratch {
    let place = Scratch::new(name);
    assert_eq!(place.zygote(&["plan", &model("i14.txt"), "--piles", "2", "-o", "plan.fold"]).code, 0);
    assert_eq!(place.zygote(&["schedule", "plan.fold", "--rig", &model(RIG)]).code, 0);
    place
}

fn deploy(place: &Scratch, more: &[&str]) -> Run {
    place.zygote(&[&["deploy", "plan.fold", "--rig", &model(RIG), "--sim"], more].concat())
}

#[test]
fn a_run_is_recorded_told_and_made_a_page() {
    let place = scheduled("recorded");
    let run = deploy(&place, &[]);
    assert_eq!(run.code, 0, "{}", run.errors);
    assert!(run.output.contains("recording: plan.1.mcap"), "{}", run.output);
    let told = place.zygote(&["replay", "plan.1.mcap"]);
    assert_eq!(told.code, 0, "{}", told.errors);
    for part in
        ["14 panels, 13 hinges", "board simulated", "virtual time", "hinge 12 is done", "result: deployed"]
    {
        assert!(told.output.contains(part), "{part:?} isn't in {}", told.output);
    }
    let json = place.zygote(&["replay", "plan.1.mcap", "--json"]);
    let json: Value = serde_json::from_str(&json.output).unwrap();
    assert_eq!((&json["report"]["outcome"], &json["cut"]), (&"deployed".into(), &Value::Null));
    let run = place.zygote(&["report", "plan.1.mcap"]);
    assert_eq!(run.code, 0, "{}", run.errors);
    assert!(run.output.starts_with("plan.1.html: "), "{}", run.output);
    assert!(place.read("plan.1.html").contains("<h1>plan.fold on "), "{}", place.read("plan.1.html"));

    // Another run is another file.
    let first = place.bytes("plan.1.mcap");
    assert_eq!(deploy(&place, &[]).code, 0);
    assert!(place.bytes("plan.2.mcap") == first, "the same run");
    // And a file that was named is never overwritten.
    let run = deploy(&place, &["--record", "plan.1.mcap"]);
    assert_eq!(run.code, 2);
    assert!(run.errors.contains("plan.1.mcap: exists already"), "{}", run.errors);
    assert!(place.bytes("plan.1.mcap") == first);
}

#[test]
fn a_recording_that_cannot_be_begun_is_told_before_anything_moves() {
    let place = scheduled("record_nowhere");
    for (file, why) in
        [("no_such_folder/run.mcap", "can't be made"), ("/dev/full", "No space left on device")]
    {
        let run = deploy(&place, &["--record", file]);
        assert_eq!(run.code, 1, "{}", run.output);
        assert!(
            run.errors.contains("the run can't be recorded") && run.errors.contains(why),
            "{}",
            run.errors
        );
        assert!(!place.files().contains(&"plan.report.json".to_owned()), "nothing ran");
    }
}

#[test]
fn what_is_no_recording_is_refused_by_name() {
    let place = scheduled("no_recording");
    place.write("empty.mcap", "");
    for (file, why) in [
        ("missing.mcap", "cannot be read"),
        ("empty.mcap", "the file is empty"),
        ("plan.fold", "no MCAP file: it begins with 7b"),
    ] {
        for verb in ["replay", "report"] {
            let run = place.zygote(&[verb, file]);
            assert_eq!(run.code, 2, "{}", run.output);
            assert!(run.errors.contains(file) && run.errors.contains(why), "{verb}: {}", run.errors);
        }
    }
    assert!(!place.files().contains(&"plan.html".to_owned()));
}
