//! The actuator supply: a voltage behind a resistance, so that it sags under load.

use super::error::{Place, PlantError, not_negative, positive};

/// The supply that every actuator shares.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SupplyConfig {
    /// Voltage at no load.
    pub open_circuit_v: f64,
    /// Resistance of the supply, its wires and the main switch together.
    pub source_ohm: f64,
    /// Standard deviation of a voltage reading.
    pub voltage_noise_mv: f64,
    /// Standard deviation of a current reading.
    pub current_noise_ma: f64,
}

impl Default for SupplyConfig {
    /// A 5 V bench supply; 50 mOhm are a metre of 1.5 mm^2 wire out and back (23 mOhm), a MOSFET switch and
    /// terminals. The noise is a few counts of a 12-bit converter on a 2:1 divider and on a 10 A shunt amplifier.
    fn default() -> Self {
        Self { open_circuit_v: 5.0, source_ohm: 0.05, voltage_noise_mv: 3.0, current_noise_ma: 5.0 }
    }
}

impl SupplyConfig {
    pub(super) fn check(&self) -> Result<(), PlantError> {
        positive(Place::Supply, "open-circuit voltage (V)", self.open_circuit_v)?;
        not_negative(Place::Supply, "source resistance (Ohm)", self.source_ohm)?;
        not_negative(Place::Supply, "voltage noise (mV)", self.voltage_noise_mv)?;
        not_negative(Place::Supply, "current noise (mA)", self.current_noise_ma)
    }
}

/// All that hangs on the supply at one moment.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Load {
    /// Resistive loads in parallel. A heater at a duty counts with its share: the mean over many PWM periods.
    pub(super) conductance_s: f64,
    /// Loads that draw their current whatever the voltage.
    pub(super) current_a: f64,
}

/// Voltage behind the main switch and current out of the supply.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Output {
    pub(super) voltage_v: f64,
    pub(super) current_a: f64,
}

impl SupplyConfig {
    /// The voltage at which the supply gives what the load takes: V = E - R (G V + I). With more constant
    /// current than the supply can give, it is short-circuited.
    pub(super) fn solve(&self, load: Load) -> Output {
        let unloaded_v = self.open_circuit_v - self.source_ohm * load.current_a;
        if unloaded_v <= 0.0 {
            return Output { voltage_v: 0.0, current_a: self.open_circuit_v / self.source_ohm };
        }
        let voltage_v = unloaded_v / (1.0 + self.source_ohm * load.conductance_s);
        Output { voltage_v, current_a: load.conductance_s * voltage_v + load.current_a }
    }

    /// The supply with nothing on it.
    pub(super) fn idle(&self) -> Output {
        self.solve(Load::default())
    }
}
