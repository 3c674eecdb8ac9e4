//! The hinge as the fit believes it to be: film heater, foil with latent heat, air and panels, a thermistor that lags.
//!
//! ```text
//!   power --> film --coupling--> foil --panels--> air         bead follows foil
//!              |                  |
//!             air                air
//! ```

use crate::nominal::{Nominal, Transformation};
use crate::phase::Phase;

/// A hinge in numbers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Model {
    /// Temperature of the air, as the thermistor reads it.
    pub ambient_c: f64,
    /// Loss of film and foil to air and panels.
    pub loss_w_per_k: f64,
    /// Share of the film in that.
    pub film_loss_share: f64,
    /// Heat capacity of film and foil, without latent heat.
    pub capacity_j_per_k: f64,
    /// Share of the film in that.
    pub film_share: f64,
    /// Conductance from the film to the foil.
    pub coupling_w_per_k: f64,
    /// Latent heat of the foil.
    pub latent_j: f64,
    /// Transformation temperatures.
    pub transformation: Transformation,
    /// Heater resistance.
    pub heater_ohm: f64,
    /// Lag of the thermistor.
    pub lag_s: f64,
}

/// How warm a hinge is at one moment.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct State {
    /// The film heater.
    pub film_c: f64,
    /// The foil.
    pub foil_c: f64,
    /// The thermistor.
    pub bead_c: f64,
    phase: Phase,
}

impl State {
    /// A hinge that has been this cold for long.
    pub const fn at_rest(t_c: f64) -> Self {
        Self { film_c: t_c, foil_c: t_c, bead_c: t_c, phase: Phase::MARTENSITE }
    }

    /// Share of austenite in the foil.
    pub fn austenite(&self) -> f64 {
        self.phase.austenite()
    }
}

impl Model {
    /// The hinge of the data sheets.
    pub fn nominal(nominal: &Nominal, ambient_c: f64) -> Self {
        let loss_w_per_k = 1.0 / nominal.thermal_resistance_k_per_w;
        let capacity_j_per_k = nominal.time_constant_s * loss_w_per_k;
        Self {
            ambient_c,
            loss_w_per_k,
            film_loss_share: nominal.film_loss_share,
            capacity_j_per_k,
            film_share: nominal.film_share,
            coupling_w_per_k: nominal.coupling_w_per_k,
            latent_j: nominal.latent_k * capacity_j_per_k * (1.0 - nominal.film_share),
            transformation: nominal.transformation,
            heater_ohm: nominal.heater_ohm,
            lag_s: nominal.lag_s,
        }
    }

    /// 1 over the whole loss.
    pub fn thermal_resistance_k_per_w(&self) -> f64 {
        1.0 / self.loss_w_per_k
    }

    /// Heat capacity times thermal resistance.
    pub fn time_constant_s(&self) -> f64 {
        self.capacity_j_per_k / self.loss_w_per_k
    }

    /// Settled rise of the foil per watt of heater power.
    pub fn foil_rise_k_per_w(&self) -> f64 {
        let film = self.loss_w_per_k * self.film_loss_share;
        let foil = self.loss_w_per_k - film;
        // What enters the film leaves it to the air and over the coupling; in series with it, the foil's loss.
        self.coupling_w_per_k / (self.coupling_w_per_k * self.loss_w_per_k + film * foil)
    }

    /// Moves a hinge on by `dt_s` under a constant power.
    pub fn advance(&self, state: &mut State, dt_s: f64, power_w: f64) {
        Step::new(self, dt_s).advance(state, power_w);
    }

    /// Temperature and phase of the foil once it took up `heat_j`.
    fn foil_after(&self, state: &State, heat_j: f64, foil_j_per_k: f64) -> (f64, Phase) {
        const TOLERANCE_K: f64 = 1e-9;
        const MOST_ROUNDS: u32 = 60;
        let furthest_c = state.foil_c + heat_j / foil_j_per_k;
        let at = &self.transformation;
        let (phase, _) = state.phase.moved(at, state.foil_c, furthest_c);
        let whole = phase.austenite() - state.phase.austenite();
        if whole == 0.0 {
            return (furthest_c, phase);
        }
        // The root lies between here and where it would get without latent heat: Newton, kept between them.
        let (mut near_c, mut far_c) = (state.foil_c, furthest_c);
        let mut t_c = furthest_c - self.latent_j * whole / foil_j_per_k;
        let mut result = (furthest_c, phase);
        for _ in 0..MOST_ROUNDS {
            let inside = (t_c - near_c) * (t_c - far_c) < 0.0;
            if !inside {
                t_c = f64::midpoint(near_c, far_c);
            }
            let (phase, slope) = state.phase.moved(at, state.foil_c, t_c);
            let turned = phase.austenite() - state.phase.austenite();
            let excess_k = t_c - furthest_c + self.latent_j / foil_j_per_k * turned;
            result = (t_c, phase);
            if excess_k.abs() < TOLERANCE_K {
                break;
            }
            if (excess_k > 0.0) == (heat_j > 0.0) {
                far_c = t_c;
            } else {
                near_c = t_c;
            }
            t_c -= excess_k / (1.0 + self.latent_j / foil_j_per_k * slope);
        }
        result
    }
}

/// A step of one length, with what it needs of the exponential function. Exact in the film and the bead for a foil that changes
/// evenly, of second order in the foil, stable for some tenths of a second; no heat is made or lost.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Step<'a> {
    model: &'a Model,
    pub(crate) dt_s: f64,
    film_loss: f64,
    foil_loss: f64,
    foil_j_per_k: f64,
    /// What is left of the film's distance from its balance, after the step and on average.
    film_left: f64,
    film_mean_left: f64,
    /// The same of the bead, after the step.
    bead_left: f64,
}

impl<'a> Step<'a> {
    pub(crate) fn new(model: &'a Model, dt_s: f64) -> Self {
        let film_loss = model.loss_w_per_k * model.film_loss_share;
        let film_j_per_k = model.capacity_j_per_k * model.film_share;
        let x = dt_s * (model.coupling_w_per_k + film_loss) / film_j_per_k;
        let film_left = (-x).exp();
        Self {
            model,
            dt_s,
            film_loss,
            foil_loss: model.loss_w_per_k - film_loss,
            foil_j_per_k: model.capacity_j_per_k - film_j_per_k,
            film_left,
            film_mean_left: (1.0 - film_left) / x,
            bead_left: (-dt_s / model.lag_s).exp(),
        }
    }

    pub(crate) fn advance(&self, state: &mut State, power_w: f64) {
        let Model { ambient_c, coupling_w_per_k, lag_s, .. } = *self.model;
        let before = *state;
        let balance_c = |foil_c: f64| {
            (power_w + coupling_w_per_k * foil_c + self.film_loss * ambient_c)
                / (coupling_w_per_k + self.film_loss)
        };
        let heat_j = |foil_c: f64, span_s: f64| {
            let film_c = balance_c(foil_c);
            let mean_film_c = film_c + (before.film_c - film_c) * self.film_mean_left;
            span_s * (coupling_w_per_k * (mean_film_c - foil_c) - self.foil_loss * (foil_c - ambient_c))
        };
        // Half a step ahead, with the latent heat as it is met there; then the whole step from what flows there.
        let (middle_c, _) =
            self.model.foil_after(state, heat_j(before.foil_c, self.dt_s / 2.0), self.foil_j_per_k);
        let (foil_c, phase) = self.model.foil_after(state, heat_j(middle_c, self.dt_s), self.foil_j_per_k);
        let film_c = balance_c(middle_c);
        let behind_k = (foil_c - before.foil_c) * lag_s / self.dt_s;
        *state = State {
            film_c: film_c + (before.film_c - film_c) * self.film_left,
            foil_c,
            bead_c: foil_c - behind_k + (before.bead_c - before.foil_c + behind_k) * self.bead_left,
            phase,
        };
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn hinge() -> Model {
        Model::nominal(&Nominal::default(), 22.0)
    }

    fn run(model: &Model, state: &mut State, seconds: f64, step_s: f64, power_w: f64) {
        let mut t_s = 0.5 * step_s;
        while t_s < seconds {
            model.advance(state, step_s, power_w);
            t_s += step_s;
        }
    }

    #[test]
    fn a_settled_foil_is_as_warm_as_its_rise_per_watt_says() {
        let (model, mut state) = (hinge(), State::at_rest(22.0));
        run(&model, &mut state, 200.0, 0.1, 0.3);
        assert!((state.foil_c - 22.0 - 0.3 * model.foil_rise_k_per_w()).abs() < 1e-6);
        assert!((state.bead_c - state.foil_c).abs() < 1e-6);
        assert!(model.foil_rise_k_per_w() < model.thermal_resistance_k_per_w());
    }

    #[test]
    fn a_cold_hinge_cools_with_its_time_constant() {
        let model = hinge();
        let mut state = State::at_rest(35.0);
        run(&model, &mut state, 2.0, 0.05, 0.0);
        let earlier = state.foil_c - 22.0;
        run(&model, &mut state, 5.0, 0.05, 0.0);
        let measured = 5.0 / (earlier / (state.foil_c - 22.0)).ln();
        assert!((measured / model.time_constant_s() - 1.0).abs() < 0.01, "{measured}");
    }

    #[test]
    fn long_steps_agree_with_short_ones_over_a_whole_cycle() {
        let cycle = |step_s: f64| {
            let (model, mut state) = (hinge(), State::at_rest(22.0));
            let mut seen = Vec::new();
            for (halves, power_w) in [(14, 0.9), (4, 0.0), (4, 0.9), (30, 0.0)] {
                for _ in 0..halves {
                    run(&model, &mut state, 0.5, step_s, power_w);
                    seen.push(state.bead_c);
                }
            }
            seen
        };
        for (long, short) in cycle(0.05).iter().zip(cycle(0.001)) {
            assert!((long - short).abs() < 0.05, "{long} for {short}");
        }
    }
}
