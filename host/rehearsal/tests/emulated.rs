//! Scenario files on the emulated board: the program that is flashed, its pins, timers, watchdog and serial line, with the
//! real controller and the simulated plant. Ignored unless asked for, because the program has to be built first:
//! `cargo xtask emulator`.
#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]

use std::path::{Path, PathBuf};
use std::time::Instant;
use zygote_emulator::{EmulatedBoard, Image};
use zygote_rehearsal::scenario::table;
use zygote_rehearsal::{Rehearsed, Scenario, Trial};

/// The program under test.
fn program() -> Image {
    let built = "../../target/firmware/thumbv7em-none-eabihf/release/zygote-nucleo-f446re";
    let path = std::env::var_os("ZYGOTE_BOARD_ELF")
        .map_or_else(|| Path::new(env!("CARGO_MANIFEST_DIR")).join(built), PathBuf::from);
    Image::open(&path).unwrap()
}

fn scenario(name: &str) -> Scenario {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../sim/scenarios");
    Scenario::open(&folder.join(name).with_extension("toml")).unwrap()
}

fn rehearse(image: &Image, trial: &Trial) -> Rehearsed {
    trial.run_on(EmulatedBoard::new(image, &trial.plant, 1).unwrap()).unwrap()
}

fn holds(name: &str) {
    let scenario = scenario(name);
    let mut trial = scenario.trial().unwrap();
    trial.log = true;
    let rehearsed = rehearse(&program(), &trial);
    let verdict = scenario.judge(&trial, &rehearsed);
    assert!(
        verdict.holds(),
        "{:?}\n{}\n{}",
        rehearsed.ending,
        rehearsed.witness.log().join("\n"),
        table(&[verdict])
    );
}

/// A test for each scenario file.
macro_rules! scenarios {
    ($($test:ident: $name:literal,)*) => {
        $(
            #[test]
            #[ignore = "needs the board's program: cargo xtask emulator"]
            fn $test() {
                holds($name);
            }
        )*
    };
}

// Those of the rules that only a board's own pins, timers and watchdog can keep, and of those that are near them; and of each
// kind of actuator one that opens.
scenarios! {
    s01_reset: "s01-reset",
    s02_second_host: "s02-second-host",
    s03_hiccup: "s03-hiccup",
    s03_host_killed: "s03-host-killed",
    s03_line_cut: "s03-line-cut",
    s03_line_cut_to_board: "s03-line-cut-to-board",
    s03_line_cut_to_host: "s03-line-cut-to-host",
    s05_thermistor_open: "s05-thermistor-open",
    s05_thermistor_shorted: "s05-thermistor-shorted",
    s06_mosfet_stuck: "s06-mosfet-stuck",
    s06_heater_breaks: "s06-heater-breaks",
    s07_servo_stalled: "s07-servo-stalled",
    s08_stop_button: "s08-stop-button",
    s08_stop_button_mixed: "s08-stop-button-mixed",
    s08_stop_frame: "s08-stop-frame",
    s09_mcu_stuck: "s09-mcu-stuck",
    s09_tasks_stuck: "s09-tasks-stuck",
    s11_frames_replayed: "s11-frames-replayed",
    s12_report_of_a_fault: "s12-report-of-a-fault",
    s12_supply_cut: "s12-supply-cut",
    servos_open: "deploy-servo",
    mixed_actuators_open: "deploy-mixed",
    fourteen_panels_of_mixed_actuators_open: "deploy-mixed-i14",
}

#[test]
#[ignore = "needs the board's program: cargo xtask emulator"]
fn fourteen_panels_open_within_a_degree_on_the_boards_own_program() {
    let scenario = scenario("deploy-i14");
    let trial = scenario.trial().unwrap();
    let start = Instant::now();
    let rehearsed = rehearse(&program(), &trial);
    let (emulated, wall) = (rehearsed.ended_at.0 as f64 / 1e6, start.elapsed().as_secs_f64());
    println!("{emulated:.1} s emulated in {wall:.1} s: {:.2} of real time", emulated / wall);
    assert_eq!(rehearsed.witness.hinges.len(), 13);
    for hinge in &rehearsed.witness.hinges {
        assert!((hinge.angle_deg - hinge.goal_deg).abs() < 1.0, "{hinge:?}");
    }
    let verdict = scenario.judge(&trial, &rehearsed);
    assert!(verdict.holds(), "{}", table(&[verdict]));
}
