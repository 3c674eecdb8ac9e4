//! Things that break on a rig. Injected by tests and by fault scenarios; only the supply's voltage comes back.

use super::Plant;
use super::error::{Hinge, Place, PlantError, finite, positive};
use super::sma::SmaHinge;
use super::thermistor::Condition;

/// One thing that breaks. A number is a heater channel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Fault {
    /// The thermistor's wire is cut: it reads full scale.
    ThermistorOpen(usize),
    /// The thermistor's wires touch: it reads 0.
    ThermistorShorted(usize),
    /// The reading stays what it was last, to the bit.
    ThermistorFrozen(usize),
    /// The thermistor came off the foil: it reads the air.
    ThermistorLoose(usize),
    /// The thermistor reads off by this much more every second.
    ThermistorDrifting {
        /// Heater channel.
        channel: usize,
        /// Above 0 it reads hotter than it is, below 0 colder.
        kelvin_per_s: f64,
    },
    /// The heater draws no current.
    HeaterOpen(usize),
    /// The heater's windings touch: this is left of its resistance.
    HeaterShorted {
        /// Heater channel.
        channel: usize,
        /// Resistance, above 0.
        ohm: f64,
    },
    /// The heater's MOSFET conducts at every duty, as long as the main switch is closed.
    MosfetStuckOn(usize),
    /// The hinge stays at its present angle.
    Jammed(Hinge),
    /// The servo's motor is blocked: it stays where it is, and draws its stall current whenever it gets pulses, also at
    /// its angle.
    ServoStalled(usize),
    /// The supply gives nothing.
    SupplyCut,
    /// The supply is weaker than it was made: a voltage behind a resistance, until it is restored.
    SupplySag {
        /// Voltage at no load, above 0.
        open_circuit_v: f64,
        /// Resistance of supply and wires, 0 or more.
        source_ohm: f64,
    },
    /// The supply is as it was made, after a sag or a cut.
    SupplyRestored,
}

impl Plant {
    /// Breaks something from now on.
    ///
    /// # Errors
    /// [`PlantError::NoSuchHinge`] when the plant does not have the hinge that is to break, [`PlantError::Value`] for a
    /// number that no such fault can have; nothing breaks then.
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
            Fault::ThermistorDrifting { channel, kelvin_per_s } => {
                finite(Place::Hinge(Hinge::Sma(channel)), "drift (K/s)", kelvin_per_s)?;
                self.sma_mut(channel)?.set_thermistor(Condition::Drifting { kelvin_per_s, offset_k: 0.0 });
            }
            Fault::HeaterShorted { channel, ohm } => {
                positive(Place::Hinge(Hinge::Sma(channel)), "shorted heater (Ohm)", ohm)?;
                self.sma_mut(channel)?.short_heater(ohm);
            }
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
            Fault::ServoStalled(channel) => {
                let (hinge, count) = (Hinge::Servo(channel), self.servos.len());
                self.servos.get_mut(channel).ok_or(PlantError::NoSuchHinge { hinge, count })?.stall();
            }
            Fault::SupplyCut => self.cut_supply(),
            Fault::SupplySag { open_circuit_v, source_ohm } => self.set_supply(open_circuit_v, source_ohm)?,
            Fault::SupplyRestored => self.restore_supply(),
        }
        Ok(())
    }

    fn sma_mut(&mut self, channel: usize) -> Result<&mut SmaHinge, PlantError> {
        let count = self.heaters.len();
        self.heaters.get_mut(channel).ok_or(PlantError::NoSuchHinge { hinge: Hinge::Sma(channel), count })
    }
}
