//! The phase of the foil along paths of temperature, and the angle that comes of it.

use core::f64::consts::PI;

use proptest::prelude::*;
use zygote_core::Duty;
use zygote_sim::plant::{Alloy, SmaConfig, Transformation};

use crate::rig::{Rig, assert_near};

const ALLOY: Alloy = Alloy::LOW_TEMPERATURE;
const COLD_C: f64 = 22.0;

/// A foil that was cold martensite, taken through `path` from temperature to temperature.
fn through(alloy: &Alloy, path: &[f64]) -> Transformation {
    let mut at_c = COLD_C;
    let mut phase = Transformation::MARTENSITE;
    for next_c in path {
        phase = phase.moved(alloy, at_c, *next_c);
        at_c = *next_c;
    }
    phase
}

#[test]
fn heating_turns_all_martensite_between_as_and_af() {
    assert_near(through(&ALLOY, &[ALLOY.as_c]).austenite(), 0.0, 0.0, "austenite at As");
    assert_near(through(&ALLOY, &[73.0]).austenite(), 0.5, 1e-12, "austenite half-way");
    // Liang and Rogers: (cos(pi (T - As) / (Af - As)) + 1) / 2 of the martensite is left.
    assert_near(
        through(&ALLOY, &[70.0]).martensite(),
        f64::midpoint((0.2 * PI).cos(), 1.0),
        1e-12,
        "at 70 °C",
    );
    assert!(through(&ALLOY, &[77.5]).martensite() > 0.0, "some is left just below Af");
    assert_near(through(&ALLOY, &[ALLOY.af_c]).martensite(), 0.0, 0.0, "martensite at Af");
}

#[test]
fn cooling_turns_all_austenite_between_ms_and_mf() {
    assert_near(through(&ALLOY, &[90.0, ALLOY.ms_c]).martensite(), 0.0, 0.0, "martensite at Ms");
    assert!(through(&ALLOY, &[90.0, 51.5]).martensite() > 0.0, "some has formed just below Ms");
    assert_near(through(&ALLOY, &[90.0, 47.0]).martensite(), 0.5, 1e-12, "martensite half-way");
    assert_near(through(&ALLOY, &[90.0, ALLOY.mf_c]).martensite(), 1.0, 0.0, "martensite at Mf");
}

#[test]
fn between_ms_and_as_the_phase_depends_on_the_side_it_came_from() {
    assert_near(through(&ALLOY, &[60.0]).austenite(), 0.0, 0.0, "from below");
    assert_near(through(&ALLOY, &[90.0, 60.0]).austenite(), 1.0, 0.0, "from above");
}

#[test]
fn interrupted_heating_is_taken_up_where_it_stopped() {
    let half = through(&ALLOY, &[73.0]);
    assert_near(through(&ALLOY, &[73.0, 56.0]).austenite(), half.austenite(), 0.0, "cooled to above Ms");
    assert_near(
        through(&ALLOY, &[73.0, 56.0, 72.0]).austenite(),
        half.austenite(),
        0.0,
        "not yet as warm again",
    );
    let onward = through(&ALLOY, &[73.0, 56.0, 75.0]);
    assert_near(onward.austenite(), through(&ALLOY, &[75.0]).austenite(), 1e-12, "beyond where it stopped");
}

#[test]
fn a_minor_loop_starts_from_the_phase_that_it_reversed_at() {
    // Half austenite, half of that turned back at 47 °C, then heated: the remaining quarter is as it was until
    // As, and the three quarters of martensite turn between As and Af.
    assert_near(through(&ALLOY, &[73.0, 47.0]).austenite(), 0.25, 1e-12, "turned back");
    assert_near(through(&ALLOY, &[73.0, 47.0, ALLOY.as_c]).austenite(), 0.25, 1e-12, "at As again");
    assert_near(
        through(&ALLOY, &[73.0, 47.0, 73.0]).martensite(),
        0.375,
        1e-12,
        "half of the three quarters",
    );
}

#[test]
fn a_reversal_where_both_transformations_overlap_does_not_jump() {
    // Ms and Mf at 75 and 65 °C, As and Af at 68 and 78 °C.
    let narrow = Alloy { mf_c: 65.0, ms_c: 75.0, ..ALLOY };
    let mut path = vec![90.0, 70.0];
    let cooled = through(&narrow, &path);
    path.push(70.001);
    assert_near(
        through(&narrow, &path).martensite(),
        cooled.martensite(),
        1e-3,
        "turned to heating at 70 °C",
    );
    path = vec![72.0];
    let heated = through(&narrow, &path);
    path.push(71.999);
    assert_near(
        through(&narrow, &path).martensite(),
        heated.martensite(),
        1e-3,
        "turned to cooling at 72 °C",
    );
}

#[test]
fn a_ripple_on_the_temperature_does_not_eat_the_martensite() {
    let mut path = Vec::new();
    for _ in 0..10_000 {
        path.extend([73.0, 72.0]);
    }
    assert_near(through(&ALLOY, &path).martensite(), 0.5, 1e-9, "martensite after 10,000 ripples");
    let mut path = vec![90.0];
    for _ in 0..10_000 {
        path.extend([47.0, 48.0]);
    }
    assert_near(through(&ALLOY, &path).martensite(), 0.5, 1e-9, "austenite after 10,000 ripples");
}

/// Alloys whose branches may overlap (Ms above As), as those with a narrow hysteresis do.
fn any_alloy() -> impl Strategy<Value = Alloy> {
    (20.0..60.0, 2.0..20.0f64, 0.5..20.0f64, 2.0..20.0f64).prop_map(|(mf_c, cool_k, gap_k, heat_k)| {
        let as_c = mf_c + gap_k;
        let af_c = as_c + heat_k.max(cool_k - gap_k + 1.0);
        Alloy { mf_c, ms_c: mf_c + cool_k, as_c, af_c, ..Alloy::LOW_TEMPERATURE }
    })
}

proptest! {
    #[test]
    fn heating_only_makes_austenite_and_cooling_only_martensite(
        alloy in any_alloy(),
        path in prop::collection::vec(0.0..110.0, 1..60),
    ) {
        let mut at_c = 0.0;
        let mut phase = Transformation::MARTENSITE;
        for next_c in path {
            let next = phase.moved(&alloy, at_c, next_c);
            prop_assert!((0.0..=1.0).contains(&next.martensite()));
            if next_c > at_c {
                prop_assert!(next.martensite() <= phase.martensite());
            } else {
                prop_assert!(next.martensite() >= phase.martensite());
            }
            (at_c, phase) = (next_c, next);
        }
    }

    #[test]
    fn no_small_change_of_temperature_makes_the_phase_jump(
        path in prop::collection::vec(30.0..90.0f64, 1..30),
    ) {
        const STEP_K: f64 = 0.01;
        // Steepest point of a cosine over the 10 K between As and Af, or Ms and Mf.
        const STEEPEST_PER_K: f64 = PI / 2.0 / 10.0;
        let mut at_c = COLD_C;
        let mut phase = Transformation::MARTENSITE;
        for goal_c in path {
            while (goal_c - at_c).abs() > STEP_K {
                let next_c = at_c + STEP_K.copysign(goal_c - at_c);
                let next = phase.moved(&ALLOY, at_c, next_c);
                let jump = (next.martensite() - phase.martensite()).abs();
                prop_assert!(jump <= STEP_K * STEEPEST_PER_K * 1.001, "{jump} from {at_c} °C");
                (at_c, phase) = (next_c, next);
            }
        }
    }

    #[test]
    fn a_way_in_pieces_ends_where_the_whole_way_does(
        alloy in any_alloy(),
        path in prop::collection::vec((0.0..110.0f64, 0.0..1.0f64), 1..30),
    ) {
        let (mut whole, mut pieces) = (Transformation::MARTENSITE, Transformation::MARTENSITE);
        let mut at_c = 0.0;
        for (next_c, share) in path {
            let between_c = at_c + (next_c - at_c) * share;
            whole = whole.moved(&alloy, at_c, next_c);
            pieces = pieces.moved(&alloy, at_c, between_c).moved(&alloy, between_c, next_c);
            prop_assert!((whole.martensite() - pieces.martensite()).abs() < 1e-9);
            at_c = next_c;
        }
    }
}

#[test]
fn a_hinge_opens_with_its_austenite_and_stays_open_when_it_cools() {
    let mut rig = Rig::hinge(SmaConfig::opening(180.0));
    rig.heaters[0] = Duty::FULL;
    rig.run_until(|foil_c| foil_c >= 73.0);
    let austenite = 1.0 - rig.plant.sma_hinges()[0].martensite();
    assert!((0.45..0.6).contains(&austenite), "half-way through: {austenite}");
    assert_near(rig.sma_deg(), 180.0 * 1.05 * austenite, 1e-9, "angle half-way");

    // Cooled to all martensite it keeps the angle, and heated again it opens no further than its austenite says.
    rig.heaters[0] = Duty::OFF;
    rig.run(0.5);
    let opened_deg = rig.sma_deg();
    rig.run(60.0);
    assert_near(rig.plant.sma_hinges()[0].martensite(), 1.0, 0.0, "martensite when cold");
    assert_near(rig.sma_deg(), opened_deg, 0.0, "angle when cold");
    rig.heaters[0] = Duty::FULL;
    rig.run_until(|foil_c| foil_c >= 70.0);
    assert_near(rig.sma_deg(), opened_deg, 0.0, "angle when a little warm");

    rig.run_until(|foil_c| foil_c >= 80.0);
    assert_near(rig.sma_deg(), 180.0, 0.0, "angle at the end stop");
    rig.heaters[0] = Duty::OFF;
    rig.run(60.0);
    assert_near(rig.sma_deg(), 180.0, 0.0, "angle when it has cooled");
}

#[test]
fn a_bridge_closes_from_180_to_90() {
    let mut rig = Rig::hinge(SmaConfig { start_deg: 180.0, ..SmaConfig::opening(90.0) });
    assert_near(rig.sma_deg(), 180.0, 0.0, "flat at the start");
    rig.heaters[0] = Duty::FULL;
    rig.run_until(|foil_c| foil_c >= 80.0);
    assert_near(rig.sma_deg(), 90.0, 0.0, "at its end stop");
}

#[test]
fn a_load_keeps_a_hinge_from_its_end_stop() {
    let unloaded = SmaConfig::opening(180.0);
    let mut rig = Rig::hinge(SmaConfig { load_mn_m: unloaded.blocked_torque_mn_m / 2.0, ..unloaded });
    rig.heaters[0] = Duty::FULL;
    rig.run(20.0);
    // Half of the blocked torque is left half-way to the memory angle, 189°.
    assert_near(rig.sma_deg(), 94.5, 1e-9, "angle under load");
}
