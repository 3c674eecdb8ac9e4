//! `[sim]`: what only the simulator reads, the truth that the rig's own settings are a guess of.

use super::quantity::{Celsius, NewtonMetres, Ohms, WattsPerKelvin, WattsPerSquareMetreKelvin};
use super::settings::settings;
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

/// What only the simulator reads.
#[derive(Debug, Clone, PartialEq)]
pub struct Sim {
    /// Temperature around the simulated hinges.
    pub ambient: Celsius,
    /// Seed of all noise.
    pub seed: u64,
    sma: SmaPlant,
    hinges: BTreeMap<usize, SmaPlant>,
}

impl Sim {
    /// The physics of one SMA hinge.
    pub fn sma_plant(&self, hinge: usize) -> &SmaPlant {
        self.hinges.get(&hinge).unwrap_or(&self.sma)
    }

    /// Hinges with physics of their own.
    pub(super) fn hinges(&self) -> impl Iterator<Item = (usize, &SmaPlant)> {
        self.hinges.iter().map(|(hinge, plant)| (*hinge, plant))
    }

    /// The physics of every other hinge.
    pub(super) fn shared(&self) -> &SmaPlant {
        &self.sma
    }
}

#[derive(Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub(super) struct SimTable {
    ambient: Option<Celsius>,
    seed: u64,
    sma: SmaPlantTable,
    hinge: Vec<HingeTable>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct HingeTable {
    hinge: usize,
    sma: SmaPlantTable,
}

impl SimTable {
    pub(super) fn resolve(self, ambient: Celsius) -> Sim {
        Sim {
            ambient: self.ambient.unwrap_or(ambient),
            seed: self.seed,
            sma: SmaPlant::resolve(None, &self.sma),
            hinges: self
                .hinge
                .iter()
                .map(|entry| (entry.hinge, SmaPlant::resolve(Some(&entry.sma), &self.sma)))
                .collect(),
        }
    }
}
