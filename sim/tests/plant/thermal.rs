//! Heat in a shape-memory hinge against closed forms and the balance of energy.

use core::time::Duration;

use proptest::prelude::*;
use zygote_core::Duty;
use zygote_sim::plant::{Config, SmaConfig};

use crate::rig::{Rig, TICK, TICK_S, assert_near, stiff_supply};

const AMBIENT_C: f64 = 22.0;

/// Rise of film, foil and bead above ambient under a constant power from rest, by the eigenvalues of the two
/// coupled nodes; the bead follows the foil through one more lag. Holds while nothing transforms.
struct ClosedForm {
    steady_film_k: f64,
    steady_foil_k: f64,
    /// Decay rate and amplitudes in film and foil.
    modes: [(f64, f64, f64); 2],
    lag_s: f64,
}

impl ClosedForm {
    fn new(sma: &SmaConfig, power_w: f64) -> Self {
        let (film, foil) = (sma.film_j_per_k, sma.foil_j_per_k());
        let (across, film_loss, foil_loss) =
            (sma.coupling_w_per_k, sma.film_loss_w_per_k(), sma.foil_loss_w_per_k());
        let steady_film_k = power_w / (film_loss + across * foil_loss / (across + foil_loss));
        let steady_foil_k = steady_film_k * across / (across + foil_loss);
        // d/dt (film, foil) = -[[a, -b], [-c, d]] (film, foil)
        let (a, b) = ((across + film_loss) / film, across / film);
        let (c, d) = (across / foil, (across + foil_loss) / foil);
        let (half_trace, root) = (f64::midpoint(a, d), ((a - d).powi(2) / 4.0 + b * c).sqrt());
        let (fast, slow) = (half_trace + root, half_trace - root);
        // A mode is (film, foil) = (b, a - rate) times a weight; together they start at minus the steady state.
        let (u, v) = (a - fast, a - slow);
        let weight_fast = (-steady_foil_k * b + steady_film_k * v) / (b * (u - v));
        let weight_slow = -steady_film_k / b - weight_fast;
        let modes = [(fast, weight_fast * b, weight_fast * u), (slow, weight_slow * b, weight_slow * v)];
        Self { steady_film_k, steady_foil_k, modes, lag_s: sma.thermistor.lag_s }
    }

    fn film_k(&self, t_s: f64) -> f64 {
        self.steady_film_k + self.modes.iter().map(|(rate, film, _)| film * (-rate * t_s).exp()).sum::<f64>()
    }

    fn foil_k(&self, t_s: f64) -> f64 {
        self.steady_foil_k + self.modes.iter().map(|(rate, _, foil)| foil * (-rate * t_s).exp()).sum::<f64>()
    }

    fn bead_k(&self, t_s: f64) -> f64 {
        let own = (-t_s / self.lag_s).exp();
        let followed = |(rate, _, foil): &(f64, f64, f64)| {
            foil / (1.0 - rate * self.lag_s) * ((-rate * t_s).exp() - own)
        };
        self.steady_foil_k * (1.0 - own) + self.modes.iter().map(followed).sum::<f64>()
    }

    fn slow_time_constant_s(&self) -> f64 {
        1.0 / self.modes[1].0
    }
}

#[test]
fn below_as_film_foil_and_bead_follow_the_closed_form() {
    let sma = SmaConfig::opening(180.0);
    let exact = ClosedForm::new(&sma, 0.3);
    assert!(AMBIENT_C + exact.steady_foil_k < sma.alloy.as_c, "the case is below As");
    let mut rig = Rig::hinge(sma);
    rig.heaters[0] = Duty::new(300);
    for tick in 1..=12_000 {
        rig.step(TICK);
        let t_s = f64::from(tick) * TICK_S;
        assert_near(rig.film_c(), AMBIENT_C + exact.film_k(t_s), 0.005, "film");
        assert_near(rig.foil_c(), AMBIENT_C + exact.foil_k(t_s), 0.005, "foil");
        let bead_c = rig.plant.sma_hinges()[0].bead_c();
        assert_near(bead_c, AMBIENT_C + exact.bead_k(t_s), 0.005, "bead");
    }
    assert_near(rig.foil_c(), AMBIENT_C + exact.steady_foil_k, 0.005, "steady state");
}

#[test]
fn a_hinge_cools_with_its_time_constant() {
    let sma = SmaConfig::opening(180.0);
    let time_constant_s = ClosedForm::new(&sma, 0.3).slow_time_constant_s();
    assert!(
        (4.0..13.0).contains(&time_constant_s),
        "{time_constant_s} s is not that of a small foil in still air"
    );
    let mut rig = Rig::hinge(sma);
    rig.heaters[0] = Duty::new(300);
    rig.run(60.0);
    rig.heaters[0] = Duty::OFF;
    // The fast mode is over after a second.
    rig.run(1.0);
    let from_k = rig.foil_c() - AMBIENT_C;
    let took_s = rig.run_until(|foil_c| foil_c - AMBIENT_C <= from_k * (-1.0f64).exp());
    assert_near(took_s, time_constant_s, 2.0 * TICK_S, "time constant");
}

#[test]
fn steady_temperature_at_full_power_is_power_over_conductance() {
    let sma = SmaConfig::opening(180.0);
    let exact = ClosedForm::new(&sma, 1.0);
    let mut rig = Rig::hinge(sma);
    rig.heaters[0] = Duty::FULL;
    rig.run(120.0);
    assert_near(rig.foil_c(), AMBIENT_C + exact.steady_foil_k, 0.01, "foil");
    assert_near(rig.film_c(), AMBIENT_C + exact.steady_film_k, 0.01, "film");
}

#[test]
fn crossing_from_as_to_af_takes_the_latent_heat() {
    let sma = SmaConfig::opening(180.0);
    let width_k = sma.alloy.af_c - sma.alloy.as_c;
    let heat_capacity_j_per_k = sma.film_j_per_k + sma.foil_j_per_k();
    let crossing_s = |sma: SmaConfig| {
        let mut rig = Rig::hinge(sma);
        rig.heaters[0] = Duty::FULL;
        rig.run_until(|foil_c| foil_c >= sma.alloy.as_c);
        let started_film_c = rig.film_c();
        let mut lost_j = 0.0;
        let mut took_s = 0.0;
        while rig.foil_c() < sma.alloy.af_c {
            let film_w = sma.film_loss_w_per_k() * (rig.film_c() - AMBIENT_C);
            lost_j += (film_w + sma.foil_loss_w_per_k() * (rig.foil_c() - AMBIENT_C)) * TICK_S;
            rig.step(TICK);
            took_s += TICK_S;
        }
        let film_j = sma.film_j_per_k * (rig.film_c() - started_film_c);
        (took_s, took_s - lost_j - film_j)
    };
    let (with_s, into_foil_j) = crossing_s(sma);
    assert_near(
        into_foil_j,
        sma.foil_j_per_k() * width_k + sma.latent_j(),
        0.02,
        "heat into the foil at 1 W",
    );
    let mut without = sma;
    without.alloy.latent_j_per_kg = 0.0;
    let (without_s, _) = crossing_s(without);
    let expected = 1.0 + sma.latent_j() / (heat_capacity_j_per_k * width_k);
    assert_near(with_s / without_s, expected, 0.1 * expected, "how much longer the plateau takes");
}

#[test]
fn the_latent_heat_comes_back_between_ms_and_mf() {
    let cooling_s = |latent_j_per_kg: f64| {
        let mut sma = SmaConfig::opening(180.0);
        sma.alloy.latent_j_per_kg = latent_j_per_kg;
        let mut rig = Rig::hinge(sma);
        rig.heaters[0] = Duty::FULL;
        rig.run_until(|foil_c| foil_c > 90.0);
        rig.heaters[0] = Duty::OFF;
        rig.run_until(|foil_c| foil_c <= sma.alloy.ms_c);
        rig.run_until(|foil_c| foil_c <= sma.alloy.mf_c)
    };
    let sma = SmaConfig::opening(180.0);
    let extra_s = cooling_s(sma.alloy.latent_j_per_kg) - cooling_s(0.0);
    // All of it leaves through the losses at about 25 K above ambient, the middle of Ms and Mf.
    let conductance_w_per_k = sma.film_loss_w_per_k() + sma.foil_loss_w_per_k();
    let expected_s = sma.latent_j() / (conductance_w_per_k * 25.0);
    assert_near(extra_s, expected_s, 0.05 * expected_s, "delay by the latent heat");
}

#[test]
fn one_step_of_20_ms_is_as_good_as_twenty_of_1_ms() {
    let config =
        Config { heaters: vec![SmaConfig::opening(180.0), SmaConfig::opening(90.0)], ..Config::default() };
    let (mut fine, mut coarse) = (Rig::new(&config), Rig::new(&config));
    for period in 0..200u16 {
        // Through the transformation both ways: full, half, off, in turns of 4 s.
        let duty = [Duty::FULL, Duty::new(500), Duty::OFF][usize::from(period / 40 % 3)];
        fine.heaters[0] = duty;
        coarse.heaters[0] = duty;
        for _ in 0..100 {
            fine.step(Duration::from_millis(1));
        }
        for _ in 0..5 {
            coarse.step(Duration::from_millis(20));
        }
        assert_near(coarse.foil_c(), fine.foil_c(), 0.002, "foil");
        assert_near(coarse.film_c(), fine.film_c(), 0.002, "film");
        assert_near(coarse.sma_deg(), fine.sma_deg(), 0.02, "angle");
    }
    assert!(fine.sma_deg() >= 180.0, "the pattern goes through the whole transformation");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(256))]

    #[test]
    fn heat_in_is_heat_stored_turned_and_lost(
        duties in prop::collection::vec(0u16..=1000, 4..20),
        latent_j_per_kg in 0.0..40_000.0,
        convection_w_per_m2_k in 20.0..70.0,
        start_below in 0.0..15.0,
        heating_width_k in 0.05..15.0,
        cooling_width_k in 0.05..10.0,
    ) {
        let mut sma = SmaConfig { convection_w_per_m2_k, ..SmaConfig::opening(180.0) };
        sma.alloy.latent_j_per_kg = latent_j_per_kg;
        sma.alloy.af_c = sma.alloy.as_c + heating_width_k;
        sma.alloy.mf_c = sma.alloy.ms_c - cooling_width_k;
        let ambient_c = 37.0 - start_below;
        let supply = stiff_supply();
        let mut rig = Rig::new(&Config { ambient_c, supply, heaters: vec![sma], ..Config::default() });
        let (mut in_j, mut lost_j) = (0.0, 0.0);
        let loss_w = |rig: &Rig| {
            sma.film_loss_w_per_k() * (rig.film_c() - ambient_c)
                + sma.foil_loss_w_per_k() * (rig.foil_c() - ambient_c)
        };
        for duty in duties {
            rig.heaters[0] = Duty::new(duty);
            for _ in 0..400 {
                let before_w = loss_w(&rig);
                rig.step(TICK);
                lost_j += f64::midpoint(before_w, loss_w(&rig)) * TICK_S;
                in_j += f64::from(duty) / 1000.0 * TICK_S;
            }
        }
        let austenite = 1.0 - rig.plant.sma_hinges()[0].martensite();
        let stored_j = sma.film_j_per_k * (rig.film_c() - ambient_c)
            + sma.foil_j_per_k() * (rig.foil_c() - ambient_c)
            + sma.latent_j() * austenite;
        prop_assert!((in_j - stored_j - lost_j).abs() <= 1e-3 + 1e-4 * in_j,
            "{in_j} J in, {stored_j} J stored, {lost_j} J lost");
    }
}
