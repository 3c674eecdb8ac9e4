//! Tests of pulses: heat of constant power, for a while.

use super::*;
use zygote_protocol::Milliamps;

const PULSE: Pulse = Pulse {
    channel: 0,
    duty: 300,
    duration: Millis(4_000),
    target: CentiCelsius(9_000),
    max_temperature: CentiCelsius(12_000),
    cool: CentiCelsius(4_500),
    rest: Millis(500),
    min_gain: CentiCelsius(400),
    gain_window: Millis(2_000),
    current: Milliamps(200),
};
const COLD: i16 = 2_200;

/// A heater and its time.
struct Bench {
    heater: SmaHeater,
    now: Micros,
}

impl Bench {
    fn new(pulse: Pulse) -> Self {
        Self { heater: SmaHeater::pulse(pulse, Micros(0), CentiCelsius(COLD)), now: Micros(0) }
    }

    /// The reading of this time.
    fn at(&mut self, ms: u64, reading: i16) -> Result<(), Trip> {
        self.now = Micros(ms * 1_000);
        self.heater.advance(self.now, CentiCelsius(reading))
    }

    /// Readings that rise by 10 °C a second, every 100 ms, up to and without `until`.
    fn warm(&mut self, until_ms: u64) {
        for (ms, reading) in (0..until_ms).step_by(100).zip((COLD..).step_by(100)) {
            assert_eq!(self.at(ms, reading), Ok(()), "at {ms} ms");
            assert_eq!(self.duty(), 300, "at {ms} ms");
        }
    }

    fn duty(&self) -> u16 {
        self.heater.duty().per_mille()
    }

    fn state(&self) -> StepState {
        self.heater.step_state()
    }
}

#[test]
fn s4_a_pulse_has_one_power_until_its_time_is_over_and_is_then_off_open_and_done() {
    let mut bench = Bench::new(PULSE);
    bench.warm(4_000);
    assert_eq!(bench.at(3_999, 6_150), Ok(()));
    assert_eq!((bench.state(), bench.duty()), (StepState::Moving, 300));
    assert_eq!(bench.at(4_000, 6_200), Ok(()), "its end is no fault");
    assert_eq!((bench.state(), bench.duty()), (StepState::Opened, 0));
    assert_eq!(bench.at(4_400, 4_400), Ok(()));
    assert_eq!(bench.state(), StepState::Opened, "it has not rested");
    assert_eq!(bench.at(4_500, 4_400), Ok(()));
    assert_eq!((bench.state(), bench.heater.peak()), (StepState::Done, CentiCelsius(6_200)));
}

#[test]
fn a_pulse_ends_at_its_target_without_holding_it() {
    let mut bench = Bench::new(Pulse { target: CentiCelsius(4_000), cool: CentiCelsius(3_000), ..PULSE });
    bench.warm(1_800);
    assert_eq!(bench.at(1_800, 3_999), Ok(()));
    assert_eq!((bench.state(), bench.duty()), (StepState::Moving, 300));
    assert_eq!(bench.at(1_810, 4_000), Ok(()));
    assert_eq!((bench.state(), bench.duty()), (StepState::Opened, 0));
}

#[test]
fn the_phases_of_a_pulse_are_heating_and_cooling() {
    let mut bench = Bench::new(PULSE);
    bench.warm(4_000);
    let temperature = CentiCelsius(6_200);
    assert_eq!(bench.heater.phase(temperature), Some(Phase::Heating { temperature, duty: 300 }));
    assert_eq!(bench.at(4_000, 6_200), Ok(()));
    assert_eq!(bench.heater.phase(temperature), Some(Phase::Cooling { temperature }));
}

#[test]
fn s6_a_pulse_without_gain_trips_at_the_end_of_its_window_even_where_that_is_its_own_end() {
    for window in [2_000, 4_000] {
        let mut bench = Bench::new(Pulse { gain_window: Millis(window), ..PULSE });
        assert_eq!(bench.at(0, COLD), Ok(()));
        assert_eq!(bench.at(u64::from(window) - 1, COLD + 399), Ok(()));
        let trip = bench.at(u64::from(window), COLD + 399);
        assert_eq!(trip, Err(Trip::new(FaultCode::NoGain, 399, 400)));
    }
}

#[test]
fn s6_a_reading_that_falls_during_a_pulse_trips() {
    let mut bench = Bench::new(PULSE);
    bench.warm(2_500);
    assert_eq!(bench.at(2_500, 4_100), Ok(()), "5 K are allowed");
    assert_eq!(bench.at(2_510, 4_099), Err(Trip::new(FaultCode::NoGain, -501, 100)));
}

#[test]
fn s5_a_reading_that_stands_still_during_a_pulse_is_put_to_the_test_and_trips_if_it_goes_on() {
    let mut bench = Bench::new(PULSE);
    bench.warm(2_500);
    assert_eq!((bench.at(2_500, 4_600), bench.duty()), (Ok(()), 300));
    assert_eq!((bench.at(2_890, 4_600), bench.duty()), (Ok(()), 300));
    assert_eq!((bench.at(2_900, 4_600), bench.duty()), (Ok(()), 0));
    let mut live = Bench { heater: bench.heater, now: bench.now };
    assert_eq!((live.at(3_000, 4_590), live.duty()), (Ok(()), 300), "it lives");
    assert_eq!(bench.at(3_890, 4_600), Ok(()));
    assert_eq!(bench.at(3_900, 4_600), Err(Trip::new(FaultCode::SensorFrozen, 4_600, 1_500)));
}

#[test]
fn s6_a_hinge_that_does_not_cool_after_a_pulse_trips() {
    let mut bench = Bench::new(PULSE);
    bench.warm(4_000);
    assert_eq!(bench.at(4_000, 6_200), Ok(()));
    assert_eq!(bench.at(13_990, 6_200), Ok(()));
    assert_eq!(bench.at(14_000, 6_101), Err(Trip::new(FaultCode::NoCooling, 99, 100)));
}
