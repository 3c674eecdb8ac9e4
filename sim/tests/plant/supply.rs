//! Sag under load, and the main switch.

use proptest::prelude::*;
use zygote_core::{Duty, PulseMicros};
use zygote_sim::plant::{Config, ServoConfig, SmaConfig, SpringConfig, SupplyConfig};

use crate::rig::{Rig, TICK, assert_near, stiff_supply};

fn everything(supply: SupplyConfig) -> Rig {
    let mut rig = Rig::new(&Config {
        supply,
        heaters: vec![SmaConfig::opening(90.0); 4],
        servos: vec![ServoConfig::default()],
        springs: vec![SpringConfig::opening(90.0)],
        ..Config::default()
    });
    rig.heaters = vec![Duty::FULL; 4];
    rig.servos = vec![Some(PulseMicros(2500))];
    rig.springs = vec![true];
    rig
}

#[test]
fn four_heaters_on_half_an_ohm_sag_as_a_divider_does() {
    let supply = SupplyConfig { source_ohm: 0.5, ..stiff_supply() };
    let mut rig =
        Rig::new(&Config { supply, heaters: vec![SmaConfig::opening(90.0); 4], ..Config::default() });
    rig.heaters = vec![Duty::FULL; 4];
    rig.step(TICK);
    // 25 Ohm / 4 on 0.5 Ohm.
    assert_near(rig.plant.supply_v(), 5.0 * 6.25 / 6.75, 1e-12, "voltage");
    assert_near(rig.plant.supply_a(), 5.0 / 6.75, 1e-12, "current");
}

#[test]
fn a_sagging_supply_heats_with_the_square_of_its_voltage() {
    let rise_k = |source_ohm: f64| {
        let supply = SupplyConfig { source_ohm, ..stiff_supply() };
        let mut rig =
            Rig::new(&Config { supply, heaters: vec![SmaConfig::opening(90.0)], ..Config::default() });
        rig.heaters[0] = Duty::new(300);
        rig.run(80.0);
        rig.foil_c() - 22.0
    };
    let mean_ohm: f64 = 25.0 / 0.3;
    assert_near(rise_k(5.0) / rise_k(0.0), (mean_ohm / (mean_ohm + 5.0)).powi(2), 1e-4, "ratio of rises");
}

proptest! {
    #[test]
    fn voltage_and_current_agree_with_the_source_and_with_the_load(
        duties in prop::collection::vec(0u16..=1000, 1..30),
        servos in 0usize..8,
        source_ohm in 0.0..1.0,
    ) {
        let supply = SupplyConfig { source_ohm, ..stiff_supply() };
        let mut rig = Rig::new(&Config {
            supply,
            heaters: vec![SmaConfig::opening(90.0); duties.len()],
            servos: vec![ServoConfig::default(); servos],
            ..Config::default()
        });
        rig.heaters = duties.iter().copied().map(Duty::new).collect();
        rig.servos = vec![Some(PulseMicros(2500)); servos];
        rig.step(TICK);
        let (volts, amps) = (rig.plant.supply_v(), rig.plant.supply_a());
        prop_assert!((volts - (5.0 - source_ohm * amps)).abs() < 1e-9, "the source");
        let heaters_s: f64 = duties.iter().map(|duty| f64::from(*duty) / 1000.0 / 25.0).sum();
        let servos_a: f64 = (0..servos).map(|_| 0.18).sum();
        prop_assert!((amps - (heaters_s * volts + servos_a)).abs() < 1e-9, "the load");
    }
}

#[test]
fn with_the_main_switch_open_nothing_gets_power() {
    let mut rig = everything(SupplyConfig::default());
    rig.main_switch = false;
    rig.run(10.0);
    for hinge in rig.plant.sma_hinges() {
        assert_near(hinge.film_c(), 22.0, 0.0, "film");
    }
    assert_near(rig.plant.servo_hinges()[0].angle_deg(), 0.0, 0.0, "servo");
    assert!(!rig.plant.spring_hinges()[0].released());
    assert_near(rig.plant.supply_a(), 0.0, 0.0, "current");
    assert_near(rig.plant.supply_v(), 5.0, 0.0, "the voltage is measured before the switch");
    rig.main_switch = true;
    rig.run(10.0);
    assert!(rig.foil_c() > 78.0 && rig.plant.spring_hinges()[0].released(), "closed, the same drive works");
}

#[test]
fn a_burn_wire_on_a_collapsed_supply_cuts_nothing() {
    let supply = SupplyConfig { source_ohm: 3.0, ..stiff_supply() };
    let spring = SpringConfig::opening(90.0);
    let mut rig = Rig::new(&Config { supply, springs: vec![spring], ..Config::default() });
    rig.springs[0] = true;
    rig.run(10.0);
    assert!(rig.plant.supply_v() < spring.release_min_v, "the case");
    assert!(!rig.plant.spring_hinges()[0].released());
}

#[test]
fn stalled_servos_beyond_what_the_supply_can_give_short_it() {
    let supply = SupplyConfig { source_ohm: 0.5, ..stiff_supply() };
    let servo = ServoConfig { stop_high_deg: 10.0, ..ServoConfig::default() };
    let mut rig = Rig::new(&Config { supply, servos: vec![servo; 8], ..Config::default() });
    rig.servos = vec![Some(PulseMicros(2500)); 8];
    rig.run(1.0);
    assert_near(rig.plant.supply_v(), 0.0, 0.0, "voltage");
    assert_near(rig.plant.supply_a(), 10.0, 1e-9, "short-circuit current");
}
