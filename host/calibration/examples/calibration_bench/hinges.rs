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

/// How far hinges differ.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Spread {
    /// Over the ranges of the plant page.
    Plant,
    /// Far beyond them.
    Wide,
}

impl Subject {
    /// The hinge of a seed.
    pub(crate) fn new(seed: u64, spread: Spread) -> Self {
        let mut chance = Chance::new(seed);
        let wide = spread == Spread::Wide;
        let mut pick = |(low, high): (f64, f64), (lower, higher): (f64, f64)| {
            if wide { chance.between(lower, higher) } else { chance.between(low, high) }
        };
        let mut hinge = SmaConfig::opening(180.0);
        let (broad, long) = (pick((0.85, 1.15), (0.7, 1.3)), pick((0.85, 1.15), (0.7, 1.3)));
        hinge.foil_width_m *= broad;
        hinge.foil_length_m *= long;
        hinge.foil_thickness_m = pick((0.10e-3, 0.15e-3), (0.08e-3, 0.2e-3));
        hinge.heater_ohm = pick((15.0, 35.0), (12.0, 45.0));
        hinge.film_j_per_k *= broad * long * pick((0.8, 1.2), (0.6, 1.5));
        hinge.coupling_w_per_k *= broad * long * pick((0.7, 1.3), (0.5, 2.0));
        hinge.convection_w_per_m2_k = pick((20.0, 70.0), (12.0, 90.0));
        hinge.panel_w_per_k = pick((1.0e-3, 8.0e-3), (0.5e-3, 10.0e-3));
        hinge.load_mn_m = pick((0.0, 20.0), (0.0, 30.0));
        hinge.thermistor = ThermistorConfig {
            lag_s: pick((0.1, 0.6), (0.05, 1.2)),
            noise_counts: pick((0.5, 2.0), (0.0, 4.0)),
            ..ThermistorConfig::default()
        };
        let latent = pick((0.8, 1.2), (0.6, 1.4));
        let supply = SupplyConfig {
            open_circuit_v: pick((5.0, 5.0), (4.0, 6.5)),
            source_ohm: pick((0.02, 1.0), (0.0, 2.0)),
            ..SupplyConfig::default()
        };
        let ambient_c = pick((15.0, 30.0), (5.0, 36.0));
        let nominal = Nominal::default();
        // Either alloy of the plant page, or one in between, sold as the nearer one.
        let blend = match chance.below(3) {
            0 => 0.0,
            1 => 1.0,
            _ => chance.share(),
        };
        let sold_as = if blend < 0.5 { Nominal::LOW_TEMPERATURE } else { Nominal::HIGH_TEMPERATURE };
        hinge.alloy = alloy(blend, latent, &mut chance);
        let config =
            Config { ambient_c, supply, heaters: vec![hinge], seed: chance.bits(), ..Config::default() };
        Self { config, hinge, nominal: Nominal { transformation: sold_as, ..nominal } }
    }

    /// Whether full power takes it past Af within one pulse, some kelvins to spare.
    pub(crate) fn can_reach_af(&self, longest_s: f64) -> bool {
        const SPARE_K: f64 = 4.0;
        let supply = &self.config.supply;
        let loop_ohm = self.hinge.heater_ohm + supply.source_ohm;
        let power_w = (supply.open_circuit_v / loop_ohm).powi(2) * self.hinge.heater_ohm;
        let rise_k = self.truth(Quantity::FoilRise) * power_w;
        let past_k = rise_k - (self.hinge.alloy.af_c + SPARE_K - self.config.ambient_c);
        // Latent heat comes on top of what it takes to warm.
        let tau_s = self.truth(Quantity::TimeConstant);
        let latent_s = self.hinge.latent_j() / past_k.max(0.1) * self.truth(Quantity::ThermalResistance);
        past_k > 0.0 && tau_s * (rise_k / past_k).ln() + latent_s < longest_s
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
fn alloy(blend: f64, latent: f64, chance: &mut Chance) -> Alloy {
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
        latent_j_per_kg: low.latent_j_per_kg * latent,
        ..low
    }
}
