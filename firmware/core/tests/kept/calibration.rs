//! Calibrations that a board keeps, and the steps that are held against them (S6, S7, S13).

use crate::a_bench::{Answer, Bench};
use zygote_protocol::{
    Action, Actuator, Calibration, CentiCelsius, Command, Heat, HeaterCalibration, Kept, Milliamps, Millis,
    Pulse, Refusal, RefusalCode, Reply, RigId, ServoCalibration, Step, Turn, program_crc,
};

const HEATER: HeaterCalibration = HeaterCalibration {
    current: Milliamps(200),
    gain: CentiCelsius(4_800),
    window: Millis(3_000),
    opens_at: Some(CentiCelsius(7_800)),
};
const SERVO: ServoCalibration = ServoCalibration { shortest_us: 600, longest_us: 2_400 };
/// As a host makes it of that calibration: a third of the gain.
const GOOD: Heat = Heat {
    channel: 0,
    target: CentiCelsius(9_500),
    hold: Millis(1_000),
    max_on: Millis(15_000),
    max_temperature: CentiCelsius(12_000),
    cool: CentiCelsius(4_500),
    rest: Millis(500),
    min_gain: CentiCelsius(1_600),
    gain_window: Millis(3_000),
    current: Milliamps(200),
};

fn heater(known: HeaterCalibration) -> Calibration {
    Calibration::Heater { channel: 0, known: Some(known) }
}

fn servo(known: ServoCalibration) -> Calibration {
    Calibration::Servo { channel: 0, known: Some(known) }
}

fn refused(code: RefusalCode, at: u16, expected: i64, got: i64) -> Answer {
    Err(Refusal { code, at, expected, got })
}

fn kept(calibrations: &[Calibration]) -> Kept<1, 1> {
    let mut kept = Kept::NOTHING;
    for calibration in calibrations {
        kept.put(*calibration).unwrap();
    }
    kept
}

/// A core that knows this of its actuators.
fn knowing(calibrations: &[Calibration]) -> Bench {
    let mut bench = Bench::new();
    bench.core.restore(kept(calibrations));
    bench
}

/// A program of one step, uploaded and committed.
fn commit(bench: &mut Bench, action: Action) -> Answer {
    let step = Step { hinge: 1, after: heapless::Vec::new(), action };
    let steps: heapless::Vec<Step, 4> = std::iter::once(step).collect();
    let (rig, crc) = (RigId::try_from("r").unwrap(), program_crc(&steps));
    bench.ask(Command::Upload { run: 1, rig, steps: 1, crc })?;
    bench.ask(Command::Steps { first: 0, steps })?;
    bench.ask(Command::Commit)
}

fn arm(bench: &mut Bench) -> Answer {
    let limits = crate::a_board::config(1, 1, 1).ceiling;
    bench.ask(Command::Arm { rig: RigId::try_from("r").unwrap(), limits, lifetime: Millis(10_000) })
}

/// The board stores this, or can't; the answer.
fn store(bench: &mut Bench, calibration: Calibration, is_stored: bool) -> Answer {
    bench.send(Command::Calibrate(calibration));
    assert!(bench.carry().is_empty(), "not before it is stored");
    bench.core.stored(is_stored);
    bench.carry().remove(0).result
}

#[test]
fn what_is_calibrated_is_stored_then_told() {
    let mut bench = Bench::new();
    let ask = Command::Calibration(Actuator::Heater(0));
    let nothing = Calibration::Heater { channel: 0, known: None };
    assert_eq!(bench.ask(ask.clone()), Ok(Reply::Calibration(nothing)));
    bench.send(Command::Calibrate(heater(HEATER)));
    bench.carry();
    assert_eq!(bench.core.to_store(), Some(&kept(&[heater(HEATER)])));
    bench.core.stored(true);
    bench.carry();
    assert_eq!(bench.ask(ask.clone()), Ok(Reply::Calibration(heater(HEATER))));
    assert_eq!(store(&mut bench, servo(SERVO), true), Ok(Reply::Done));
    assert_eq!(bench.ask(ask.clone()), Ok(Reply::Calibration(heater(HEATER))), "the one beside it stays");
    assert_eq!(store(&mut bench, nothing, true), Ok(Reply::Done));
    assert_eq!(bench.ask(ask), Ok(Reply::Calibration(nothing)));
    assert_eq!(bench.ask(Command::Calibration(Actuator::Servo(0))), Ok(Reply::Calibration(servo(SERVO))));
}

#[test]
fn a_calibration_that_cannot_be_stored_changes_nothing() {
    let mut bench = knowing(&[heater(HEATER)]);
    let hotter = HeaterCalibration { gain: CentiCelsius(9_000), ..HEATER };
    assert_eq!(store(&mut bench, heater(hotter), false), refused(RefusalCode::NotStored, 0, 0, 0));
    let ask = Command::Calibration(Actuator::Heater(0));
    assert_eq!(bench.ask(ask), Ok(Reply::Calibration(heater(HEATER))));
}

#[test]
fn values_and_channels_that_cannot_be_are_refused() {
    let mut bench = Bench::new();
    let cases = [
        (heater(HeaterCalibration { current: Milliamps(0), ..HEATER }), 1, 0),
        (heater(HeaterCalibration { gain: CentiCelsius(-3), ..HEATER }), 1, -3),
        (heater(HeaterCalibration { gain: CentiCelsius(0), ..HEATER }), 1, 0),
        (heater(HeaterCalibration { window: Millis(0), ..HEATER }), 1, 0),
        (servo(ServoCalibration { shortest_us: 1_501, longest_us: 1_500 }), 1_500, 1_501),
    ];
    for (calibration, nearest, got) in cases {
        let answer = bench.ask(Command::Calibrate(calibration));
        assert_eq!(answer, refused(RefusalCode::CalibrationValue, 0, nearest, got), "{calibration:?}");
    }
    let narrow = servo(ServoCalibration { shortest_us: 1_500, longest_us: 1_500 });
    assert_eq!(store(&mut bench, narrow, true), Ok(Reply::Done));
    let unknown = refused(RefusalCode::UnknownChannel, 1, 0, 1);
    assert_eq!(bench.ask(Command::Calibration(Actuator::Heater(1))), unknown);
    assert_eq!(bench.ask(Command::Calibration(Actuator::Servo(1))), unknown);
    assert_eq!(bench.ask(Command::Calibrate(Calibration::Servo { channel: 1, known: Some(SERVO) })), unknown);
    assert_eq!(bench.ask(Command::Calibrate(Calibration::Heater { channel: 1, known: None })), unknown);
}

#[test]
fn s6_a_step_expects_a_quarter_of_the_measured_gain_at_least() {
    let mut bench = knowing(&[heater(HEATER)]);
    let expects = |bench: &mut Bench, min_gain, gain_window| {
        let (min_gain, gain_window) = (CentiCelsius(min_gain), Millis(gain_window));
        commit(bench, Action::Heat(Heat { min_gain, gain_window, ..GOOD }))
    };
    assert_eq!(commit(&mut bench, Action::Heat(GOOD)), Ok(Reply::Done));
    assert_eq!(expects(&mut bench, 1_200, 3_000), Ok(Reply::Done));
    let little = |least, got| refused(RefusalCode::CalibratedGain, 0, least, got);
    assert_eq!(expects(&mut bench, 1_199, 3_000), little(1_200, 1_199));
    assert_eq!(expects(&mut bench, 1_199, 9_000), little(1_200, 1_199), "later it has gained more");
    assert_eq!(expects(&mut bench, 400, 1_000), Ok(Reply::Done), "in a third of the time");
    assert_eq!(expects(&mut bench, 399, 1_000), little(400, 399));
}

#[test]
fn s7_a_step_declares_the_measured_current_but_for_a_lower_supply() {
    let mut bench = knowing(&[heater(HEATER)]);
    let declares = |bench: &mut Bench, current| {
        commit(bench, Action::Heat(Heat { current: Milliamps(current), ..GOOD }))
    };
    assert_eq!(declares(&mut bench, 160), Ok(Reply::Done));
    assert_eq!(declares(&mut bench, 159), refused(RefusalCode::CalibratedCurrent, 0, 160, 159));
}

#[test]
fn a_target_is_above_the_temperature_at_which_the_hinge_is_open() {
    let mut bench = knowing(&[heater(HEATER)]);
    let targets = |bench: &mut Bench, target| {
        commit(bench, Action::Heat(Heat { target: CentiCelsius(target), ..GOOD }))
    };
    assert_eq!(targets(&mut bench, 7_801), Ok(Reply::Done));
    assert_eq!(targets(&mut bench, 7_800), refused(RefusalCode::CalibratedTarget, 0, 7_800, 7_800));
    bench.core.restore(kept(&[heater(HeaterCalibration { opens_at: None, ..HEATER })]));
    assert_eq!(targets(&mut bench, 7_800), Ok(Reply::Done), "it was never seen");
}

#[test]
fn s13_a_servo_is_not_pushed_against_its_ends() {
    let mut bench = knowing(&[servo(SERVO)]);
    let turns = |bench: &mut Bench, from_us, to_us| {
        let (duration, settle) = (Millis(900), Millis(0));
        let (current, hold_current) = (Milliamps(10), Milliamps(10));
        let turn = Turn { channel: 0, from_us, to_us, duration, settle, current, hold_current };
        commit(bench, Action::Turn(turn))
    };
    assert_eq!(turns(&mut bench, 600, 2_400), Ok(Reply::Done));
    assert_eq!(turns(&mut bench, 599, 2_400), refused(RefusalCode::ServoRange, 0, 600, 599));
    assert_eq!(turns(&mut bench, 600, 2_401), refused(RefusalCode::ServoRange, 0, 2_400, 2_401));
}

#[test]
fn a_pulse_may_find_another_heater_than_there_was() {
    let mut bench = knowing(&[heater(HEATER)]);
    let pulse = Pulse {
        channel: 0,
        duty: 250,
        duration: Millis(5_000),
        target: CentiCelsius(6_000),
        max_temperature: CentiCelsius(12_000),
        cool: CentiCelsius(4_500),
        rest: Millis(500),
        min_gain: CentiCelsius(100),
        gain_window: Millis(3_000),
        current: Milliamps(100),
    };
    assert_eq!(commit(&mut bench, Action::Pulse(pulse)), Ok(Reply::Done));
}

#[test]
fn a_program_is_held_against_what_was_measured_since_it_was_committed() {
    let mut bench = Bench::new();
    assert_eq!(commit(&mut bench, Action::Heat(Heat { current: Milliamps(100), ..GOOD })), Ok(Reply::Done));
    bench.send(Command::Calibrate(heater(HEATER)));
    bench.carry();
    assert_eq!(arm(&mut bench), refused(RefusalCode::Storing, 0, 0, 0));
    bench.core.stored(true);
    bench.carry();
    assert_eq!(arm(&mut bench), refused(RefusalCode::CalibratedCurrent, 0, 160, 100));
}

#[test]
fn nothing_is_calibrated_while_something_is_energised() {
    let mut bench = Bench::new();
    commit(&mut bench, Action::Heat(GOOD)).unwrap();
    arm(&mut bench).unwrap();
    let answer = bench.ask(Command::Calibrate(heater(HEATER)));
    assert_eq!(answer, refused(RefusalCode::WrongState, 0, 0, 2));
    assert_eq!(bench.core.to_store(), None);
}
