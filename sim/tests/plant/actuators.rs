//! Servos and springs.

use core::time::Duration;

use proptest::prelude::*;
use zygote_core::{Duty, PulseMicros};
use zygote_sim::plant::{
    Config, Drive, Plant, PlantError, ServoActivity, ServoConfig, SmaConfig, SpringConfig, SupplyConfig,
};

use crate::rig::{Rig, TICK, assert_near, stiff_supply};

fn servo_deg(rig: &Rig) -> f64 {
    rig.plant.servo_hinges()[0].angle_deg()
}

fn spring_deg(rig: &Rig) -> f64 {
    rig.plant.spring_hinges()[0].angle_deg()
}

#[test]
fn a_servo_slews_to_its_pulse_and_draws_more_while_it_moves() {
    let servo = ServoConfig::default();
    let mut rig = Rig::servo(servo);
    // 1500 us is the middle of 500 to 2500 us: 135°, at 375 °/s 0.36 s away.
    rig.servos[0] = Some(PulseMicros(1500));
    rig.run(0.2);
    assert_near(servo_deg(&rig), 0.2 * servo.slew_deg_per_s, 1e-9, "on its way");
    assert_near(rig.plant.supply_a(), servo.moving_ma / 1000.0, 1e-12, "moving current");
    rig.run(0.2);
    assert_near(servo_deg(&rig), 135.0, 1e-9, "arrived");
    assert_near(rig.plant.supply_a(), servo.idle_ma / 1000.0, 1e-12, "holding current");
    assert_eq!(rig.plant.servo_hinges()[0].activity(), ServoActivity::Holding);
}

#[test]
fn a_servo_is_as_slow_as_its_supply_is_low() {
    let supply = SupplyConfig { open_circuit_v: 4.0, ..stiff_supply() };
    let servo = ServoConfig::default();
    let mut rig = Rig::new(&Config { supply, servos: vec![servo], ..Config::default() });
    rig.servos[0] = Some(PulseMicros(1500));
    rig.run(0.2);
    assert_near(servo_deg(&rig), 0.2 * servo.slew_deg_per_s * 4.0 / servo.rated_v, 1e-9, "at 4 V");
}

#[test]
fn a_servo_ignores_what_lies_in_its_dead_band() {
    let mut rig = Rig::servo(ServoConfig::default());
    rig.servos[0] = Some(PulseMicros(1500));
    rig.run(1.0);
    // 2 us are 0.27°, 4 us are 0.54°; the dead band is 0.4°.
    rig.servos[0] = Some(PulseMicros(1502));
    rig.run(0.1);
    assert_near(servo_deg(&rig), 135.0, 1e-9, "within the dead band");
    rig.servos[0] = Some(PulseMicros(1504));
    rig.run(0.1);
    assert_near(servo_deg(&rig), 135.54, 1e-9, "beyond it");
}

#[test]
fn a_servo_without_pulse_or_power_is_limp_and_stays() {
    let mut rig = Rig::servo(ServoConfig::default());
    rig.servos[0] = Some(PulseMicros(2500));
    rig.run(0.1);
    let here_deg = servo_deg(&rig);
    rig.servos[0] = None;
    rig.run(1.0);
    assert_near(servo_deg(&rig), here_deg, 0.0, "without pulse");
    rig.servos[0] = Some(PulseMicros(2500));
    rig.main_switch = false;
    rig.run(1.0);
    assert_near(servo_deg(&rig), here_deg, 0.0, "without power");
    assert_eq!(rig.plant.servo_hinges()[0].activity(), ServoActivity::Limp);
    assert_near(rig.plant.supply_a(), 0.0, 0.0, "current without power");
}

#[test]
fn a_servo_commanded_past_its_end_stop_stalls_there() {
    let servo = ServoConfig { stop_high_deg: 90.0, ..ServoConfig::default() };
    let mut rig = Rig::servo(servo);
    rig.servos[0] = Some(PulseMicros(2000));
    rig.run(1.0);
    assert_near(servo_deg(&rig), 90.0, 0.0, "at the stop");
    assert_eq!(rig.plant.servo_hinges()[0].activity(), ServoActivity::Stalled);
    assert_near(rig.plant.supply_a(), servo.stall_ma / 1000.0, 1e-12, "stall current");
}

#[test]
fn a_bowed_servo_is_off_its_line_in_the_middle_and_on_it_at_the_ends() {
    let servo = ServoConfig { bow_deg: 20.0, ..ServoConfig::default() };
    let mut rig = Rig::servo(servo);
    for (pulse, angle) in [(500, 0.0), (1000, 67.5 + 15.0), (1500, 155.0), (2500, 270.0)] {
        rig.servos[0] = Some(PulseMicros(pulse));
        rig.run(1.0);
        assert_near(servo_deg(&rig), angle, 1e-9, "at its angle");
    }
    let too_bowed = ServoConfig { bow_deg: 67.5, ..ServoConfig::default() };
    let config = Config { servos: vec![too_bowed], ..Config::default() };
    let refusal = Plant::new(&config).expect_err("a servo that turns back").to_string();
    assert!(refusal.contains("servo 0: way less four times the bow"), "{refusal}");
}

#[test]
fn a_hinge_with_backlash_stands_short_of_its_pulse_on_either_side_and_reaches_its_stops() {
    let servo = ServoConfig { backlash_deg: 3.0, stop_high_deg: 200.0, ..ServoConfig::default() };
    let mut rig = Rig::servo(servo);
    for (pulse, angle) in [(1500, 133.5), (1000, 69.0), (1010, 69.0), (2500, 200.0)] {
        rig.servos[0] = Some(PulseMicros(pulse));
        rig.run(1.0);
        assert_near(servo_deg(&rig), angle, 1e-9, "behind its motor");
    }
    assert_eq!(rig.plant.servo_hinges()[0].activity(), ServoActivity::Stalled);
}

proptest! {
    #[test]
    fn a_servo_never_leaves_its_stops_nor_outruns_its_slew_rate(
        pulses in prop::collection::vec(prop::option::of(0u16..4000), 1..40),
        stop_low_deg in 0.0..60.0, stop_high_deg in 100.0..270.0,
    ) {
        let servo = ServoConfig { start_deg: 80.0, stop_low_deg, stop_high_deg, ..ServoConfig::default() };
        let mut rig = Rig::servo(servo);
        for pulse in pulses {
            rig.servos[0] = pulse.map(PulseMicros);
            let before_deg = servo_deg(&rig);
            rig.step(Duration::from_millis(50));
            prop_assert!((stop_low_deg..=stop_high_deg).contains(&servo_deg(&rig)));
            prop_assert!((servo_deg(&rig) - before_deg).abs() <= servo.slew_deg_per_s * 0.05 + 1e-9);
        }
    }
}

#[test]
fn a_spring_opens_in_milliseconds_once_its_wire_was_hot_long_enough_and_never_closes() {
    let spring = SpringConfig::opening(180.0);
    let mut rig = Rig::spring(spring);
    rig.springs[0] = true;
    rig.run(0.795);
    assert!(!rig.plant.spring_hinges()[0].released(), "5 ms too early");
    assert_near(spring_deg(&rig), 0.0, 0.0, "held");
    rig.step(TICK);
    assert!(rig.plant.spring_hinges()[0].released(), "at the release time");
    rig.run(0.015);
    assert_near(spring_deg(&rig), 45.0, 1e-6, "a quarter of the way at half of its 30 ms");
    rig.run(0.02);
    assert_near(spring_deg(&rig), 180.0, 0.0, "open");
    assert_near(rig.plant.supply_a(), 1.0, 1e-12, "the wire conducts while it is energised");
    rig.springs[0] = false;
    rig.run(10.0);
    assert_near(spring_deg(&rig), 180.0, 0.0, "still open");
    assert_near(rig.plant.supply_a(), 0.0, 0.0, "current of a wire that is off");
}

#[test]
fn a_burn_wire_that_is_switched_off_in_between_starts_over() {
    let mut rig = Rig::spring(SpringConfig::opening(90.0));
    for _ in 0..20 {
        rig.springs[0] = true;
        rig.run(0.7);
        rig.springs[0] = false;
        rig.run(0.1);
    }
    assert!(!rig.plant.spring_hinges()[0].released());
}

#[test]
fn a_drive_with_too_few_outputs_is_refused_and_time_stands_still() {
    let config =
        Config { heaters: vec![SmaConfig::opening(90.0), SmaConfig::opening(90.0)], ..Config::default() };
    let mut plant = Plant::new(&config).expect("a sound configuration");
    let short = Drive { heaters: &[Duty::FULL], servos: &[], springs: &[], main_switch: true };
    let refusal = plant.advance(Duration::from_secs(1), &short).expect_err("one duty for two heaters");
    assert_eq!(refusal, PlantError::Drive { kind: "heater duties", expected: 2, got: 1 });
    assert_near(plant.sma_hinges()[0].temperature_c(), 22.0, 0.0, "nothing happened");
    let spare = Drive { heaters: &[Duty::FULL; 16], servos: &[None; 4], springs: &[], main_switch: true };
    plant.advance(Duration::from_secs(1), &spare).expect("outputs with nothing on them");
    assert!(plant.sma_hinges()[1].temperature_c() > 30.0, "the heaters that there are get warm");
}

#[test]
fn numbers_that_no_hinge_can_have_are_refused_by_name() {
    type Change = fn(&mut Config);
    let broken = |change: Change| {
        let mut config = Config {
            heaters: vec![SmaConfig::opening(90.0), SmaConfig::opening(90.0)],
            servos: vec![ServoConfig::default()],
            springs: vec![SpringConfig::opening(90.0)],
            ..Config::default()
        };
        change(&mut config);
        Plant::new(&config).expect_err("a number out of range").to_string()
    };
    let cases: [(&str, Change); 8] = [
        ("room: temperature (°C) is NaN", |config| config.ambient_c = f64::NAN),
        ("supply: source resistance (Ohm) is -1", |config| config.supply.source_ohm = -1.0),
        ("heater 1: heater (Ohm) is 0", |config| config.heaters[1].heater_ohm = 0.0),
        ("heater 0: Af is 60, expected above As", |config| config.heaters[0].alloy.af_c = 60.0),
        ("heater 0: ambient (°C) is 70, expected at most As", |config| config.ambient_c = 70.0),
        ("heater 1: time constant between film and foil", |config| config.heaters[1].film_j_per_k = 1e-9),
        ("servo 0: slew rate (°/s) is inf", |config| config.servos[0].slew_deg_per_s = f64::INFINITY),
        ("spring 0: opening time (s) is 0", |config| config.springs[0].opening_s = 0.0),
    ];
    for (expected, change) in cases {
        let message = broken(change);
        assert!(message.contains(expected), "expected \"{expected}\" in \"{message}\"");
    }
}
