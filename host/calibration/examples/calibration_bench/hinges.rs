//! Random hinges over the ranges of the plant page, and what is known of each before it is measured.

use zygote_calibration::{Nominal, Quantity, Transformation};
use zygote_sim::Chance;
use zygote_sim::plant::{Alloy, Config, SmaConfig, SupplyConfig, ThermistorConfig};

/// A hinge on a supply, and its data sheet.
pub(crate) struct Subject {
    pub(crate) config: Config,
    pub(crate) hinge: SmaConfig,
    pub(crate) nominal: Nominal,
}

impl Subject {
    /// The hinge of a seed.
    pub(crate) fn new(seed: u64) -> Self {
        let mut chance = Chance::new(seed);
        let nominal = Nominal::default();
        // Either alloy of the plant page, or one in between, sold as the nearer one.
        let blend = match chance.below(3) {
            0 => 0.0,
            1 => 1.0,
            _ => chance.share(),
        };
        let alloy = alloy(blend, &mut chance);
        let sold_as = if blend < 0.5 { Nominal::LOW_TEMPERATURE } else { Nominal::HIGH_TEMPERATURE };
        let mut hinge = SmaConfig::opening(180.0);
        let (wide, long) = (chance.between(0.85, 1.15), chance.between(0.85, 1.15));
        hinge.foil_width_m *= wide;
        hinge.foil_length_m *= long;
        hinge.foil_thickness_m = chance.between(0.10e-3, 0.15e-3);
        hinge.alloy = alloy;
        hinge.heater_ohm = chance.between(15.0, 35.0);
        hinge.film_j_per_k *= wide * long * chance.between(0.8, 1.2);
        hinge.coupling_w_per_k *= wide * long * chance.between(0.7, 1.3);
        hinge.convection_w_per_m2_k = chance.between(20.0, 70.0);
        hinge.panel_w_per_k = chance.between(1.0e-3, 8.0e-3);
        hinge.load_mn_m = chance.between(0.0, 20.0);
        hinge.thermistor = ThermistorConfig {
            lag_s: chance.between(0.1, 0.6),
            noise_counts: chance.between(0.5, 2.0),
            ..ThermistorConfig::default()
        };
        let supply = SupplyConfig { source_ohm: chance.between(0.02, 1.0), ..SupplyConfig::default() };
        let config = Config {
            ambient_c: chance.between(15.0, 30.0),
            supply,
            heaters: vec![hinge],
            seed: chance.bits(),
            ..Config::default()
        };
        Self { config, hinge, nominal: Nominal { transformation: sold_as, ..nominal } }
    }

    /// What a perfect calibration would say.
    pub(crate) fn truth(&self, quantity: Quantity) -> f64 {
        let hinge = &self.hinge;
        let (film, foil) = (hinge.film_loss_w_per_k(), hinge.foil_loss_w_per_k());
        let resistance = 1.0 / (film + foil);
        match quantity {
            Quantity::ThermalResistance => resistance,
            Quantity::TimeConstant => (hinge.film_j_per_k + hinge.foil_j_per_k()) * resistance,
            Quantity::HeaterResistance => hinge.heater_ohm,
            Quantity::LatentHeat => hinge.latent_j(),
            Quantity::AusteniteStart => hinge.alloy.as_c,
            Quantity::AusteniteFinish => hinge.alloy.af_c,
            Quantity::MartensiteStart => hinge.alloy.ms_c,
            Quantity::MartensiteFinish => hinge.alloy.mf_c,
            Quantity::FoilRise => 1.0 / (film + foil + film * foil / hinge.coupling_w_per_k),
            Quantity::ThermistorLag => hinge.thermistor.lag_s,
            Quantity::Opening => f64::NAN,
        }
    }
}

/// Between the low-temperature alloy (0) and the high-temperature one (1), each temperature 2 K off at most.
fn alloy(blend: f64, chance: &mut Chance) -> Alloy {
    let (low, high) = (Alloy::LOW_TEMPERATURE, Alloy::HIGH_TEMPERATURE);
    let mut between = |low: f64, high: f64| low + blend * (high - low) + chance.between(-2.0, 2.0);
    let at = Transformation {
        mf_c: between(low.mf_c, high.mf_c),
        ms_c: between(low.ms_c, high.ms_c),
        as_c: between(low.as_c, high.as_c),
        af_c: between(low.af_c, high.af_c),
    };
    Alloy {
        mf_c: at.mf_c,
        ms_c: at.ms_c,
        as_c: at.as_c,
        af_c: at.af_c,
        latent_j_per_kg: low.latent_j_per_kg * chance.between(0.8, 1.2),
        ..low
    }
}
