//! `zygote calibrate --servo` as a user meets it: angles typed or read by a sensor become pulses, and runs are driven by them.
#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]

mod scratch;

use scratch::{Run, Scratch};
use serde_json::Value;

const RIG: &str = r#"
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
servos = 16

[hinges]
default = "servo"

[[sim.hinge]]
hinge = 0
servo = { pulse_0 = "620 us", pulse_270 = "2380 us", bow = "14 deg", backlash = "0.2 deg" }

[[sim.hinge]]
hinge = 1
servo = { pulse_0 = "2450 us", pulse_270 = "560 us", stop_high = "200 deg" }
"#;

/// What hinges 0 and 1 truly do, but for their play.
fn truth_deg(hinge: usize, pulse_us: f64) -> f64 {
    let (at_0_us, at_270_us, bow_deg) = [(620.0, 2380.0, 14.0), (2450.0, 560.0, 0.0)][hinge];
    let share = ((pulse_us - at_0_us) / (at_270_us - at_0_us)).clamp(0.0, 1.0);
    270.0 * share + 4.0 * bow_deg * share * (1.0 - share)
}

fn calibrate(place: &Scratch, rig: &str, more: &[&str], input: &str) -> Run {
    place.write("rig.toml", rig);
    place.zygote_told(&[&["calibrate", "--rig", "rig.toml", "--sim"], more].concat(), input)
}

/// Angles and pulses of a hinge in the calibration file.
fn points(place: &Scratch, hinge: usize) -> Vec<(f64, f64)> {
    let text = place.read("calibration.toml");
    let start = format!("[[hinge]]\nhinge = {hinge}\n");
    let part = text.split(&start).nth(1).unwrap().split("[[hinge]]").next().unwrap().to_owned();
    let number = |line: &str| line.split('"').nth(1).unwrap().split(' ').next().unwrap().parse().unwrap();
    let of = |key: &str| part.lines().filter(|line| line.starts_with(key)).map(number).collect::<Vec<f64>>();
    let pulses = of("pulse = ");
    // Angles without a pulse come after those with one.
    of("angle = ").into_iter().zip(pulses).collect()
}

#[test]
fn the_truth_of_simulated_servos_is_found_by_a_sensor_and_what_they_dont_reach_is_told() {
    let place = Scratch::new("calibrates_servos");
    // With 2 A a servo that pushes is told by its current, with 1 A by the MCU's fault.
    for limit in ["2 A", "1 A"] {
        let rig = RIG.replace("\"2 A\"", &format!("\"{limit}\""));
        let run = calibrate(&place, &rig, &["--servo", "0", "--servo", "1", "--sensor", "sim"], "");
        assert_eq!(run.code, 0, "{}{}", run.output, run.errors);
        assert!(
            run.output.contains("hinge 1 has no pulse for 270 deg: the hinge ends at 200.0 deg"),
            "{}",
            run.output
        );
        assert_eq!((points(&place, 0).len(), points(&place, 1).len()), (4, 3), "{}", run.output);
        for hinge in [0, 1] {
            for (angle, pulse) in points(&place, hinge) {
                let off = truth_deg(hinge, pulse) - angle;
                assert!(off.abs() <= 1.0 + 0.1 + 0.4, "hinge {hinge}: {off} at {angle}, {pulse} us");
            }
        }
        let page = place.read("calibration.servos.html");
        assert!(page.matches("<svg").count() == 2 && page.contains("end stop, 200.0 deg"), "{page}");
        let records: Value = serde_json::from_slice(&place.bytes("calibration.servos.json")).unwrap();
        assert_eq!(records["complete"].as_bool(), Some(true));
        let pushed = records["hinges"][1]["looks"].as_array().unwrap().iter().filter(|look| look[2] == true);
        assert_eq!(pushed.count(), 1, "it goes there once: {records}");
    }
}

#[test]
fn typed_angles_are_taken_and_what_isnt_understood_or_cant_be_is_asked_again() {
    let place = Scratch::new("calibrates_typed");
    let input = "135\nninety\n400\n+5\n90.7\n45\n0\n180\n225\n27\n27O\n270\n270\n";
    let run = calibrate(&place, RIG, &["--servo", "2"], input);
    assert_eq!(run.code, 0, "{}{}", run.output, run.errors);
    for told in [
        "\"ninety\" isn't understood",
        "no hinge opens to 400.0 deg: expected -30 to 300 deg: please read it again",
        "hinge 2, 1172 us, looking for 90 deg: angle?",
        "27.0 deg contradicts the",
        "\"27O\" isn't understood",
    ] {
        assert!(run.output.contains(told), "{told} isn't in {}", run.output);
    }
    let found = points(&place, 2);
    assert_eq!(
        found.iter().map(|(angle, _)| *angle).collect::<Vec<_>>(),
        [0.0, 90.0, 180.0, 270.0],
        "{}",
        run.output
    );
    assert!((found[1].1 - 1172.0).abs() < 0.5, "as it was nudged: {found:?}");
    let text = place.read("calibration.toml");
    assert!(text.starts_with("version = 2") && text.contains("verdict = \"calibrated\""), "{text}");
}

#[test]
fn input_that_ends_keeps_what_was_typed_and_it_goes_on_from_there() {
    let place = Scratch::new("calibrates_on");
    let run = calibrate(&place, RIG, &["--servo", "2"], "135\n90\n");
    assert_eq!(run.code, 1, "{}", run.output);
    assert!(run.errors.contains("--resume goes on with it"), "{}", run.errors);
    let begun = calibrate(&place, RIG, &["--servo", "2"], "");
    assert!(begun.code == 2 && begun.errors.contains("was interrupted: --resume"), "{}", begun.errors);
    let other = calibrate(&place, RIG, &["--servo", "3", "--resume"], "");
    assert!(other.code == 2 && other.errors.contains("name the same hinges"), "{}", other.errors);
    let stopped = calibrate(&place, RIG, &["--servo", "2", "--resume"], "45\nstop\n");
    assert_eq!(stopped.code, 1, "{}", stopped.output);
    let run = calibrate(&place, RIG, &["--servo", "2", "--resume"], "0\n180\n225\n270\n");
    assert_eq!((run.code, points(&place, 2).len()), (0, 4), "{}{}", run.output, run.errors);
    assert!(!run.output.contains("1500 us"), "the middle was read: {}", run.output);
}

#[test]
fn what_is_no_servo_no_sensor_or_no_calibration_of_this_rig_is_refused() {
    let place = Scratch::new("calibrates_no_servo");
    for (arguments, message) in [
        (&["--servo", "16"][..], "--servo 16: expected a hinge of the rig, 0 to 15"),
        (
            &["--hinge", "2"],
            "--hinge 2: expected a shape-memory hinge, found a servo; for servos there is --servo",
        ),
        (&["--servo", "2", "--resume"], "calibration.servos.json: cannot be read"),
        (&["--servo", "2", "--tolerance", "0"], "--tolerance 0: expected 0.1 to 10 degrees"),
        (&["--servo", "2", "--hinge", "1"], "cannot be used with"),
    ] {
        let run = calibrate(&place, RIG, arguments, "");
        assert_eq!((run.code, run.errors.contains(message)), (2, true), "{message}: {}", run.errors);
    }
    for (sensor, message) in [
        ("echo no", "printed \"no\"; expected one number, in degrees"),
        ("exit 3", "ended with exit code 3"),
        ("echo 17", "it turned by 0 deg between"),
    ] {
        let run = calibrate(&place, RIG, &["--servo", "2", "--restart", "--sensor", sensor], "");
        assert_eq!(
            (run.code, run.errors.contains(message)),
            (1, true),
            "{message}: {}{}",
            run.output,
            run.errors
        );
    }
    let sma =
        RIG.replace("servos = 16", "servos = 16\nheaters = 1") + "[[hinge]]\nhinge = 5\nkind = \"sma\"\n";
    let run = calibrate(&place, &sma, &["--servo", "5", "--restart"], "");
    assert!(
        run.code == 2 && run.errors.contains("--servo 5: expected a servo hinge, found a sma"),
        "{}",
        run.errors
    );
    let narrow = RIG.to_owned()
        + "[servo]\nshortest_pulse = \"2700 us\"\nlongest_pulse = \"3 ms\"\npulse_0 = \"2800 us\"\npulse_270 = \"2900 us\"\n";
    let run = calibrate(&place, &narrow, &["--servo", "2", "--restart"], "");
    assert!(run.code == 2 && run.errors.contains("leave nothing of the 400 to 2600 us"), "{}", run.errors);
    place.write(
        "calibration.toml",
        "version = 2\nrig = \"other\"\nboard = \"b\"\nunique_id = \"00\"\nhinge = []\n",
    );
    let run = calibrate(&place, RIG, &["--servo", "2", "--restart"], "");
    assert!(run.code == 2 && run.errors.contains("a calibration of rig \"other\""), "{}", run.errors);
}

#[test]
fn a_run_is_driven_by_the_pulses_that_were_found_and_an_angle_out_of_reach_is_no_schedule() {
    let place = Scratch::new("drives_by_servos");
    let model = scratch::model("i14.txt");
    let plan = place.zygote(&["plan", &model, "--piles", "2", "--free", "ideal", "-o", "plan.fold"]);
    assert_eq!(plan.code, 0, "{}", plan.errors);
    let plan: Value = serde_json::from_slice(&place.bytes("plan.fold")).unwrap();
    let hinges = plan["zygote:hinges"].as_array().unwrap();
    let opening = |hinge: &Value| hinge["opening_deg"].as_u64().unwrap();
    let bowed = hinges.iter().position(|hinge| hinge["kind"] == "fold" && opening(hinge) == 90).unwrap();
    let one = RIG.split("[[sim.hinge]]\nhinge = 1\n").next().unwrap();
    let rig = one.replace("hinge = 0", &format!("hinge = {bowed}"));
    let calibrated = rig.replace("# calibration", "calibration = \"calibration.toml\"");
    let schedule = ["schedule", "plan.fold", "--rig", "rig.toml", "-o", "schedule.json"];
    let deploy = ["deploy", "plan.fold", "--schedule", "schedule.json", "--rig", "rig.toml", "--sim"];

    // By the rig file alone that hinge ends beside its angle.
    place.write("rig.toml", &rig);
    assert_eq!(place.zygote(&schedule).code, 0);
    let run = place.zygote(&deploy);
    assert!(run.output.contains("true angles: 12 of 13 hinges"), "{}{}", run.output, run.errors);

    let number = bowed.to_string();
    let sensor = ["--plan", "plan.fold", "--servo", &number, "--sensor", "sim", "--tolerance", "0.3"];
    let run = calibrate(&place, &calibrated, &sensor, "");
    assert_eq!(run.code, 0, "{}{}", run.output, run.errors);
    assert_eq!(place.zygote(&deploy).code, 2, "a schedule made without the calibration");
    let run = place.zygote(&schedule);
    assert_eq!(run.code, 0, "{}", run.errors);
    let found = points(&place, bowed);
    let made: Value = serde_json::from_str(&place.read("schedule.json")).unwrap();
    let step = made["steps"].as_array().unwrap().iter().find(|step| step["hinge"] == bowed).unwrap();
    let pulses = [&step["motion"]["from_us"], &step["motion"]["to_us"]].map(|pulse| pulse.as_f64().unwrap());
    for (pulse, (_, found)) in pulses.iter().zip(&found) {
        assert!((pulse - found).abs() < 0.5, "{pulse} for {found}");
    }
    let run = place.zygote(&deploy);
    assert!(
        run.code == 0 && run.output.contains("true angles: 13 of 13 hinges"),
        "{}{}",
        run.output,
        run.errors
    );

    let text = place.read("calibration.toml");
    let cut = text
        .replace("angle = \"90 deg\"", "angle = \"60 deg\"")
        .replace("angle = \"180 deg\"", "angle = \"61 deg\"");
    place.write("calibration.toml", &cut.replace("angle = \"270 deg\"", "angle = \"62 deg\""));
    let run = place.zygote(&schedule);
    assert_eq!(run.code, 2, "{}", run.output);
    let message = format!("rig.calibration: hinge {bowed}: expected opening angles from 0 deg to 62 deg");
    assert!(run.errors.contains(&message) && run.errors.contains("found 90 deg"), "{}", run.errors);
}
