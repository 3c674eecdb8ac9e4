//! A quantity while one hinge turns, as a function of the angle.

use std::f64::consts::TAU;

/// `constant + cosine cos(x) + sine sin(x) + slope x`, x in radians from the start of the turn.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Swing {
    pub(super) constant: f64,
    pub(super) cosine: f64,
    pub(super) sine: f64,
    pub(super) slope: f64,
}

impl Swing {
    pub(super) fn at(&self, angle: f64) -> f64 {
        let (sin, cos) = angle.sin_cos();
        self.constant + self.cosine * cos + self.sine * sin + self.slope * angle
    }

    pub(super) fn rate(&self, angle: f64) -> f64 {
        let (sin, cos) = angle.sin_cos();
        self.sine * cos - self.cosine * sin + self.slope
    }

    /// The angles from `from` to `to`, at most a full turn apart, among which those of the least and the greatest value are:
    /// both ends, and where the rate is 0.
    pub(super) fn candidates(&self, from: f64, to: f64) -> impl Iterator<Item = f64> + use<> {
        // The rate is steepest cos(x + phase) + slope.
        let (steepest, phase) = (self.sine.hypot(self.cosine), self.cosine.atan2(self.sine));
        let half = (-self.slope / steepest).acos();
        [-phase - half, -phase + half]
            .into_iter()
            // Without a zero `half` is no number, and every comparison with it is false.
            .map(move |zero| from + (zero - from).rem_euclid(TAU))
            .filter(move |zero| *zero <= to)
            .chain([from, to])
    }

    /// The least value from 0 to an angle.
    pub(super) fn least(&self, to: f64) -> f64 {
        self.candidates(0.0, to).map(|angle| self.at(angle)).fold(f64::INFINITY, f64::min)
    }

    /// The angles from `from` to `to` at which the swing without slope and constant is 0, and both ends, rising.
    pub(super) fn pieces_of_one_sign(&self, from: f64, to: f64) -> Vec<f64> {
        let zero = (-self.cosine).atan2(self.sine);
        let zeros = [zero, zero + TAU / 2.0].map(|zero| from + (zero - from).rem_euclid(TAU));
        let mut cuts: Vec<_> = zeros.into_iter().filter(|zero| *zero < to).chain([from, to]).collect();
        cuts.sort_by(f64::total_cmp);
        cuts
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn no_sample_is_beyond_the_least_and_the_greatest_of_the_candidates(
            [constant, cosine, sine, slope] in [-2.0..2.0_f64, -2.0..2.0, -2.0..2.0, -2.0..2.0],
            to in 0.0..TAU,
        ) {
            let swing = Swing { constant, cosine, sine, slope };
            let values: Vec<_> = swing.candidates(0.0, to).map(|angle| swing.at(angle)).collect();
            let greatest = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
            let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
            for sample in 0..=2000 {
                let value = swing.at(to * f64::from(sample) / 2000.0);
                (low, high) = (low.min(value), high.max(value));
            }
            // Samples miss a turning point by at most half a step, squared.
            prop_assert!(greatest >= high - 1e-12 && greatest <= high + 1e-5, "{greatest}, sampled {high}");
            prop_assert!(swing.least(to) <= low + 1e-12 && swing.least(to) >= low - 1e-5);
        }
    }

    #[test]
    fn what_doesnt_change_has_its_ends_alone() {
        assert_eq!(Swing::default().candidates(0.0, 1.0).collect::<Vec<_>>(), [0.0, 1.0]);
    }
}
