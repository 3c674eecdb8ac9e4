//! A spring hinge held shut by a line that a hot wire burns through.
//!
//! ```text
//!   Held -- wire hot for the release time --> Opening -- milliseconds --> Open
//!     ^ |
//!     +-+ wire off or too weak: it cools, the time starts over
//! ```

use super::error::{Place, PlantError, finite, not_negative, positive};

/// A spring hinge and its burn wire.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SpringConfig {
    /// Angle while it is held.
    pub start_deg: f64,
    /// Angle of its end stop.
    pub opening_deg: f64,
    /// Time without a break for which the wire must be energised.
    pub release_s: f64,
    /// Supply voltage below which the wire does not get hot enough.
    pub release_min_v: f64,
    /// Time from the release to the end stop.
    pub opening_s: f64,
    /// Resistance of the wire. It burns the line, not itself, so it conducts as long as it is energised.
    pub wire_ohm: f64,
}

impl SpringConfig {
    /// A hinge that springs from 0° to `opening_deg`. 5 Ohm of nichrome draw 1 A at 5 V and cut a thin nylon
    /// line within a second, as published burn-wire releases do with 1 to 2 A; a spring hinge between panels
    /// of a few grams opens within some 30 ms.
    pub fn opening(opening_deg: f64) -> Self {
        Self {
            start_deg: 0.0,
            opening_deg,
            release_s: 0.8,
            release_min_v: 3.5,
            opening_s: 0.03,
            wire_ohm: 5.0,
        }
    }

    pub(super) fn check(&self, place: Place) -> Result<(), PlantError> {
        finite(place, "start angle (°)", self.start_deg)?;
        finite(place, "opening angle (°)", self.opening_deg)?;
        not_negative(place, "release time (s)", self.release_s)?;
        not_negative(place, "voltage needed for release (V)", self.release_min_v)?;
        positive(place, "opening time (s)", self.opening_s)?;
        positive(place, "burn wire (Ohm)", self.wire_ohm)
    }
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum Latch {
    Held { hot_s: f64 },
    Opening { since_s: f64 },
    Open,
}

/// A spring hinge at work.
#[derive(Debug, Clone)]
pub struct SpringHinge {
    config: SpringConfig,
    latch: Latch,
    /// Set where a jam has stopped it.
    jammed_deg: Option<f64>,
}

impl SpringHinge {
    pub(super) fn new(config: SpringConfig) -> Self {
        Self { config, latch: Latch::Held { hot_s: 0.0 }, jammed_deg: None }
    }

    /// True angle.
    pub fn angle_deg(&self) -> f64 {
        if let Some(angle_deg) = self.jammed_deg {
            return angle_deg;
        }
        let share = match self.latch {
            Latch::Held { .. } => 0.0,
            // From rest under a nearly constant torque.
            Latch::Opening { since_s } => (since_s / self.config.opening_s).powi(2),
            Latch::Open => 1.0,
        };
        self.config.start_deg + (self.config.opening_deg - self.config.start_deg) * share
    }

    /// The line that held it is cut.
    pub fn released(&self) -> bool {
        !matches!(self.latch, Latch::Held { .. })
    }

    pub(super) fn conductance_s(&self) -> f64 {
        1.0 / self.config.wire_ohm
    }

    pub(super) fn advance(&mut self, dt_s: f64, supply_v: f64, energised: bool) {
        self.latch = match self.latch {
            Latch::Held { hot_s } if energised && supply_v >= self.config.release_min_v => {
                // A sum of steps falls short of the time by its rounding.
                const ROUNDING_S: f64 = 1e-9;
                let over_s = hot_s + dt_s - self.config.release_s;
                if over_s < -ROUNDING_S {
                    Latch::Held { hot_s: hot_s + dt_s }
                } else {
                    self.opened(over_s.max(0.0))
                }
            }
            Latch::Held { .. } => Latch::Held { hot_s: 0.0 },
            Latch::Opening { since_s } => self.opened(since_s + dt_s),
            Latch::Open => Latch::Open,
        };
    }

    fn opened(&self, since_s: f64) -> Latch {
        if since_s < self.config.opening_s { Latch::Opening { since_s } } else { Latch::Open }
    }

    pub(super) fn jam(&mut self) {
        self.jammed_deg = Some(self.angle_deg());
    }
}
