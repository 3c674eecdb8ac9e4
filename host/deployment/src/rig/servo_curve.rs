//! The pulses of one servo as `zygote calibrate --servo` found them: up to four angles, straight lines between.
//!
//! Beyond the outermost angles there is no pulse: nobody has seen the servo there, and an end stop may be nearer than the line.

use super::places::Place;
use super::quantity::{Degrees, Seconds};
use super::settings::ServoSettings;
use super::{Rig, RigError};

/// The opening angles at which a servo is measured, degrees: all that hinges of a plan have.
pub const SERVO_ANGLES: [u16; 4] = [0, 90, 180, 270];
/// Rounding of an angle, not a reach.
const SLACK: Degrees = Degrees(1e-6);

/// Pulses by opening angle.
#[derive(Debug, Clone, Copy)]
pub struct ServoCurve {
    points: [(Degrees, Seconds); SERVO_ANGLES.len()],
    count: usize,
}

impl ServoCurve {
    /// A curve through two to four points by rising angle, whose pulses rise or fall all the way; none through others.
    pub fn new(points: &[(Degrees, Seconds)]) -> Option<Self> {
        let mut ours = [(Degrees(0.0), Seconds(0.0)); SERVO_ANGLES.len()];
        ours.get_mut(..points.len())?.copy_from_slice(points);
        let rises = |pair: &[(Degrees, Seconds)]| pair[0].1 < pair[1].1;
        let angles_rise = points.windows(2).all(|pair| pair[0].0 < pair[1].0);
        let rising = points.windows(2).filter(|pair| rises(pair)).count();
        let differ = points.windows(2).all(|pair| pair[0].1 != pair[1].1);
        let one_way = rising == 0 || rising + 1 == points.len();
        (points.len() >= 2 && angles_rise && differ && one_way)
            .then_some(Self { points: ours, count: points.len() })
    }

    /// The points, by rising angle; two or more.
    pub fn points(&self) -> &[(Degrees, Seconds)] {
        &self.points[..self.count]
    }

    /// The pulse for an opening angle; none beyond the outermost points.
    pub fn pulse(&self, opening: Degrees) -> Option<Seconds> {
        let points = self.points();
        points.windows(2).find_map(|pair| {
            let ((low, from), (high, to)) = (pair[0], pair[1]);
            let inside = low.0 - SLACK.0 <= opening.0 && opening.0 <= high.0 + SLACK.0;
            let share = (opening.0 - low.0) / (high.0 - low.0);
            inside.then_some(Seconds(from.0 + (to.0 - from.0) * share))
        })
    }

    /// Shortest and longest pulse: it was seen to stand free at both, so between them it may be driven.
    pub fn range(&self) -> (Seconds, Seconds) {
        let pulses = || self.points().iter().map(|(_, pulse)| pulse.0);
        (Seconds(pulses().fold(f64::INFINITY, f64::min)), Seconds(pulses().fold(0.0, f64::max)))
    }

    fn reach(&self) -> (Degrees, Degrees) {
        let angles = || self.points().iter().map(|(angle, _)| angle.0);
        (Degrees(angles().fold(f64::INFINITY, f64::min)), Degrees(angles().fold(0.0, f64::max)))
    }
}

impl PartialEq for ServoCurve {
    fn eq(&self, other: &Self) -> bool {
        self.points() == other.points()
    }
}

impl Rig {
    /// The pulse for an opening angle of a servo hinge.
    ///
    /// # Errors
    /// [`RigError::Value`] where it was calibrated and doesn't reach that angle.
    pub(crate) fn pulse(
        &self,
        hinge: usize,
        servo: &ServoSettings,
        opening: Degrees,
    ) -> Result<Seconds, RigError> {
        let Some(curve) = &servo.curve else {
            let share = opening.0 / 270.0;
            return Ok(Seconds(servo.pulse_0.0 + share * (servo.pulse_270.0 - servo.pulse_0.0)));
        };
        curve.pulse(opening).ok_or_else(|| {
            let (low, high) = curve.reach();
            let Place { file, line, key } = self.places.of("rig.calibration");
            RigError::Value {
                place: Place { file, line, key: format!("{key}: hinge {hinge}") },
                expected: format!(
                    "opening angles from {low} to {high}, between which its servo was calibrated: give this hinge another servo or horn, \
                     and calibrate it again"
                ),
                found: opening.to_string(),
            }
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn curve(points: &[(f64, f64)]) -> Option<ServoCurve> {
        let points: Vec<_> = points.iter().map(|(deg, us)| (Degrees(*deg), Seconds(us * 1e-6))).collect();
        ServoCurve::new(&points)
    }

    #[test]
    fn between_its_points_a_curve_is_straight_and_beyond_them_there_is_no_pulse() {
        let curve = curve(&[(0.0, 2400.0), (90.0, 1700.0), (180.0, 900.0)]).unwrap();
        for (deg, us) in [(0.0, 2400.0), (45.0, 2050.0), (90.0, 1700.0), (135.0, 1300.0), (180.0, 900.0)] {
            let pulse = curve.pulse(Degrees(deg)).unwrap();
            assert!((pulse.0 * 1e6 - us).abs() < 1e-9, "at {deg} deg: {pulse}");
        }
        assert_eq!((curve.pulse(Degrees(-1.0)), curve.pulse(Degrees(180.1))), (None, None));
        let (shortest, longest) = curve.range();
        assert!((shortest.0 - 900e-6).abs() < 1e-12 && (longest.0 - 2400e-6).abs() < 1e-12);
    }

    #[test]
    fn points_that_no_servo_has_make_no_curve() {
        for points in [
            &[(90.0, 1500.0)][..],
            &[(0.0, 500.0), (90.0, 1500.0), (180.0, 1400.0)],
            &[(0.0, 500.0), (90.0, 500.0)],
            &[(90.0, 500.0), (0.0, 1500.0)],
            &[(0.0, 500.0), (1.0, 501.0), (2.0, 502.0), (3.0, 503.0), (4.0, 504.0)],
        ] {
            assert_eq!(curve(points), None, "{points:?}");
        }
    }
}
