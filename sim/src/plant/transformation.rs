//! How much of a nitinol part is martensite, from its temperature history. [`super::sma`] asks while it heats
//! and cools the foil.
//!
//! ```text
//!            above As, warmer than ever on this branch
//!   Cooling ------------------------------------------> Heating
//!           <------------------------------------------
//!            below Ms, cooler than ever on this branch
//! ```

use core::f64::consts::PI;

use super::error::{Place, PlantError, positive};

/// What a nitinol alloy does and stores.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Alloy {
    /// Martensite finish: all martensite below, on cooling.
    pub mf_c: f64,
    /// Martensite start: the first martensite on cooling.
    pub ms_c: f64,
    /// Austenite start: the first austenite on heating.
    pub as_c: f64,
    /// Austenite finish: all austenite above, on heating.
    pub af_c: f64,
    /// Heat taken up by martensite turning into austenite, and given back on the way down.
    pub latent_j_per_kg: f64,
    /// Heat capacity of either phase.
    pub specific_heat_j_per_kg_k: f64,
    /// Density of either phase.
    pub density_kg_per_m3: f64,
}

impl Alloy {
    /// The alloy of low-temperature actuator wire. Temperatures as in public models of commercial wire at no
    /// load; 5.78 cal/g of latent heat, 0.20 cal/(g K) and 6.45 g/cm^3 are the usual data sheet of `NiTi`.
    pub const LOW_TEMPERATURE: Self = Self {
        mf_c: 42.0,
        ms_c: 52.0,
        as_c: 68.0,
        af_c: 78.0,
        latent_j_per_kg: 24_200.0,
        specific_heat_j_per_kg_k: 837.0,
        density_kg_per_m3: 6450.0,
    };

    /// The alloy of high-temperature actuator wire; sources as for [`Alloy::LOW_TEMPERATURE`].
    pub const HIGH_TEMPERATURE: Self =
        Self { mf_c: 62.0, ms_c: 72.0, as_c: 88.0, af_c: 98.0, ..Self::LOW_TEMPERATURE };

    /// Refuses an alloy whose temperatures are out of order. The branches below rely on Mf < As and Ms < Af:
    /// then nothing of the other phase is left where a branch has come to its end.
    pub(super) fn check(&self, place: Place) -> Result<(), PlantError> {
        let ordered = [
            ("Ms", self.ms_c, self.mf_c, "above Mf"),
            ("Af", self.af_c, self.as_c, "above As"),
            ("As", self.as_c, self.mf_c, "above Mf"),
            ("Af", self.af_c, self.ms_c, "above Ms"),
        ];
        for (quantity, got, floor, expected) in ordered {
            // Asked this way round, a NaN is refused too.
            if !(got > floor && got.is_finite() && floor.is_finite()) {
                return Err(PlantError::Value { place, quantity, got, expected });
            }
        }
        positive(place, "specific heat (J/(kg K))", self.specific_heat_j_per_kg_k)?;
        positive(place, "density (kg/m^3)", self.density_kg_per_m3)?;
        super::error::not_negative(place, "latent heat (J/kg)", self.latent_j_per_kg)
    }

    /// Share of the martensite that survives heating to `t_c`: 1 at As and below, 0 at Af and above.
    fn survives_heating(&self, t_c: f64) -> f64 {
        cosine_step((self.af_c - t_c) / (self.af_c - self.as_c))
    }

    /// Share of the austenite that survives cooling to `t_c`: 1 at Ms and above, 0 at Mf and below.
    fn survives_cooling(&self, t_c: f64) -> f64 {
        cosine_step((t_c - self.mf_c) / (self.ms_c - self.mf_c))
    }
}

/// Half a cosine that climbs from 0 at `x` = 0 to 1 at `x` = 1, and is flat outside.
fn cosine_step(x: f64) -> f64 {
    if x <= 0.0 {
        0.0
    } else if x >= 1.0 {
        1.0
    } else {
        (1.0 - libm::cos(PI * x)) / 2.0
    }
}

/// The transformation that went on last; `scale` is what the phase being consumed amounts to where the branch
/// begins, so that the branch passes through the point of reversal.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Branch {
    Heating { scale: f64 },
    Cooling { scale: f64 },
}

/// Martensite fraction with its history: the cosine kinetics of Liang and Rogers (1990) at no stress.
///
/// A branch is latched when the *transformation* reverses, not when the temperature does. Heating that is
/// interrupted above Ms is thus taken up where it stopped; latched on every change of temperature, a ripple on
/// a constant temperature would eat the martensite away.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Transformation {
    martensite: f64,
    branch: Branch,
}

impl Transformation {
    /// A part that was cooled to below Mf: all martensite.
    pub const MARTENSITE: Self = Self { martensite: 1.0, branch: Branch::Cooling { scale: 0.0 } };

    /// Share of martensite, 0 to 1.
    pub fn martensite(&self) -> f64 {
        self.martensite
    }

    /// Share of austenite, 0 to 1.
    pub fn austenite(&self) -> f64 {
        1.0 - self.martensite
    }

    /// The state after the temperature went straight from `from_c`, where it was, to `to_c`.
    #[must_use]
    pub fn moved(self, alloy: &Alloy, from_c: f64, to_c: f64) -> Self {
        if to_c > from_c { self.heated(alloy, from_c, to_c) } else { self.cooled(alloy, from_c, to_c) }
    }

    fn heated(self, alloy: &Alloy, from_c: f64, to_c: f64) -> Self {
        let after = alloy.survives_heating(to_c);
        let scale = match self.branch {
            Branch::Heating { scale } => scale,
            Branch::Cooling { .. } => {
                let before = alloy.survives_heating(from_c);
                if after >= before {
                    return self;
                }
                self.martensite / before
            }
        };
        Self { martensite: self.martensite.min(scale * after), branch: Branch::Heating { scale } }
    }

    fn cooled(self, alloy: &Alloy, from_c: f64, to_c: f64) -> Self {
        let after = alloy.survives_cooling(to_c);
        let scale = match self.branch {
            Branch::Cooling { scale } => scale,
            Branch::Heating { .. } => {
                let before = alloy.survives_cooling(from_c);
                if after >= before {
                    return self;
                }
                self.austenite() / before
            }
        };
        Self { martensite: self.martensite.max(1.0 - scale * after), branch: Branch::Cooling { scale } }
    }

    /// Fall of the martensite fraction per kelvin, were it moving on along its branch.
    pub(super) fn slope_per_k(&self, alloy: &Alloy) -> f64 {
        let (left, scale, width_k) = match self.branch {
            Branch::Heating { scale } => (self.martensite, scale, alloy.af_c - alloy.as_c),
            Branch::Cooling { scale } => (self.austenite(), scale, alloy.ms_c - alloy.mf_c),
        };
        if scale <= 0.0 {
            return 0.0;
        }
        // With y = (1 - cos(pi x)) / 2 is dy/dx = pi sqrt(y (1 - y)): no sine needed.
        let y = (left / scale).min(1.0);
        scale * PI * (y * (1.0 - y)).sqrt() / width_k
    }
}
