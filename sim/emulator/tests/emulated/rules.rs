//! What the program does on its chip: it starts, keeps the rules that only its pins, timers and watchdog can keep, and does
//! the same in every run.

use crate::host::{Host, heat, plant};
use zygote_emulator::Drive;
use zygote_protocol::{Command, FaultCode, Millis, ResetCause, State};
use zygote_sim::Stuck;
use zygote_sim::plant::Fault as Broken;

fn warm_hinge() -> Host {
    let mut host = Host::connected(&plant());
    host.run_until_warm(&[heat(0, &[])]);
    assert!(!host.all_off());
    host
}

/// After this, the hinge only cools: nothing heats it, whatever the firmware says.
fn only_cools(host: &mut Host) {
    host.pass(Millis(1_500));
    let mut last = host.board.plant().sma_hinges()[0].temperature_c();
    for _ in 0..5 {
        host.pass(Millis(500));
        let now = host.board.plant().sma_hinges()[0].temperature_c();
        assert!(now < last, "{now} °C after {last} °C");
        last = now;
    }
}

#[test]
#[ignore = "needs the board's program: cargo xtask emulator"]
fn the_board_starts_and_answers_a_hello() {
    let host = Host::connected(&plant());
    let identity = host.identity.unwrap();
    assert_eq!((identity.board.as_str(), identity.reset), ("nucleo-f446re", ResetCause::Power));
    assert_eq!(&identity.unique_id, b"zygote-emul1");
}

#[test]
#[ignore = "needs the board's program: cargo xtask emulator"]
fn a_hinge_is_opened_by_the_pins_of_the_board() {
    let mut host = Host::connected(&plant());
    host.run(&[heat(0, &[]), heat(1, &[0])]);
    host.pass_until(Millis(60_000), |host| host.state() == State::Finished);
    for hinge in &host.board.plant().sma_hinges()[..2] {
        assert!((hinge.angle_deg() - 90.0).abs() < 0.5, "{}", hinge.angle_deg());
    }
    assert!(host.all_off());
    assert!(host.faults.is_empty(), "{:?}", host.faults);
}

/// Every change of a pin ends a step of the board's clock, so that none goes unseen.
#[test]
#[ignore = "needs the board's program: cargo xtask emulator"]
fn s1_no_output_is_driven_from_power_on_until_a_program_runs() {
    let mut host = Host::new(&plant());
    for _ in 0..100 {
        assert_eq!(host.board.drive(), Drive::OFF);
        host.pass(Millis(1));
    }
    host.connect(77);
    for _ in 0..100 {
        host.pass(Millis(1));
        assert_eq!(host.board.drive(), Drive::OFF);
    }
}

#[test]
#[ignore = "needs the board's program: cargo xtask emulator"]
fn s1_everything_is_off_after_a_reset_in_the_middle_of_a_run() {
    let mut host = warm_hinge();
    host.board.reset();
    assert!(host.all_off());
    for _ in 0..100 {
        host.pass(Millis(1));
        assert!(host.all_off());
    }
    host.connect(78);
    assert_eq!(host.identity.as_ref().unwrap().reset, ResetCause::Pin);
    only_cools(&mut host);
}

#[test]
#[ignore = "needs the board's program: cargo xtask emulator"]
fn s3_a_silent_host_costs_the_heat_within_the_timeout_and_50_ms() {
    let mut host = warm_hinge();
    host.connected = false;
    let took = host.pass_until(Millis(2_000), |host| host.all_off());
    assert!(Millis(900) <= took && took <= Millis(1_051), "{took}");
    only_cools(&mut host);
    assert!(host.all_off());
}

#[test]
#[ignore = "needs the board's program: cargo xtask emulator"]
fn s5_an_open_thermistor_turns_everything_off_within_100_ms() {
    let mut host = warm_hinge();
    host.board.plant_mut().inject(Broken::ThermistorOpen(0)).unwrap();
    let took = host.pass_until(Millis(500), |host| host.all_off());
    assert!(took <= Millis(100), "{took}");
    host.pass(Millis(100));
    assert_eq!(host.faults.iter().map(|fault| fault.code).collect::<Vec<_>>(), [FaultCode::SensorOpen]);
}

#[test]
#[ignore = "needs the board's program: cargo xtask emulator"]
fn s8_the_stop_button_turns_everything_off_within_10_ms() {
    let mut host = warm_hinge();
    host.board.press_stop(true);
    let took = host.pass_until(Millis(100), |host| host.all_off());
    assert!(took <= Millis(10), "{took}");
    host.board.press_stop(false);
    host.pass(Millis(100));
    assert!(host.all_off(), "it stays so when the button is released");
    assert_eq!(host.state(), State::Safe);
    only_cools(&mut host);
}

#[test]
#[ignore = "needs the board's program: cargo xtask emulator"]
fn s8_a_stop_frame_turns_everything_off_within_10_ms() {
    let mut host = warm_hinge();
    host.stop();
    let took = host.pass_until(Millis(100), |host| host.all_off());
    assert!(took <= Millis(10), "{took}");
}

/// The emulated watchdog has the slowest oscillator that a chip may have.
#[test]
#[ignore = "needs the board's program: cargo xtask emulator"]
fn s9_a_stuck_chip_is_reset_by_the_watchdog_within_500_ms_and_tells_what_it_was_doing() {
    let mut host = warm_hinge();
    host.board.hang(Stuck::Everything);
    host.pass(Millis(10));
    assert!(!host.all_off(), "outputs stay as they are until the watchdog acts");
    let took = host.pass_until(Millis(1_000), |host| host.all_off());
    assert!(took <= Millis(490), "{took}");
    host.connect(78);
    assert_eq!(host.identity.as_ref().unwrap().reset, ResetCause::Watchdog);
    let kept = host.kept();
    assert_eq!((kept.state, kept.run), (State::Running, Some(5)));
    only_cools(&mut host);
}

#[test]
#[ignore = "needs the board's program: cargo xtask emulator"]
fn s9_stuck_tasks_cost_the_heat_within_50_ms_by_the_dead_mans_switch() {
    let mut host = warm_hinge();
    host.board.hang(Stuck::Tasks);
    let took = host.pass_until(Millis(1_000), |host| host.all_off());
    assert!(took <= Millis(50), "{took}");
    host.connect(78);
    assert_eq!(host.identity.as_ref().unwrap().reset, ResetCause::DeadMan);
    only_cools(&mut host);
}

#[test]
#[ignore = "needs the board's program: cargo xtask emulator"]
fn the_fast_way_and_the_core_agree_on_every_byte_and_every_instruction() {
    let [hurried, careful] = [true, false].map(|hurry| {
        let mut host = Host::new(&plant());
        if !hurry {
            host.board.do_not_hurry();
        }
        host.pass(Millis(20));
        host.connect(77);
        host.run(&[heat(0, &[])]);
        host.pass(Millis(300));
        (host.heard, host.board.instructions(), host.board.now())
    });
    assert!(hurried.0.len() > 10);
    assert_eq!(hurried, careful);
}

#[test]
#[ignore = "needs the board's program: cargo xtask emulator"]
fn two_runs_are_the_same_in_every_byte_and_every_instruction() {
    let [first, second] = [1, 2].map(|_| {
        let mut host = warm_hinge();
        host.board.plant_mut().inject(Broken::ThermistorOpen(0)).unwrap();
        host.pass(Millis(1_000));
        let latencies = host.board.latencies().clone();
        (host.heard, host.board.instructions(), host.board.now(), latencies)
    });
    assert!(first.0.len() > 20, "{} pieces", first.0.len());
    assert_eq!(first, second);
}

/// What the page of the emulator says is measured here: how long interrupts wait, and how evenly the sensors are read.
#[test]
#[ignore = "needs the board's program: cargo xtask emulator"]
fn interrupts_and_control_ticks_are_in_time_while_a_hinge_is_heated() {
    let mut host = Host::connected(&plant());
    host.board.take_rounds();
    host.run(&[heat(0, &[])]);
    host.pass(Millis(5_000));
    let rounds = host.board.take_rounds();
    let mut periods: Vec<u64> = rounds.windows(2).map(|pair| pair[1] - pair[0]).collect();
    periods.sort_unstable();
    let median = periods[periods.len() / 2];
    // Against a grid of the ticker's own period.
    let phases = rounds.iter().map(|at| at % (median.div_ceil(1_000_000_000) * 1_000_000_000));
    let (least, most) = (phases.clone().min().unwrap(), phases.max().unwrap());
    println!("{} rounds, median {median} ps, phases {least} to {most} ps", rounds.len());
    for (number, latency) in host.board.latencies() {
        println!("interrupt {number}: {} handled, worst {} ps", latency.handled, latency.worst_ps);
        assert!(latency.worst_ps < 100_000_000, "interrupt {number} waited {} ps", latency.worst_ps);
    }
    assert!(most - least < 500_000_000, "{} ps", most - least);
    assert!(host.ask(Command::Progress { first: 0 }).is_ok());
}
