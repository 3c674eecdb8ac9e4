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

    /// Moves a hinge on by `dt_s` under a constant power. Exact in the film and the bead for a foil that changes evenly, of second
    /// order in the foil, stable for steps up to some tenths of a second; no heat is made or lost.
    pub fn advance(&self, state: &mut State, dt_s: f64, power_w: f64) {
        let film_loss = self.loss_w_per_k * self.film_loss_share;
        let foil_loss = self.loss_w_per_k - film_loss;
        let film_j_per_k = self.capacity_j_per_k * self.film_share;
        let foil_j_per_k = self.capacity_j_per_k - film_j_per_k;
        let out = self.coupling_w_per_k + film_loss;
        let x = dt_s * out / film_j_per_k;
        let left = (-x).exp();
        let mean_left = (1.0 - left) / x;

        let foil_rate = |foil_c: f64| {
            let film_c = (power_w + self.coupling_w_per_k * foil_c + film_loss * self.ambient_c) / out;
            let mean_film_c = film_c + (state.film_c - film_c) * mean_left;
            let heat_w =
                self.coupling_w_per_k * (mean_film_c - foil_c) - foil_loss * (foil_c - self.ambient_c);
            (heat_w, film_c)
        };
        // Half a step ahead, with the latent heat as it is met there; then the whole step from what flows there.
        let (heat_w, _) = foil_rate(state.foil_c);
        let (middle_c, _) = self.foil_after(state, heat_w * dt_s / 2.0, foil_j_per_k);
        let (heat_w, film_c) = foil_rate(middle_c);
        let before_c = state.foil_c;
        let (foil_c, phase) = self.foil_after(state, heat_w * dt_s, foil_j_per_k);
        state.film_c = film_c + (state.film_c - film_c) * left;
        state.foil_c = foil_c;
        state.phase = phase;

        let y = dt_s / self.lag_s;
        let left = (-y).exp();
        let rate_k = (foil_c - before_c) / y;
        state.bead_c = foil_c - rate_k + (state.bead_c - before_c + rate_k) * left;
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

#[cfg(test)]
mod tests {
    use super::*;

    fn hinge() -> Model {
        Model::nominal(&Nominal::default(), 22.0)
    }

    fn run(model: &Model, state: &mut State, seconds: f64, step_s: f64, power_w: f64) {
        let steps = (seconds / step_s).round();
        for _ in 0..steps as usize {
            model.advance(state, step_s, power_w);
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
            for (seconds, power_w) in [(7.0, 0.9), (2.0, 0.0), (2.0, 0.9), (15.0, 0.0)] {
                for _ in 0..(seconds / 0.5) as usize {
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
