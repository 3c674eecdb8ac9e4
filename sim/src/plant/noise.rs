//! Seeded measurement noise: a normal distribution by Box and Muller's method.

use crate::chance::Chance;
use core::f64::consts::TAU;

/// A stream of normally distributed numbers.
#[derive(Debug, Clone)]
pub(super) struct Noise {
    chance: Chance,
    /// Box and Muller make two at a time.
    spare: Option<f64>,
}

impl Noise {
    pub(super) fn new(seed: u64) -> Self {
        Self { chance: Chance::new(seed), spare: None }
    }

    /// The next number of mean 0 and standard deviation 1.
    pub(super) fn standard(&mut self) -> f64 {
        if let Some(spare) = self.spare.take() {
            return spare;
        }
        let radius = (-2.0 * libm::log(self.chance.share())).sqrt();
        let (sin, cos) = libm::sincos(TAU * self.chance.share());
        self.spare = Some(radius * sin);
        radius * cos
    }
}
