//! `[sim]`: what only the simulator reads, the truth that the rig's own settings are a guess of.

use super::Rig;
use super::quantity::{
    Celsius, Degrees, NewtonMetres, Ohms, Seconds, WattsPerKelvin, WattsPerSquareMetreKelvin,
};
use super::settings::{Drive, settings};
use serde::Deserialize;
use std::collections::BTreeMap;

settings! {
    /// Physics of a simulated shape-memory hinge: what people may want to set of the plant's many numbers.
    SmaPlant, SmaPlantTable {
        /// Resistance of the film heater.
        heater_resistance: Ohms = Ohms(25.0),
        /// Loss to still air from either face.
        convection: WattsPerSquareMetreKelvin = WattsPerSquareMetreKelvin(45.0),
        /// Loss into the panels.
        panel_conductance: WattsPerKelvin = WattsPerKelvin(0.004),
        /// All martensite below, on cooling.
        martensite_finish: Celsius = Celsius(42.0),
        /// First martensite, on cooling.
        martensite_start: Celsius = Celsius(52.0),
        /// First austenite, on heating.
        austenite_start: Celsius = Celsius(68.0),
        /// All austenite above, on heating.
        austenite_finish: Celsius = Celsius(78.0),
        /// Torque that the hinge works against.
        load: NewtonMetres = NewtonMetres(0.0),
    }
}

/// A pulse of a simulated servo; none where it is as the rig file guesses it.
#[derive(Debug, Clone, Copy, PartialEq, Default, Deserialize)]
#[serde(transparent)]
pub struct TruePulse(pub Option<Seconds>);

settings! {
    /// Physics of a simulated servo hinge.
    ServoPlant, ServoPlantTable {
        /// Pulse that commands 0 degrees; beyond it nothing changes.
        pulse_0: TruePulse = TruePulse(None),
        /// Pulse that commands 270 degrees; beyond it nothing changes.
        pulse_270: TruePulse = TruePulse(None),
        /// How far its angle is above a straight line in the middle.
        bow: Degrees = Degrees(0.0),
        /// Error below which it doesn't move.
        dead_band: Degrees = Degrees(0.4),
        /// Play between its motor and the hinge.
        backlash: Degrees = Degrees(0.0),
        /// Lower end stop of the hinge.
        stop_low: Degrees = Degrees(0.0),
        /// Upper end stop of the hinge.
        stop_high: Degrees = Degrees(270.0),
    }
}

/// What only the simulator reads.
#[derive(Debug, Clone, PartialEq)]
pub struct Sim {
    /// Temperature around the simulated hinges.
    pub ambient: Celsius,
    /// Seed of all noise.
    pub seed: u64,
    sma: SmaPlant,
    servo: ServoPlant,
    hinges: BTreeMap<usize, SmaPlant>,
    servos: BTreeMap<usize, ServoPlant>,
}

impl Sim {
    /// The physics of one SMA hinge.
    pub fn sma_plant(&self, hinge: usize) -> &SmaPlant {
        self.hinges.get(&hinge).unwrap_or(&self.sma)
    }

    /// The physics of one servo hinge.
    pub fn servo_plant(&self, hinge: usize) -> &ServoPlant {
        self.servos.get(&hinge).unwrap_or(&self.servo)
    }

    /// Shape-memory hinges with physics of their own.
    pub(super) fn hinges(&self) -> impl Iterator<Item = (usize, &SmaPlant)> {
        self.hinges.iter().map(|(hinge, plant)| (*hinge, plant))
    }

    /// Servo hinges with physics of their own.
    pub(super) fn servos(&self) -> impl Iterator<Item = (usize, &ServoPlant)> {
        self.servos.iter().map(|(hinge, plant)| (*hinge, plant))
    }

    /// The physics of every other hinge.
    pub(super) fn shared(&self) -> (&SmaPlant, &ServoPlant) {
        (&self.sma, &self.servo)
    }
}

impl Rig {
    /// The pulses at which a hinge's simulated servo stands at 0 and at 270 degrees: the simulator's own, else what the rig file says of
    /// it, whatever was measured since.
    pub fn true_pulses(&self, hinge: usize) -> (Seconds, Seconds) {
        let guess = match self.drive_of(hinge) {
            Drive::Servo(servo) => servo,
            Drive::Sma(_) | Drive::Spring(_) => self.servo,
        };
        let truth = self.sim.servo_plant(hinge);
        (truth.pulse_0.0.unwrap_or(guess.pulse_0), truth.pulse_270.0.unwrap_or(guess.pulse_270))
    }
}

#[derive(Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub(super) struct SimTable {
    ambient: Option<Celsius>,
    seed: u64,
    sma: SmaPlantTable,
    servo: ServoPlantTable,
    hinge: Vec<HingeTable>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct HingeTable {
    hinge: usize,
    sma: Option<SmaPlantTable>,
    servo: Option<ServoPlantTable>,
}

impl SimTable {
    pub(super) fn resolve(self, ambient: Celsius) -> Sim {
        Sim {
            ambient: self.ambient.unwrap_or(ambient),
            seed: self.seed,
            sma: SmaPlant::resolve(None, &self.sma),
            servo: ServoPlant::resolve(None, &self.servo),
            hinges: self
                .hinge
                .iter()
                .filter_map(|entry| {
                    Some((entry.hinge, SmaPlant::resolve(Some(entry.sma.as_ref()?), &self.sma)))
                })
                .collect(),
            servos: self
                .hinge
                .iter()
                .filter_map(|entry| {
                    Some((entry.hinge, ServoPlant::resolve(Some(entry.servo.as_ref()?), &self.servo)))
                })
                .collect(),
        }
    }
}
