//! From a divider reading to a temperature: NTC thermistor, beta equation.

use crate::io::ADC_FULL_SCALE;
use libm::{logf, roundf};
use zygote_protocol::CentiCelsius;

const KELVIN_AT_25_C: f32 = 298.15;
const KELVIN_AT_0_C: f32 = 273.15;

/// A thermistor and its pull-up.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Thermistor {
    /// Resistance at 25 °C, ohm.
    pub r25_ohm: f32,
    /// Beta constant between 25 and 85 °C, kelvin.
    pub beta_k: f32,
    /// Pull-up to the ADC's reference, ohm.
    pub pull_up_ohm: f32,
}

/// A common 10 kohm NTC (B25/85 = 3950 K) with a 10 kohm pull-up.
pub const NTC_10K: Thermistor = Thermistor { r25_ohm: 10_000.0, beta_k: 3_950.0, pull_up_ohm: 10_000.0 };

impl Thermistor {
    /// Temperature for a reading strictly between 0 and full scale; readings outside clamp to the nearest inside.
    pub fn temperature(&self, counts: u16) -> CentiCelsius {
        let counts = counts.clamp(1, ADC_FULL_SCALE - 1);
        let ratio = f32::from(counts) / f32::from(ADC_FULL_SCALE);
        let ohm = self.pull_up_ohm * ratio / (1.0 - ratio);
        let kelvin = 1.0 / (1.0 / KELVIN_AT_25_C + logf(ohm / self.r25_ohm) / self.beta_k);
        let centi = roundf((kelvin - KELVIN_AT_0_C) * 100.0).clamp(f32::from(i16::MIN), f32::from(i16::MAX));
        #[expect(
            clippy::as_conversions,
            clippy::cast_possible_truncation,
            reason = "clamped to the range of i16"
        )]
        let centi = centi as i16;
        CentiCelsius(centi)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Counts that the divider gives at a temperature, by the beta equation solved the other way.
    #[expect(
        clippy::as_conversions,
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "0 to 4095"
    )]
    fn counts_at(celsius: f64) -> u16 {
        let ohm = 10_000.0 * libm::exp(3_950.0 * (1.0 / (celsius + 273.15) - 1.0 / 298.15));
        libm::round(4_095.0 * ohm / (ohm + 10_000.0)) as u16
    }

    #[test]
    fn readings_give_the_temperature_within_a_quantisation_step() {
        for celsius in [-20.0, 0.0, 25.0, 60.0, 95.0, 120.0] {
            let measured = f64::from(NTC_10K.temperature(counts_at(celsius)).0) / 100.0;
            assert!((measured - celsius).abs() < 0.4, "{measured} for {celsius}");
        }
    }

    #[test]
    fn a_reading_at_either_end_gives_a_finite_temperature() {
        assert!(NTC_10K.temperature(0).0 > 20_000);
        assert!(NTC_10K.temperature(ADC_FULL_SCALE).0 < -5_000);
    }

    #[test]
    fn a_reading_at_either_end_is_taken_for_the_next_one_inside() {
        assert_eq!(NTC_10K.temperature(0), NTC_10K.temperature(1));
        assert_eq!(NTC_10K.temperature(ADC_FULL_SCALE), NTC_10K.temperature(ADC_FULL_SCALE - 1));
        assert!(NTC_10K.temperature(ADC_FULL_SCALE - 1) < NTC_10K.temperature(ADC_FULL_SCALE - 2));
    }
}
