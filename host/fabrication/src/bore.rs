//! The hole of a magnet as a prism with many sides: about an axis along x in the middle of the thickness, from the side of the
//! panel to where the magnet ends. No narrower than asked for, so that the magnet goes in.

use crate::panel::{Magnet, Panel};
use std::f64::consts::PI;

/// Sides of the prism; even, so that it has corners at the very top and bottom.
const SIDES: u32 = 12;

/// A hole at the south side of a panel, open to the west.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Bore {
    /// From the axis to the corners.
    radius: f64,
    /// Where the axis is.
    pub(crate) y: f64,
    /// Where it ends.
    pub(crate) end_x: f64,
}

/// From the axis to the corners of a hole so wide across its flats.
pub(crate) fn corner_radius(hole_mm: f64) -> f64 {
    hole_mm / 2.0 / (PI / f64::from(SIDES)).cos()
}

impl Bore {
    pub(crate) fn new(panel: &Panel, magnet: &Magnet) -> Self {
        Self {
            radius: corner_radius(magnet.hole_mm()),
            // On the axis of a round side, and as deep in a square one.
            y: panel.thickness_mm / 2.0 - panel.side_mm / 2.0,
            end_x: magnet.length_mm / 2.0,
        }
    }

    /// Heights of its corners, from the bottom up.
    pub(crate) fn levels(&self) -> Vec<f64> {
        let half = i32::try_from(SIDES / 2).unwrap_or(i32::MAX);
        let level = |step: i32| {
            // The middle is 0 and the ends are ends, not nearly so.
            let angle = PI * f64::from(2 * step - half) / f64::from(2 * half);
            self.radius * angle.sin()
        };
        (0..=half).map(level).collect()
    }

    /// Half its width at a height between its corners; 0 at the top and at the bottom.
    pub(crate) fn half_width(&self, z: f64) -> Option<f64> {
        let levels = self.levels();
        let width = |level: f64| (self.radius.powi(2) - level.powi(2)).max(0.0).sqrt();
        if z <= levels[0] || z >= levels[levels.len() - 1] {
            let at_end = levels.iter().any(|level| level.to_bits() == z.to_bits());
            return at_end.then_some(0.0);
        }
        let upper = levels.iter().position(|level| z <= *level)?;
        let (low, high) = (levels[upper - 1], levels[upper]);
        let share = (z - low) / (high - low);
        let last = levels.len() - 1;
        let at = |corner: usize| if corner == 0 || corner == last { 0.0 } else { width(levels[corner]) };
        Some(at(upper - 1) * (1.0 - share) + at(upper) * share)
    }
}
