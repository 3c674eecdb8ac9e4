//! What the readings say of a servo.

use super::record::{Look, ServoBounds, ServoNominal, ServoRecord};
use super::search::{Aim, aims};
use super::view::View;

/// An angle with its pulse.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FoundPoint {
    /// The opening angle, degrees.
    pub angle_deg: u16,
    /// The pulse.
    pub pulse_us: u16,
    /// What was read at it.
    pub read_deg: f64,
}

/// Why an angle has no pulse.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum NotReached {
    /// The hinge comes to its end before.
    #[error("the hinge ends at {at_deg:.1} deg")]
    Stop {
        /// Where.
        at_deg: f64,
    },
    /// The pulses do.
    #[error("at the last pulse that rig and board allow it stands at {at_deg:.1} deg")]
    Bound {
        /// Where.
        at_deg: f64,
    },
    /// It goes past it in one step.
    #[error("no pulse brings it nearer than {at_deg:.1} deg")]
    Coarse {
        /// Where.
        at_deg: f64,
    },
    /// Nobody has looked yet.
    #[error("not looked for yet")]
    Open,
}

/// A servo as it was found.
#[derive(Debug, Clone, PartialEq)]
pub struct FoundServo {
    /// Angles with their pulses, rising.
    pub points: Vec<FoundPoint>,
    /// Angles without, rising.
    pub unreached: Vec<(u16, NotReached)>,
    /// Lower end stop, where one was met.
    pub stop_low_deg: Option<f64>,
    /// Upper end stop, where one was met.
    pub stop_high_deg: Option<f64>,
    /// Each free reading with what it is off the straight line that fits them best; none with fewer than three.
    pub off_line_deg: Vec<(Look, f64)>,
}

impl FoundServo {
    /// Nothing is left to look for.
    pub fn is_complete(&self) -> bool {
        !self.unreached.iter().any(|(_, why)| matches!(why, NotReached::Open))
    }

    /// The furthest from the straight line.
    pub fn worst_off_line_deg(&self) -> Option<f64> {
        self.off_line_deg.iter().map(|(_, off)| off.abs()).reduce(f64::max)
    }
}

/// What is known of a servo.
pub fn found(record: &ServoRecord, nominal: &ServoNominal, bounds: &ServoBounds) -> FoundServo {
    let view = View::new(record, nominal, bounds);
    let (mut points, mut unreached) = (Vec::new(), Vec::new());
    for (angle_deg, aim) in aims(&view, bounds.tolerance_deg) {
        match aim {
            Aim::Found(seen) => {
                points.push(FoundPoint { angle_deg, pulse_us: view.pulse(seen.x), read_deg: seen.angle_deg });
            }
            Aim::Try(_) => unreached.push((angle_deg, NotReached::Open)),
            Aim::Stop(at_deg) => unreached.push((angle_deg, NotReached::Stop { at_deg })),
            Aim::Bound(_) if view.centre.is_none() => unreached.push((angle_deg, NotReached::Open)),
            Aim::Bound(at_deg) => unreached.push((angle_deg, NotReached::Bound { at_deg })),
            Aim::Coarse(seen) => unreached.push((angle_deg, NotReached::Coarse { at_deg: seen.angle_deg })),
        }
    }
    FoundServo {
        points,
        unreached,
        stop_low_deg: view.mirrored().stop_deg().map(|angle_deg| -angle_deg),
        stop_high_deg: view.stop_deg(),
        off_line_deg: off_line(record),
    }
}

/// Least squares through the free readings.
fn off_line(record: &ServoRecord) -> Vec<(Look, f64)> {
    let free: Vec<Look> = record.looks.iter().filter(|look| !look.pushes).copied().collect();
    if free.len() < 3 {
        return Vec::new();
    }
    #[expect(clippy::cast_precision_loss, reason = "some tens")]
    let count = free.len() as f64;
    let mean = |of: &dyn Fn(&Look) -> f64| free.iter().map(of).sum::<f64>() / count;
    let (mean_us, mean_deg) = (mean(&|look| f64::from(look.pulse_us)), mean(&|look| look.angle_deg));
    let spread = mean(&|look| (f64::from(look.pulse_us) - mean_us).powi(2));
    let both = mean(&|look| (f64::from(look.pulse_us) - mean_us) * (look.angle_deg - mean_deg));
    if spread <= 0.0 {
        return Vec::new();
    }
    let line = |look: &Look| mean_deg + both / spread * (f64::from(look.pulse_us) - mean_us);
    free.iter().map(|look| (*look, look.angle_deg - line(look))).collect()
}
