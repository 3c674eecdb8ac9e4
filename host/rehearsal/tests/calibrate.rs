//! Calibrations on the simulated board in which something goes wrong: nothing stays on, and no measurement is lost or invented.
#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]

use std::cell::Cell;
use std::io;
use zygote_calibration::Quantity;
use zygote_controller::calibrate::{CalibrateError, Calibration, Ending, Hinge, Measured, calibrate};
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
