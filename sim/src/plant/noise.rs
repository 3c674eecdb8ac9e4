//! Seeded measurement noise, equal on every machine: integers from `SplitMix64` (Steele, Lea and Flood 2014),
//! a normal distribution from them by Box and Muller's method.

use core::f64::consts::TAU;

/// A stream of normally distributed numbers.
#[derive(Debug, Clone)]
pub(super) struct Noise {
    state: u64,
    /// Box and Muller make two at a time.
    spare: Option<f64>,
}

impl Noise {
    pub(super) fn new(seed: u64) -> Self {
        Self { state: seed, spare: None }
    }

    /// The next number of mean 0 and standard deviation 1.
    pub(super) fn standard(&mut self) -> f64 {
        if let Some(spare) = self.spare.take() {
            return spare;
        }
        let radius = (-2.0 * libm::log(self.open_unit())).sqrt();
        let (sin, cos) = libm::sincos(TAU * self.open_unit());
        self.spare = Some(radius * sin);
        radius * cos
    }

    /// The next number above 0 and below 1: its logarithm is finite.
    fn open_unit(&mut self) -> f64 {
        const STEP: f64 = 1.0 / (1u64 << 53) as f64;
        ((self.next() >> 11) as f64 + 0.5) * STEP
    }

    fn next(&mut self) -> u64 {
        self.state = self.state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.state;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }
}
