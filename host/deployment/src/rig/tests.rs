//! Good rig files, and what is said of bad ones.

use super::*;
use crate::testing::{rig_text, tree_plan};
use crate::tree::Tree;
use zygote_stacking::HingeKind;

fn rig(extra: &str) -> Rig {
    Rig::read("rig.toml", &rig_text(extra)).expect("a good rig")
}

fn refusal(text: &str) -> String {
    Rig::read("rig.toml", text).expect_err("a bad rig").to_string()
}

/// The refusal of a good rig file in which one piece is replaced by another.
fn changed(from: &str, to: &str) -> String {
    let text = rig_text("[sma]\ntarget = \"95 degC\"\nmax_on = \"20 s\"\n");
    assert!(text.contains(from), "{from} must be in the good file");
    refusal(&text.replace(from, to))
}

#[test]
fn the_example_rigs_are_good() {
    for (name, hinges) in [("sma-bench", 13), ("sma-160", 143), ("servo-160", 143), ("mixed", 13)] {
        let path = format!("{}/../../models/rigs/{name}.toml", env!("CARGO_MANIFEST_DIR"));
        let rig = Rig::read(&path, &std::fs::read_to_string(&path).expect("the file")).expect("a good rig");
        assert_eq!(rig.id, name);
        assert_eq!(rig.fit(hinges).expect("channels for all").len(), hinges);
    }
}

#[test]
fn what_is_not_in_the_file_has_its_default() {
    let rig = rig("");
    assert_eq!(rig.link, Link { timeout: Seconds(1.0), baud: 921_600 });
    assert_eq!(rig.sim.ambient, Celsius(22.0));
    let Drive::Sma(sma) = rig.fit(1).expect("a heater")[0].drive else { panic!("the default kind is sma") };
    assert_eq!((sma.target, sma.hold), (Celsius(95.0), Seconds(1.0)));
}

#[test]
fn a_hinge_takes_its_own_setting_before_the_shared_one() {
    let rig =
        rig("[sma]\nhold = \"2 s\"\nrest = \"3 s\"\n[[hinge]]\nhinge = 1\nsma = { hold = \"500 ms\" }\n");
    let hold_and_rest: Vec<_> = rig
        .fit(2)
        .expect("heaters")
        .iter()
        .map(|fitting| match fitting.drive {
            Drive::Sma(sma) => (sma.hold.0, sma.rest.0),
            Drive::Servo(_) | Drive::Spring(_) => panic!("the default kind is sma"),
        })
        .collect();
    assert_eq!(hold_and_rest, [(2.0, 3.0), (0.5, 3.0)]);
}

#[test]
fn free_channels_are_dealt_out_around_those_that_are_taken() {
    let rig = rig("[[hinge]]\nhinge = 2\nchannel = 0\n[[hinge]]\nhinge = 1\nkind = \"servo\"\n");
    let channels: Vec<_> =
        rig.fit(4).expect("channels").iter().map(|fit| (fit.drive.kind(), fit.channel)).collect();
    assert_eq!(channels, [(Kind::Sma, 1), (Kind::Servo, 0), (Kind::Sma, 0), (Kind::Sma, 2)]);
}

#[test]
fn hinges_go_to_the_node_of_the_hinge_before_them_and_to_the_next_where_that_is_full() {
    // A trunk 0 - 1 - 2, with a branch of three at its first panel and another at its last.
    let plan = tree_plan(&[0, 1, 2, 1, 4, 5, 3, 7, 8], &[HingeKind::Fold; 9]);
    let text =
        rig_text("[[node]]\nname = \"b\"\nheaters = 16\n[[hinge]]\nhinge = 3\nnode = \"b\"\nchannel = 0\n");
    let rig = Rig::read("rig.toml", &text.replace("name = \"a\"\nheaters = 16", "name = \"a\"\nheaters = 5"));
    let fittings =
        rig.expect("a good rig").fit_tree(&Tree::new(&plan).expect("a tree")).expect("channels for all");
    let sockets: Vec<_> = fittings.iter().map(|fitting| (fitting.node, fitting.channel)).collect();
    // Hinge 3 is given away, and takes 4 and 5 with it; the rest goes along the trunk until its node is full.
    assert_eq!(sockets, [(0, 0), (0, 1), (0, 2), (1, 0), (1, 1), (1, 2), (0, 3), (0, 4), (1, 3)]);
}

#[test]
fn a_wrong_key_is_refused_with_its_line() {
    insta::assert_snapshot!(changed("limit =", "limt ="), @"rig.toml:6: unknown field `limt`, expected one of `voltage`, `limit`, `resistance`");
    insta::assert_snapshot!(changed("limit = \"2 A\"\n", ""), @"rig.toml:4: missing field `limit`");
    insta::assert_snapshot!(changed("limit =", "limit"), @"rig.toml:6: key with no value, expected `=`");
}

#[test]
fn a_wrong_unit_is_refused_with_its_line() {
    insta::assert_snapshot!(changed("\"2 A\"", "\"2 V\""), @r#"rig.toml:6: expected a current with its unit, as in "2 A" or "500 mA", found "2 V""#);
    insta::assert_snapshot!(changed("\"2 A\"", "2"), @r#"rig.toml:6: invalid type: integer `2`, expected a current with its unit, as in "2 A" or "500 mA""#);
}

#[test]
fn another_version_is_refused_before_its_keys_are_looked_at() {
    let text = rig_text("colour = \"red\"\n");
    insta::assert_snapshot!(refusal(&text.replace("version = 1", "version = 2")), @"rig.toml:1: version: expected version 1, found 2");
    insta::assert_snapshot!(refusal(&text.replace("version = 1\n", "")), @"rig.toml: version: expected version 1, found none");
}

#[test]
fn values_that_cannot_work_are_refused_with_their_place() {
    let refusals = [
        changed("bench-1", "a bench with a name that is far too long"),
        changed("[[node]]", "[link]\ntimeout = \"6 s\"\n[[node]]"),
        changed("\"5 V\"", "\"0 V\""),
        changed("\"50 mohm\"", "\"3 ohm\""),
        changed("95 degC", "125 degC"),
        changed("95 degC", "70 degC"),
        changed("20 s", "800 ms"),
        changed("20 s", "6 s"),
        changed("max_on", "thermal_resistance = \"60 K/W\"\nmax_on"),
        changed("max_on", "heater_resistance = \"2 ohm\"\nmax_on"),
        refusal(&rig_text("[servo]\npulse_270 = \"500 us\"\n")),
        refusal(&rig_text("[spring]\ncurrent = \"2.5 A\"\n")),
        refusal(&rig_text("[[hinge]]\nhinge = 3\n[[hinge]]\nhinge = 3\n")),
        refusal(&rig_text("[[hinge]]\nhinge = 3\nkind = \"servo\"\nsma = { hold = \"1 s\" }\n")),
        refusal(&rig_text("[[hinge]]\nhinge = 3\nkind = \"motor\"\n")),
        refusal(&rig_text("[[node]]\nname = \"a\"\n")),
        refusal(&rig_text("[[hinge]]\nhinge = 3\nnode = \"b\"\n")),
        refusal(&rig_text("[[node]]\nname = \"b\"\n[[hinge]]\nhinge = 3\nchannel = 1\n")),
        refusal(&rig_text("[sim.sma]\nmartensite_finish = \"60 degC\"\n")),
    ];
    insta::assert_snapshot!(refusals.join("\n"));
}

#[test]
fn a_simulated_servo_is_what_the_rig_file_says_unless_the_simulators_truth_differs() {
    let servos = "[hinges]\ndefault = \"servo\"\n[servo]\npulse_0 = \"600 us\"\n[[hinge]]\nhinge = 1\nservo = { pulse_270 = \"2300 us\" }\n\
                  [sim.servo]\nbacklash = \"1 deg\"\n[[sim.hinge]]\nhinge = 2\nservo = { pulse_0 = \"650 us\", bow = \"-9 deg\" }\n";
    let rig = rig(servos);
    let pulses = |hinge| {
        let (pulse_0, pulse_270) = rig.true_pulses(hinge);
        ((pulse_0.0 * 1e6).round(), (pulse_270.0 * 1e6).round())
    };
    assert_eq!([pulses(0), pulses(1), pulses(2)], [(600.0, 2500.0), (600.0, 2300.0), (650.0, 2500.0)]);
    let (other, own) = (rig.sim.servo_plant(1), rig.sim.servo_plant(2));
    assert_eq!((other.bow, own.bow, own.backlash), (Degrees(0.0), Degrees(-9.0), Degrees(1.0)));
    let bad = |extra: &str| refusal(&rig_text(extra));
    assert!(
        bad("[sim.servo]\nbow = \"70 deg\"\n")
            .starts_with("rig.toml:14: sim.servo.bow: expected -67 deg to 67 deg")
    );
    assert!(
        bad("[sim.servo]\nstop_high = \"-1 deg\"\n")
            .contains("sim.servo.stop_low: expected less than stop_high")
    );
    let twice = bad("[[sim.hinge]]\nhinge = 0\nservo = { pulse_0 = \"1 ms\", pulse_270 = \"1 ms\" }\n");
    assert!(twice.contains("sim.hinge (hinge 0): servo.pulse_270: expected another pulse"), "{twice}");
}

#[test]
fn a_gain_watch_that_ends_after_the_heating_is_refused() {
    insta::assert_snapshot!(changed("max_on", "gain_window = \"21 s\"\nmax_on"), @"rig.toml:15: sma.gain_window: expected at most max_on = 20 s, found 21 s");
}

#[test]
fn a_rig_that_does_not_suit_a_plan_is_refused() {
    let unfit = |extra: &str, hinges| rig(extra).fit(hinges).expect_err("no fit").to_string();
    let refusals = [
        unfit("", 17),
        unfit("[hinges]\ndefault = \"servo\"\n", 5),
        unfit("[[hinge]]\nhinge = 13\n", 13),
        unfit("[[hinge]]\nhinge = 1\nchannel = 16\n", 13),
        unfit("[[hinge]]\nhinge = 1\nchannel = 3\n[[hinge]]\nhinge = 2\nchannel = 3\n", 13),
        unfit("[[node]]\nname = \"b\"\nheaters = 16\n", 33),
        unfit(
            "[[node]]\nname = \"b\"\nheaters = 1\n[[hinge]]\nhinge = 1\nnode = \"b\"\n[[hinge]]\nhinge = 2\nnode = \"b\"\n",
            13,
        ),
        unfit("[[sim.hinge]]\nhinge = 20\nsma = { load = \"1 mNm\" }\n", 13),
    ];
    insta::assert_snapshot!(refusals.join("\n"));
}

#[test]
fn weights_ratings_and_directions_that_cannot_be_are_refused_with_their_line() {
    for (extra, said) in [
        ("[panel]\nmass = \"0 g\"\n", "rig.toml:14: panel.mass: expected more than 0, found 0 g"),
        ("[panel]\nmass = \"-12 g\"\n", "rig.toml:14: panel.mass: expected more than 0, found -12 g"),
        (
            "[panel]\ndensity = \"0 kg/m2\"\n",
            "rig.toml:14: panel.density: expected more than 0, found 0 g/m2",
        ),
        (
            "[panel]\nmass = \"1 g\"\ndensity = \"1 kg/m2\"\n",
            "rig.toml:15: panel.density: expected either a mass or a density, found both",
        ),
        (
            "[panel]\nmass = 12\n",
            "rig.toml:14: invalid type: integer `12`, expected a mass with its unit, as in \"12 g\"",
        ),
        (
            "[gravity]\ndirection = [0, 0, 0]\n",
            "rig.toml:14: gravity.direction: expected three finite numbers, not all of them 0, found [0.0, 0.0, 0.0]",
        ),
        (
            "[gravity]\ndirection = [0, nan, 1]\n",
            "rig.toml:14: gravity.direction: expected three finite numbers",
        ),
        ("[sma]\ntorque = \"0 mNm\"\n", "rig.toml:14: sma.torque: expected more than 0, found 0 Nm"),
        ("[servo]\ntorque = []\n", "rig.toml"),
        (
            "[sma]\ntorque = [[\"90 deg\", \"1 Nm\"], [\"10 deg\", \"1 Nm\"]]\n",
            "rig.toml:14: sma.torque: expected rising angles",
        ),
        (
            "[sma]\ntorque = [[\"300 deg\", \"1 Nm\"]]\n",
            "rig.toml:14: sma.torque: expected 0 deg to 270 deg, found 300 deg",
        ),
        (
            "[[hinge]]\nhinge = 1\nsma = { torque = \"-1 Nm\" }\n",
            "rig.toml:15: hinge[0].sma.torque: expected more than 0, found -1 Nm",
        ),
    ] {
        let refused = refusal(&rig_text(extra));
        assert!(refused.starts_with(said), "{extra}: {refused}");
    }
}

#[test]
fn a_panel_weighs_its_mass_or_its_density_times_its_area() {
    let mass = |extra: &str| rig(extra).panel_mass(Millimetres(100.0)).expect("a mass").0;
    assert!((mass("[panel]\nmass = \"12 g\"\n") - 12.0).abs() < 1e-12);
    assert!((mass("[panel]\ndensity = \"1.5 kg/m2\"\n") - 15.0).abs() < 1e-12);
}

#[test]
fn the_defaults_of_a_kind_that_the_rig_lacks_need_not_suit_it() {
    let text = rig_text("[hinges]\ndefault = \"servo\"\n").replace("2 A", "300 mA");
    Rig::read("rig.toml", &text).expect("no spring here draws 1 A");
    insta::assert_snapshot!(refusal(&(text + "[spring]\npulse = \"1 s\"\n")), @"rig.toml: spring.current: expected at most supply.limit = 0.3 A, found 1 A");
}
