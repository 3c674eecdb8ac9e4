//! Things that break on a rig. Injected by tests and by fault scenarios; none of them heals.

use super::Plant;
use super::error::{Hinge, PlantError};
use super::sma::SmaHinge;
use super::thermistor::Condition;

/// One thing that breaks. A number is a heater channel.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Fault {
    /// The thermistor's wire is cut: it reads full scale.
    ThermistorOpen(usize),
    /// The thermistor's wires touch: it reads 0.
    ThermistorShorted(usize),
    /// The reading stays what it was last, to the bit.
    ThermistorFrozen(usize),
    /// The thermistor came off the foil: it reads the air.
    ThermistorLoose(usize),
    /// The heater draws no current.
    HeaterOpen(usize),
    /// The heater's MOSFET conducts at every duty, as long as the main switch is closed.
    MosfetStuckOn(usize),
    /// The hinge stays at its present angle.
    Jammed(Hinge),
    /// The supply gives nothing.
    SupplyCut,
}

impl Plant {
    /// Breaks something from now on.
    ///
    /// # Errors
    /// [`PlantError::NoSuchHinge`] when the plant does not have the hinge that is to break; nothing breaks then.
    pub fn inject(&mut self, fault: Fault) -> Result<(), PlantError> {
        match fault {
            Fault::ThermistorOpen(channel) => self.sma_mut(channel)?.set_thermistor(Condition::Open),
            Fault::ThermistorShorted(channel) => self.sma_mut(channel)?.set_thermistor(Condition::Shorted),
            Fault::ThermistorFrozen(channel) => {
                let hinge = self.sma_mut(channel)?;
                let reading = hinge.thermistor.reading();
                hinge.set_thermistor(Condition::Frozen(reading));
            }
            Fault::ThermistorLoose(channel) => self.sma_mut(channel)?.set_thermistor(Condition::Loose),
            Fault::HeaterOpen(channel) => self.sma_mut(channel)?.break_heater(),
            Fault::MosfetStuckOn(channel) => self.sma_mut(channel)?.stick_switch_on(),
            Fault::Jammed(Hinge::Sma(channel)) => self.sma_mut(channel)?.jam(),
            Fault::Jammed(hinge @ Hinge::Servo(channel)) => {
                let count = self.servos.len();
                self.servos.get_mut(channel).ok_or(PlantError::NoSuchHinge { hinge, count })?.jam();
            }
            Fault::Jammed(hinge @ Hinge::Spring(channel)) => {
                let count = self.springs.len();
                self.springs.get_mut(channel).ok_or(PlantError::NoSuchHinge { hinge, count })?.jam();
            }
            Fault::SupplyCut => self.cut_supply(),
        }
        Ok(())
    }

    fn sma_mut(&mut self, channel: usize) -> Result<&mut SmaHinge, PlantError> {
        let count = self.heaters.len();
        self.heaters.get_mut(channel).ok_or(PlantError::NoSuchHinge { hinge: Hinge::Sma(channel), count })
    }
}
