//! A plant and its drive on a virtual clock, as these tests use them.

use core::time::Duration;

use zygote_core::{Duty, PulseMicros};
use zygote_sim::plant::{Config, Drive, Plant, ServoConfig, SmaConfig, SpringConfig, SupplyConfig};

pub(crate) const TICK: Duration = Duration::from_millis(5);
pub(crate) const TICK_S: f64 = 0.005;

/// A supply that neither sags nor has noise, for comparison with closed forms.
pub(crate) fn stiff_supply() -> SupplyConfig {
    SupplyConfig { open_circuit_v: 5.0, source_ohm: 0.0, voltage_noise_mv: 0.0, current_noise_ma: 0.0 }
}

/// A plant with its drive, everything off and the main switch closed.
pub(crate) struct Rig {
    pub(crate) plant: Plant,
    pub(crate) heaters: Vec<Duty>,
    pub(crate) servos: Vec<Option<PulseMicros>>,
    pub(crate) springs: Vec<bool>,
    pub(crate) main_switch: bool,
}

impl Rig {
    pub(crate) fn new(config: &Config) -> Self {
        Self {
            plant: Plant::new(config).expect("a sound configuration"),
            heaters: vec![Duty::OFF; config.heaters.len()],
            servos: vec![None; config.servos.len()],
            springs: vec![false; config.springs.len()],
            main_switch: true,
        }
    }

    /// One shape-memory hinge on a stiff supply.
    pub(crate) fn hinge(sma: SmaConfig) -> Self {
        Self::new(&Config { supply: stiff_supply(), heaters: vec![sma], ..Config::default() })
    }

    /// One servo on a stiff supply.
    pub(crate) fn servo(servo: ServoConfig) -> Self {
        Self::new(&Config { supply: stiff_supply(), servos: vec![servo], ..Config::default() })
    }

    /// One spring on a stiff supply.
    pub(crate) fn spring(spring: SpringConfig) -> Self {
        Self::new(&Config { supply: stiff_supply(), springs: vec![spring], ..Config::default() })
    }

    pub(crate) fn step(&mut self, dt: Duration) {
        let drive = Drive {
            heaters: &self.heaters,
            servos: &self.servos,
            springs: &self.springs,
            main_switch: self.main_switch,
        };
        self.plant.advance(dt, &drive).expect("a drive for every hinge");
    }

    /// Runs for `seconds` in ticks.
    pub(crate) fn run(&mut self, seconds: f64) {
        let mut left = (seconds / TICK_S).round();
        while left > 0.0 {
            self.step(TICK);
            left -= 1.0;
        }
    }

    /// Runs until the first foil satisfies `until`, and says how long that took.
    pub(crate) fn run_until(&mut self, until: impl Fn(f64) -> bool) -> f64 {
        const PATIENCE_S: f64 = 300.0;
        let mut elapsed_s = 0.0;
        while !until(self.foil_c()) {
            self.step(TICK);
            elapsed_s += TICK_S;
            assert!(elapsed_s < PATIENCE_S, "the foil is at {} °C after {PATIENCE_S} s", self.foil_c());
        }
        elapsed_s
    }

    pub(crate) fn foil_c(&self) -> f64 {
        self.plant.sma_hinges()[0].temperature_c()
    }

    pub(crate) fn film_c(&self) -> f64 {
        self.plant.sma_hinges()[0].film_c()
    }

    pub(crate) fn sma_deg(&self) -> f64 {
        self.plant.sma_hinges()[0].angle_deg()
    }
}

#[track_caller]
pub(crate) fn assert_near(got: f64, expected: f64, tolerance: f64, what: &str) {
    assert!((got - expected).abs() <= tolerance, "{what}: got {got}, expected {expected} +- {tolerance}");
}
