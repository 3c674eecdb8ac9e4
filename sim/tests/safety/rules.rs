//! One test or more for each rule that the core enforces so far.

use crate::host::{CHANNELS, Host, LIMITS, RIG, heat, plant, release, turn};
use zygote_core::Duty;
use zygote_protocol::{
    Action, CentiCelsius, Command, EventKind, FaultCode, Limits, Micros, Milliamps, Millis, RefusalCode,
    Reply, ResetCause, State, Step, StepState,
};
use zygote_sim::plant::Fault as Broken;
use zygote_sim::{Board, CEILING, Stuck};

fn warm_hinge() -> Host {
    let mut host = Host::new(&plant());
    host.run_until_warm(&[heat(0, &[])]);
    assert!(!host.all_off());
    host
}

/// After this, the hinge only cools: nothing heats it, whatever the firmware says.
fn only_cools(host: &mut Host) {
    host.pass(Millis(1_500));
    let mut last = host.board.plant().sma_hinges()[0].temperature_c();
    for _ in 0..10 {
        host.pass(Millis(500));
        let now = host.board.plant().sma_hinges()[0].temperature_c();
        assert!(now < last, "{now} °C after {last} °C");
        last = now;
    }
}

fn fault(host: &Host) -> FaultCode {
    host.board.core().fault().expect("a fault").code
}

#[test]
fn a_run_opens_every_kind_of_hinge_in_order() {
    let mut host = Host::new(&plant());
    host.run(&[heat(0, &[]), turn(10, &[0]), release(11, &[1]), heat(1, &[2])]);
    host.pass_until(Millis(60_000), |host| host.board.core().state() == State::Finished);
    let plant = host.board.plant();
    assert!((plant.sma_hinges()[0].angle_deg() - 90.0).abs() < 0.5);
    assert!((plant.sma_hinges()[1].angle_deg() - 90.0).abs() < 0.5);
    assert!((plant.servo_hinges()[0].angle_deg() - 135.0).abs() < 0.5);
    assert!((plant.spring_hinges()[0].angle_deg() - 180.0).abs() < 0.5);
    assert!(host.all_off());
    host.exchange();
    let done = host.events.iter().filter(|event| matches!(event.kind, EventKind::StepDone { .. })).count();
    assert_eq!(done, 4);
    assert!(host.faults.is_empty());
}

#[test]
fn s1_everything_is_off_after_a_reset_in_the_middle_of_a_run() {
    let mut host = warm_hinge();
    host.board.reset(ResetCause::Watchdog);
    assert!(host.all_off());
    assert_eq!(host.board.core().state(), State::Idle);
    host.connect(78);
    only_cools(&mut host);
}

#[test]
fn s2_nothing_starts_unless_armed() {
    let mut host = Host::new(&plant());
    host.upload(&[heat(0, &[])]).unwrap();
    let refusal = host.ask(Command::Start { run: 5 }).unwrap_err();
    assert_eq!((refusal.code, refusal.expected, refusal.got), (RefusalCode::WrongState, 2, 1));
    assert!(host.all_off());
}

#[test]
fn s2_an_arming_for_another_rig_is_refused() {
    let mut host = Host::new(&plant());
    host.upload(&[heat(0, &[])]).unwrap();
    let command =
        Command::Arm { rig: "another".try_into().unwrap(), limits: LIMITS, lifetime: Millis(1_000) };
    assert_eq!(host.ask(command).unwrap_err().code, RefusalCode::RigMismatch);
    assert_eq!(host.board.core().state(), State::Loaded);
}

#[test]
fn s2_an_arming_expires() {
    let mut host = Host::new(&plant());
    host.upload(&[heat(0, &[])]).unwrap();
    host.arm(LIMITS).unwrap();
    assert!(!host.all_off(), "the main switch is closed");
    host.pass(Millis(5_010));
    assert_eq!(fault(&host), FaultCode::ArmExpired);
    assert!(host.all_off());
}

#[test]
fn s2_a_new_session_turns_off_what_another_one_started() {
    let mut host = warm_hinge();
    host.connect(78);
    assert_eq!(fault(&host), FaultCode::SessionEnded);
    assert!(host.all_off());
    only_cools(&mut host);
}

#[test]
fn s2_disarming_ends_a_run() {
    let mut host = warm_hinge();
    host.ask(Command::Disarm).unwrap();
    assert!(host.all_off());
    assert_eq!(host.step_states(), [StepState::Interrupted]);
}

#[test]
fn s3_a_lost_link_turns_everything_off_within_50_ms_of_the_timeout() {
    let mut host = warm_hinge();
    host.pass(Millis(300));
    host.connected = false;
    host.pass(Millis(700));
    assert!(!host.all_off(), "the timeout is 1 s, and the host spoke at most 200 ms before the cut");
    let more = host.pass_until(Millis(400), |host| host.all_off());
    assert!(more <= Millis(350), "{more} after 700 ms of silence");
    assert_eq!(fault(&host), FaultCode::LinkLost);
    only_cools(&mut host);
}

#[test]
fn s3_a_host_that_lives_keeps_the_run_going() {
    let mut host = warm_hinge();
    host.pass_until(Millis(60_000), |host| host.board.core().state() == State::Finished);
    assert!(host.faults.is_empty());
}

#[test]
fn s4_a_heater_too_weak_for_the_target_goes_off_at_its_longest_time() {
    let mut weak = plant();
    weak.heaters[0].heater_ohm = 45.0;
    let mut host = Host::new(&weak);
    host.run(&[heat(0, &[])]);
    let took = host.pass_until(Millis(25_000), |host| host.all_off());
    assert_eq!(fault(&host), FaultCode::OnTooLong);
    assert!(took <= Millis(20_010), "{took}");
    only_cools(&mut host);
}

#[test]
fn s4_a_hinge_above_its_highest_temperature_turns_everything_off() {
    let mut host = Host::new(&plant());
    let mut step = heat(0, &[]);
    if let Action::Heat(heat) = &mut step.action {
        // So near above the target that the overshoot passes it.
        heat.max_temperature = CentiCelsius(heat.target.0 + 10);
    }
    host.run(&[step]);
    host.pass_until(Millis(20_000), |host| host.all_off());
    assert_eq!(fault(&host), FaultCode::OverTemperature);
    only_cools(&mut host);
}

fn breaks_within(broken: Broken, expected: FaultCode, most: Millis) {
    let mut host = warm_hinge();
    host.board.plant_mut().inject(broken).unwrap();
    host.pass_until(most, |host| host.all_off());
    assert_eq!(fault(&host), expected);
    assert_eq!(host.board.core().fault().unwrap().step, Some(0));
    only_cools(&mut host);
    assert_eq!(host.faults.len(), 1, "the host was told once");
}

#[test]
fn s5_an_open_thermistor_turns_everything_off_within_100_ms() {
    breaks_within(Broken::ThermistorOpen(0), FaultCode::SensorOpen, Millis(100));
}

#[test]
fn s5_a_shorted_thermistor_turns_everything_off_within_100_ms() {
    breaks_within(Broken::ThermistorShorted(0), FaultCode::SensorShorted, Millis(100));
}

#[test]
fn s6_a_heater_that_does_not_heat_is_found_by_the_end_of_its_gain_window() {
    let mut host = Host::new(&plant());
    host.board.plant_mut().inject(Broken::HeaterOpen(0)).unwrap();
    host.run(&[heat(0, &[])]);
    host.pass_until(Millis(3_020), |host| host.all_off());
    assert_eq!(fault(&host), FaultCode::NoGain);
}

#[test]
fn s6_a_loose_thermistor_is_found_while_the_true_temperature_is_still_harmless() {
    let mut host = Host::new(&plant());
    host.board.plant_mut().inject(Broken::ThermistorLoose(0)).unwrap();
    host.run(&[heat(0, &[])]);
    host.pass_until(Millis(3_020), |host| host.all_off());
    assert_eq!(fault(&host), FaultCode::NoGain);
    let true_c = host.board.plant().sma_hinges()[0].temperature_c();
    assert!(true_c < 120.0, "{true_c} °C");
}

#[test]
fn s6_a_mosfet_that_sticks_opens_the_main_switch_before_the_hinge_is_hot() {
    let mut host = Host::new(&plant());
    host.board.plant_mut().inject(Broken::MosfetStuckOn(2)).unwrap();
    // Hinge 2 waits for hinge 0, and yet it gets warm; while a servo is held, current tells nothing.
    host.run(&[turn(10, &[]), heat(0, &[0]), heat(2, &[1])]);
    host.pass_until(Millis(10_000), |host| host.all_off());
    assert_eq!(fault(&host), FaultCode::UnexpectedHeat);
    assert_eq!(host.board.core().fault().unwrap().channel, Some(2));
    host.pass(Millis(2_000));
    let stuck = &host.board.plant().sma_hinges()[2];
    assert!(stuck.temperature_c() < 60.0, "{} °C", stuck.temperature_c());
    assert!(host.board.plant().supply_a() < 0.001, "nothing flows behind the open main switch");
}

#[test]
fn s6_s7_current_that_nobody_planned_turns_everything_off_long_before_it_is_felt() {
    for broken in [Broken::MosfetStuckOn(2), Broken::HeaterShorted { channel: 0, ohm: 12.0 }] {
        let mut host = warm_hinge();
        host.board.plant_mut().inject(broken).unwrap();
        let off = host.pass_until(Millis(300), |host| host.all_off());
        assert!(off <= Millis(260), "{broken:?}: {off}");
        assert_eq!(fault(&host), FaultCode::UnplannedCurrent, "{broken:?}");
        assert!(host.board.plant().sma_hinges()[2].temperature_c() < 30.0, "{broken:?}");
    }
}

#[test]
fn s7_the_sum_of_currents_stays_under_the_limit() {
    let mut host = Host::new(&plant());
    host.upload(&[heat(0, &[]), heat(1, &[]), heat(2, &[]), heat(3, &[])]).unwrap();
    host.arm(Limits { supply: Milliamps(450), ..LIMITS }).unwrap();
    host.ask(Command::Start { run: 5 }).unwrap();
    let mut most = 0.0_f64;
    host.pass_until(Millis(120_000), |host| {
        most = most.max(host.board.plant().supply_a());
        host.board.core().state() == State::Finished
    });
    assert!(most <= 0.45, "{most} A");
    assert!(most > 0.35, "two at a time fit: {most} A");
}

#[test]
fn s7_a_step_that_alone_is_over_the_limit_is_refused() {
    let mut host = Host::new(&plant());
    host.upload(&[release(11, &[])]).unwrap();
    let refusal = host.arm(Limits { supply: Milliamps(900), ..LIMITS }).unwrap_err();
    assert_eq!((refusal.code, refusal.expected, refusal.got), (RefusalCode::StepOverCurrent, 900, 1_000));
}

#[test]
fn s7_more_current_than_allowed_turns_everything_off() {
    let mut greedy = plant();
    greedy.heaters[0].heater_ohm = 5.0;
    let mut host = Host::new(&greedy);
    host.upload(&[heat(0, &[])]).unwrap();
    host.arm(Limits { supply: Milliamps(300), ..LIMITS }).unwrap();
    host.ask(Command::Start { run: 5 }).unwrap();
    host.pass_until(Millis(100), |host| host.all_off());
    assert_eq!(fault(&host), FaultCode::OverCurrent);
}

#[test]
fn s8_a_stop_frame_turns_everything_off_at_once_and_latches() {
    let mut host = warm_hinge();
    let before = host.board.now();
    host.stop();
    assert!(host.all_off());
    assert_eq!(host.board.now(), before, "no tick was needed");
    assert_eq!(fault(&host), FaultCode::Stopped);
    assert_eq!(host.arm(LIMITS).unwrap_err().code, RefusalCode::WrongState);
    only_cools(&mut host);
    host.ask(Command::Clear).unwrap();
    host.run(&[heat(1, &[])]);
}

#[test]
fn s8_the_stop_button_turns_everything_off_within_10_ms_and_holds_while_pressed() {
    let mut host = warm_hinge();
    host.board.press_stop(true);
    host.pass(Millis(10));
    assert!(host.all_off());
    assert_eq!(fault(&host), FaultCode::StopButton);
    assert_eq!(host.ask(Command::Clear).unwrap_err().code, RefusalCode::StopPressed);
    host.board.press_stop(false);
    host.pass(Millis(10));
    host.ask(Command::Clear).unwrap();
    assert_eq!(host.board.core().state(), State::Idle);
}

#[test]
fn s8_a_stop_works_from_any_state() {
    for prepare in [
        |_: &mut Host| {},
        |host: &mut Host| drop(host.upload(&[heat(0, &[])]).unwrap()),
        |host: &mut Host| {
            host.upload(&[heat(0, &[])]).unwrap();
            host.arm(LIMITS).unwrap();
        },
    ] {
        let mut host = Host::new(&plant());
        prepare(&mut host);
        host.stop();
        assert_eq!(host.board.core().state(), State::Safe);
        assert!(host.all_off());
    }
}

#[test]
fn s10_a_hinge_waits_until_those_before_it_are_open() {
    let mut host = Host::new(&plant());
    host.run(&[heat(0, &[]), heat(1, &[]), heat(2, &[0, 1])]);
    host.pass_until(Millis(60_000), |host| {
        let states: Vec<_> = host.board.core().step_states().collect();
        let open = |state| matches!(state, StepState::Opened | StepState::Done);
        assert!(states[2] == StepState::Waiting || (open(states[0]) && open(states[1])), "{states:?}");
        host.board.core().state() == State::Finished
    });
}

#[test]
fn s10_a_program_out_of_order_is_refused() {
    let mut host = Host::new(&plant());
    for (steps, at) in [(vec![heat(0, &[0])], 0), (vec![heat(0, &[]), heat(1, &[2]), heat(2, &[])], 1)] {
        let refusal = host.upload(&steps).unwrap_err();
        assert_eq!((refusal.code, refusal.at), (RefusalCode::OrderViolated, at));
        assert_eq!(host.board.core().state(), State::Idle);
    }
}

#[test]
fn s11_a_command_whose_frames_come_three_times_is_done_once() {
    let mut host = Host::new(&plant());
    host.copies = 3;
    host.run(&[heat(0, &[])]);
    host.pass(Millis(500));
    let states = |wanted| host.events.iter().filter(|event| event.kind == EventKind::State(wanted)).count();
    assert_eq!((states(State::Loaded), states(State::Armed), states(State::Running)), (1, 1, 1));
    let started =
        host.events.iter().filter(|event| matches!(event.kind, EventKind::StepStarted { .. })).count();
    assert_eq!(started, 1);
}

#[test]
fn s11_noise_on_the_line_changes_nothing() {
    let mut host = Host::new(&plant());
    let mut random = 12_345_u32;
    for _ in 0..2_000 {
        let noise: Vec<u8> = (0..37)
            .map(|_| {
                random = random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                random.to_le_bytes()[3]
            })
            .collect();
        host.board.receive(&noise);
    }
    // The delimiter ends what the noise began.
    host.board.receive(&[0]);
    assert_eq!(host.board.core().state(), State::Idle);
    assert!(host.board.core().link_counters().bad > 100);
    host.run(&[heat(0, &[])]);
    assert_eq!(host.board.core().state(), State::Running);
}

#[test]
fn s12_a_stopped_run_says_which_hinges_moved_and_which_did_not() {
    let mut host = Host::new(&plant());
    host.run(&[heat(0, &[]), heat(1, &[0]), heat(2, &[1])]);
    host.pass_until(Millis(20_000), |host| host.board.core().step_states().nth(1) == Some(StepState::Moving));
    host.pass(Millis(1_000));
    host.stop();
    assert_eq!(host.step_states(), [StepState::Done, StepState::Interrupted, StepState::Waiting]);
}

#[test]
fn s13_no_limit_can_be_raised_above_the_ceiling() {
    let laxer = [
        Limits { max_temperature: CentiCelsius(CEILING.max_temperature.0 + 1), ..LIMITS },
        Limits { max_on: Millis(CEILING.max_on.0 + 1), ..LIMITS },
        Limits { min_rest: Millis(CEILING.min_rest.0 - 1), ..LIMITS },
        Limits { supply: Milliamps(CEILING.supply.0 + 1), ..LIMITS },
        Limits { link_timeout: Millis(CEILING.link_timeout.0 + 1), ..LIMITS },
    ];
    let mut host = Host::new(&plant());
    host.upload(&[heat(0, &[])]).unwrap();
    for (number, limits) in (0..).zip(laxer) {
        let refusal = host.arm(limits).unwrap_err();
        assert_eq!((refusal.code, refusal.at), (RefusalCode::LimitAboveCeiling, number));
        assert_eq!(host.board.core().state(), State::Loaded);
    }
}

#[test]
fn s13_steps_are_held_against_the_limits_of_the_session_too() {
    let mut host = Host::new(&plant());
    host.upload(&[heat(0, &[])]).unwrap();
    let refusal = host.arm(Limits { max_temperature: CentiCelsius(11_000), ..LIMITS }).unwrap_err();
    assert_eq!(
        (refusal.code, refusal.expected, refusal.got),
        (RefusalCode::StepOverTemperature, 11_000, 12_000)
    );
}

/// What a program may not be, and how it is refused.
#[test]
fn programs_that_break_a_rule_are_refused_with_the_step() {
    let hotter = |change: fn(&mut zygote_protocol::Heat)| -> Step {
        let mut step = heat(1, &[]);
        if let Action::Heat(heat) = &mut step.action {
            change(heat);
        }
        step
    };
    let cases = [
        (heat(9, &[]), RefusalCode::UnknownChannel),
        (Step { hinge: 1, ..heat(0, &[]) }, RefusalCode::ChannelTaken),
        (Step { hinge: 0, ..heat(1, &[]) }, RefusalCode::HingeTaken),
        (hotter(|heat| heat.max_temperature = CentiCelsius(20_000)), RefusalCode::StepOverTemperature),
        (hotter(|heat| heat.target = heat.max_temperature), RefusalCode::StepOverTemperature),
        (hotter(|heat| heat.cool = heat.target), RefusalCode::StepOverTemperature),
        (hotter(|heat| heat.min_gain = CentiCelsius(0)), RefusalCode::StepOverTemperature),
        (hotter(|heat| heat.max_on = Millis(1_000_000)), RefusalCode::StepOverOnTime),
        (hotter(|heat| heat.hold = heat.max_on), RefusalCode::StepOverOnTime),
        (hotter(|heat| heat.gain_window = Millis(30_000)), RefusalCode::StepOverOnTime),
        (hotter(|heat| heat.current = Milliamps(1_000_000)), RefusalCode::StepOverCurrent),
    ];
    for (step, code) in cases {
        let mut host = Host::new(&plant());
        let refusal = host.upload(&[heat(0, &[]), step]).unwrap_err();
        assert_eq!((refusal.code, refusal.at), (code, 1));
        assert_eq!(host.board.core().state(), State::Idle);
    }
}

#[test]
fn an_upload_that_is_not_what_was_declared_is_refused() {
    let mut host = Host::new(&plant());
    let rig = || RIG.try_into().unwrap();
    let upload = |steps, crc| Command::Upload { run: 5, rig: rig(), steps, crc };
    assert_eq!(host.ask(upload(0, 0)).unwrap_err().code, RefusalCode::ProgramEmpty);
    assert_eq!(host.ask(upload(5_000, 0)).unwrap_err().code, RefusalCode::TooManySteps);
    assert_eq!(host.ask(Command::Commit).unwrap_err().code, RefusalCode::NoUpload);
    host.ask(upload(1, 0)).unwrap();
    assert_eq!(host.ask(Command::Commit).unwrap_err().code, RefusalCode::ProgramIncomplete);
    let steps = |first| Command::Steps { first, steps: [heat(0, &[])].into_iter().collect() };
    assert_eq!(host.ask(steps(1)).unwrap_err().code, RefusalCode::StepsOutOfSequence);
    host.ask(steps(0)).unwrap();
    assert_eq!(host.ask(steps(1)).unwrap_err().code, RefusalCode::TooManySteps);
    assert_eq!(host.ask(Command::Commit).unwrap_err().code, RefusalCode::ProgramChecksum);
}

#[test]
fn the_same_run_gives_the_same_bytes() {
    let transcript = || {
        let mut host = Host::new(&plant());
        host.run(&[heat(0, &[]), heat(1, &[0])]);
        host.pass(Millis(30_000));
        format!("{:?}{:?}", host.events, host.telemetry)
    };
    assert_eq!(transcript(), transcript());
}

#[test]
fn a_silent_board_needs_no_host() {
    let mut board = Board::new(&plant(), CHANNELS, 1).unwrap();
    while board.now() < Micros(10_000_000) {
        board.advance(Micros(10_000_000)).unwrap();
    }
    let mut bytes = Vec::new();
    board.transmit(&mut bytes);
    assert!(bytes.is_empty(), "nothing is said to nobody");
}

/// Heats hinge 0 until it is at `celsius`, breaks its thermistor, and tells what came of it, how long the heater was still on,
/// and how hot the foil truly got.
fn broken_while_heating(celsius: f64, broken: Broken) -> (FaultCode, Millis, f64) {
    let mut host = Host::new(&plant());
    host.run(&[heat(0, &[])]);
    host.pass_until(Millis(20_000), |host| host.board.plant().sma_hinges()[0].temperature_c() > celsius);
    host.board.plant_mut().inject(broken).unwrap();
    let since = host.board.now();
    let (mut last_on, mut peak) = (since, celsius);
    host.pass_until(Millis(20_000), |host| {
        peak = peak.max(host.board.plant().sma_hinges()[0].temperature_c());
        if host.board.core().outputs().heaters[0] != Duty::OFF {
            last_on = host.board.now();
        }
        host.board.core().state() == State::Safe
    });
    (fault(&host), Millis(u32::try_from(last_on.since(since) / 1000).unwrap()), peak)
}

#[test]
fn s5_a_frozen_thermistor_turns_its_heater_off_within_half_a_second_wherever_it_freezes() {
    for celsius in [30.0, 60.0, 80.0, 92.0, 96.0] {
        let (code, on, peak) = broken_while_heating(celsius, Broken::ThermistorFrozen(0));
        assert_eq!(code, FaultCode::SensorFrozen, "frozen at {celsius} °C");
        assert!(on <= Millis(510), "frozen at {celsius} °C: on for {on}");
        assert!(peak < 120.0, "frozen at {celsius} °C: {peak} °C");
    }
}

#[test]
fn s6_a_thermistor_that_comes_off_turns_its_heater_off_within_a_tenth_of_a_second() {
    for celsius in [60.0, 80.0, 92.0, 96.0] {
        let (code, on, peak) = broken_while_heating(celsius, Broken::ThermistorLoose(0));
        assert!(matches!(code, FaultCode::NoGain | FaultCode::SensorJumped), "at {celsius} °C: {code}");
        assert!(on <= Millis(100), "loose at {celsius} °C: on for {on}");
        assert!(peak < 105.0, "loose at {celsius} °C: {peak} °C");
    }
}

#[test]
fn s6_a_mosfet_that_sticks_while_its_hinge_cools_is_cut_by_the_main_switch() {
    let mut host = Host::new(&plant());
    // While a servo is held, current tells nothing.
    host.run(&[turn(10, &[]), heat(0, &[0])]);
    host.pass_until(Millis(30_000), |host| {
        host.events.iter().any(|event| matches!(event.kind, EventKind::StepOpened { step: 1 }))
    });
    host.board.plant_mut().inject(Broken::MosfetStuckOn(0)).unwrap();
    host.pass_until(Millis(12_000), |host| host.board.core().state() == State::Safe);
    assert!(matches!(fault(&host), FaultCode::NoCooling | FaultCode::UnexpectedHeat), "{}", fault(&host));
    host.pass(Millis(10));
    assert!(host.board.plant().supply_a() == 0.0);
}

#[test]
fn s3_s9_stuck_tasks_are_cut_by_the_dead_mans_switch_within_50_ms() {
    let mut host = warm_hinge();
    host.board.hang(Stuck::Tasks);
    let off = host.pass_until(Millis(60), |host| host.board.plant().supply_a() == 0.0);
    assert!(off <= Millis(50), "{off}");
    host.connect(78);
    assert_eq!(host.reset_cause(), Some(ResetCause::DeadMan));
    only_cools(&mut host);
}

#[test]
fn s9_a_stuck_mcu_is_reset_within_500_ms_and_tells_what_it_was_doing() {
    let mut host = Host::new(&plant());
    host.run(&[turn(10, &[]), heat(0, &[0]), heat(1, &[1])]);
    host.pass_until(Millis(20_000), |host| host.board.plant().sma_hinges()[0].temperature_c() > 60.0);
    let boot = host.boot();
    host.board.hang(Stuck::Everything);
    let off = host.pass_until(Millis(600), |host| host.board.plant().supply_a() == 0.0);
    assert!(off <= Millis(500), "{off}");
    host.connect(78);
    assert_eq!(host.reset_cause(), Some(ResetCause::Watchdog));
    let Ok(Reply::LastRun(Some(before))) = host.ask(Command::LastRun) else { panic!("no snapshot") };
    assert_eq!((before.boot, before.state, before.run, before.steps), (boot, State::Running, Some(5), 3));
    assert_eq!(
        [0, 1, 2].map(|step| before.step(step)),
        [StepState::Done, StepState::Interrupted, StepState::Waiting]
    );
    only_cools(&mut host);
}

#[test]
fn s9_a_fault_is_told_after_the_reset_that_followed_it_and_forgotten_when_power_was_off() {
    for (cause, told) in [(ResetCause::Software, true), (ResetCause::Power, false)] {
        let mut host = warm_hinge();
        host.stop();
        host.board.reset(cause);
        host.connect(78);
        let Ok(Reply::LastRun(before)) = host.ask(Command::LastRun) else { panic!("no answer") };
        let fault = before.and_then(|before| before.fault).map(|fault| fault.code);
        assert_eq!(fault, told.then_some(FaultCode::Stopped));
    }
}

#[test]
fn s11_a_whole_session_that_is_said_again_after_a_reset_moves_nothing() {
    for cause in [ResetCause::Power, ResetCause::Watchdog] {
        let mut host = warm_hinge();
        let replayed = host.said.clone();
        host.board.reset(cause);
        host.board.receive(&replayed);
        host.board.transmit(&mut Vec::new());
        let core = host.board.core();
        assert_eq!((core.state(), core.step_states().count()), (State::Idle, 0), "{cause:?}");
        host.connect(78);
        only_cools(&mut host);
    }
}
