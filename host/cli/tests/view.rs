//! `zygote view` as a user meets it, as far as no browser is needed; the page itself is tested in one, in `host/viewer`.

mod scratch;

use scratch::{Scratch, model};
use std::net::{Ipv4Addr, TcpListener};

fn with_plans(name: &str) -> Scratch {
    let place = Scratch::new(name);
    for (shape, file) in [("i14.txt", "i.fold"), ("l14.txt", "l.fold")] {
        let run = place.zygote(&["plan", &model(shape), "--piles", "2", "--free", "ideal", "-o", file]);
        assert_eq!(run.code, 0, "{}", run.errors);
    }
    place
}

#[test]
fn what_cannot_be_shown_is_refused_with_exit_code_2() {
    let place = with_plans("view_refused");
    let refused = |arguments: &[&str], said: &str| {
        let run = place.zygote(&[&["view", "--no-open"], arguments].concat());
        assert_eq!(run.code, 2, "{}", run.errors);
        assert!(run.errors.contains(said), "{}", run.errors);
        assert_eq!(run.output, "");
    };
    refused(&["none.fold"], "none.fold: cannot be read");
    place.write("list.fold", "[]");
    refused(&["list.fold"], "list.fold: no plan");
    refused(&["i.fold", "--schedule", "none.json"], "none.json: cannot be read");
    refused(&["i.fold", "--at", "0.5"], "--png");
    refused(&["i.fold", "--rig", "none.toml"], "none.toml: cannot be read");
}

#[test]
fn a_schedule_of_another_plan_or_of_the_way_back_is_refused() {
    let place = with_plans("view_schedules");
    let rig = model("rigs/servo-160.toml");
    let run = place.zygote(&["schedule", "i.fold", "--rig", &rig, "-o", "i.json"]);
    assert_eq!(run.code, 0, "{}", run.errors);
    let run = place.zygote(&["view", "l.fold", "--schedule", "i.json", "--no-open"]);
    assert_eq!(run.code, 2);
    assert!(run.errors.contains("i.json: is for plan"), "{}", run.errors);
    let run = place.zygote(&["fold", "i.fold", "--rig", &rig, "--schedule", "i.json", "-o", "back.json"]);
    assert_eq!(run.code, 0, "{}", run.errors);
    let run = place.zygote(&["view", "i.fold", "--schedule", "back.json", "--no-open"]);
    assert_eq!(run.code, 2);
    assert!(run.errors.contains("back.json: is a way back"), "{}", run.errors);
}

#[test]
fn a_port_that_is_taken_is_told() {
    let place = with_plans("view_port");
    let taken = TcpListener::bind((Ipv4Addr::LOCALHOST, 0)).expect("a free port");
    let port = taken.local_addr().expect("it has one").port().to_string();
    let run = place.zygote(&["view", "i.fold", "--no-open", "--port", &port]);
    assert_eq!(run.code, 2);
    assert!(run.errors.contains(&format!("port {port} of this computer can't be used")), "{}", run.errors);
    assert!(run.errors.contains("because: "), "{}", run.errors);
}

#[test]
fn without_a_browser_no_picture_is_written() {
    let place = with_plans("view_browser");
    let run = place.zygote(&["view", "i.fold", "--png", "i.png", "--browser", "/nowhere/chromium"]);
    assert_eq!(run.code, 2);
    assert!(run.errors.contains("/nowhere/chromium: no such program"), "{}", run.errors);
    let run = place.zygote(&["view", "i.fold", "--png", "i.png", "--colour", "torque"]);
    assert_eq!(run.code, 2);
    assert!(run.errors.contains("needs a --rig"), "{}", run.errors);
    let run = place.zygote(&["view", "i.fold", "--png", "i.png", "--colour", "drive"]);
    assert_eq!(run.code, 2);
    assert!(run.errors.contains("needs a schedule"), "{}", run.errors);
    assert!(!place.files().contains(&"i.png".to_owned()));
}

/// A plan with its schedule, and a run of it that was recorded.
fn with_recording(name: &str) -> (Scratch, String) {
    let place = with_plans(name);
    let rig = model("rigs/servo-160.toml");
    for arguments in [
        &["schedule", "i.fold", "--rig", &rig][..],
        &["deploy", "i.fold", "--rig", &rig, "--sim", "--record", "i.mcap"],
    ] {
        let run = place.zygote(arguments);
        assert_eq!(run.code, 0, "{}", run.errors);
    }
    (place, rig)
}

#[test]
fn a_run_that_cannot_be_shown_is_refused_before_anything_moves() {
    let (place, rig) = with_recording("view_runs");
    let taken = TcpListener::bind((Ipv4Addr::LOCALHOST, 0)).expect("a free port");
    let port = taken.local_addr().expect("it has one").port().to_string();
    let files = place.files();
    let refused = |arguments: &[&str], said: &str| {
        let run = place.zygote(arguments);
        assert_eq!(run.code, 2, "{arguments:?}: {}", run.errors);
        assert!(run.errors.contains(said), "{arguments:?}: {}", run.errors);
        assert_eq!(place.files(), files);
    };
    let told = format!("port {port} of this computer can't be used; leave out --view-port");
    refused(&["deploy", "i.fold", "--rig", &rig, "--sim", "--view", "--view-port", &port], &told);
    refused(&["serve", "i.fold", "--rig", &rig, "--sim", "--view-port", &port], &told);
    refused(&["replay", "i.mcap", "--view", "--view-port", &port], &told);
    refused(&["deploy", "i.fold", "--rig", &rig, "--sim", "--pace", "5"], "--pace needs --view");
    refused(&["deploy", "i.fold", "--rig", &rig, "--sim", "--yes"], "--view");
    refused(&["deploy", "i.fold", "--rig", &rig, "--sim", "--view", "--pace", "0"], "0.01 to 10000");
    refused(&["serve", "l.fold", "--rig", &rig, "--sim"], "there is nothing to run");
    refused(&["serve", "i.mcap", "--rig", &rig, "--sim"], "i.mcap: cannot be read");
    refused(&["replay", "i.mcap", "--plan", "l.fold"], "i.mcap: is of plan");
}

#[test]
fn a_schedule_is_served_with_its_plan_alone() {
    let (place, rig) = with_recording("view_serve");
    let run = place.zygote(&["fold", "i.fold", "--rig", &rig, "-o", "back.json"]);
    assert_eq!(run.code, 0, "{}", run.errors);
    let run = place.zygote(&["serve", "l.fold", "back.json", "--rig", &rig, "--sim"]);
    assert_eq!(run.code, 2, "{}", run.errors);
    assert!(run.errors.contains("which none of the plans named is"), "{}", run.errors);
}
