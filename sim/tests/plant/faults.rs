//! Every fault against the plant's truth: what it breaks, and what it leaves whole.

use zygote_core::{ADC_FULL_SCALE, Duty, PulseMicros};
use zygote_protocol::{Milliamps, Millivolts};
use zygote_sim::plant::{
    Config, Fault, Hinge, Plant, PlantError, ServoActivity, ServoConfig, SmaConfig, SpringConfig,
};

use crate::rig::{Rig, TICK, assert_near, stiff_supply};

/// Two hinges of each kind; only the first ones break.
fn rig_with(fault: Fault, after_s: f64) -> Rig {
    let mut rig = Rig::new(&Config {
        supply: stiff_supply(),
        heaters: vec![SmaConfig::opening(180.0); 2],
        servos: vec![ServoConfig::default(); 2],
        springs: vec![SpringConfig::opening(180.0); 2],
        ..Config::default()
    });
    rig.heaters = vec![Duty::FULL; 2];
    rig.run(after_s);
    rig.plant.inject(fault).expect("a hinge that there is");
    rig
}

fn celsius(reading: u16) -> f64 {
    SmaConfig::opening(180.0).thermistor.celsius_from_counts(f64::from(reading))
}

#[test]
fn an_open_thermistor_reads_full_scale_while_the_foil_heats_on() {
    let mut rig = rig_with(Fault::ThermistorOpen(0), 2.0);
    rig.run(2.0);
    let readings = rig.plant.sense();
    assert_eq!(readings.thermistors[0], ADC_FULL_SCALE);
    assert_near(celsius(readings.thermistors[1]), rig.plant.sma_hinges()[1].bead_c(), 1.0, "its neighbour");
    assert_near(rig.foil_c(), rig.plant.sma_hinges()[1].temperature_c(), 0.0, "the truth");
}

#[test]
fn a_shorted_thermistor_reads_zero() {
    let mut rig = rig_with(Fault::ThermistorShorted(0), 2.0);
    assert_eq!(rig.plant.sense().thermistors[0], 0);
    assert!(rig.foil_c() > 30.0, "the foil is warm all the same");
}

#[test]
fn a_frozen_thermistor_repeats_its_last_reading_without_noise() {
    let mut rig = rig_with(Fault::ThermistorLoose(1), 1.0);
    let last = rig.plant.sense().thermistors[0];
    rig.plant.inject(Fault::ThermistorFrozen(0)).expect("a hinge that there is");
    let at_c = rig.foil_c();
    for _ in 0..200 {
        rig.run(0.02);
        assert_eq!(rig.plant.sense().thermistors[0], last);
    }
    assert!(rig.foil_c() > at_c + 20.0, "the foil went on from {at_c} to {} °C", rig.foil_c());
}

#[test]
fn a_loose_thermistor_falls_back_to_the_air() {
    let mut rig = rig_with(Fault::ThermistorLoose(0), 3.0);
    let warm_c = celsius(rig.plant.sense().thermistors[0]);
    assert!(warm_c > 40.0, "warm when it comes off: {warm_c}");
    rig.run(3.0);
    assert_near(celsius(rig.plant.sense().thermistors[0]), 22.0, 0.3, "reading");
    assert!(rig.foil_c() > 60.0, "the foil is at {} °C", rig.foil_c());
}

#[test]
fn an_open_heater_draws_nothing_and_cools() {
    let mut rig = rig_with(Fault::HeaterOpen(0), 3.0);
    let warm_c = rig.foil_c();
    rig.run(10.0);
    assert!(rig.foil_c() < warm_c - 15.0, "it cooled to {} °C", rig.foil_c());
    assert!(rig.plant.sma_hinges()[1].temperature_c() > 78.0, "its neighbour heats");
    assert_near(rig.plant.supply_a(), 0.2 + 0.01, 1e-9, "one heater and two idle servos");
}

#[test]
fn a_mosfet_that_is_stuck_on_heats_at_no_duty_until_the_main_switch_opens() {
    let mut rig = rig_with(Fault::MosfetStuckOn(0), 0.0);
    rig.heaters = vec![Duty::OFF; 2];
    rig.run(10.0);
    assert!(rig.foil_c() > 78.0, "it heats, to {} °C", rig.foil_c());
    assert_near(rig.plant.sma_hinges()[1].temperature_c(), 22.0, 1e-9, "its neighbour does not");
    assert_near(rig.plant.supply_a(), 0.2 + 0.01, 1e-9, "and draws its current");
    let hot_c = rig.foil_c();
    rig.main_switch = false;
    rig.run(10.0);
    assert!(rig.foil_c() < hot_c - 30.0, "it cooled to {} °C", rig.foil_c());
}

#[test]
fn a_jammed_sma_hinge_heats_and_does_not_open() {
    let mut rig = rig_with(Fault::Jammed(Hinge::Sma(0)), 0.0);
    rig.run(10.0);
    assert_near(rig.sma_deg(), 0.0, 0.0, "its angle");
    assert_near(rig.plant.sma_hinges()[0].martensite(), 0.0, 0.0, "its foil has turned");
    assert_near(rig.plant.sma_hinges()[1].angle_deg(), 180.0, 0.0, "its neighbour");
}

#[test]
fn a_jammed_servo_stalls() {
    let mut rig = rig_with(Fault::Jammed(Hinge::Servo(0)), 0.0);
    rig.heaters = vec![Duty::OFF; 2];
    rig.servos = vec![Some(PulseMicros(1500)); 2];
    rig.run(1.0);
    let [jammed, sound] = rig.plant.servo_hinges() else { panic!("two servos") };
    assert_near(jammed.angle_deg(), 0.0, 0.0, "its angle");
    assert_eq!(jammed.activity(), ServoActivity::Stalled);
    assert_near(sound.angle_deg(), 135.0, 1e-9, "its neighbour");
    assert_near(rig.plant.supply_a(), 1.8 + 0.005, 1e-9, "stall current");
}

#[test]
fn a_jammed_spring_is_released_and_does_not_open() {
    let mut rig = rig_with(Fault::Jammed(Hinge::Spring(0)), 0.0);
    rig.springs = vec![true; 2];
    rig.run(2.0);
    let [jammed, sound] = rig.plant.spring_hinges() else { panic!("two springs") };
    assert!(jammed.released());
    assert_near(jammed.angle_deg(), 0.0, 0.0, "its angle");
    assert_near(sound.angle_deg(), 180.0, 0.0, "its neighbour");
}

#[test]
fn a_cut_supply_takes_the_power_from_everything_and_reads_zero() {
    let mut rig = rig_with(Fault::SupplyCut, 4.0);
    let warm_c = rig.foil_c();
    rig.servos = vec![Some(PulseMicros(1500)); 2];
    rig.springs = vec![true; 2];
    rig.run(5.0);
    assert!(rig.foil_c() < warm_c - 15.0, "it cooled to {} °C", rig.foil_c());
    assert_near(rig.plant.servo_hinges()[0].angle_deg(), 0.0, 0.0, "servo");
    assert!(!rig.plant.spring_hinges()[0].released());
    let readings = rig.plant.sense();
    assert_eq!((readings.supply, readings.current), (Millivolts(0), Milliamps(0)));
    assert!(
        readings.thermistors[0] > 0,
        "the thermistors hang on the converter's reference, not on the supply"
    );
}

#[test]
fn a_fault_in_a_hinge_that_is_not_there_is_refused() {
    let mut plant = Plant::new(&Config { heaters: vec![SmaConfig::opening(90.0)], ..Config::default() })
        .expect("a sound configuration");
    for (fault, hinge, count) in [
        (Fault::HeaterOpen(1), Hinge::Sma(1), 1),
        (Fault::Jammed(Hinge::Servo(0)), Hinge::Servo(0), 0),
        (Fault::Jammed(Hinge::Spring(3)), Hinge::Spring(3), 0),
    ] {
        assert_eq!(plant.inject(fault), Err(PlantError::NoSuchHinge { hinge, count }));
    }
}

#[test]
fn faults_stay() {
    let mut rig = rig_with(Fault::ThermistorOpen(0), 0.0);
    for _ in 0..1000 {
        rig.step(TICK);
        assert_eq!(rig.plant.sense().thermistors[0], ADC_FULL_SCALE);
    }
}

#[test]
fn a_drifting_thermistor_reads_off_by_its_rate_while_the_foil_is_what_it_was() {
    let drift = Fault::ThermistorDrifting { channel: 0, kelvin_per_s: -2.0 };
    let mut rig = rig_with(drift, 3.0);
    rig.run(5.0);
    let readings = rig.plant.sense();
    let bead_c = rig.plant.sma_hinges()[0].bead_c();
    assert_near(celsius(readings.thermistors[0]), bead_c - 10.0, 1.0, "its reading");
    assert_near(rig.foil_c(), rig.plant.sma_hinges()[1].temperature_c(), 0.0, "the truth");
    assert_near(celsius(readings.thermistors[1]), bead_c, 1.0, "its neighbour");
}

#[test]
fn a_shorted_heater_draws_and_heats_as_its_lower_resistance_says() {
    let mut rig = rig_with(Fault::HeaterShorted { channel: 0, ohm: 12.5 }, 0.0);
    rig.run(1.0);
    assert_near(
        rig.plant.supply_a(),
        0.4 + 0.2 + 0.01,
        1e-9,
        "twice its current, its neighbour and two idle servos",
    );
    assert_near(rig.plant.heaters_a(), 0.6, 1e-9, "of which the heaters");
    let (shorted, sound) = (&rig.plant.sma_hinges()[0], &rig.plant.sma_hinges()[1]);
    // Below As nothing transforms and the model is linear: twice the power is twice the rise.
    let (rise, sound_rise) = (shorted.temperature_c() - 22.0, sound.temperature_c() - 22.0);
    assert_near(rise / sound_rise, 2.0, 1e-6, "rise against the neighbour's");
    rig.heaters = vec![Duty::OFF; 2];
    rig.run(0.01);
    assert_near(rig.plant.heaters_a(), 0.0, 0.0, "it is still switched");
}

#[test]
fn a_sagging_supply_gives_its_lower_voltage_behind_its_higher_resistance_and_comes_back() {
    let sag = Fault::SupplySag { open_circuit_v: 4.0, source_ohm: 1.0 };
    let mut rig = rig_with(sag, 0.5);
    rig.run(0.01);
    // Two heaters of 25 ohm and 10 mA of two servos: V = 4 - 1 (2 V / 25 + 0.01).
    let volts = (4.0 - 0.01) / 1.08;
    assert_near(rig.plant.supply_v(), volts, 1e-9, "voltage");
    assert_near(rig.plant.heaters_a(), 2.0 * volts / 25.0, 1e-9, "current of the heaters");
    rig.plant.inject(Fault::SupplyRestored).expect("a supply");
    rig.run(0.01);
    assert_near(rig.plant.supply_v(), 5.0, 1e-9, "voltage again");
    rig.plant.inject(Fault::SupplyCut).expect("a supply");
    rig.plant.inject(Fault::SupplyRestored).expect("a supply");
    rig.run(0.01);
    assert_near(rig.plant.supply_v(), 5.0, 1e-9, "voltage after a cut");
}

#[test]
fn a_sagging_supply_slows_servos_and_leaves_burn_wires_too_cold() {
    let mut rig = rig_with(Fault::SupplySag { open_circuit_v: 2.5, source_ohm: 0.0 }, 0.0);
    rig.heaters = vec![Duty::OFF; 2];
    rig.servos = vec![Some(PulseMicros(2_500)); 2];
    rig.springs = vec![true; 2];
    rig.run(0.4);
    // Half of 375 degrees a second.
    assert_near(rig.plant.servo_hinges()[0].angle_deg(), 75.0, 1e-6, "servo");
    rig.run(2.0);
    assert!(!rig.plant.spring_hinges()[0].released());
}

#[test]
fn a_stalled_servo_stays_and_draws_its_stall_current_even_where_it_is_told_to_be() {
    let mut rig = rig_with(Fault::ServoStalled(0), 0.0);
    rig.heaters = vec![Duty::OFF; 2];
    rig.servos = vec![Some(PulseMicros(500)); 2];
    rig.run(0.5);
    let [stalled, sound] = rig.plant.servo_hinges() else { panic!("two servos") };
    assert_eq!((stalled.activity(), sound.activity()), (ServoActivity::Stalled, ServoActivity::Holding));
    assert_near(rig.plant.supply_a(), 1.8 + 0.005, 1e-9, "stall current, and one idle servo");
    rig.servos = vec![Some(PulseMicros(1_500)); 2];
    rig.run(1.0);
    assert_near(rig.plant.servo_hinges()[0].angle_deg(), 0.0, 0.0, "its angle");
    rig.servos = vec![None; 2];
    rig.run(0.01);
    assert_near(rig.plant.supply_a(), 0.01, 1e-9, "limp, it draws no more than its neighbour");
}

#[test]
fn a_fault_with_an_impossible_number_is_refused_and_breaks_nothing() {
    let mut rig = rig_with(Fault::ThermistorLoose(1), 0.0);
    for fault in [
        Fault::HeaterShorted { channel: 0, ohm: 0.0 },
        Fault::ThermistorDrifting { channel: 0, kelvin_per_s: f64::NAN },
        Fault::SupplySag { open_circuit_v: 0.0, source_ohm: 0.1 },
        Fault::SupplySag { open_circuit_v: 5.0, source_ohm: -0.1 },
    ] {
        assert!(matches!(rig.plant.inject(fault), Err(PlantError::Value { .. })), "{fault:?}");
    }
    rig.run(0.01);
    assert_near(rig.plant.supply_a(), 0.4 + 0.01, 1e-9, "two heaters and two idle servos");
}
