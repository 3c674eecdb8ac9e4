//! `zygote torque`, `zygote table`, `zygote assembly` and the Gantt chart as a user meets them.

#![expect(clippy::unwrap_used, reason = "output without its lines fails the test")]

mod scratch;

use scratch::{Scratch, model};

const RIG: &str = "version = 1\n[rig]\nid = \"bench-1\"\n[supply]\nvoltage = \"5 V\"\nlimit = \"2 A\"\n\
                   resistance = \"50 mohm\"\n[[node]]\nname = \"a\"\nheaters = 16\n";

/// A folder with a plan of 14 panels and a rig whose panels weigh so much.
fn planned(name: &str, mass: &str) -> Scratch {
    let place = Scratch::new(name);
    let run = place.zygote(&["plan", &model("l14.txt"), "--piles", "2", "-o", "plan.fold"]);
    assert_eq!(run.code, 0, "{}", run.errors);
    place.write("rig.toml", &format!("{RIG}[panel]\nmass = \"{mass}\"\n"));
    place
}

fn number(text: &str, line: usize, column: usize) -> f64 {
    text.lines().nth(line).unwrap().split(',').nth(column).unwrap().parse().unwrap()
}

#[test]
fn overloads_are_listed_and_end_with_exit_code_1_unless_allowed() {
    let place = planned("torque_overload", "100 g");
    let command = ["torque", "plan.fold", "--rig", "rig.toml", "--allow-tipping"];
    let run = place.zygote(&command);
    assert_eq!(run.code, 1, "{}", run.output);
    assert!(run.errors.contains("hinges are overloaded"), "{}", run.errors);
    assert!(run.output.contains("13 hinges in the order of the tree, panels of 100 g"), "{}", run.output);
    assert_eq!(run.output.lines().filter(|line| line.contains("34.00")).count(), 10, "{}", run.output);
    let allowed = place.zygote(&[&command[..], &["--allow-overload"]].concat());
    assert_eq!((allowed.code, &allowed.output), (0, &run.output));
    let light = planned("torque_light", "1 g").zygote(&command);
    assert_eq!(light.code, 0, "{}", light.errors);
    assert!(light.output.contains("0 beyond their rating"), "{}", light.output);
}

#[test]
fn torque_grows_with_the_mass_in_table_and_json_alike() {
    let (one, two) = (planned("torque_one", "10 g"), planned("torque_two", "20 g"));
    let command = [
        "torque",
        "plan.fold",
        "--rig",
        "rig.toml",
        "--json",
        "-o",
        "loads.csv",
        "--allow-overload",
        "--allow-tipping",
    ];
    let [first, second] = [&one, &two].map(|place| {
        let run = place.zygote(&command);
        assert_eq!(run.code, 0, "{}", run.errors);
        let json: serde_json::Value = serde_json::from_str(&run.output).unwrap();
        (json, place.read("loads.csv"))
    });
    let worst = |json: &serde_json::Value| json["worst"][0]["torque_nm"].as_f64().unwrap();
    assert!((worst(&second.0) / worst(&first.0) - 2.0).abs() < 1e-9);
    assert_eq!(first.1.lines().count(), 14);
    for line in 1..14 {
        for column in [3, 7] {
            let (one, two) = (number(&first.1, line, column), number(&second.1, line, column));
            assert!((two - 2.0 * one).abs() < 1e-3, "line {line}: {one} and {two} mNm");
        }
    }
    assert_eq!(first.0["steps"], 13);
    assert_eq!(first.0["tipping"]["support"], "touching");
}

#[test]
fn the_order_is_that_of_the_schedule_where_there_is_one() {
    let place = planned("torque_schedule", "1 g");
    let schedule = ["schedule", "plan.fold", "--rig", "rig.toml", "--allow-tipping"];
    assert_eq!(place.zygote(&schedule).code, 0);
    let root = ["torque", "plan.fold", "--rig", "rig.toml", "--support", "root", "--allow-tipping"];
    let run = place.zygote(&root);
    assert_eq!(run.code, 0, "{}", run.errors);
    assert!(
        run.output.contains("in the order of its schedule, but one by one, panels of 1 g"),
        "{}",
        run.output
    );
    assert!(run.output.contains("tipping: on the root it "), "{}", run.output);
}

#[test]
fn a_rig_that_does_not_say_what_panels_weigh_is_refused() {
    let place = planned("torque_refused", "1 g");
    for (extra, said) in [
        ("", "panel.mass: expected what a panel weighs, as in mass = \"12 g\", found none"),
        ("[panel]\nmass = \"0 g\"\n", "rig.toml:12: panel.mass: expected more than 0, found 0 g"),
        ("[sma]\ntorque = \"-3 mNm\"\n", "rig.toml:12: sma.torque: expected more than 0, found -0.003 Nm"),
    ] {
        place.write("rig.toml", &format!("{RIG}{extra}"));
        let run = place.zygote(&["torque", "plan.fold", "--rig", "rig.toml", "-o", "loads.csv"]);
        assert_eq!(run.code, 2, "{}", run.output);
        assert!(run.errors.contains(said), "{}", run.errors);
    }
    assert_eq!(place.files(), ["plan.fold", "rig.toml"]);
}

#[test]
fn what_tips_ends_with_exit_code_1_unless_allowed() {
    let place = planned("torque_tipping", "1 g");
    for verb in ["torque", "schedule"] {
        let command = [verb, "plan.fold", "--rig", "rig.toml"];
        let run = place.zygote(&command);
        assert_eq!(run.code, 1, "{}", run.output);
        assert!(
            run.errors.contains("plan.fold: it tips; ") && !run.errors.contains("overloaded"),
            "{}",
            run.errors
        );
        assert!(run.output.contains("tipping: "), "{}", run.output);
        let allowed = place.zygote(&[&command[..], &["--allow-tipping"]].concat());
        assert_eq!(allowed.code, 0, "{}", allowed.errors);
        assert!(allowed.output.contains("tipping: "), "{}", allowed.output);
    }
}

#[test]
fn a_schedule_refuses_overloads_and_keeps_what_was_weighed() {
    let place = planned("schedule_overload", "100 g");
    let command = ["schedule", "plan.fold", "--rig", "rig.toml", "-o", "schedule.json", "--allow-tipping"];
    let run = place.zygote(&command);
    assert_eq!(run.code, 1, "{}", run.output);
    assert!(run.errors.contains("hinges are overloaded; choose another root"), "{}", run.errors);
    assert_eq!(
        run.output.lines().filter(|line| line.starts_with("overload: hinge ")).count(),
        5,
        "{}",
        run.output
    );
    assert!(run.output.contains("in the shape itself, whatever the order"), "{}", run.output);
    assert_eq!(place.files(), ["plan.fold", "rig.toml"], "nothing is written");
    let run = place.zygote(&[&command[..], &["--allow-overload"]].concat());
    assert_eq!(run.code, 0, "{}", run.errors);
    let json: serde_json::Value = serde_json::from_str(&place.read("schedule.json")).unwrap();
    let loads = &json["loads"];
    assert_eq!((&loads["panel_mass_g"], &loads["support"]), (&100.0.into(), &"touching".into()));
    let torque = ["torque", "plan.fold", "--rig", "rig.toml", "--schedule", "schedule.json", "--json"];
    let told = place.zygote(&torque);
    assert_eq!(told.code, 1, "{}", told.errors);
    let told: serde_json::Value = serde_json::from_str(&told.output).unwrap();
    let worst = told["worst"][0]["factor"].as_f64().unwrap();
    assert!((loads["worst_factor"].as_f64().unwrap() - worst).abs() < 1e-9);
    let mut overloaded: Vec<_> =
        told["overloads"].as_array().unwrap().iter().map(|load| load["hinge"].as_u64().unwrap()).collect();
    overloaded.sort_unstable();
    overloaded.dedup();
    assert_eq!(loads["overloaded"], serde_json::json!(overloaded));
    // Heavier panels on the rig are another weighing.
    place.write("rig.toml", &format!("{RIG}[panel]\nmass = \"101 g\"\n"));
    let run = place.zygote(&torque);
    assert_eq!(run.code, 2, "{}", run.output);
    assert!(run.errors.contains("loads.panel_mass_g should be 101, found 100"), "{}", run.errors);
}

#[test]
fn an_order_that_spares_the_hinges_is_taken_where_there_is_one() {
    let place = Scratch::new("schedule_lighter");
    let plan = ["plan", &model("l14.txt"), "--piles", "2", "--bridges", "base", "-o", "plan.fold"];
    assert_eq!(place.zygote(&plan).code, 0);
    place.write("rig.toml", &format!("{RIG}[panel]\nmass = \"5 g\"\n"));
    let run = place.zygote(&["schedule", "plan.fold", "--rig", "rig.toml", "--allow-tipping"]);
    assert_eq!(run.code, 0, "{}", run.errors);
    assert!(
        run.output.contains("order: 1 hinges overloaded as first found, 0 in the lightest of "),
        "{}",
        run.output
    );
    let check = place.zygote(&["check", "plan.fold", "--motion"]);
    assert_eq!(check.code, 0, "{}", check.errors);
}

#[test]
fn a_schedule_is_drawn_as_a_chart_and_printed_as_a_table() {
    let place = planned("gantt", "1 g");
    let chart = ["picture", "plan.fold", "--view", "gantt", "-o", "gantt.svg"];
    for command in [&chart[..], &["table", "plan.fold"]] {
        let run = place.zygote(command);
        assert_eq!(run.code, 2);
        assert!(run.errors.contains("has no schedule"), "{}", run.errors);
    }
    let schedule = ["schedule", "plan.fold", "--rig", "rig.toml", "--parallel", "3", "--allow-tipping"];
    assert_eq!(place.zygote(&schedule).code, 0);
    let run = place.zygote(&chart);
    assert_eq!(run.code, 0, "{}", run.errors);
    assert!(place.read("gantt.svg").contains("limit 2 A"));
    let run = place.zygote(&["table", "plan.fold"]);
    assert_eq!((run.code, run.output.lines().count()), (0, 14), "{}", run.errors);
    assert_eq!(place.zygote(&["table", "plan.fold", "-o", "table.csv"]).code, 0);
    assert_eq!(place.read("table.csv"), run.output);
}

#[test]
fn people_read_every_hinge_once_in_the_order_of_the_tree_or_of_the_schedule() {
    let place = planned("assembly", "1 g");
    let run = place.zygote(&["assembly", "plan.fold"]);
    assert_eq!(run.code, 0, "{}", run.errors);
    assert!(run.output.starts_with("plan.fold: 13 hinges by hand, in the order of the tree. Panel "));
    for number in 1..=13 {
        let start = format!("{number:>2}. ");
        assert_eq!(run.output.lines().filter(|line| line.starts_with(&start)).count(), 1, "{}", run.output);
    }
    assert!(run.output.contains("\nPile on cell (0,0)\n"), "{}", run.output);
    assert!(run.output.contains("\nFrom the pile on cell "), "{}", run.output);
    assert_eq!(place.zygote(&["assembly", "plan.fold", "-o", "hands.csv"]).code, 0);
    let table = place.read("hands.csv");
    let hinges =
        |text: &str, column: usize| -> Vec<f64> { (1..14).map(|line| number(text, line, column)).collect() };
    let mut once = hinges(&table, 1);
    once.sort_by(f64::total_cmp);
    assert_eq!(once, (0..13).map(f64::from).collect::<Vec<_>>());
    let schedule = ["schedule", "plan.fold", "--rig", "rig.toml", "--parallel", "4", "--allow-tipping"];
    assert_eq!(place.zygote(&schedule).code, 0);
    assert_eq!(place.zygote(&["assembly", "plan.fold", "-o", "hands.csv"]).code, 0);
    let (by_hand, steps) = (place.read("hands.csv"), place.zygote(&["table", "plan.fold"]).output);
    assert_eq!(hinges(&by_hand, 1), hinges(&steps, 1));
    assert!(place.zygote(&["assembly", "plan.fold"]).output.contains("in the order of its schedule"));
}

#[test]
fn servos_fold_a_shape_up_again_and_other_hinges_are_refused_by_name() {
    let place = planned("fold_back", "1 g");
    let servos = RIG.replace("heaters = 16", "servos = 16") + "[hinges]\ndefault = \"servo\"\n";
    place.write("servos.toml", &servos);
    assert_eq!(
        place
            .zygote(&["schedule", "plan.fold", "--rig", "servos.toml", "--sequential", "-o", "there.json"])
            .code,
        0
    );
    let fold = |rig: &str, there: &str| {
        place.zygote(&["fold", "plan.fold", "--rig", rig, "--schedule", there, "-o", "back.json"])
    };
    let run = fold("servos.toml", "there.json");
    assert_eq!(run.code, 0, "{}", run.errors);
    let json = |name: &str| -> serde_json::Value { serde_json::from_str(&place.read(name)).unwrap() };
    let (there, back) = (json("there.json"), json("back.json"));
    assert_eq!(there["steps"][0]["hinge"], back["steps"][12]["hinge"]);
    assert_eq!(there["steps"][0]["motion"]["from_us"], back["steps"][12]["motion"]["to_us"]);
    assert_eq!(back["steps"][1]["after"], serde_json::json!([0]));
    let sma = ["schedule", "plan.fold", "--rig", "rig.toml", "--allow-tipping", "-o", "sma.json"];
    assert_eq!(place.zygote(&sma).code, 0);
    let run = fold("rig.toml", "sma.json");
    assert_eq!(run.code, 2, "{}", run.output);
    assert!(run.errors.contains("is a sma hinge, which doesn't close by itself"), "{}", run.errors);
}
