//! The rules to the last tick, and what the board tells of itself meanwhile.

use crate::host::{Host, LIMITS, RIG, heat, plant, turn};
use zygote_protocol::{
    Command, Fault, FaultCode, Micros, Millis, Phase, RefusalCode, Reply, ResetCause, State, Status,
};
use zygote_sim::TICK;
use zygote_sim::plant::Fault as Broken;

fn status(host: &mut Host) -> Status {
    let Ok(Reply::Status(status)) = host.ask(Command::Status) else { panic!("no status") };
    status
}

fn arm_for(host: &mut Host, lifetime: Millis) -> Result<Reply, zygote_protocol::Refusal> {
    host.ask(Command::Arm { rig: RIG.try_into().unwrap(), limits: LIMITS, lifetime })
}

#[test]
fn s2_an_arming_may_wait_for_ten_minutes_and_no_longer() {
    let mut host = Host::new(&plant());
    host.upload(&[heat(0, &[])]).unwrap();
    for wrong in [600_001, u32::MAX] {
        let refusal = arm_for(&mut host, Millis(wrong)).unwrap_err();
        let expected = (RefusalCode::LifetimeTooLong, 600_000, i64::from(wrong));
        assert_eq!((refusal.code, refusal.expected, refusal.got), expected);
        assert!(host.all_off());
    }
    arm_for(&mut host, Millis(600_000)).unwrap();
}

#[test]
fn s2_a_start_of_another_run_than_the_armed_one_is_refused() {
    let mut host = Host::new(&plant());
    host.upload(&[heat(0, &[])]).unwrap();
    host.arm(LIMITS).unwrap();
    let refusal = host.ask(Command::Start { run: 6 }).unwrap_err();
    assert_eq!((refusal.code, refusal.expected, refusal.got), (RefusalCode::RunMismatch, 5, 6));
    assert_eq!(host.board.core().state(), State::Armed);
}

#[test]
fn s3_silence_exactly_as_long_as_the_timeout_is_no_loss_and_a_tick_more_is() {
    let mut host = Host::new(&plant());
    host.upload(&[heat(0, &[])]).unwrap();
    host.arm(LIMITS).unwrap();
    host.pass(Millis(20));
    let heard = status(&mut host).at;
    assert_eq!(heard.0 % TICK.to_micros(), 0, "the host spoke with a tick");
    host.connected = false;
    host.pass(LIMITS.link_timeout);
    assert_eq!(host.board.core().state(), State::Armed);
    host.pass(TICK);
    let fault = Fault {
        code: FaultCode::LinkLost,
        at: heard.plus(Millis(1_005)),
        step: None,
        channel: None,
        value: 1_005,
        limit: 1_000,
    };
    assert_eq!(host.board.core().fault(), Some(fault));
}

#[test]
fn s6_a_hinge_that_warmed_before_it_was_armed_is_not_held_against_an_earlier_arming() {
    let mut host = Host::new(&plant());
    // The servo goes first, so the heater is off and watched.
    host.upload(&[turn(10, &[]), heat(0, &[0])]).unwrap();
    host.arm(LIMITS).unwrap();
    host.pass(Millis(100));
    host.ask(Command::Disarm).unwrap();
    host.board.plant_mut().inject(Broken::ThermistorDrifting { channel: 0, kelvin_per_s: 10.0 }).unwrap();
    host.pass(Millis(2_000));
    host.arm(LIMITS).unwrap();
    host.pass(Millis(500));
    assert_eq!(host.board.core().state(), State::Armed);
    host.pass_until(Millis(1_500), |host| host.board.core().state() == State::Safe);
    assert_eq!(host.board.core().fault().unwrap().code, FaultCode::UnexpectedHeat);
}

#[test]
fn s8_a_stop_button_that_is_pressed_before_anybody_is_connected_is_told_once_somebody_is() {
    let mut host = Host::new(&plant());
    host.board.reset(ResetCause::Power);
    host.board.press_stop(true);
    while host.board.now() < Micros(100_000) {
        host.board.advance(Micros(100_000)).unwrap();
        host.board.transmit(&mut Vec::new());
    }
    host.connect(78);
    assert_eq!(status(&mut host).fault.unwrap().code, FaultCode::StopButton);
}

#[test]
fn a_status_tells_how_many_heaters_are_on_and_whether_the_main_switch_is_closed() {
    let mut host = Host::new(&plant());
    let told = |host: &mut Host| {
        let status = status(host);
        (status.state, status.heaters_on, status.main_switch, status.opened)
    };
    assert_eq!(told(&mut host), (State::Idle, 0, false, 0));
    host.run(&[heat(0, &[]), heat(1, &[]), heat(2, &[0])]);
    host.pass(Millis(500));
    assert_eq!(told(&mut host), (State::Running, 2, true, 0));
    host.pass_until(Millis(20_000), |host| status(host).opened == 2);
    host.pass(Millis(10));
    assert_eq!(told(&mut host), (State::Running, 1, true, 2));
    host.stop();
    assert_eq!(told(&mut host), (State::Safe, 0, false, 2));
}

#[test]
fn telemetry_comes_ten_times_a_second_with_what_is_under_way() {
    let mut host = Host::new(&plant());
    host.pass(Millis(105));
    host.run(&[heat(3, &[])]);
    host.telemetry.clear();
    host.pass(Millis(1_000));
    let apart: Vec<_> = host.telemetry.windows(2).map(|pair| pair[1].at.since(pair[0].at)).collect();
    assert_eq!(apart, [100_000; 9]);
    let last = host.telemetry.last().unwrap();
    assert_eq!((last.state, last.opened, last.motions.len()), (State::Running, 0, 1));
    assert!((150..=250).contains(&last.current.0), "{}", last.current);
    assert!(last.supply.0 > 3_000, "{}", last.supply);
    let motion = last.motions[0];
    let Phase::Heating { temperature, duty: 1_000 } = motion.phase else { panic!("{motion:?}") };
    assert!((2_300..9_500).contains(&temperature.0), "{temperature}");
}

#[test]
fn s3_the_dead_mans_switch_acts_30_ms_after_the_latest_tick_and_only_while_something_may_be_energised() {
    let mut host = Host::new(&plant());
    host.upload(&[heat(0, &[])]).unwrap();
    host.pass(Millis(20));
    assert_eq!(host.board.core().dead_line(), None);
    host.arm(LIMITS).unwrap();
    host.pass(Millis(20));
    assert_eq!(host.board.core().dead_line(), Some(host.board.now().plus(Millis(30))));
    host.ask(Command::Disarm).unwrap();
    assert_eq!(host.board.core().dead_line(), None);
}
