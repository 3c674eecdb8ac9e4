//! Random hinges: physics spread over what real parts are like, and a step that a sound one completes.

use crate::judge::margin_k;
use serde_json::{Value, json};
use zygote_sim::plant::{Alloy, ServoConfig, SmaConfig, SpringConfig, SupplyConfig};
use zygote_sim::{CEILING, Chance};

/// A hinge as it truly is.
#[derive(Debug, Clone, Copy)]
pub(super) enum Physics {
    Sma(SmaConfig),
    Servo(ServoConfig),
    Spring(SpringConfig),
}

/// A hinge and the step that opens it.
#[derive(Debug, Clone)]
pub(super) struct Specimen {
    pub(super) physics: Physics,
    pub(super) opening_deg: u16,
    /// What it draws at most, and when it is open, in mA.
    pub(super) current_ma: u64,
    pub(super) hold_current_ma: u64,
    /// The `motion` of a schedule's step.
    pub(super) motion: Value,
}

impl Specimen {
    /// The word for its kind in a rig file.
    pub(super) fn kind(&self) -> &'static str {
        match self.physics {
            Physics::Sma(_) => "sma",
            Physics::Servo(_) => "servo",
            Physics::Spring(_) => "spring",
        }
    }
}

/// Any hinge; every second one is of shape-memory alloy.
pub(super) fn any(chance: &mut Chance, supply: &SupplyConfig, ambient_c: f64) -> Specimen {
    let opening_deg = [90, 180, 270][chance.below(3)];
    match chance.below(4) {
        0 => servo(chance, opening_deg),
        1 => spring(chance, supply, opening_deg),
        _ => sma(chance, supply, ambient_c, opening_deg),
    }
}

/// Any hinge of shape-memory alloy.
pub(super) fn heated(chance: &mut Chance, supply: &SupplyConfig, ambient_c: f64) -> Specimen {
    sma(chance, supply, ambient_c, 180)
}

fn sma(chance: &mut Chance, supply: &SupplyConfig, ambient_c: f64, opening_deg: u16) -> Specimen {
    const TRIES: usize = 50;
    let opening = f64::from(opening_deg);
    let mut specimen = sma_with(SmaConfig::opening(opening), 15.0, supply, ambient_c, opening_deg);
    for _ in 0..TRIES {
        let shift_k = chance.between(-8.0, 5.0);
        let alloy = Alloy::LOW_TEMPERATURE;
        let mut sma = SmaConfig {
            overdrive: chance.between(1.02, 1.15),
            load_mn_m: chance.between(0.0, 0.5),
            alloy: Alloy {
                mf_c: alloy.mf_c + shift_k,
                ms_c: alloy.ms_c + shift_k,
                as_c: alloy.as_c + shift_k,
                af_c: alloy.af_c + shift_k,
                ..alloy
            },
            foil_width_m: chance.between(4.0e-3, 7.0e-3),
            foil_thickness_m: chance.between(0.1e-3, 0.15e-3),
            film_j_per_k: chance.between(0.006, 0.02),
            coupling_w_per_k: chance.between(0.05, 0.15),
            convection_w_per_m2_k: chance.between(20.0, 70.0),
            panel_w_per_k: chance.between(0.002, 0.006),
            ..SmaConfig::opening(opening)
        };
        sma.thermistor.lag_s = chance.between(0.1, 0.45);
        sma.thermistor.noise_counts = chance.between(0.3, 1.5);
        let wanted = sma_with(sma, chance.between(15.0, 40.0), supply, ambient_c, opening_deg);
        if fits_the_board(&wanted, supply) {
            specimen = wanted;
            break;
        }
    }
    specimen
}

/// The heater is made so strong that the foil would settle `reserve_k` above the target.
fn sma_with(
    mut sma: SmaConfig,
    reserve_k: f64,
    supply: &SupplyConfig,
    ambient_c: f64,
    opening_deg: u16,
) -> Specimen {
    let target_c = sma.alloy.af_c + 12.0;
    let (film, foil) = (sma.film_loss_w_per_k(), sma.foil_loss_w_per_k());
    // Both nodes settled: P = (T - T_air) (G_foil + G_film + G_foil G_film / k).
    let power_w = (target_c + reserve_k - ambient_c) * (foil + film + foil * film / sma.coupling_w_per_k);
    let volts = supply.open_circuit_v;
    sma.heater_ohm = volts * volts / power_w;
    let max_c = target_c + 6.0 + 0.7 * margin_k(&sma, volts, sma.heater_ohm, target_c);
    let motion = json!({
        "kind": "sma",
        "target_centi_celsius": centi(target_c),
        "hold_ms": 500,
        "max_on_ms": 45_000,
        "max_temperature_centi_celsius": centi(max_c),
        "cool_to_centi_celsius": centi(sma.alloy.as_c - 8.0),
        "rest_ms": 500,
        "min_gain_centi_celsius": 400,
        "gain_window_ms": 3_000,
    });
    let current_ma = milliamps(volts / sma.heater_ohm);
    Specimen { physics: Physics::Sma(sma), opening_deg, current_ma, hold_current_ma: 0, motion }
}

/// What a careful person looks at: with the margin of physics, the highest temperature stays under the ceiling.
fn fits_the_board(specimen: &Specimen, supply: &SupplyConfig) -> bool {
    let Physics::Sma(sma) = specimen.physics else { return true };
    let max_c = specimen.motion["max_temperature_centi_celsius"].as_f64().unwrap_or(f64::INFINITY) / 100.0;
    let most_c = max_c + margin_k(&sma, supply.open_circuit_v, sma.heater_ohm, max_c);
    most_c <= f64::from(CEILING.max_temperature.0) / 100.0
}

fn servo(chance: &mut Chance, opening_deg: u16) -> Specimen {
    let servo = ServoConfig {
        slew_deg_per_s: chance.between(250.0, 450.0),
        moving_ma: chance.between(100.0, 250.0),
        stall_ma: chance.between(600.0, 2_000.0),
        ..ServoConfig::default()
    };
    let speed_deg_per_s = chance.between(60.0, 180.0);
    let duration_ms = whole(f64::from(opening_deg) / speed_deg_per_s * 1e3);
    let to_us = whole(500.0 + 2_000.0 * f64::from(opening_deg) / 270.0);
    let motion =
        json!({ "kind": "servo", "from_us": 500, "to_us": to_us, "move_ms": duration_ms, "settle_ms": 200 });
    Specimen { physics: Physics::Servo(servo), opening_deg, current_ma: 300, hold_current_ma: 10, motion }
}

fn spring(chance: &mut Chance, supply: &SupplyConfig, opening_deg: u16) -> Specimen {
    let spring = SpringConfig {
        release_s: chance.between(0.3, 0.9),
        opening_s: chance.between(0.01, 0.1),
        wire_ohm: chance.between(5.0, 8.0),
        ..SpringConfig::opening(f64::from(opening_deg))
    };
    let motion = json!({ "kind": "spring", "pulse_ms": 1_200, "settle_ms": 300 });
    let current_ma = milliamps(supply.open_circuit_v / spring.wire_ohm);
    Specimen { physics: Physics::Spring(spring), opening_deg, current_ma, hold_current_ma: 0, motion }
}

fn centi(celsius: f64) -> u64 {
    whole(celsius * 100.0)
}

fn milliamps(amps: f64) -> u64 {
    whole((amps * 1e3).ceil())
}

fn whole(value: f64) -> u64 {
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "small, and above 0 by construction"
    )]
    let whole = value.round().max(0.0) as u64;
    whole
}
