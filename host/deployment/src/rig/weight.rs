//! What the panels weigh, and where down is.

use super::quantity::{Grams, GramsPerSquareMetre, Millimetres};
use super::{Rig, RigError};
use serde::Deserialize;

/// What a panel weighs, with all that is fixed on it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Weight {
    /// Every panel weighs so much.
    Each(Grams),
    /// Every panel weighs so much for its area.
    PerArea(GramsPerSquareMetre),
}

#[derive(Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub(super) struct PanelTable {
    mass: Option<Grams>,
    density: Option<GramsPerSquareMetre>,
}

impl PanelTable {
    /// A mass before a density; the rules refuse both.
    pub(super) fn weight(self) -> Option<Weight> {
        self.mass.map(Weight::Each).or(self.density.map(Weight::PerArea))
    }
}

/// Gravity.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Gravity {
    /// Down, in the space of the zygote, where piles go up along z; of any length above 0.
    pub direction: [f64; 3],
}

impl Default for Gravity {
    fn default() -> Self {
        Self { direction: [0.0, 0.0, -1.0] }
    }
}

impl Rig {
    /// What one panel of such a length weighs.
    ///
    /// # Errors
    /// [`RigError::Value`] if the file doesn't say what panels weigh.
    pub fn panel_mass(&self, length: Millimetres) -> Result<Grams, RigError> {
        match self.panel {
            Some(Weight::Each(mass)) => Ok(mass),
            Some(Weight::PerArea(density)) => Ok(Grams(density.0 * (length.0 * 1e-3).powi(2))),
            None => Err(RigError::Value {
                place: self.places.of("panel.mass"),
                expected: "what a panel weighs, as in mass = \"12 g\"".to_owned(),
                found: "none".to_owned(),
            }),
        }
    }
}
