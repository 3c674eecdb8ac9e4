//! `zygote deploy --sim` as a user meets it: the whole way from a model to true angles, and what goes wrong.
#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]

mod scratch;

use scratch::{Run, Scratch, model};
use serde_json::Value;

const RIG: &str = "rigs/sma-160.toml";

/// Plans, schedules and deploys a model; every step must succeed but the last.
fn deploy(place: &Scratch, name: &str, piles: usize, rig: &str, parallel: usize) -> Run {
    let run = place.zygote(&[
        "plan",
        &model(name),
        "--piles",
        &piles.to_string(),
        "--bridges",
        "base",
        "-o",
        "plan.fold",
    ]);
    assert_eq!(run.code, 0, "{name} in {piles} piles: {}", run.errors);
    let run = place.zygote(&["schedule", "plan.fold", "--rig", rig, "--parallel", &parallel.to_string()]);
    assert_eq!(run.code, 0, "{name} in {piles} piles: {}", run.errors);
    place.zygote(&["deploy", "plan.fold", "--rig", rig, "--sim"])
}

/// Deploys a model in 1, 2 and 4 piles, as far as they divide its panels, with every hinge at its true angle.
fn assert_deploys(name: &str, panels: usize) {
    let place = Scratch::new(&format!("deploys_{name}"));
    for piles in [1, 2, 4].into_iter().filter(|piles| panels.is_multiple_of(*piles)) {
        let run = deploy(&place, name, piles, &model(RIG), 8);
        assert_eq!(run.code, 0, "{name} in {piles} piles: {}{}", run.output, run.errors);
        let hinges = panels - 1;
        for line in [
            format!("deployed: {hinges} of {hinges} hinges are open"),
            format!("true angles: {hinges} of {hinges} hinges within 1°"),
        ] {
            assert!(run.output.contains(&line), "{name} in {piles} piles: {line:?} isn't in {}", run.output);
        }
    }
}

#[test]
fn an_i_deploys() {
    assert_deploys("i14.txt", 14);
}

#[test]
fn an_l_deploys() {
    assert_deploys("l14.txt", 14);
}

#[test]
fn an_open_sheet_deploys() {
    assert_deploys("sheet12.obj", 144);
}

#[test]
fn a_fish_deploys() {
    assert_deploys("fish92.txt", 92);
}

#[test]
fn a_vehicle_deploys() {
    assert_deploys("vehicle92.txt", 92);
}

#[test]
fn an_airplane_deploys() {
    assert_deploys("airplane92.txt", 92);
}

#[test]
fn a_larger_fish_deploys() {
    assert_deploys("fish144.txt", 144);
}

#[test]
fn servos_and_springs_deploy_too() {
    for (number, rig) in ["rigs/mixed.toml", "rigs/servo-160.toml"].into_iter().enumerate() {
        let place = Scratch::new(&format!("kinds_{number}"));
        let run = deploy(&place, "l14.txt", 2, &model(rig), 1);
        assert_eq!(run.code, 0, "{rig}: {}{}", run.output, run.errors);
    }
}

#[test]
fn the_same_run_leaves_the_same_bytes() {
    let bytes = |name| {
        let place = Scratch::new(name);
        assert_eq!(deploy(&place, "i14.txt", 2, &model(RIG), 2).code, 0);
        ["plan.fold", "plan.events.jsonl", "plan.report.json", "plan.1.mcap"].map(|file| place.bytes(file))
    };
    assert!(bytes("bytes_a") == bytes("bytes_b"));
}

#[test]
fn the_event_log_tells_the_run_in_order() {
    let place = Scratch::new("event_log");
    assert_eq!(deploy(&place, "i14.txt", 1, &model(RIG), 1).code, 0);
    let log = place.read("plan.events.jsonl");
    let records: Vec<Value> = log.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    assert!(records.windows(2).all(|two| two[0]["host_us"].as_u64() <= two[1]["host_us"].as_u64()));
    let kinds: Vec<_> = records.iter().map(|record| record["kind"].as_str().unwrap()).collect();
    assert_eq!(kinds[..2], ["connected", "uploaded"]);
    for kind in ["started", "opened", "done"] {
        assert_eq!(kinds.iter().filter(|found| **found == kind).count(), 13, "{kind}");
    }
    assert_eq!(records.last().unwrap()["state"], "finished");
}

/// A rig whose simulated hinges differ from what the rig file promises.
fn rig_with_truth(place: &Scratch, truth: &str) -> &'static str {
    let rig = std::fs::read_to_string(model("rigs/sma-bench.toml")).unwrap();
    assert!(!rig.contains("[sim.sma]"), "the bench rig has its own truth now; write this test anew");
    place.write("rig.toml", &format!("{rig}\n[sim.sma]\n{truth}\n"));
    "rig.toml"
}

#[test]
fn a_heater_too_weak_ends_in_a_fault_and_a_report_of_what_moved() {
    let place = Scratch::new("weak_heater");
    let rig = rig_with_truth(&place, "heater_resistance = \"45 ohm\"");
    let run = deploy(&place, "i14.txt", 2, rig, 1);
    assert_eq!(run.code, 1);
    assert!(run.output.contains("not deployed: 0 of 13 hinges are open; F07"), "{}", run.output);
    assert!(run.errors.contains("the shape is not deployed"), "{}", run.errors);
    let report: Value = serde_json::from_str(&place.read("plan.report.json")).unwrap();
    let outcomes: Vec<_> =
        report["hinges"].as_array().unwrap().iter().map(|hinge| hinge["outcome"].as_str().unwrap()).collect();
    assert_eq!(outcomes[0], "interrupted");
    assert!(outcomes[1..].iter().all(|outcome| *outcome == "not_moved"), "{outcomes:?}");
    assert_eq!(report["outcome"], "fault");
}

#[test]
fn an_alloy_that_opens_hotter_than_the_rig_file_says_is_found_by_the_true_angles() {
    let place = Scratch::new("wrong_alloy");
    let truth = "martensite_finish = \"82 degC\"\nmartensite_start = \"92 degC\"\naustenite_start = \"108 degC\"\n\
                 austenite_finish = \"118 degC\"";
    let run = deploy(&place, "i14.txt", 2, rig_with_truth(&place, truth), 1);
    assert_eq!(run.code, 1);
    assert!(run.output.contains("deployed: 13 of 13"), "{}", run.output);
    assert!(run.errors.contains("the simulator's true angles:"), "{}", run.errors);
}

/// Makes a plan with its schedule, then deploys with these arguments.
fn refused(name: &str, prepare: impl FnOnce(&Scratch), arguments: &[&str]) -> (Run, Vec<String>) {
    let place = Scratch::new(name);
    let i14 = model("i14.txt");
    assert_eq!(place.zygote(&["plan", &i14, "--piles", "2", "-o", "plan.fold"]).code, 0);
    assert_eq!(place.zygote(&["schedule", "plan.fold", "--rig", &model("rigs/sma-bench.toml")]).code, 0);
    prepare(&place);
    let rig = model("rigs/sma-bench.toml");
    let before = place.files();
    let run = place.zygote(&[&["deploy", "plan.fold", "--rig", &rig][..], arguments].concat());
    let new = place.files().into_iter().filter(|file| !before.contains(file)).collect();
    (run, new)
}

#[test]
fn a_plan_without_a_schedule_is_refused_with_the_command_that_makes_one() {
    let replan = |place: &Scratch| {
        assert_eq!(place.zygote(&["plan", &model("i14.txt"), "-o", "plan.fold"]).code, 0);
    };
    let (run, files) = refused("no_schedule", replan, &["--sim"]);
    assert_eq!(run.code, 2);
    assert!(
        run.errors.contains("plan.fold: has no schedule; make it with `zygote schedule plan.fold"),
        "{}",
        run.errors
    );
    assert!(files.is_empty(), "{files:?}");
}

#[test]
fn the_schedule_of_another_plan_is_refused() {
    let mix = |place: &Scratch| {
        assert_eq!(place.zygote(&["plan", &model("l14.txt"), "--piles", "2", "-o", "other.fold"]).code, 0);
        let rig = model("rigs/sma-bench.toml");
        assert_eq!(place.zygote(&["schedule", "other.fold", "--rig", &rig, "-o", "other.json"]).code, 0);
    };
    let (run, files) = refused("other_schedule", mix, &["--sim", "--schedule", "other.json"]);
    assert_eq!(run.code, 2);
    assert!(run.errors.contains("other.json"), "{}", run.errors);
    assert!(files.is_empty(), "{files:?}");
}

#[test]
fn a_plan_edited_by_hand_is_refused_with_key_and_index() {
    let edit = |place: &Scratch| {
        let plan = place.read("plan.fold");
        let mut plan: Value = serde_json::from_str(&plan).unwrap();
        plan["zygote:hinges"][3]["opening_deg"] = 270.into();
        plan["zygote:hinges"][4]["opening_deg"] = 270.into();
        place.write("plan.fold", &plan.to_string());
    };
    let (run, files) = refused("edited", edit, &["--sim"]);
    assert_eq!(run.code, 2);
    assert!(run.errors.contains("zygote:hinges["), "{}", run.errors);
    assert!(files.is_empty(), "{files:?}");
}

#[test]
fn a_port_that_does_not_exist_is_refused_by_name() {
    let (run, files) = refused("no_port", |_| {}, &["--port", "/dev/no-such-port"]);
    assert_eq!(run.code, 2);
    assert!(run.errors.contains("/dev/no-such-port: no such port"), "{}", run.errors);
    assert!(files.is_empty(), "{files:?}");
}

#[test]
fn deploying_nowhere_or_on_two_lines_is_a_wrong_command() {
    assert_eq!(refused("nowhere", |_| {}, &[]).0.code, 2);
    assert_eq!(refused("two_lines", |_| {}, &["--sim", "--port", "/dev/null"]).0.code, 2);
}

#[test]
fn a_rig_that_asks_for_more_than_the_board_allows_is_refused() {
    let place = Scratch::new("above_ceiling");
    let rig = std::fs::read_to_string(model("rigs/sma-bench.toml")).unwrap();
    let (usual, hotter) = ("max_temperature = \"120 degC\"", "max_temperature = \"180 degC\"");
    assert!(rig.contains(usual), "the bench rig has another limit now; write this test anew");
    place.write("rig.toml", &rig.replace(usual, hotter));
    let run = deploy(&place, "i14.txt", 2, "rig.toml", 1);
    assert_eq!(run.code, 1);
    assert!(run.errors.contains("limit MaxTemperature of 18000"), "{}", run.errors);
    assert!(run.errors.contains("the simulated allows 13000"), "{}", run.errors);
}

#[test]
fn a_log_that_cannot_be_written_is_told_before_anything_moves() {
    let (run, files) = refused("no_log", |_| {}, &["--sim", "--log", "no_such_folder/log.jsonl"]);
    assert_eq!(run.code, 1);
    assert!(run.errors.contains("no_such_folder/log.jsonl"), "{}", run.errors);
    assert!(files.is_empty(), "{files:?}");
}

#[test]
fn a_refused_run_leaves_the_log_of_the_one_before_alone() {
    let place = Scratch::new("log_kept");
    let rig = model("rigs/sma-bench.toml");
    assert_eq!(deploy(&place, "i14.txt", 2, &rig, 1).code, 0);
    let log = place.read("plan.events.jsonl");
    place.write("hot.toml", &std::fs::read_to_string(&rig).unwrap().replace("120 degC", "180 degC"));
    assert_eq!(place.zygote(&["schedule", "plan.fold", "--rig", "hot.toml"]).code, 0);
    let run = place.zygote(&["deploy", "plan.fold", "--rig", "hot.toml", "--sim"]);
    assert_eq!(run.code, 1, "{}", run.output);
    assert!(place.read("plan.events.jsonl") == log);
}

#[test]
fn the_report_is_printed_as_json_on_request() {
    let (run, _) = refused("json", |_| {}, &["--sim", "--json"]);
    assert_eq!(run.code, 0, "{}", run.errors);
    let report: Value = serde_json::from_str(&run.output).unwrap();
    assert_eq!(report["outcome"], "deployed");
    assert_eq!(report["hinges"].as_array().unwrap().len(), 13);
}

#[test]
fn servos_fold_the_shape_up_again() {
    let place = Scratch::new("folds_back");
    let rig = model("rigs/servo-160.toml");
    assert_eq!(deploy(&place, "l14.txt", 2, &rig, 2).code, 0);
    let there = place.read("plan.report.json");
    assert_eq!(place.zygote(&["fold", "plan.fold", "--rig", &rig, "-o", "back.json"]).code, 0);
    let run = place.zygote(&["deploy", "plan.fold", "--schedule", "back.json", "--rig", &rig, "--sim"]);
    assert_eq!(run.code, 0, "{}{}", run.output, run.errors);
    for line in ["folded: 13 of 13 hinges are closed", "true angles: 13 of 13 hinges within 1°"] {
        assert!(run.output.contains(line), "{line:?} isn't in {}", run.output);
    }
    let report: Value = serde_json::from_str(&place.read("back.report.json")).unwrap();
    assert_eq!((&report["direction"], &report["outcome"]), (&"fold".into(), &"folded".into()));
    assert_eq!(place.read("plan.report.json"), there, "the report of the way there is kept");
}

#[test]
fn a_way_back_that_was_changed_is_refused() {
    let place = Scratch::new("changed_back");
    let rig = model("rigs/servo-160.toml");
    assert_eq!(deploy(&place, "i14.txt", 2, &rig, 1).code, 0);
    assert_eq!(place.zygote(&["fold", "plan.fold", "--rig", &rig, "-o", "back.json"]).code, 0);
    let mut back: Value = serde_json::from_str(&place.read("back.json")).unwrap();
    back["steps"][0]["opening_deg"] = 90.into();
    place.write("back.json", &back.to_string());
    let run = place.zygote(&["deploy", "plan.fold", "--schedule", "back.json", "--rig", &rig, "--sim"]);
    assert_eq!(run.code, 2, "{}", run.output);
    assert!(
        run.errors.contains("back.json") && run.errors.contains("opening_deg should be"),
        "{}",
        run.errors
    );
}

/// Opens servos and heaters until hinge 6, whose heater is too weak, ends the run.
fn broken_off(place: &Scratch, kind: &str) -> String {
    let rig = std::fs::read_to_string(model("rigs/mixed.toml")).unwrap();
    let rig = format!("{rig}\n[[hinge]]\nhinge = 6\nkind = \"{kind}\"\n");
    place.write("good.toml", &rig);
    place.write(
        "weak.toml",
        &format!("{rig}\n[[sim.hinge]]\nhinge = 6\nsma = {{ heater_resistance = \"400 ohm\" }}\n"),
    );
    let run = deploy(place, "i14.txt", 2, "weak.toml", 1);
    assert_eq!(run.code, 1, "{}", run.output);
    assert!(run.output.contains("--resume"), "{}", run.output);
    place.read("plan.report.json")
}

#[test]
fn a_run_that_broke_off_goes_on_from_its_report() {
    let place = Scratch::new("resume");
    let report: Value = serde_json::from_str(&broken_off(&place, "sma")).unwrap();
    let opened = |report: &Value| {
        report["hinges"].as_array().unwrap().iter().filter(|hinge| hinge["outcome"] == "opened").count()
    };
    let before = opened(&report);
    assert!(0 < before && before < 13, "{before}");
    place.write("first.json", &report.to_string());
    let run = place.zygote(&["deploy", "plan.fold", "--rig", "good.toml", "--sim", "--resume", "first.json"]);
    assert_eq!(run.code, 0, "{}{}", run.output, run.errors);
    assert!(run.output.contains("deployed: 13 of 13 hinges are open"), "{}", run.output);
    assert!(run.output.contains("true angles: 13 of 13 hinges within 1°"), "{}", run.output);
    let report: Value = serde_json::from_str(&place.read("plan.report.json")).unwrap();
    let moved =
        report["hinges"].as_array().unwrap().iter().filter(|hinge| hinge["opened_s"].is_number()).count();
    assert_eq!((opened(&report), moved), (13, 13 - before));
    // And that is all there is to do.
    let run =
        place.zygote(&["deploy", "plan.fold", "--rig", "good.toml", "--sim", "--resume", "plan.report.json"]);
    assert_eq!(run.code, 2);
    assert!(run.errors.contains("nothing is left to do"), "{}", run.errors);
}

#[test]
fn a_report_of_another_run_is_refused() {
    let place = Scratch::new("resume_other");
    let report = broken_off(&place, "sma");
    let resume = |text: &str| {
        place.write("first.json", text);
        let run =
            place.zygote(&["deploy", "plan.fold", "--rig", "good.toml", "--sim", "--resume", "first.json"]);
        assert_eq!(run.code, 2, "{}", run.output);
        assert!(run.errors.contains("first.json"), "{}", run.errors);
        run.errors
    };
    let mut other: Value = serde_json::from_str(&report).unwrap();
    other["rig"] = "another".into();
    assert!(resume(&other.to_string()).contains("found `another`"));
    let mut fewer: Value = serde_json::from_str(&report).unwrap();
    fewer["hinges"].as_array_mut().unwrap().pop();
    assert!(resume(&fewer.to_string()).contains("expected 13 hinges, found 12"));
    assert!(resume("{}").contains("no report of a run"));
}

#[test]
fn servos_that_were_interrupted_must_be_put_back_by_hand() {
    let place = Scratch::new("resume_servo");
    let mut report: Value = serde_json::from_str(&broken_off(&place, "sma")).unwrap();
    let servo =
        report["hinges"].as_array_mut().unwrap().iter_mut().find(|hinge| hinge["kind"] == "servo").unwrap();
    servo["outcome"] = "interrupted".into();
    let hinge = servo["hinge"].to_string();
    place.write("first.json", &report.to_string());
    let resume = ["deploy", "plan.fold", "--rig", "good.toml", "--sim", "--resume", "first.json"];
    let run = place.zygote(&resume);
    assert_eq!(run.code, 2);
    assert!(run.errors.contains(&format!("the servos of hinges {hinge} were interrupted")), "{}", run.errors);
    let run = place.zygote(&[&resume[..], &["--interrupted-are-back"]].concat());
    assert_eq!(run.code, 0, "{}", run.errors);
}
