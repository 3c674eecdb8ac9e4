//! What a fit says of one parameter: a value with its interval, or why there is none.

use crate::diagnosis::Diagnosis;
use core::fmt;

/// A parameter of a hinge.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Quantity {
    /// 1 over the loss of film and foil to air and panels together.
    ThermalResistance,
    /// Heat capacity of film and foil, without latent heat, times the thermal resistance.
    TimeConstant,
    /// Resistance of the film heater.
    HeaterResistance,
    /// Latent heat of the whole foil.
    LatentHeat,
    /// The first austenite on heating.
    AusteniteStart,
    /// All austenite on heating.
    AusteniteFinish,
    /// The first martensite on cooling.
    MartensiteStart,
    /// All martensite on cooling.
    MartensiteFinish,
    /// Settled rise of the foil per watt: what the thermistor sees, some percent below the thermal resistance for
    /// the film is hotter and loses heat too.
    FoilRise,
    /// Lag of the thermistor behind the foil. With the film's it makes one delay, so its interval is wide.
    ThermistorLag,
    /// How far the hinge opens. No thermistor sees that, so it is never identified.
    Opening,
}

impl Quantity {
    /// All of them, in the order of reports.
    pub const ALL: [Self; 11] = [
        Self::ThermalResistance,
        Self::TimeConstant,
        Self::HeaterResistance,
        Self::LatentHeat,
        Self::AusteniteStart,
        Self::AusteniteFinish,
        Self::MartensiteStart,
        Self::MartensiteFinish,
        Self::FoilRise,
        Self::ThermistorLag,
        Self::Opening,
    ];

    /// For people and files.
    pub const fn name(self) -> &'static str {
        match self {
            Self::ThermalResistance => "thermal resistance",
            Self::TimeConstant => "time constant",
            Self::HeaterResistance => "heater resistance",
            Self::LatentHeat => "latent heat",
            Self::AusteniteStart => "austenite start",
            Self::AusteniteFinish => "austenite finish",
            Self::MartensiteStart => "martensite start",
            Self::MartensiteFinish => "martensite finish",
            Self::FoilRise => "foil rise",
            Self::ThermistorLag => "thermistor lag",
            Self::Opening => "opening",
        }
    }

    /// As a key of files.
    pub fn key(self) -> String {
        self.name().replace(' ', "_")
    }

    /// Its unit as files have it.
    pub fn ascii_unit(self) -> String {
        self.unit().replace('°', "deg")
    }

    /// Its unit.
    pub const fn unit(self) -> &'static str {
        match self {
            Self::ThermalResistance | Self::FoilRise => "K/W",
            Self::TimeConstant | Self::ThermistorLag => "s",
            Self::HeaterResistance => "ohm",
            Self::LatentHeat => "J",
            Self::AusteniteStart | Self::AusteniteFinish | Self::MartensiteStart | Self::MartensiteFinish => {
                "°C"
            }
            Self::Opening => "°",
        }
    }

    /// No half interval is narrower: what the model's steps in time and the edges of a drive resolve.
    pub(crate) const fn resolution(self) -> f64 {
        match self {
            Self::AusteniteStart | Self::AusteniteFinish | Self::MartensiteStart | Self::MartensiteFinish => {
                0.05
            }
            Self::ThermistorLag => 0.01,
            Self::ThermalResistance
            | Self::TimeConstant
            | Self::HeaterResistance
            | Self::LatentHeat
            | Self::FoilRise
            | Self::Opening => 0.0,
        }
    }

    /// The widest half interval that still counts as identified: a share of the value, or kelvins.
    pub(crate) const fn widest(self) -> Width {
        match self {
            Self::ThermalResistance | Self::TimeConstant | Self::HeaterResistance | Self::FoilRise => {
                Width::Share(0.05)
            }
            Self::LatentHeat => Width::Share(0.2),
            Self::AusteniteStart | Self::AusteniteFinish => Width::Absolute(2.0),
            Self::MartensiteStart | Self::MartensiteFinish => Width::Absolute(3.0),
            Self::ThermistorLag => Width::Absolute(0.3),
            Self::Opening => Width::Absolute(0.0),
        }
    }
}

impl fmt::Display for Quantity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// A half interval.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Width {
    /// As a share of the value.
    Share(f64),
    /// In the unit of the value.
    Absolute(f64),
}

/// A value that lies between `low` and `high` 95 times in 100.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Interval {
    /// The best one.
    pub value: f64,
    /// Lower end.
    pub low: f64,
    /// Upper end.
    pub high: f64,
}

/// Identified or not.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Verdict {
    /// The data have it.
    Identified(Interval),
    /// They don't, so no value is given.
    NotIdentified {
        /// Why not.
        why: Why,
    },
}

/// One parameter.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Estimate {
    /// Which one.
    pub quantity: Quantity,
    /// What the data say of it.
    pub verdict: Verdict,
}

/// Why a parameter has no value.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum Why {
    /// Something is broken.
    #[error(transparent)]
    Fault(Diagnosis),
    /// There are too few samples of that.
    #[error("the record has no {missing}")]
    TooShort {
        /// What it lacks.
        missing: &'static str,
    },
    /// The foil stayed colder than the transformation reaches.
    #[error(
        "the foil got {highest_c:.1} °C hot, expected to pass {expected_c:.1} °C; the supply is too weak, the pulse too short or the limit too low"
    )]
    NotReached {
        /// Highest temperature of the foil.
        highest_c: f64,
        /// What it had to pass.
        expected_c: f64,
    },
    /// The foil stayed warmer than the transformation reaches.
    #[error(
        "the foil cooled to {lowest_c:.1} °C, expected to fall below {expected_c:.1} °C; it is too warm here, or the rest too short"
    )]
    NotCooled {
        /// Lowest temperature of the foil after it was hot.
        lowest_c: f64,
        /// What it had to pass.
        expected_c: f64,
    },
    /// Many values fit the data equally well.
    #[error("the data leave ±{half:.3} {unit} of {value:.3} {unit}, expected ±{most:.3} {unit} at most")]
    TooWide {
        /// What would be the best value.
        value: f64,
        /// Half the interval.
        half: f64,
        /// The widest that is accepted.
        most: f64,
        /// Unit of all three.
        unit: &'static str,
    },
    /// The model doesn't follow the readings.
    #[error(
        "the model misses the readings by {rmse_k:.2} K (rms), expected {most_k:.2} K at most: the hinge doesn't behave as the model says, or a part of it failed meanwhile"
    )]
    Misfit {
        /// Root of the mean square residual.
        rmse_k: f64,
        /// The most that is accepted.
        most_k: f64,
    },
    /// The held-out pulse isn't predicted.
    #[error(
        "the held-out pulse is predicted with an error of {rmse_k:.2} K (rms), expected {most_k:.2} K at most"
    )]
    HeldOut {
        /// Root of the mean square error.
        rmse_k: f64,
        /// The most that is accepted.
        most_k: f64,
    },
    /// A reading of the angle is needed.
    #[error("a thermistor doesn't see the angle: a jammed hinge heats like a free one; watch it open")]
    AngleUnseen,
}
