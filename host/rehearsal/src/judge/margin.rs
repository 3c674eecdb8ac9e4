//! How far above a reading the foil may truly be, by physics: the margin that the temperature rule is judged with.
//!
//! Let P be the heater's power, C the heat capacity of the foil without latent heat, F that of the film, k the
//! conductance between them, L the thermistor's lag.
//!
//! * While the heater is on, the film is at most P/k above the foil: beyond that it would give off more than it gets.
//!   So the foil gets at most P and rises at most by P/C a second.
//! * The bead follows the foil with a lag: it is behind by at most L P/C.
//! * The guard sees a reading at the next tick at the latest, and what it decides acts from then on: two ticks, 2 t P/C.
//! * After switching off, the film still holds P/k above the foil, shared by both: P/k F/(C + F).
//! * A reading is rounded and noisy: three counts of the converter at that temperature.
//!
//! Together (L + 2 t) P/C + P/k F/(C + F) + three counts; 13.5 K for the default hinge with 1 W.

use zygote_sim::TICK;
use zygote_sim::plant::SmaConfig;

/// Counts of the converter by which a reading may be off.
const COUNTS: f64 = 3.0;

/// The margin above `limit_c` for a heater of `ohm` at `volts`, in kelvins.
pub fn margin_k(sma: &SmaConfig, volts: f64, ohm: f64, limit_c: f64) -> f64 {
    let power_w = volts * volts / ohm;
    let foil = sma.foil_j_per_k();
    let unseen_s = sma.thermistor.lag_s + 2.0 * f64::from(TICK.0) / 1e3;
    let behind_k = unseen_s * power_w / foil;
    let stored_k = power_w / sma.coupling_w_per_k * sma.film_j_per_k / (foil + sma.film_j_per_k);
    behind_k + stored_k + counts_k(sma, limit_c)
}

/// What the converter's counts are in kelvins at a temperature.
fn counts_k(sma: &SmaConfig, celsius: f64) -> f64 {
    let counts = sma.thermistor.counts_at(celsius);
    sma.thermistor.celsius_from_counts(counts - COUNTS) - celsius
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::time::Duration;
    use zygote_core::Duty;
    use zygote_sim::plant::{Config, Drive, Plant, SupplyConfig};

    /// Heats at full power until the bead reads over `limit_c`, then switches off; how far the foil gets above it.
    fn overshoot_k(sma: SmaConfig, limit_c: f64) -> f64 {
        let supply = SupplyConfig { source_ohm: 0.0, ..SupplyConfig::default() };
        let mut plant = Plant::new(&Config { supply, heaters: vec![sma], ..Config::default() }).unwrap();
        let (mut duty, mut hottest_c) = (Duty::FULL, 0.0_f64);
        for _ in 0..6_000 {
            let drive = Drive { heaters: &[duty], servos: &[], springs: &[], main_switch: true };
            plant.advance(Duration::from_millis(5), &drive).unwrap();
            let hinge = &plant.sma_hinges()[0];
            hottest_c = hottest_c.max(hinge.temperature_c());
            if hinge.bead_c() > limit_c {
                duty = Duty::OFF;
            }
        }
        hottest_c - limit_c
    }

    #[test]
    fn no_hinge_gets_further_above_its_limit_than_the_margin() {
        let mut nearest = 0.0_f64;
        for ohm in [25.0, 12.5, 5.0] {
            for (film_j_per_k, coupling_w_per_k, lag_s) in
                [(0.012, 0.075, 0.3), (0.03, 0.04, 0.1), (0.006, 0.15, 0.8)]
            {
                let mut sma =
                    SmaConfig { heater_ohm: ohm, film_j_per_k, coupling_w_per_k, ..SmaConfig::opening(90.0) };
                sma.thermistor.lag_s = lag_s;
                for limit_c in [60.0, 72.0, 110.0] {
                    let (got, most) = (overshoot_k(sma, limit_c), margin_k(&sma, 5.0, ohm, limit_c));
                    assert!(got <= most, "{got} K over {limit_c} °C with {ohm} ohm, at most {most} K");
                    nearest = nearest.max(got / most);
                }
            }
        }
        assert!(nearest > 0.5, "at most {nearest} of the margin is ever used: it says nothing");
    }
}
