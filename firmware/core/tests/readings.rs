//! Readings of a thermistor that fails and is mended while nothing is energised.
#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]

mod a_bench;
mod a_board;

use a_bench::Bench;
use zygote_core::NTC_10K;
use zygote_protocol::{CentiCelsius, Command, Micros, Reply, State};

/// Some 22 °C, some 45 °C, and a cut wire.
const COLD: u16 = 2_190;
const WARM: u16 = 1_226;
const OPEN: u16 = 4_095;

/// What is told after these readings.
fn told(bench: &mut Bench, readings: &[u16]) -> Option<CentiCelsius> {
    for counts in readings {
        bench.tick(*counts, false);
    }
    let Ok(Reply::Readings(readings)) = bench.ask(Command::Readings { first: 0 }) else {
        panic!("no readings");
    };
    readings.channels[0].temperature
}

#[test]
fn s5_a_thermistor_that_fails_is_not_believed_and_believed_again_once_it_is_mended() {
    let (cold, warm) = (Some(NTC_10K.temperature(COLD)), Some(NTC_10K.temperature(WARM)));
    let mut bench = Bench::new();
    assert_eq!(told(&mut bench, &[]), None, "nothing was read yet");
    assert_eq!(told(&mut bench, &[COLD]), cold);
    assert_eq!(told(&mut bench, &[OPEN, OPEN]), cold, "noise");
    assert_eq!(told(&mut bench, &[OPEN]), None);
    assert_eq!(told(&mut bench, &[OPEN; 9]), None);
    assert_eq!(told(&mut bench, &[WARM]), warm, "another hinge, perhaps");
    assert_eq!(told(&mut bench, &[COLD, COLD]), warm, "it jumps");
    assert_eq!(told(&mut bench, &[COLD]), None);
    assert_eq!(told(&mut bench, &[COLD]), cold, "and stays there");
    assert_eq!(bench.core.state(), State::Idle);
}

#[test]
fn readings_are_of_the_latest_tick() {
    let mut bench = Bench::new();
    bench.tick(COLD, false);
    let Ok(Reply::Readings(first)) = bench.ask(Command::Readings { first: 0 }) else { panic!("no readings") };
    bench.tick(COLD, false);
    let Ok(Reply::Readings(second)) = bench.ask(Command::Readings { first: 0 }) else {
        panic!("no readings")
    };
    assert_eq!((second.at.since(first.at), second.supply.0, second.current.0), (1_000, 12_000, 0));
    assert!(first.at > Micros(0));
}
