//! `zygote calibrate --sim` as a user meets it: what is found is what the simulated hinges are like, and what can't be
//! calibrated is told with why.
#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]

mod scratch;

use scratch::{Run, Scratch};
use serde_json::{Value, json};

/// Two hinges that differ from what the rig file says, and from each other.
const RIG: &str = r#"
version = 1

[rig]
id = "bench"

[supply]
voltage = "5 V"
limit = "2 A"
resistance = "50 mohm"

[[node]]
name = "simulated"
heaters = 2

[sim]
seed = 4

[[sim.hinge]]
hinge = 0
sma = { heater_resistance = "27 ohm", austenite_start = "65 degC", austenite_finish = "76 degC", martensite_start = "50 degC", martensite_finish = "39 degC" }

[[sim.hinge]]
hinge = 1
sma = { heater_resistance = "22 ohm", convection = "55 W/m2K" }
"#;

fn calibrate(place: &Scratch, rig: &str, more: &[&str]) -> Run {
    place.write("rig.toml", rig);
    place.zygote(&[&["calibrate", "--rig", "rig.toml", "--sim"], more].concat())
}

/// A number of the calibration file, the first of its value.
fn value(text: &str, hinge: usize, key: &str) -> f64 {
    let part = text.split("[[hinge]]").nth(hinge + 1).unwrap();
    let entry = part.split(&format!("[hinge.values.{key}]")).nth(1).unwrap();
    let line = entry.lines().find(|line| line.starts_with("value")).unwrap();
    line.split('"').nth(1).unwrap().split(' ').next().unwrap().parse().unwrap()
}

#[test]
fn two_hinges_are_calibrated_side_by_side_and_what_is_found_is_the_truth() {
    let place = Scratch::new("calibrates_two");
    let run = calibrate(&place, RIG, &["--all", "--json"]);
    assert_eq!(run.code, 0, "{}{}", run.output, run.errors);
    let told: Value = serde_json::from_str(&run.output).unwrap();
    assert_eq!((told["rig"].as_str(), told["board"].as_str()), (Some("bench"), Some("simulated")));
    let heater = &told["hinges"][1]["values"]["heater_resistance"];
    assert!((heater["value"].as_f64().unwrap() - 22.0).abs() < 0.7, "{heater}");
    assert!(told["hinges"][0]["values"]["opening"]["unknown"].is_string(), "{told}");
    assert_eq!(run.errors, "", "no progress without a terminal");
    let text = place.read("calibration.toml");
    for (hinge, key, truth, within) in [
        (0, "heater_resistance", 27.0, 27.0 * 0.03),
        (1, "heater_resistance", 22.0, 22.0 * 0.03),
        (0, "austenite_start", 65.0, 2.0),
        (0, "austenite_finish", 76.0, 2.0),
        (1, "austenite_start", 68.0, 2.0),
        (1, "austenite_finish", 78.0, 2.0),
    ] {
        let found = value(&text, hinge, key);
        assert!((found - truth).abs() <= within, "hinge {hinge}: {key} {found} for {truth}\n{text}");
    }
    assert!(value(&text, 1, "thermal_resistance") < value(&text, 0, "thermal_resistance"), "{text}");
    let records: Value = serde_json::from_slice(&place.bytes("calibration.records.json")).unwrap();
    assert_eq!((records["rig"].as_str(), records["complete"].as_bool()), (Some("bench"), Some(true)));
    assert!(place.read("calibration.html").matches("<svg").count() == 2);
    assert_eq!(told["board_keeps"], json!({ "known": 2, "new": 2 }));
    // One of them again, at a rig that has changed its name.
    let renamed = RIG.replace("\"bench\"", "\"other\"");
    let run = calibrate(&place, &renamed, &["--hinge", "1"]);
    assert_eq!(run.code, 2, "{}", run.output);
    assert!(run.errors.contains("a calibration of rig \"bench\", expected \"other\""), "{}", run.errors);
    assert_eq!(place.read("calibration.toml"), text, "it stays as it was");
}

#[test]
fn a_rig_that_is_too_warm_or_too_weak_is_told_and_nothing_is_called_calibrated() {
    let place = Scratch::new("calibrates_nothing");
    let cases = [
        (RIG.replace("[sim]", "[sim]\nambient = \"60 degC\""), "expected a room's"),
        (RIG.replace("27 ohm", "58 ohm"), "hinge 0: incomplete: no austenite"),
    ];
    for (rig, message) in cases {
        let run = calibrate(&place, &rig, &["--hinge", "0", "--restart"]);
        assert_eq!(run.code, 1, "{}{}", run.output, run.errors);
        assert!(run.errors.contains(message), "{message} isn't in {}", run.errors);
        assert!(!run.output.contains(" calibrated"), "{}", run.output);
    }
}

#[test]
fn what_is_no_hinge_of_the_rig_or_no_record_of_it_is_refused() {
    let place = Scratch::new("calibrates_no_such");
    for (arguments, message) in [
        (&["--hinge", "2"][..], "--hinge 2: expected a hinge of the rig, 0 to 1"),
        (&["--all", "--resume"], "calibration.records.json: cannot be read"),
        (&["--all", "--plan", "none.fold"], "none.fold: cannot be read"),
    ] {
        let run = calibrate(&place, RIG, arguments);
        assert_eq!((run.code, run.errors.contains(message)), (2, true), "{}", run.errors);
    }
    let records = |rig: &str, version: u32, complete: bool| {
        format!(
            "{{\"version\":{version},\"rig\":\"{rig}\",\"board\":\"b\",\"unique_id\":\"00\",\"firmware\":\"f\",\
             \"complete\":{complete},\"hinges\":[]}}"
        )
    };
    for (text, arguments, message) in [
        (records("bench", 1, false), &["--all"][..], "holds a calibration that was interrupted: --resume"),
        (records("other", 1, false), &["--all", "--resume"], "these records are of another rig"),
        (records("bench", 1, false), &["--all", "--resume"], "these records are of another board"),
        (records("bench", 2, false), &["--all", "--resume"], "expected version 1, found 2"),
        ("{}".to_owned(), &["--all", "--resume"], "no records of a calibration"),
    ] {
        place.write("calibration.records.json", &text);
        let run = calibrate(&place, RIG, arguments);
        assert_eq!((run.code, run.errors.contains(message)), (2, true), "{message}: {}", run.errors);
        assert_eq!(place.read("calibration.records.json"), text, "nothing was measured");
    }
}

/// Sixteen hinges, of which number 3 has a weaker heater than the rig file says.
const LARGE: &str = r#"
version = 1

[rig]
id = "bench"
# calibration

[supply]
voltage = "5 V"
limit = "2 A"
resistance = "50 mohm"

[[node]]
name = "simulated"
heaters = 16

[[sim.hinge]]
hinge = 3
sma = { heater_resistance = "29 ohm" }
"#;

/// Current and least gain of a hinge's step.
fn step(place: &Scratch, hinge: usize) -> (u64, i64) {
    let schedule: Value = serde_json::from_str(&place.read("schedule.json")).unwrap();
    let steps = schedule["steps"].as_array().unwrap();
    let step = steps.iter().find(|step| step["hinge"] == hinge).unwrap();
    (step["current_ma"].as_u64().unwrap(), step["motion"]["min_gain_centi_celsius"].as_i64().unwrap())
}

/// The heater of hinge 3 ages: a run says so, live, on its page, and again from its recording.
fn drifts(place: &Scratch, calibrated: &str, deploy: &[&str]) {
    let drift = ["drift", "schedule.1.mcap", "--rig", "rig.toml"];
    let run = place.zygote(&drift);
    assert_eq!((run.code, run.output.as_str()), (0, "hinge 3: keep\n"), "{}", run.errors);
    place.write("rig.toml", &calibrated.replace("29 ohm", "32 ohm"));
    let run = place.zygote(deploy);
    assert_eq!(run.code, 0, "{}{}", run.output, run.errors);
    assert!(run.output.contains("recalibrate hinge 3: heater resistance 3"), "{}", run.output);
    assert!(run.output.contains("zygote calibrate --rig rig.toml --hinge 3"), "{}", run.output);
    let report: Value = serde_json::from_slice(&place.bytes("schedule.report.json")).unwrap();
    assert_eq!(report["drift"][0]["verdict"], "recalibrate", "{report}");
    let run = place.zygote(&["drift", "schedule.2.mcap", "--rig", "rig.toml", "--json"]);
    assert_eq!(run.code, 1, "{}", run.errors);
    let told: Value = serde_json::from_str(&run.output).unwrap();
    assert_eq!(told["hinges"], report["drift"], "as it was told live");
    assert_eq!(place.zygote(&["report", "schedule.2.mcap"]).code, 0);
    assert!(place.read("schedule.2.html").contains("<td class=\"bad\">recalibrate</td>"));
    place.write("rig.toml", LARGE);
    let run = place.zygote(&drift);
    assert_eq!(run.code, 2, "{}", run.output);
    assert!(run.errors.contains("names no calibration"), "{}", run.errors);
    place.write("rig.toml", calibrated);
}

/// What was measured at one board isn't run on another, unless somebody insists.
fn stays_at_its_board(place: &Scratch, schedule: &[&str]) {
    let own = place.read("calibration.toml");
    let other = own.replace("unique_id = \"", "unique_id = \"ff");
    place.write("calibration.toml", &other);
    let run = place.zygote(schedule);
    assert_eq!(run.code, 0, "{}", run.errors);
    let mut board = place.start(&["sim", "--rig", "rig.toml"]);
    let port = board.first_line();
    let deploy =
        ["deploy", "plan.fold", "--schedule", "schedule.json", "--rig", "rig.toml", "--port", port.as_str()];
    let run = place.zygote(&deploy);
    assert_eq!(run.code, 2, "{}{}", run.output, run.errors);
    for part in ["a calibration at board simulated ff", "--calibrated-at-another-board"] {
        assert!(run.errors.contains(part), "{}", run.errors);
    }
    drop(board);
    place.write("calibration.toml", &own);
    assert_eq!(place.zygote(schedule).code, 0);
}

#[test]
fn a_rig_that_names_its_calibration_is_driven_by_what_was_measured() {
    let place = Scratch::new("drives_by_calibration");
    let calibrated = LARGE.replace("# calibration", "calibration = \"calibration.toml\"");
    let plan = place.zygote(&[
        "plan",
        &scratch::model("i14.txt"),
        "--piles",
        "2",
        "--free",
        "ideal",
        "-o",
        "plan.fold",
    ]);
    assert_eq!(plan.code, 0, "{}", plan.errors);
    let schedule = ["schedule", "plan.fold", "--rig", "rig.toml", "-o", "schedule.json"];
    let deploy = ["deploy", "plan.fold", "--schedule", "schedule.json", "--rig", "rig.toml", "--sim"];

    place.write("rig.toml", &calibrated);
    let missing = place.zygote(&schedule);
    assert_eq!(missing.code, 2);
    assert!(missing.errors.contains("zygote calibrate --rig rig.toml"), "{}", missing.errors);

    // The rig file that names it is also what it is made with.
    let run = calibrate(&place, &calibrated, &["--hinge", "3"]);
    assert_eq!(run.code, 0, "{}{}", run.output, run.errors);
    place.write("rig.toml", LARGE);
    assert_eq!(place.zygote(&schedule).code, 0);
    assert_eq!(step(&place, 3), (200, 500));
    place.write("rig.toml", &calibrated);
    let stale = place.zygote(&deploy);
    assert_eq!(stale.code, 2, "a schedule made without the calibration: {}{}", stale.output, stale.errors);
    assert!(stale.errors.contains("it was made without a calibration"), "{}", stale.errors);

    let run = place.zygote(&schedule);
    assert_eq!(run.code, 0, "{}", run.errors);
    let ((current, gain), other) = (step(&place, 3), step(&place, 4));
    assert!((170..=175).contains(&current), "{current} mA at 29 ohm");
    assert!(gain > 1_000, "a third of what is expected in 3 s, in 0.01 K: {gain}");
    assert_eq!(other, (200, 500), "nothing is known of it");
    let run = place.zygote(&deploy);
    assert_eq!(run.code, 0, "{}{}", run.output, run.errors);
    assert!(run.output.contains("true angles: 13 of 13 hinges"), "{}", run.output);
    assert!(run.output.contains("calibration: 1 of 1 hinges are as they were measured"), "{}", run.output);
    drifts(&place, &calibrated, &deploy);
    stays_at_its_board(&place, &schedule);

    let other = place.read("calibration.toml").replace("rig = \"bench\"", "rig = \"other\"");
    place.write("calibration.toml", &other);
    let refused = place.zygote(&schedule);
    assert_eq!(refused.code, 2);
    assert!(refused.errors.contains("a calibration of rig \"other\""), "{}", refused.errors);
}
