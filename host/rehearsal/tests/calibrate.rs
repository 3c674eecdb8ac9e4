//! Calibrations on the simulated board in which something goes wrong: nothing stays on, and no measurement is lost or invented.
#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]

use std::cell::Cell;
use std::io;
use zygote_calibration::Quantity;
use zygote_controller::calibrate::{CalibrateError, Calibration, Ending, Hinge, Measured, calibrate};
use zygote_controller::calibrate_servo::{
    Answer, MeasuredServos, Protractor, Question, ReadingError, ServoCalibration, ServoEnding, ServoError,
    ServoHinge, calibrate_servos,
};
use zygote_controller::{Session, Transport};
use zygote_core::Duty;
use zygote_deployment::{Drive, Rig};
use zygote_protocol::{FaultCode, Micros, Millis};
use zygote_sim::Board;
use zygote_sim::plant::Fault as Broken;

const RIG: &str = r#"
version = 1
[rig]
id = "bench"
[supply]
voltage = "5 V"
limit = "2 A"
resistance = "50 mohm"
[[node]]
name = "simulated"
heaters = 3
[sim]
seed = 9
"#;

/// A board at the end of a line without delay, which breaks at a time.
struct Bench {
    board: Board,
    breaks: Option<(Micros, Broken)>,
    arrived: Vec<u8>,
}

impl Transport for Bench {
    fn now(&self) -> Micros {
        self.board.now()
    }

    fn send(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.board.receive(bytes);
        Ok(())
    }

    fn receive(&mut self, buffer: &mut [u8], deadline: Micros) -> io::Result<usize> {
        loop {
            self.board.transmit(&mut self.arrived);
            if !self.arrived.is_empty() || self.board.now() >= deadline {
                break;
            }
            if let Some((_, broken)) = self.breaks.take_if(|(at, _)| *at <= self.board.now()) {
                self.board.plant_mut().inject(broken).map_err(io::Error::other)?;
            }
            self.board.advance(deadline).map_err(io::Error::other)?;
        }
        let count = self.arrived.len().min(buffer.len());
        for (place, byte) in buffer.iter_mut().zip(self.arrived.drain(..count)) {
            *place = byte;
        }
        Ok(count)
    }

    fn name(&self) -> String {
        "bench".to_owned()
    }
}

struct Ended {
    outcome: Result<(), CalibrateError>,
    hinges: Vec<Hinge>,
    board: Board,
    /// What was kept last.
    kept: Vec<u8>,
}

impl Ended {
    fn all_off(&self) -> bool {
        let outputs = self.board.core().outputs();
        !outputs.main_switch && outputs.heaters.iter().all(|duty| *duty == Duty::OFF)
    }
}

/// Calibrates three hinges. It goes on with what was kept; it breaks after some seconds; the user stops after so many looks.
fn run(kept: Option<&[u8]>, breaks: Option<(u64, Broken)>, stops_after: usize) -> Ended {
    let rig = Rig::read("rig.toml", RIG).unwrap();
    let fittings = rig.fit(3).unwrap();
    let board = zygote_rehearsal::bench(&rig, &fittings, 1).unwrap();
    let breaks = breaks.map(|(seconds, broken)| (Micros(seconds * 1_000_000), broken));
    let bench = Bench { board, breaks, arrived: Vec::new() };
    let mut session = Session::connect(bench, 1, Millis(1_000)).unwrap();
    let info = session.info().clone();
    let mut hinges: Vec<Hinge> = fittings
        .iter()
        .enumerate()
        .map(|(number, fitting)| match fitting.drive {
            Drive::Sma(settings) => Hinge::new(number, fitting.channel, settings, &info.ceiling),
            other => panic!("{other:?}"),
        })
        .collect();
    if let Some(kept) = kept {
        Measured::from_json(kept).unwrap().resume(&rig.id, &info, &mut hinges).unwrap();
    }
    let looks = Cell::new(0);
    let interrupted = || {
        looks.set(looks.get() + 1);
        looks.get() > stops_after
    };
    let calibration = Calibration { rig: &rig, run: 1, clear: false, interrupted: &interrupted };
    let mut last = Vec::new();
    let mut keep = |hinges: &[Hinge]| {
        last = serde_json::to_vec(&Measured::new(&rig.id, &info, hinges)).unwrap();
        Ok(())
    };
    let outcome = calibrate(&mut session, &calibration, &mut hinges, &mut keep, &mut |_| {});
    Ended { outcome, hinges, board: session.into_transport().board, kept: last }
}

#[test]
fn an_interrupted_calibration_leaves_nothing_on_and_goes_on_with_all_that_was_measured() {
    // In the midst of the pulses side by side.
    let first = run(None, None, 900);
    assert!(matches!(first.outcome, Err(CalibrateError::Interrupted)), "{:?}", first.outcome);
    assert!(first.all_off());
    let samples =
        |hinges: &[Hinge]| hinges.iter().map(|hinge| hinge.record.samples.len()).collect::<Vec<_>>();
    let (before, drives) = (samples(&first.hinges), first.hinges[0].record.drives.clone());
    assert!(before.iter().all(|count| *count > 20) && !drives.is_empty(), "{before:?}, {drives:?}");
    let second = run(Some(&first.kept), None, usize::MAX);
    assert!(second.outcome.is_ok(), "{:?}", second.outcome);
    assert!(second.all_off());
    for (hinge, earlier) in second.hinges.iter().zip(&first.hinges) {
        assert_eq!(hinge.ending, Some(Ending::Done), "hinge {}", hinge.number);
        let count = earlier.record.samples.len();
        assert_eq!(hinge.record.samples[..count], earlier.record.samples[..], "hinge {}", hinge.number);
        let af = hinge.fit().unwrap().value(Quantity::AusteniteFinish).unwrap();
        assert!((af.value - 78.0).abs() < 2.0, "hinge {}: {af:?}", hinge.number);
    }
}

#[test]
fn s6_a_thermistor_that_comes_off_ends_its_hinge_and_the_others_go_on() {
    let ended = run(None, Some((1, Broken::ThermistorLoose(1))), usize::MAX);
    assert!(ended.outcome.is_ok(), "{:?}", ended.outcome);
    assert!(ended.all_off());
    let endings: Vec<_> = ended.hinges.iter().map(|hinge| hinge.ending.clone().unwrap()).collect();
    assert_eq!((&endings[0], &endings[2]), (&Ending::Done, &Ending::Done));
    assert!(matches!(endings[1], Ending::Refused(_) | Ending::Fault(_)), "{:?}", endings[1]);
    let known =
        Quantity::ALL.iter().filter(|quantity| ended.hinges[1].fit().unwrap().value(**quantity).is_some());
    assert_eq!(known.count(), 0, "nothing is known of a hinge that nobody measured");
}

#[test]
fn s6_a_mosfet_that_sticks_ends_the_calibration_with_everything_off() {
    let ended = run(None, Some((40, Broken::MosfetStuckOn(2))), usize::MAX);
    let Err(CalibrateError::Fault { fault, .. }) = &ended.outcome else { panic!("{:?}", ended.outcome) };
    assert!(
        matches!(fault.code, FaultCode::UnplannedCurrent | FaultCode::UnexpectedHeat | FaultCode::NoCooling),
        "{fault:?}"
    );
    assert!(ended.all_off());
}

#[test]
fn s5_a_thermistor_that_is_not_there_is_told_before_anything_is_heated() {
    let ended = run(None, Some((0, Broken::ThermistorOpen(1))), usize::MAX);
    let error = ended.outcome.as_ref().unwrap_err();
    assert!(
        matches!(error, CalibrateError::Thermistors(wrong) if wrong.len() == 1 && wrong[0].0 == 1),
        "{error}"
    );
    assert!(ended.all_off());
    assert!(ended.hinges.iter().all(|hinge| hinge.record.samples.is_empty()));
}

const SERVOS: &str = r#"
version = 1
[rig]
id = "bench"
[supply]
voltage = "5 V"
limit = "2 A"
resistance = "50 mohm"
[[node]]
name = "simulated"
servos = 3
[hinges]
default = "servo"
[sim.servo]
stop_high = "200 deg"
"#;

/// Reads the truth, and leaves off after so many answers.
struct Reader {
    answers: usize,
    asked: Vec<Question>,
}

impl Protractor<Bench> for Reader {
    fn ask(&mut self, question: &Question) -> Result<(), ReadingError> {
        self.asked.push(question.clone());
        Ok(())
    }

    fn answer(&mut self, line: &Bench) -> Result<Option<Answer>, ReadingError> {
        let Some(left) = self.answers.checked_sub(1) else { return Ok(Some(Answer::Stop)) };
        self.answers = left;
        // Each hinge is on the channel of its number.
        let hinge = self.asked.last().unwrap().hinge;
        Ok(Some(Answer::Angle(line.board.plant().servo_hinges()[hinge].angle_deg())))
    }
}

struct ServosEnded {
    outcome: Result<(), ServoError>,
    hinges: Vec<ServoHinge>,
    asked: Vec<Question>,
    board: Board,
    kept: Vec<u8>,
}

/// Calibrates servos 1 and 2, going on with what was kept.
fn run_servos(kept: Option<&[u8]>, breaks: Option<(u64, Broken)>, answers: usize) -> ServosEnded {
    let rig = Rig::read("rig.toml", SERVOS).unwrap();
    let fittings = rig.fit(3).unwrap();
    let board = zygote_rehearsal::bench(&rig, &fittings, 1).unwrap();
    let breaks = breaks.map(|(seconds, broken)| (Micros(seconds * 1_000_000), broken));
    let mut session =
        Session::connect(Bench { board, breaks, arrived: Vec::new() }, 1, Millis(1_000)).unwrap();
    let settings = session.settings().unwrap().in_force;
    let info = session.info().clone();
    let hinge = |number: usize| match fittings[number].drive {
        Drive::Servo(servo) => ServoHinge::new(number, fittings[number].channel, servo, &settings, 1.0),
        other => panic!("{other:?}"),
    };
    let mut hinges = vec![hinge(1), hinge(2)];
    if let Some(kept) = kept {
        MeasuredServos::from_json(kept).unwrap().resume(&rig.id, &info, &mut hinges).unwrap();
    }
    let calibration = ServoCalibration { rig: &rig, run: 1, clear: false, interrupted: &|| false };
    let mut reader = Reader { answers, asked: Vec::new() };
    let mut last = Vec::new();
    let mut keep = |hinges: &[ServoHinge]| {
        last = serde_json::to_vec(&MeasuredServos::new(&rig.id, &info, hinges)).unwrap();
        Ok(())
    };
    let outcome = calibrate_servos(&mut session, &calibration, &mut hinges, &mut reader, &mut keep);
    let board = session.into_transport().board;
    ServosEnded { outcome, hinges, asked: reader.asked, board, kept: last }
}

fn all_limp(board: &Board) -> bool {
    let outputs = board.core().outputs();
    !outputs.main_switch && outputs.servos.iter().all(Option::is_none)
}

#[test]
fn a_servo_calibration_that_is_left_goes_on_with_what_was_read_and_leaves_every_servo_limp() {
    let first = run_servos(None, None, 5);
    assert!(matches!(first.outcome, Err(ServoError::Interrupted)), "{:?}", first.outcome);
    assert!(all_limp(&first.board));
    assert_eq!(first.hinges[0].record.looks.len(), 5);
    let second = run_servos(Some(&first.kept), None, usize::MAX);
    assert!(second.outcome.is_ok() && all_limp(&second.board), "{:?}", second.outcome);
    for hinge in &second.hinges {
        assert_eq!(hinge.ending, Some(ServoEnding::Done));
        let found = hinge.found();
        assert_eq!(found.points.iter().map(|point| point.angle_deg).collect::<Vec<_>>(), [0, 90, 180]);
        assert!((found.stop_high_deg.unwrap() - 200.0).abs() < 1.0, "{found:?}");
        assert_eq!(hinge.record.looks.iter().filter(|look| look.pushes).count(), 1, "it goes there once");
    }
    assert_eq!(second.hinges[0].record.looks[..5], first.hinges[0].record.looks[..]);
    let relaxed = second.asked.iter().filter(|question| question.relaxed);
    assert_eq!(relaxed.count(), 2, "nothing pushes while it is read");
}

#[test]
fn a_servo_that_stalls_or_jams_on_its_way_ends_the_calibration_with_everything_off() {
    for broken in [Broken::ServoStalled(1), Broken::Jammed(zygote_sim::plant::Hinge::Servo(1))] {
        let ended = run_servos(None, Some((6, broken)), usize::MAX);
        assert!(all_limp(&ended.board));
        let refused = matches!(ended.hinges[0].ending, Some(ServoEnding::Refused(_)));
        let obstructed = matches!(ended.outcome, Err(ServoError::Obstructed { hinge: 1, .. }));
        let points = ended.hinges[0].found().points.len();
        assert!(refused || obstructed || points < 4, "{broken:?}: {:?}, {points} points", ended.outcome);
    }
}

#[test]
fn s8_a_stop_button_ends_a_servo_calibration_with_its_fault() {
    let rig = Rig::read("rig.toml", SERVOS).unwrap();
    let fittings = rig.fit(3).unwrap();
    let mut board = zygote_rehearsal::bench(&rig, &fittings, 1).unwrap();
    board.press_stop(true);
    let mut session =
        Session::connect(Bench { board, breaks: None, arrived: Vec::new() }, 1, Millis(1_000)).unwrap();
    let settings = session.settings().unwrap().in_force;
    let Drive::Servo(servo) = fittings[0].drive else { panic!("no servo") };
    let mut hinges = vec![ServoHinge::new(0, 0, servo, &settings, 1.0)];
    let calibration = ServoCalibration { rig: &rig, run: 1, clear: true, interrupted: &|| false };
    let mut reader = Reader { answers: usize::MAX, asked: Vec::new() };
    let outcome = calibrate_servos(&mut session, &calibration, &mut hinges, &mut reader, &mut |_| Ok(()));
    assert!(outcome.is_err() && reader.asked.is_empty(), "{outcome:?}");
    assert!(all_limp(&session.into_transport().board));
}
