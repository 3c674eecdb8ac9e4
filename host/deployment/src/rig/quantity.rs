//! Physical quantities as a person writes them in a rig file, `"500 mA"`: one newtype a unit, in SI inside.

use serde::de::{self, Deserialize, Deserializer, Visitor};
use std::{fmt, str::FromStr};

/// A text that isn't the quantity that it should be.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("expected {expected}, found \"{found}\"")]
pub struct QuantityError {
    /// What stands there in a good file.
    pub expected: &'static str,
    /// What stands there.
    pub found: String,
}

/// Reads a number followed by one of the units, and returns it in the unit whose factor is 1.
fn parse(text: &str, units: &[(&str, f64)]) -> Option<f64> {
    let text = text.trim();
    let split = text.find(|c: char| !(c.is_ascii_digit() || matches!(c, '+' | '-' | '.')))?;
    let (number, unit) = text.split_at(split);
    let value: f64 = number.parse().ok()?;
    let (_, factor) = units.iter().find(|(name, _)| *name == unit.trim_start())?;
    Some(value * factor)
}

macro_rules! quantity {
    ($(#[$doc:meta])* $name:ident, $base:literal, $expected:literal, $units:expr) => {
        $(#[$doc])*
        #[derive(Debug, Clone, Copy, PartialEq, PartialOrd)]
        pub struct $name(pub f64);

        impl FromStr for $name {
            type Err = QuantityError;

            fn from_str(text: &str) -> Result<Self, QuantityError> {
                parse(text, &$units)
                    .map(Self)
                    .ok_or_else(|| QuantityError { expected: $expected, found: text.to_owned() })
            }
        }

        impl fmt::Display for $name {
            fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                // Six decimals, less the zeros at the end: what was typed comes back, without noise of scaling.
                let digits = format!("{:.*}", f.precision().unwrap_or(6), self.0);
                if !digits.contains('.') {
                    return write!(f, "{digits} {}", $base);
                }
                write!(f, "{} {}", digits.trim_end_matches('0').trim_end_matches('.'), $base)
            }
        }

        impl<'de> Deserialize<'de> for $name {
            fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
                struct Text;
                impl Visitor<'_> for Text {
                    type Value = $name;

                    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                        f.write_str($expected)
                    }

                    fn visit_str<E: de::Error>(self, text: &str) -> Result<$name, E> {
                        text.parse().map_err(E::custom)
                    }
                }
                deserializer.deserialize_str(Text)
            }
        }
    };
}

quantity! {
    /// Voltage in volts.
    Volts, "V", "a voltage with its unit, as in \"5 V\" or \"500 mV\"", [("V", 1.0), ("mV", 1e-3)]
}
quantity! {
    /// Current in amperes.
    Amps, "A", "a current with its unit, as in \"2 A\" or \"500 mA\"", [("A", 1.0), ("mA", 1e-3)]
}
quantity! {
    /// Electrical resistance in ohms.
    Ohms, "ohm", "a resistance with its unit, as in \"25 ohm\" or \"50 mohm\"",
    [("ohm", 1.0), ("mohm", 1e-3), ("kohm", 1e3), ("Ω", 1.0), ("mΩ", 1e-3), ("kΩ", 1e3)]
}
quantity! {
    /// A span of time in seconds.
    Seconds, "s", "a time with its unit, as in \"1 s\", \"500 ms\" or \"500 us\"",
    [("s", 1.0), ("ms", 1e-3), ("us", 1e-6), ("µs", 1e-6), ("min", 60.0)]
}
quantity! {
    /// Temperature in degrees Celsius.
    Celsius, "degC", "a temperature with its unit, as in \"95 degC\"", [("degC", 1.0), ("°C", 1.0)]
}
quantity! {
    /// Difference of two temperatures in kelvins.
    Kelvins, "K", "a temperature difference with its unit, as in \"5 K\"", [("K", 1.0), ("mK", 1e-3)]
}
quantity! {
    /// Rise of temperature per heating power, in kelvins per watt.
    KelvinsPerWatt, "K/W", "a thermal resistance with its unit, as in \"140 K/W\"", [("K/W", 1.0)]
}
quantity! {
    /// Energy in joules.
    Joules, "J", "an energy with its unit, as in \"1 J\" or \"500 mJ\"", [("J", 1.0), ("mJ", 1e-3)]
}
quantity! {
    /// Heat flow per temperature difference, in watts per kelvin.
    WattsPerKelvin, "W/K", "a thermal conductance with its unit, as in \"4 mW/K\"", [("W/K", 1.0), ("mW/K", 1e-3)]
}
quantity! {
    /// Heat flow per area and temperature difference, in watts per square metre and kelvin.
    WattsPerSquareMetreKelvin, "W/m2K", "a heat transfer coefficient with its unit, as in \"45 W/m2K\"",
    [("W/m2K", 1.0), ("W/m²K", 1.0)]
}
quantity! {
    /// Torque in newton metres.
    NewtonMetres, "Nm", "a torque with its unit, as in \"5 mNm\"", [("Nm", 1.0), ("mNm", 1e-3)]
}
quantity! {
    /// Mass in grams.
    Grams, "g", "a mass with its unit, as in \"12 g\"", [("g", 1.0), ("kg", 1e3), ("mg", 1e-3)]
}
quantity! {
    /// Mass per area, in grams per square metre.
    GramsPerSquareMetre, "g/m2", "a mass per area with its unit, as in \"1.5 kg/m2\"",
    [("g/m2", 1.0), ("kg/m2", 1e3), ("g/m²", 1.0), ("kg/m²", 1e3)]
}
quantity! {
    /// Angular speed in degrees per second.
    DegreesPerSecond, "deg/s", "an angular speed with its unit, as in \"90 deg/s\"", [("deg/s", 1.0)]
}
quantity! {
    /// Angle in degrees.
    Degrees, "deg", "an angle with its unit, as in \"1 deg\" or \"0.02 rad\"",
    [("deg", 1.0), ("°", 1.0), ("rad", 180.0 / std::f64::consts::PI)]
}
quantity! {
    /// Length in millimetres.
    Millimetres, "mm", "a length with its unit, as in \"0.1 mm\" or \"100 um\"",
    [("mm", 1.0), ("um", 1e-3), ("µm", 1e-3), ("cm", 10.0)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_quantity_is_read_in_any_of_its_units() {
        assert_eq!("500 mA".parse(), Ok(Amps(0.5)));
        assert_eq!("5V".parse(), Ok(Volts(5.0)));
        assert_eq!(" -40 degC ".parse(), Ok(Celsius(-40.0)));
        assert_eq!("1.5 min".parse(), Ok(Seconds(90.0)));
    }

    #[test]
    fn a_wrong_unit_or_a_bare_number_is_refused_with_what_is_expected() {
        let wrong = "2 V".parse::<Amps>().unwrap_err().to_string();
        assert_eq!(wrong, "expected a current with its unit, as in \"2 A\" or \"500 mA\", found \"2 V\"");
        for text in ["", "5", "A", "1 000 mA", "nan A", "inf A", "1,5 A", "--1 A", "5 a"] {
            assert!(text.parse::<Amps>().is_err(), "{text:?} is no current");
        }
    }

    #[test]
    fn a_quantity_prints_as_it_may_be_typed() {
        assert_eq!(Seconds(0.0005).to_string(), "0.0005 s");
        assert_eq!(Volts(100.0).to_string(), "100 V");
        assert_eq!(Kelvins(0.1 + 0.2).to_string(), "0.3 K");
    }
}
