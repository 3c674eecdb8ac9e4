//! What a hinge of each kind is driven with: every setting with its default, shared by all hinges of the kind
//! in `[sma]`, `[servo]` and `[spring]`, or given for one hinge in `[hinge.sma]` and so on.

use super::quantity::{
    Amps, Celsius, DegreesPerSecond, Joules, Kelvins, KelvinsPerWatt, NewtonMetres, Ohms, Seconds,
};
use super::rating::Rating;
use super::servo_curve::ServoCurve;
use serde::Deserialize;

/// Defines a set of settings, and the table of a rig file in which each of them may stand or not. What is `measured` stands in no rig
/// file: a calibration has it.
macro_rules! settings {
    ($(#[$doc:meta])* $name:ident, $table:ident { $($(#[$field_doc:meta])* $field:ident: $ty:ty = $default:expr,)+ }
     $(measured { $(#[$measured_doc:meta])* $measured:ident: $measured_ty:ty })?) => {
        $(#[$doc])*
        #[derive(Debug, Clone, Copy, PartialEq)]
        pub struct $name {
            $($(#[$field_doc])* pub $field: $ty,)+
            $($(#[$measured_doc])* pub $measured: Option<$measured_ty>,)?
        }

        #[derive(Debug, Clone, Default, Deserialize)]
        #[serde(deny_unknown_fields, default)]
        pub(super) struct $table {
            $($field: Option<$ty>,)+
        }

        impl $name {
            /// A hinge's own setting, else the shared one, else the default.
            pub(super) fn resolve(own: Option<&$table>, shared: &$table) -> Self {
                Self {
                    $($field: own.and_then(|own| own.$field).or(shared.$field).unwrap_or($default),)+
                    $($measured: None,)?
                }
            }
        }
    };
}
pub(super) use settings;

/// A pulse outside makes no servo move: 100 us to 10 ms.
pub(super) const SERVO_PULSES: (Seconds, Seconds) = (Seconds(1e-4), Seconds(1e-2));

settings! {
    /// How a shape-memory hinge is heated, and what is known of it.
    SmaSettings, SmaTable {
        /// Temperature to heat to; well above `austenite_finish`.
        target: Celsius = Celsius(95.0),
        /// How long the target is held before the hinge counts as opened.
        hold: Seconds = Seconds(1.0),
        /// Longest time that the heater may be on for one motion (S4).
        max_on: Seconds = Seconds(20.0),
        /// Hotter than this is a fault (S4).
        max_temperature: Celsius = Celsius(120.0),
        /// The hinge counts as cooled at this temperature.
        cool_to: Celsius = Celsius(45.0),
        /// Least time without heating after a motion (S4).
        rest: Seconds = Seconds(1.0),
        /// While heating, a rise below this in `gain_window` is a fault (S6).
        min_gain: Kelvins = Kelvins(5.0),
        /// See `min_gain`.
        gain_window: Seconds = Seconds(3.0),
        /// Resistance of the film heater.
        heater_resistance: Ohms = Ohms(25.0),
        /// Rise above the ambience per watt, when settled.
        thermal_resistance: KelvinsPerWatt = KelvinsPerWatt(115.0),
        /// Time in which the difference to the settled temperature shrinks to 1/e.
        time_constant: Seconds = Seconds(5.5),
        /// Energy that the transformation from `austenite_start` to `austenite_finish` takes up.
        latent_heat: Joules = Joules(1.0),
        /// Here the hinge begins to open.
        austenite_start: Celsius = Celsius(68.0),
        /// Here the hinge has opened.
        austenite_finish: Celsius = Celsius(78.0),
        /// The most that it lifts or holds.
        torque: Rating = Rating::constant(NewtonMetres(0.034)),
    }
}

settings! {
    /// How a servo hinge is moved.
    ServoSettings, ServoTable {
        /// Pulse that holds the hinge closed (opening angle 0).
        pulse_0: Seconds = Seconds(500e-6),
        /// Pulse that holds the hinge at an opening angle of 270 degrees.
        pulse_270: Seconds = Seconds(2500e-6),
        /// Nothing drives it with a shorter pulse.
        shortest_pulse: Seconds = SERVO_PULSES.0,
        /// Nothing drives it with a longer pulse.
        longest_pulse: Seconds = SERVO_PULSES.1,
        /// Speed at which the pulse is led from one angle to the other.
        speed: DegreesPerSecond = DegreesPerSecond(90.0),
        /// Wait after the last pulse change, before the hinge counts as opened.
        settle: Seconds = Seconds(0.2),
        /// Current while moving.
        current: Amps = Amps(0.25),
        /// Current of a servo that holds its angle, until the run ends.
        hold_current: Amps = Amps(0.01),
        /// The most that it lifts or holds.
        torque: Rating = Rating::constant(NewtonMetres(0.17)),
    }
    measured {
        /// Pulses by opening angle as they were found; they count more than `pulse_0` and `pulse_270`.
        curve: ServoCurve
    }
}

settings! {
    /// How a spring hinge is released.
    SpringSettings, SpringTable {
        /// How long the burn wire or latch is energised.
        pulse: Seconds = Seconds(1.2),
        /// Wait after the pulse, before the hinge counts as opened.
        settle: Seconds = Seconds(0.5),
        /// Current of the burn wire or latch.
        current: Amps = Amps(1.0),
        /// The most that it lifts or holds.
        torque: Rating = Rating::constant(NewtonMetres(0.05)),
    }
}

/// What moves a hinge.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Deserialize, serde::Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Kind {
    /// Shape-memory alloy under a film heater.
    Sma,
    /// Hobby servo.
    Servo,
    /// Spring behind a burn wire or a latch.
    Spring,
}

impl Kind {
    /// Every kind.
    pub const ALL: [Self; 3] = [Self::Sma, Self::Servo, Self::Spring];

    /// The word for it in a rig file.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Sma => "sma",
            Self::Servo => "servo",
            Self::Spring => "spring",
        }
    }

    /// The key of a `[[node]]` that counts its channels.
    pub const fn channel_key(self) -> &'static str {
        match self {
            Self::Sma => "heaters",
            Self::Servo => "servos",
            Self::Spring => "springs",
        }
    }
}

/// The settings of one hinge.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Drive {
    /// Shape-memory alloy under a film heater.
    Sma(SmaSettings),
    /// Hobby servo.
    Servo(ServoSettings),
    /// Spring behind a burn wire or a latch.
    Spring(SpringSettings),
}

impl Drive {
    /// What moves the hinge.
    pub const fn kind(&self) -> Kind {
        match self {
            Self::Sma(_) => Kind::Sma,
            Self::Servo(_) => Kind::Servo,
            Self::Spring(_) => Kind::Spring,
        }
    }

    /// The most torque that the hinge lifts or holds.
    pub const fn torque(&self) -> &Rating {
        match self {
            Self::Sma(sma) => &sma.torque,
            Self::Servo(servo) => &servo.torque,
            Self::Spring(spring) => &spring.torque,
        }
    }
}
