//! A whole plant in numbers.

use super::error::{Hinge, Place, PlantError, finite};
use super::servo::ServoConfig;
use super::sma::SmaConfig;
use super::spring::SpringConfig;
use super::supply::SupplyConfig;

/// Everything that a plant is made of. Channels count from 0 in each list.
#[derive(Debug, Clone, PartialEq)]
pub struct Config {
    /// Temperature of the room, the panels and everything at the start.
    pub ambient_c: f64,
    /// The actuator supply.
    pub supply: SupplyConfig,
    /// Shape-memory hinges, one a heater channel.
    pub heaters: Vec<SmaConfig>,
    /// Servo hinges.
    pub servos: Vec<ServoConfig>,
    /// Spring hinges.
    pub springs: Vec<SpringConfig>,
    /// Seed of the measurement noise; nothing else is random.
    pub seed: u64,
}

impl Default for Config {
    /// A room of 22 °C with a supply and no hinge yet.
    fn default() -> Self {
        Self {
            ambient_c: 22.0,
            supply: SupplyConfig::default(),
            heaters: Vec::new(),
            servos: Vec::new(),
            springs: Vec::new(),
            seed: 0,
        }
    }
}

impl Config {
    pub(super) fn check(&self) -> Result<(), PlantError> {
        finite(Place::Room, "temperature (°C)", self.ambient_c)?;
        self.supply.check()?;
        for (channel, sma) in self.heaters.iter().enumerate() {
            sma.check(channel, self.ambient_c)?;
        }
        for (channel, servo) in self.servos.iter().enumerate() {
            servo.check(Place::Hinge(Hinge::Servo(channel)))?;
        }
        for (channel, spring) in self.springs.iter().enumerate() {
            spring.check(Place::Hinge(Hinge::Spring(channel)))?;
        }
        Ok(())
    }
}
