//! Readings against the truth behind them.

use core::time::Duration;

use proptest::prelude::*;
use zygote_core::{Duty, PulseMicros};
use zygote_protocol::{Milliamps, Millivolts};
use zygote_sim::plant::{Config, ServoConfig, SmaConfig, SpringConfig, ThermistorConfig};

use crate::rig::{Rig, TICK, assert_near, stiff_supply};

#[test]
fn a_10k_thermistor_reads_as_its_data_sheet_says() {
    let thermistor = ThermistorConfig::default();
    assert_near(thermistor.counts_at(25.0), 2047.5, 1e-9, "half of full scale at 25 °C");
    // R(50 °C) of a 10 kOhm, 3950 K bead by the beta model is 3588 Ohm; R(0 °C) is 33.6 kOhm.
    assert_near(thermistor.ohm_at(50.0), 3588.0, 1.0, "ohm at 50 °C");
    assert_near(thermistor.ohm_at(0.0), 33_620.0, 10.0, "ohm at 0 °C");
    assert!(thermistor.counts_at(90.0) < thermistor.counts_at(30.0), "hotter reads lower");
}

proptest! {
    #[test]
    fn a_reading_turns_back_into_its_temperature(
        t_c in -20.0..150.0f64, r25_ohm in 1e3..1e5f64, beta_k in 3000.0..4500.0f64, pull_up_ohm in 1e3..1e5f64,
    ) {
        let thermistor = ThermistorConfig { r25_ohm, beta_k, pull_up_ohm, ..ThermistorConfig::default() };
        let back_c = thermistor.celsius_from_counts(thermistor.counts_at(t_c));
        prop_assert!((back_c - t_c).abs() < 1e-6, "{t_c} °C came back as {back_c} °C");
    }
}

#[test]
fn a_reading_at_rest_is_the_temperature_within_a_count() {
    let mut sma = SmaConfig::opening(90.0);
    sma.thermistor.noise_counts = 0.0;
    let mut rig = Rig::hinge(sma);
    rig.heaters[0] = Duty::new(300);
    rig.run(60.0);
    let exact = sma.thermistor.counts_at(rig.foil_c());
    assert_near(f64::from(rig.plant.sense().thermistors[0]), exact, 0.501, "counts");
}

#[test]
fn the_noise_has_the_spread_that_was_asked_for() {
    let mut sma = SmaConfig::opening(90.0);
    sma.thermistor.noise_counts = 4.0;
    let mut rig = Rig::hinge(sma);
    let exact = sma.thermistor.counts_at(22.0);
    let errors: Vec<f64> = (0..20_000).map(|_| f64::from(rig.plant.sense().thermistors[0]) - exact).collect();
    let count = 20_000.0;
    let mean = errors.iter().sum::<f64>() / count;
    let deviation = (errors.iter().map(|error| (error - mean).powi(2)).sum::<f64>() / count).sqrt();
    assert_near(mean, 0.0, 0.1, "mean");
    // Rounding adds its own twelfth of a count squared.
    assert_near(deviation, (16.0 + 1.0 / 12.0f64).sqrt(), 0.1, "standard deviation");
}

#[test]
fn supply_and_current_are_read_in_thousandths() {
    let supply = stiff_supply();
    let mut rig = Rig::new(&Config { supply, heaters: vec![SmaConfig::opening(90.0)], ..Config::default() });
    rig.heaters[0] = Duty::new(500);
    rig.step(TICK);
    let readings = rig.plant.sense();
    assert_eq!((readings.supply, readings.current), (Millivolts(5000), Milliamps(100)));
}

#[test]
fn the_same_seed_gives_the_same_run_and_another_seed_other_noise() {
    let run = |seed| {
        let mut rig = Rig::new(&Config {
            heaters: vec![SmaConfig::opening(90.0), SmaConfig::opening(270.0)],
            servos: vec![ServoConfig::default()],
            springs: vec![SpringConfig::opening(180.0)],
            seed,
            ..Config::default()
        });
        rig.heaters = vec![Duty::FULL, Duty::new(300)];
        rig.servos = vec![Some(PulseMicros(1500))];
        rig.springs = vec![true];
        let mut readings = Vec::new();
        for _ in 0..600 {
            rig.step(Duration::from_millis(10));
            readings.push(rig.plant.sense());
        }
        (readings, rig.foil_c().to_bits(), rig.sma_deg().to_bits())
    };
    let (first, other) = (run(7), run(8));
    assert_eq!(first, run(7));
    assert_ne!(first.0, other.0);
    assert_eq!((first.1, first.2), (other.1, other.2), "the seed is the noise's alone");
}
