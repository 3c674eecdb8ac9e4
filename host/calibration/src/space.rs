//! The space that a fit searches: every parameter as its distance from the nominal one, in what it may stray. What the
//! data leave open then stays within its spread, and adds that spread to the intervals.
//!
//! The coordinates are what readings show: the foil's settled rise and the slower of the two modes, not the loss and the capacity,
//! which follow from them only with what is hardly seen of the film. So the valley of good fits is straight.

use crate::diagnosis::Electrical;
use crate::model::Model;
use crate::nominal::{Nominal, Transformation};
use nalgebra::SVector;

/// How many parameters there are.
pub(crate) const COUNT: usize = 14;
/// A film of more than this share would be the hinge, and the steps of the model too long for it.
const MOST_FILM: f64 = 0.6;
/// A point of the space: 0 is nominal, 1 is one spread off.
pub(crate) type Point = SVector<f64, COUNT>;

/// A hinge, and how much warmer than the air it was at the record's start.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Candidate {
    pub(crate) model: Model,
    pub(crate) start_k: f64,
}

/// Centre and spread of every parameter; those that must stay positive by their logarithm,
/// shares by that of their odds.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Space {
    centre: Point,
    spread: Point,
}

impl Space {
    /// Place of the austenite start among the parameters.
    const AS: usize = 4;
    /// Place of the thermistor's lag.
    const LAG: usize = 11;
    /// Places of what a pulse below As can't show.
    const HIDDEN: core::ops::Range<usize> = 3..12;

    /// The space around the nominal hinge in air of `ambient_c`. The spreads are wide for what the data show, and for what they
    /// hardly show as wide as such parts differ.
    pub(crate) fn new(nominal: &Nominal, heater: Option<Electrical>, ambient_c: f64) -> Self {
        let at = &nominal.transformation;
        let (ohm, error_ohm) = heater
            .map_or((nominal.heater_ohm, 0.2 * nominal.heater_ohm), |heater| (heater.ohm, heater.error_ohm));
        let capacity_j_per_k = nominal.time_constant_s / nominal.thermal_resistance_k_per_w;
        let film = nominal.film_share.min(MOST_FILM * 0.95);
        let foil = 1.0 - film;
        let film_s = film * foil * capacity_j_per_k / nominal.coupling_w_per_k;
        let rows = [
            (Model::nominal(nominal, ambient_c).foil_rise_k_per_w().ln(), 1.0),
            (nominal.time_constant_s.ln(), 1.0),
            (ohm.ln(), error_ohm / ohm),
            ((nominal.latent_k * foil).ln(), 0.4),
            (at.as_c, 15.0),
            ((at.af_c - at.as_c).ln(), 0.6),
            ((at.af_c - at.ms_c).ln(), 0.5),
            ((at.ms_c - at.mf_c).ln(), 0.6),
            ((film / (MOST_FILM - film)).ln(), 0.5),
            ((nominal.film_loss_share / (1.0 - nominal.film_loss_share)).ln(), 0.7),
            (film_s.ln(), 0.6),
            (nominal.lag_s.ln(), 0.7),
            (ambient_c, 2.0),
            (0.0, 0.3),
        ];
        Self {
            centre: Point::from_iterator(rows.iter().map(|row| row.0)),
            spread: Point::from_iterator(rows.iter().map(|row| row.1)),
        }
    }

    /// The hinge at a point.
    pub(crate) fn at(&self, point: &Point) -> Candidate {
        let [
            rise,
            slow,
            ohm,
            latent,
            as_c,
            width,
            hysteresis,
            back,
            film,
            film_loss,
            quick,
            lag,
            ambient_c,
            start_k,
        ] = (self.centre + self.spread.component_mul(point)).into();
        let (film_share, film_loss_share) =
            (MOST_FILM / (1.0 + (-film).exp()), 1.0 / (1.0 + (-film_loss).exp()));
        let (rise_k_per_w, slow_s) = (rise.exp(), slow.exp());
        let in_two = film_share * (1.0 - film_share);
        let coupling_w_per_k = in_two * slow_s / rise_k_per_w / quick.exp();
        // The loss that leaves the foil this rise: the root of loss + loss² s = 1 / rise.
        let s = film_loss_share * (1.0 - film_loss_share) / coupling_w_per_k;
        let loss_w_per_k = 2.0 / rise_k_per_w / (1.0 + (1.0 + 4.0 * s / rise_k_per_w).sqrt());
        // The capacity whose slower mode has this time constant: the lesser root of what film and foil balance to.
        let film_w_per_k = coupling_w_per_k + film_loss_share * loss_w_per_k;
        let foil_w_per_k = coupling_w_per_k + (1.0 - film_loss_share) * loss_w_per_k;
        let sum = film_w_per_k * (1.0 - film_share) + foil_w_per_k * film_share;
        let product = film_w_per_k * foil_w_per_k - coupling_w_per_k * coupling_w_per_k;
        let root = (sum * sum - 4.0 * in_two * product).max(0.0).sqrt();
        let capacity_j_per_k = slow_s * 2.0 * product / (sum + root);
        let af_c = as_c + width.exp();
        let ms_c = af_c - hysteresis.exp();
        let model = Model {
            ambient_c,
            loss_w_per_k,
            film_loss_share,
            capacity_j_per_k,
            film_share,
            coupling_w_per_k,
            latent_j: latent.exp() * capacity_j_per_k,
            transformation: Transformation { mf_c: ms_c - back.exp(), ms_c, as_c, af_c },
            heater_ohm: ohm.exp(),
            lag_s: lag.exp(),
        };
        Candidate { model, start_k }
    }

    /// The point with everything nominal that a pulse below As can't show, but for a lag so many times the nominal.
    pub(crate) fn unbiased(&self, point: &Point, lag: f64) -> Point {
        let mut point = *point;
        for parameter in Self::HIDDEN {
            point[parameter] = 0.0;
        }
        point[Self::LAG] = lag.ln() / self.spread[Self::LAG];
        point
    }

    /// The point with the austenite start so many kelvins off.
    pub(crate) fn shifted(&self, point: &Point, kelvins: f64) -> Point {
        let mut point = *point;
        point[Self::AS] += kelvins / self.spread[Self::AS];
        point
    }
}

#[cfg(test)]
#[expect(clippy::float_cmp, reason = "the same bits are meant")]
mod tests {
    use super::*;

    #[test]
    fn the_centre_is_the_nominal_hinge() {
        let nominal = Nominal::default();
        let at = Space::new(&nominal, None, 21.0).at(&Point::zeros());
        let model = Model::nominal(&nominal, 21.0);
        assert_eq!(at.start_k, 0.0);
        for (got, expected) in [
            (at.model.time_constant_s(), model.time_constant_s()),
            (at.model.loss_w_per_k, model.loss_w_per_k),
            (at.model.latent_j, model.latent_j),
            (at.model.transformation.mf_c, model.transformation.mf_c),
            (at.model.transformation.ms_c, model.transformation.ms_c),
            (at.model.lag_s, model.lag_s),
            (at.model.heater_ohm, model.heater_ohm),
        ] {
            // The slower mode is the lumped one but for parts in ten thousand.
            assert!((got / expected - 1.0).abs() < 1e-3, "{got}, expected {expected}");
        }
    }

    #[test]
    fn a_shift_moves_the_whole_alloy() {
        let space = Space::new(&Nominal::default(), None, 21.0);
        let at = space.at(&space.shifted(&Point::zeros(), 7.0)).model.transformation;
        assert!((at.as_c - 75.0).abs() < 1e-9 && (at.mf_c - 49.0).abs() < 1e-9);
    }
}
