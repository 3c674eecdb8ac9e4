//! The thermistor on a foil, its divider and its converter: a temperature becomes a count.

use zygote_core::ADC_FULL_SCALE;

use super::error::{Place, PlantError, not_negative, positive};

const ZERO_CELSIUS_K: f64 = 273.15;
/// The temperature that a thermistor's rated resistance is given at.
const RATED_K: f64 = 298.15;

/// A thermistor to ground with a pull-up to the converter's reference.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ThermistorConfig {
    /// Resistance at 25 °C.
    pub r25_ohm: f64,
    /// Exponent of the beta model R = R25 exp(beta (1/T - 1/298.15 K)).
    pub beta_k: f64,
    /// Pull-up of the divider.
    pub pull_up_ohm: f64,
    /// Time constant with which the bead follows the foil.
    pub lag_s: f64,
    /// Standard deviation of a reading, in counts of 4095.
    pub noise_counts: f64,
}

impl Default for ThermistorConfig {
    /// The commonest bead, 10 kOhm and 3950 K, with the pull-up that suits it at room temperature; a lag of
    /// 0.3 s for a 0.5 mm bead glued to the foil (data sheets of such beads name some 0.2 s in stirred liquid);
    /// one count of noise, what a 12-bit converter shows on a quiet board.
    fn default() -> Self {
        Self { r25_ohm: 10_000.0, beta_k: 3950.0, pull_up_ohm: 10_000.0, lag_s: 0.3, noise_counts: 1.0 }
    }
}

impl ThermistorConfig {
    /// Resistance at `t_c`.
    pub fn ohm_at(&self, t_c: f64) -> f64 {
        self.r25_ohm * libm::exp(self.beta_k * (1.0 / (t_c + ZERO_CELSIUS_K) - 1.0 / RATED_K))
    }

    /// The converter's reading at `t_c` before rounding and noise, 0 to [`ADC_FULL_SCALE`].
    pub fn counts_at(&self, t_c: f64) -> f64 {
        let ohm = self.ohm_at(t_c);
        f64::from(ADC_FULL_SCALE) * ohm / (ohm + self.pull_up_ohm)
    }

    /// The temperature in °C that reads `counts`; infinite at either rail, where a thermistor is shorted or open.
    pub fn celsius_from_counts(&self, counts: f64) -> f64 {
        let ratio = counts / (f64::from(ADC_FULL_SCALE) - counts);
        let inverse_k = 1.0 / RATED_K + libm::log(ratio * self.pull_up_ohm / self.r25_ohm) / self.beta_k;
        if inverse_k <= 0.0 {
            return f64::INFINITY;
        }
        1.0 / inverse_k - ZERO_CELSIUS_K
    }

    pub(super) fn check(&self, place: Place) -> Result<(), PlantError> {
        positive(place, "thermistor resistance at 25 °C (Ohm)", self.r25_ohm)?;
        positive(place, "thermistor beta (K)", self.beta_k)?;
        positive(place, "thermistor pull-up (Ohm)", self.pull_up_ohm)?;
        positive(place, "thermistor lag (s)", self.lag_s)?;
        not_negative(place, "thermistor noise (counts)", self.noise_counts)
    }
}

/// What has become of a thermistor.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Condition {
    Sound,
    Open,
    Shorted,
    /// Reads this for ever.
    Frozen(u16),
    /// Hangs in the air beside the foil.
    Loose,
    /// Reads a temperature that is off, by ever more.
    Drifting {
        kelvin_per_s: f64,
        offset_k: f64,
    },
}

/// A thermistor at work.
#[derive(Debug, Clone)]
pub(super) struct Thermistor {
    config: ThermistorConfig,
    bead_c: f64,
    condition: Condition,
    reading: u16,
}

impl Thermistor {
    pub(super) fn new(config: ThermistorConfig, t_c: f64) -> Self {
        let reading = quantised(config.counts_at(t_c));
        Self { config, bead_c: t_c, condition: Condition::Sound, reading }
    }

    /// Lets the bead follow the foil, which went from `before_c` to `after_c` in `dt_s`. The trapezoidal rule:
    /// second order, and stable for a lag of any length.
    pub(super) fn advance(&mut self, dt_s: f64, before_c: f64, after_c: f64, ambient_c: f64) {
        if let Condition::Drifting { kelvin_per_s, offset_k } = &mut self.condition {
            *offset_k += *kelvin_per_s * dt_s;
        }
        let surroundings_c = match self.condition {
            Condition::Loose => ambient_c,
            Condition::Sound
            | Condition::Open
            | Condition::Shorted
            | Condition::Frozen(_)
            | Condition::Drifting { .. } => f64::midpoint(before_c, after_c),
        };
        let r = dt_s / (2.0 * self.config.lag_s);
        self.bead_c = (self.bead_c * (1.0 - r) + 2.0 * r * surroundings_c) / (1.0 + r);
    }

    /// A reading with `noise` standard deviations of noise on it.
    pub(super) fn sense(&mut self, noise: f64) -> u16 {
        self.reading = match self.condition {
            Condition::Sound | Condition::Loose => {
                quantised(self.config.counts_at(self.bead_c) + noise * self.config.noise_counts)
            }
            Condition::Drifting { offset_k, .. } => {
                quantised(self.config.counts_at(self.bead_c + offset_k) + noise * self.config.noise_counts)
            }
            Condition::Open => ADC_FULL_SCALE,
            Condition::Shorted => 0,
            Condition::Frozen(reading) => reading,
        };
        self.reading
    }

    pub(super) fn set_condition(&mut self, condition: Condition) {
        self.condition = condition;
    }

    /// What it read last; before any reading, what it would read without noise.
    pub(super) fn reading(&self) -> u16 {
        self.reading
    }

    pub(super) fn bead_c(&self) -> f64 {
        self.bead_c
    }
}

/// The converter's rounding, and its rails.
fn quantised(counts: f64) -> u16 {
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "clamped to the converter's range"
    )]
    let counts = counts.round().clamp(0.0, f64::from(ADC_FULL_SCALE)) as u16;
    counts
}
