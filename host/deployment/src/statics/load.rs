//! The worst torque on a hinge, against what the hinge is rated for at its angle.

use super::swing::Swing;
use crate::rig::{Degrees, NewtonMetres, Rating};

/// What a hinge does under its load.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Role {
    /// It turns.
    Turning,
    /// It is open, and holds what hangs on it.
    Holding,
}

impl Role {
    /// In a word.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Turning => "turning",
            Self::Holding => "holding",
        }
    }
}

/// The torque of gravity on a hinge where it is worst.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Load {
    /// The hinge that bears it.
    pub hinge: usize,
    /// Whether it turns or holds.
    pub role: Role,
    /// The place in the order, from 0, of the step in which that is.
    pub step: usize,
    /// The hinge that turns in that step.
    pub turning: usize,
    /// Opening angle at that moment of the hinge that turns.
    pub opening: Degrees,
    /// Positive where gravity would close the hinge, negative where it would open it further.
    pub torque: NewtonMetres,
    /// The most that the hinge is rated for at its own opening angle.
    pub rating: NewtonMetres,
}

impl Load {
    /// The torque, either way, over the rating.
    pub fn factor(&self) -> f64 {
        self.torque.0.abs() / self.rating.0
    }

    /// Whether it is more than the hinge is rated for.
    pub fn is_overload(&self) -> bool {
        self.factor() > 1.0
    }
}

/// How the opening angle goes while a hinge turns by `angle` radians.
#[derive(Debug, Clone, Copy)]
pub(super) struct Opening {
    pub(super) from_deg: f64,
    pub(super) to_deg: f64,
    pub(super) angle: f64,
}

impl Opening {
    pub(super) fn at(&self, angle: f64) -> Degrees {
        let share = if self.angle > 0.0 { angle / self.angle } else { 0.0 };
        Degrees(self.from_deg + (self.to_deg - self.from_deg) * share)
    }

    fn angle_at(&self, opening: Degrees) -> f64 {
        self.angle * (opening.0 - self.from_deg) / (self.to_deg - self.from_deg)
    }
}

/// The angle of a turn at which the torque of the hinge that turns is worst against its rating.
///
/// Between two points of the rating it is a straight line R, and the torque T a sine wave, so T' R - T R' has the rate
/// -T R: it is 0 at most once where T has one sign, and |T| / R is greatest there or at an end.
pub(super) fn worst(torque: &Swing, rating: &Rating, opening: &Opening) -> f64 {
    let end = opening.angle;
    let knots = rating.points().iter().map(|(knot, _)| opening.angle_at(*knot));
    let mut cuts: Vec<f64> = knots
        .filter(|angle| *angle > 0.0 && *angle < end)
        .chain(torque.pieces_of_one_sign(0.0, end))
        .collect();
    cuts.sort_by(f64::total_cmp);
    let at = |angle: f64| rating.at(opening.at(angle)).0;
    let mut angles: Vec<f64> = cuts.clone();
    if rating.points().len() == 1 {
        angles.extend(torque.candidates(0.0, end));
    } else {
        for piece in cuts.windows(2) {
            let (mut low, mut high) = (piece[0], piece[1]);
            let bend = (at(high) - at(low)) / (high - low);
            let growth = |angle: f64| {
                let (value, rate) = (torque.at(angle), torque.rate(angle));
                (rate * at(angle) - value * bend) * torque.at(f64::midpoint(piece[0], piece[1])).signum()
            };
            if growth(low) > 0.0 && growth(high) < 0.0 {
                // Halved until no number is between.
                while low < f64::midpoint(low, high) && f64::midpoint(low, high) < high {
                    let middle = f64::midpoint(low, high);
                    if growth(middle) > 0.0 { low = middle } else { high = middle }
                }
                angles.push(low);
            }
        }
    }
    let factor = |angle: &f64| torque.at(*angle).abs() / at(*angle);
    // The earliest of equals.
    angles.sort_by(|a, b| factor(b).total_cmp(&factor(a)).then(a.total_cmp(b)));
    angles.first().copied().unwrap_or(0.0)
}
