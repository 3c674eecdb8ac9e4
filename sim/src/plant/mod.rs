//! The physics behind the actuators: hinges driven by what the firmware core puts out, read back through sensors.
//!
//! [`Plant::advance`] moves time on under one [`Drive`], [`Plant::sense`] reads what a board would read, and the
//! getters tell the truth, for tests and reports. Time is a parameter; the same configuration, drives and steps
//! give the same bits on every machine. The model and its limits are described in `docs/src/plant.md`.

mod config;
mod error;
mod fault;
mod noise;
mod servo;
mod sma;
mod spring;
mod supply;
mod thermistor;
mod transformation;

use core::time::Duration;

use zygote_core::{Duty, PulseMicros};
use zygote_protocol::{Milliamps, Millivolts};

pub use config::Config;
pub use error::{Hinge, Place, PlantError};
pub use fault::Fault;
pub use servo::{ServoActivity, ServoConfig, ServoHinge};
pub use sma::{SmaConfig, SmaHinge};
pub use spring::{SpringConfig, SpringHinge};
pub use supply::SupplyConfig;
pub use thermistor::ThermistorConfig;
pub use transformation::{Alloy, Transformation};

use noise::Noise;
use supply::{Load, Output};

/// What drives the actuators during a step. Slices may be longer than the plant has hinges: outputs with nothing
/// on them.
#[derive(Debug, Clone, Copy)]
pub struct Drive<'a> {
    /// Power of each heater.
    pub heaters: &'a [Duty],
    /// Pulse of each servo.
    pub servos: &'a [Option<PulseMicros>],
    /// Burn wire of each spring.
    pub springs: &'a [bool],
    /// The main switch is closed; open, nothing gets power.
    pub main_switch: bool,
}

/// What a board reads of the plant.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Readings {
    /// Divider reading of each heater's thermistor.
    pub thermistors: Vec<u16>,
    /// Voltage of the supply at the input of the main switch.
    pub supply: Millivolts,
    /// Current out of the supply.
    pub current: Milliamps,
}

/// A supply and the hinges on it.
#[derive(Debug, Clone)]
pub struct Plant {
    ambient_c: f64,
    supply: SupplyConfig,
    /// The supply as it was made, to come back to after a sag.
    sound_supply: SupplyConfig,
    supply_cut: bool,
    heaters: Vec<SmaHinge>,
    servos: Vec<ServoHinge>,
    springs: Vec<SpringHinge>,
    noise: Noise,
    /// What the supply gave in the latest step.
    output: Output,
    /// What of it went through heaters.
    heaters_a: f64,
    longest_step_s: f64,
}

impl Plant {
    /// Longest step of the integration: a spring opens in a few of them.
    const LONGEST_STEP_S: f64 = 0.005;
    /// A step's share of the fastest time constant in the plant: 20 times below where the midpoint rule becomes
    /// unstable, and wrong by 2 parts in 10,000 of the fastest mode in each step.
    const STEP_PER_TIME_CONSTANT: f64 = 0.1;
    /// Shortest step of the integration; a hinge that needs a shorter one is refused.
    const SHORTEST_STEP_S: f64 = 2e-5;

    /// A plant at rest: every hinge at its start angle and at ambient temperature, the foils martensite.
    ///
    /// # Errors
    /// [`PlantError::Value`] for a number that no such plant can have.
    pub fn new(config: &Config) -> Result<Self, PlantError> {
        config.check()?;
        let mut longest_step_s = Self::LONGEST_STEP_S;
        for (channel, sma) in config.heaters.iter().enumerate() {
            let step_s = Self::STEP_PER_TIME_CONSTANT / sma.fastest_rate_per_s();
            if step_s < Self::SHORTEST_STEP_S {
                return Err(PlantError::Value {
                    place: Place::Hinge(Hinge::Sma(channel)),
                    quantity: "time constant between film and foil (s)",
                    got: 1.0 / sma.fastest_rate_per_s(),
                    expected: "at least 0.0002; enlarge the film's heat capacity or the resistance between them",
                });
            }
            longest_step_s = longest_step_s.min(step_s);
        }
        Ok(Self {
            ambient_c: config.ambient_c,
            supply: config.supply,
            sound_supply: config.supply,
            supply_cut: false,
            heaters: config.heaters.iter().map(|sma| SmaHinge::new(*sma, config.ambient_c)).collect(),
            servos: config.servos.iter().copied().map(ServoHinge::new).collect(),
            springs: config.springs.iter().copied().map(SpringHinge::new).collect(),
            noise: Noise::new(config.seed),
            output: config.supply.idle(),
            heaters_a: 0.0,
            longest_step_s,
        })
    }

    /// Moves time on by `dt` under a steady drive, in equal inner steps short enough for the fastest hinge.
    ///
    /// # Errors
    /// [`PlantError::Drive`] when the drive has fewer outputs than there are hinges; time stands still then.
    pub fn advance(&mut self, dt: Duration, drive: &Drive<'_>) -> Result<(), PlantError> {
        enough("heater duties", self.heaters.len(), drive.heaters.len())?;
        enough("servo pulses", self.servos.len(), drive.servos.len())?;
        enough("spring outputs", self.springs.len(), drive.springs.len())?;
        // A hair less than whole, so that 20 ms are four steps of 5 ms and not five.
        let steps = (dt.as_secs_f64() / self.longest_step_s - 1e-9).ceil().max(1.0);
        let step_s = dt.as_secs_f64() / steps;
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "whole and at least 1")]
        let steps = steps as u64;
        if step_s > 0.0 {
            for _ in 0..steps {
                self.step(step_s, drive);
            }
        }
        Ok(())
    }

    fn step(&mut self, dt_s: f64, drive: &Drive<'_>) {
        let powered = drive.main_switch && !self.supply_cut;
        self.output = self.load(powered, drive);
        let actuators_v = if powered { self.output.voltage_v } else { 0.0 };
        self.heaters_a = 0.0;
        for (hinge, duty) in self.heaters.iter_mut().zip(drive.heaters) {
            let conductance_s = hinge.conductance_s(share(*duty));
            self.heaters_a += actuators_v * conductance_s;
            let power_w = actuators_v * actuators_v * conductance_s;
            hinge.advance(dt_s, power_w, self.ambient_c);
        }
        for (hinge, pulse) in self.servos.iter_mut().zip(drive.servos) {
            hinge.advance(dt_s, actuators_v, *pulse);
        }
        for (hinge, energised) in self.springs.iter_mut().zip(drive.springs) {
            hinge.advance(dt_s, actuators_v, powered && *energised);
        }
    }

    /// What the supply gives to all that hangs on it, with the servos taking up their pulses.
    fn load(&mut self, powered: bool, drive: &Drive<'_>) -> Output {
        let mut load = Load::default();
        for (hinge, pulse) in self.servos.iter_mut().zip(drive.servos) {
            load.current_a += hinge.command(*pulse, powered);
        }
        if self.supply_cut {
            return Output { voltage_v: 0.0, current_a: 0.0 };
        }
        if !powered {
            return self.supply.idle();
        }
        for (hinge, duty) in self.heaters.iter().zip(drive.heaters) {
            load.conductance_s += hinge.conductance_s(share(*duty));
        }
        for (hinge, _) in self.springs.iter().zip(drive.springs).filter(|(_, energised)| **energised) {
            load.conductance_s += hinge.conductance_s();
        }
        self.supply.solve(load)
    }

    /// Reads every sensor, with noise: the thermistors as they are now, the supply as it was in the latest step.
    pub fn sense(&mut self) -> Readings {
        let mut thermistors = Vec::with_capacity(self.heaters.len());
        for hinge in &mut self.heaters {
            thermistors.push(hinge.thermistor.sense(self.noise.standard()));
        }
        let volts_noise = self.noise.standard() * self.supply.voltage_noise_mv;
        let amps_noise = self.noise.standard() * self.supply.current_noise_ma;
        Readings {
            thermistors,
            supply: Millivolts(thousandths(self.output.voltage_v, volts_noise)),
            current: Milliamps(thousandths(self.output.current_a, amps_noise)),
        }
    }

    /// The shape-memory hinges as they truly are, by heater channel.
    pub fn sma_hinges(&self) -> &[SmaHinge] {
        &self.heaters
    }

    /// The servo hinges as they truly are.
    pub fn servo_hinges(&self) -> &[ServoHinge] {
        &self.servos
    }

    /// The spring hinges as they truly are.
    pub fn spring_hinges(&self) -> &[SpringHinge] {
        &self.springs
    }

    /// True voltage of the supply in the latest step, at the input of the main switch.
    pub fn supply_v(&self) -> f64 {
        self.output.voltage_v
    }

    /// True current out of the supply in the latest step.
    pub fn supply_a(&self) -> f64 {
        self.output.current_a
    }

    /// True current through all heaters together in the latest step.
    pub fn heaters_a(&self) -> f64 {
        self.heaters_a
    }

    fn set_supply(&mut self, open_circuit_v: f64, source_ohm: f64) -> Result<(), PlantError> {
        let weak = SupplyConfig { open_circuit_v, source_ohm, ..self.supply };
        weak.check()?;
        self.supply = weak;
        Ok(())
    }

    fn restore_supply(&mut self) {
        self.supply = self.sound_supply;
        self.supply_cut = false;
    }

    fn cut_supply(&mut self) {
        self.supply_cut = true;
        self.output = Output { voltage_v: 0.0, current_a: 0.0 };
    }
}

fn enough(kind: &'static str, expected: usize, got: usize) -> Result<(), PlantError> {
    if got < expected { Err(PlantError::Drive { kind, expected, got }) } else { Ok(()) }
}

/// A duty as a share of 1.
fn share(duty: Duty) -> f64 {
    f64::from(duty.per_mille()) / 1000.0
}

/// Volts or amperes with some noise, as a converter gives them: whole thousandths, never below 0.
fn thousandths(value: f64, noise: f64) -> u32 {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a float's `as` saturates")]
    let whole = (value * 1000.0 + noise).round().max(0.0) as u32;
    whole
}
