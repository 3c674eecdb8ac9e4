//! How much of a foil is austenite: the cosine law of Liang and Rogers (1990), a branch of which begins where the
//! transformation turns round, not where the temperature does.

use crate::nominal::Transformation;
use core::f64::consts::PI;

/// A foil's phase with what it needs of its past.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Phase {
    austenite: f64,
    heating: bool,
    /// What the phase that is used up amounts to at the branch's start.
    whole: f64,
}

impl Phase {
    /// Cold for long.
    pub(crate) const MARTENSITE: Self = Self { austenite: 0.0, heating: false, whole: 0.0 };

    pub(crate) fn austenite(&self) -> f64 {
        self.austenite
    }

    /// The phase after going straight from one temperature to another, and the austenite that a kelvin more brings
    /// there.
    pub(crate) fn moved(self, at: &Transformation, from_c: f64, to_c: f64) -> (Self, f64) {
        if to_c > from_c {
            // Martensite left at `to_c` of the branch's whole.
            let (left, slope) = falling(to_c, at.as_c, at.af_c);
            if left >= 1.0 {
                return (self, 0.0);
            }
            let whole = if self.heating {
                self.whole
            } else {
                let (before, _) = falling(from_c, at.as_c, at.af_c);
                if left >= before {
                    return (self, 0.0);
                }
                (1.0 - self.austenite) / before
            };
            let austenite = 1.0 - whole * left;
            let slope = if austenite > self.austenite { whole * slope } else { 0.0 };
            (Self { austenite: self.austenite.max(austenite), heating: true, whole }, slope)
        } else {
            // Austenite left at `to_c`.
            let (gone, slope) = falling(to_c, at.mf_c, at.ms_c);
            let left = 1.0 - gone;
            if left >= 1.0 {
                return (self, 0.0);
            }
            let whole = if self.heating {
                let before = 1.0 - falling(from_c, at.mf_c, at.ms_c).0;
                if left >= before {
                    return (self, 0.0);
                }
                self.austenite / before
            } else {
                self.whole
            };
            let austenite = whole * left;
            let slope = if austenite < self.austenite { whole * slope } else { 0.0 };
            (Self { austenite: self.austenite.min(austenite), heating: false, whole }, slope)
        }
    }
}

/// Half a cosine that falls from 1 at `low_c` to 0 at `high_c`, and its fall per kelvin.
fn falling(t_c: f64, low_c: f64, high_c: f64) -> (f64, f64) {
    let x = (t_c - low_c) / (high_c - low_c);
    if x <= 0.0 {
        (1.0, 0.0)
    } else if x >= 1.0 {
        (0.0, 0.0)
    } else {
        let (sin, cos) = (PI * x).sin_cos();
        (f64::midpoint(1.0, cos), PI * sin / (2.0 * (high_c - low_c)))
    }
}

#[cfg(test)]
#[expect(clippy::float_cmp, reason = "the same bits are meant")]
mod tests {
    use super::*;
    use crate::nominal::Nominal;

    const AT: Transformation = Nominal::LOW_TEMPERATURE;

    fn through(temperatures: &[f64]) -> f64 {
        let mut phase = Phase::MARTENSITE;
        for pair in temperatures.windows(2) {
            phase = phase.moved(&AT, pair[0], pair[1]).0;
        }
        phase.austenite()
    }

    #[test]
    fn heating_through_makes_austenite_and_cooling_through_unmakes_it() {
        assert_eq!(through(&[20.0, 60.0, 68.0]), 0.0);
        assert!((through(&[20.0, 73.0]) - 0.5).abs() < 1e-12);
        assert_eq!(through(&[20.0, 90.0]), 1.0);
        assert_eq!(through(&[20.0, 90.0, 53.0]), 1.0);
        assert!((through(&[20.0, 90.0, 47.0]) - 0.5).abs() < 1e-12);
        assert_eq!(through(&[20.0, 90.0, 40.0]), 0.0);
    }

    #[test]
    fn a_ripple_between_the_branches_changes_nothing_and_heating_goes_on_where_it_stopped() {
        let stopped = through(&[20.0, 73.0]);
        assert_eq!(through(&[20.0, 73.0, 60.0, 72.0, 56.0]), stopped);
        assert_eq!(through(&[20.0, 73.0, 60.0, 75.0]), through(&[20.0, 75.0]));
    }

    #[test]
    fn cooling_from_a_half_turned_foil_turns_back_what_had_turned() {
        assert!((through(&[20.0, 73.0, 47.0]) - 0.25).abs() < 1e-12);
        assert_eq!(through(&[20.0, 73.0, 30.0]), 0.0);
    }

    #[test]
    fn the_slope_is_the_change_per_kelvin() {
        let phase = Phase::MARTENSITE;
        let (near, slope) = phase.moved(&AT, 20.0, 71.0);
        let (far, _) = phase.moved(&AT, 20.0, 71.000_1);
        assert!(((far.austenite() - near.austenite()) / 1e-4 - slope).abs() < 1e-5);
    }
}
