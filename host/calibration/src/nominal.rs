//! What is known of a hinge before it is measured: where the fit starts from, and what it falls back to for what no
//! thermistor shows.

/// Transformation temperatures.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Transformation {
    /// Martensite finish, °C.
    pub mf_c: f64,
    /// Martensite start, °C.
    pub ms_c: f64,
    /// Austenite start, °C.
    pub as_c: f64,
    /// Austenite finish, °C.
    pub af_c: f64,
}

/// A hinge as its data sheets have it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Nominal {
    /// The alloy's temperatures; each may be off by 15 K or so.
    pub transformation: Transformation,
    /// Resistance of the heater; may be off by half.
    pub heater_ohm: f64,
    /// Rise over the air per watt of heater power; may be off by a factor of 2.
    pub thermal_resistance_k_per_w: f64,
    /// Time constant; may be off by a factor of 2.
    pub time_constant_s: f64,
    /// Latent heat over heat capacity of the foil, kelvins. 24.2 kJ/kg over 837 J/(kg K) are 28.9 K.
    pub latent_k: f64,
    /// Share of film and glue in the hinge's heat capacity.
    pub film_share: f64,
    /// Share of the hinge's heat that goes to the air straight from the film.
    pub film_loss_share: f64,
    /// Conductance from the film to the foil.
    pub coupling_w_per_k: f64,
    /// Lag of the thermistor.
    pub lag_s: f64,
    /// The thermistor.
    pub sensor: Sensor,
}

impl Nominal {
    /// Temperatures of low-temperature actuator wire.
    pub const LOW_TEMPERATURE: Transformation =
        Transformation { mf_c: 42.0, ms_c: 52.0, as_c: 68.0, af_c: 78.0 };
    /// Temperatures of high-temperature actuator wire.
    pub const HIGH_TEMPERATURE: Transformation =
        Transformation { mf_c: 62.0, ms_c: 72.0, as_c: 88.0, af_c: 98.0 };
}

impl Default for Nominal {
    /// The foil of 5 mm x 10 mm x 0.125 mm with a film heater of 25 ohm, as the plant page derives it.
    fn default() -> Self {
        Self {
            transformation: Self::LOW_TEMPERATURE,
            heater_ohm: 25.0,
            thermal_resistance_k_per_w: 118.0,
            time_constant_s: 5.4,
            latent_k: 28.9,
            film_share: 0.26,
            film_loss_share: 0.28,
            coupling_w_per_k: 0.075,
            lag_s: 0.3,
            sensor: Sensor::default(),
        }
    }
}

/// A thermistor to ground with a pull-up, and the converter that reads it: how fine a reading is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sensor {
    /// Resistance at 25 °C.
    pub r25_ohm: f64,
    /// Beta constant, kelvins.
    pub beta_k: f64,
    /// Pull-up to the converter's reference.
    pub pull_up_ohm: f64,
    /// Highest count of the converter.
    pub full_scale: f64,
}

impl Default for Sensor {
    /// The common 10 kohm bead at a 12-bit converter.
    fn default() -> Self {
        Self { r25_ohm: 10_000.0, beta_k: 3_950.0, pull_up_ohm: 10_000.0, full_scale: 4_095.0 }
    }
}

impl Sensor {
    const KELVIN_AT_0_C: f64 = 273.15;
    const KELVIN_AT_25_C: f64 = 298.15;

    /// Kelvins per count at a temperature.
    pub fn k_per_count(&self, t_c: f64) -> f64 {
        let kelvin = (t_c + Self::KELVIN_AT_0_C).max(1.0);
        let ohm = self.r25_ohm * (self.beta_k * (1.0 / kelvin - 1.0 / Self::KELVIN_AT_25_C)).exp();
        let share = ohm / (ohm + self.pull_up_ohm);
        kelvin * kelvin / (self.full_scale * share * (1.0 - share) * self.beta_k)
    }
}

/// What a calibration must keep to.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bounds {
    /// Readings above trip the MCU.
    pub max_temperature_c: f64,
    /// Longest pulse.
    pub max_on_s: f64,
    /// Shortest rest between two pulses.
    pub min_rest_s: f64,
}

impl Default for Bounds {
    /// 120 °C, 20 s, 0.5 s.
    fn default() -> Self {
        Self { max_temperature_c: 120.0, max_on_s: 20.0, min_rest_s: 0.5 }
    }
}
