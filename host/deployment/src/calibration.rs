//! The calibration file: what was measured of a rig's hinges, with intervals. `zygote calibrate` writes it, people read it.

use crate::calibrated_servo::CalibratedServo;
use crate::rig::{Celsius, Joules, KelvinsPerWatt, Ohms, Seconds};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::fmt;

/// The version of the file that is written. The first knew no servos; it is read too.
const VERSION: u32 = 2;
const OLDEST: u32 = 1;

/// A calibration file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Calibration {
    version: u32,
    /// The rig's name.
    pub rig: String,
    /// The board's name.
    pub board: String,
    /// The chip's unique id, in hex.
    pub unique_id: String,
    /// The hinges, by number.
    #[serde(rename = "hinge")]
    pub hinges: Vec<CalibratedHinge>,
}

/// A board that hinges were measured at, and a schedule is made for.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CalibratedAt {
    /// The board's name.
    pub board: String,
    /// The chip's unique id, in hex.
    pub unique_id: String,
}

impl fmt::Display for CalibratedAt {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} {}", self.board, self.unique_id)
    }
}

/// The file's version, whatever else it has.
#[derive(Deserialize)]
struct Versioned {
    version: u32,
}

/// One hinge.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CalibratedHinge {
    /// Its number in the plan.
    pub hinge: usize,
    /// Heater and thermistor.
    pub channel: u16,
    /// When it was measured, in UTC.
    pub date: String,
    /// Firmware version and commit.
    pub firmware: String,
    /// What to think of it.
    pub verdict: CalibrationVerdict,
    /// Why it has no values, or not all of them.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub why: Option<String>,
    /// Temperature around it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub ambient: Option<String>,
    /// What the model misses of the readings: root mean square, the worst, and of a pulse that it wasn't fitted to.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub residuals: BTreeMap<String, String>,
    /// Values with their intervals of 95 %, by name.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub values: BTreeMap<String, Calibrated>,
    /// Of a servo hinge, what was found instead of values.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub servo: Option<CalibratedServo>,
}

/// What to think of a hinge's calibration.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum CalibrationVerdict {
    /// All that schedules and boards need is known.
    Calibrated,
    /// Some of it isn't.
    Incomplete,
    /// Nothing is.
    Failed,
}

impl CalibrationVerdict {
    /// The word for it.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Calibrated => "calibrated",
            Self::Incomplete => "incomplete",
            Self::Failed => "failed",
        }
    }
}

/// A value, or why there is none.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(untagged, deny_unknown_fields)]
pub enum Calibrated {
    /// Between `low` and `high` 95 times in 100.
    Known {
        /// The best one, with its unit.
        value: String,
        /// Lower end.
        low: String,
        /// Upper end.
        high: String,
    },
    /// The measurement doesn't have it.
    Unknown {
        /// Why.
        unknown: String,
    },
}

/// What a hinge is known by: the settings of the rig file that a calibration replaces.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Known {
    /// Of the film heater.
    pub heater_resistance: Option<Ohms>,
    /// Rise of the foil above the ambience per watt, when settled.
    pub foil_rise: Option<KelvinsPerWatt>,
    /// Time in which the difference to the settled temperature shrinks to 1/e.
    pub time_constant: Option<Seconds>,
    /// Taken up by the transformation.
    pub latent_heat: Option<Joules>,
    /// Here the hinge begins to open.
    pub austenite_start: Option<Celsius>,
    /// Here the hinge has opened.
    pub austenite_finish: Option<Celsius>,
}

/// A file that is no calibration of this rig.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum CalibrationError {
    /// No TOML of this form.
    #[error("no calibration: {message}")]
    Parse {
        /// What is wrong, and where.
        message: String,
    },
    /// Another version.
    #[error("expected version {OLDEST} to {VERSION}, found {found}")]
    Version {
        /// What it says.
        found: u32,
    },
    /// Another rig.
    #[error("a calibration of rig {found:?}, expected {expected:?}: calibrate this rig")]
    OtherRig {
        /// The rig at hand.
        expected: String,
        /// That of the file.
        found: String,
    },
    /// Another board.
    #[error(
        "a calibration at board {found}, expected {expected}: thermistors and heaters hang on a board, so calibrate this one"
    )]
    OtherBoard {
        /// The board at hand.
        expected: String,
        /// That of the file.
        found: String,
    },
}

impl Calibration {
    /// Without a hinge.
    pub fn new(rig: &str, board: &str, unique_id: &str) -> Self {
        let (rig, board, unique_id) = (rig.to_owned(), board.to_owned(), unique_id.to_owned());
        Self { version: VERSION, rig, board, unique_id, hinges: Vec::new() }
    }

    /// Reads a file.
    ///
    /// # Errors
    /// [`CalibrationError`], for what is no calibration of `rig`.
    pub fn read(text: &str, rig: &str) -> Result<Self, CalibrationError> {
        let parse = |error: toml::de::Error| CalibrationError::Parse {
            message: error.to_string().trim_end().to_owned(),
        };
        // Before the keys: a file of another version may have keys that this one doesn't know.
        let Versioned { version } = toml::from_str(text).map_err(parse)?;
        if !(OLDEST..=VERSION).contains(&version) {
            return Err(CalibrationError::Version { found: version });
        }
        let calibration = Self { version: VERSION, ..toml::from_str(text).map_err(parse)? };
        if calibration.rig != rig {
            return Err(CalibrationError::OtherRig { expected: rig.to_owned(), found: calibration.rig });
        }
        Ok(calibration)
    }

    /// The board that it was made at.
    pub fn at(&self) -> CalibratedAt {
        CalibratedAt { board: self.board.clone(), unique_id: self.unique_id.clone() }
    }

    /// Takes in hinges that were measured at the same board; what the file had of them before is replaced.
    ///
    /// # Errors
    /// [`CalibrationError::OtherBoard`]; nothing is taken in then.
    pub fn take_in(&mut self, newer: Self) -> Result<(), CalibrationError> {
        if self.at() != newer.at() {
            let (expected, found) = (newer.at().to_string(), self.at().to_string());
            return Err(CalibrationError::OtherBoard { expected, found });
        }
        self.hinges.retain(|old| newer.hinges.iter().all(|new| new.hinge != old.hinge));
        self.hinges.extend(newer.hinges);
        self.hinges.sort_by_key(|hinge| hinge.hinge);
        Ok(())
    }

    /// The file.
    ///
    /// # Errors
    /// What the writer of TOML says; our own values can be written.
    pub fn text(&self) -> Result<String, CalibrationError> {
        toml::to_string(self).map_err(|error| CalibrationError::Parse { message: error.to_string() })
    }
}

impl CalibratedHinge {
    /// What is known of the hinge.
    ///
    /// # Errors
    /// A value whose unit isn't its own.
    pub fn known(&self) -> Result<Known, CalibrationError> {
        Ok(Known {
            heater_resistance: self.value("heater_resistance")?,
            foil_rise: self.value("foil_rise")?,
            time_constant: self.value("time_constant")?,
            latent_heat: self.value("latent_heat")?,
            austenite_start: self.value("austenite_start")?,
            austenite_finish: self.value("austenite_finish")?,
        })
    }

    /// Value, lower and upper end of a quantity in `unit`; none where the measurement doesn't have it.
    ///
    /// # Errors
    /// Numbers that can't be read, or with another unit.
    pub fn interval(&self, key: &str, unit: &str) -> Result<Option<[f64; 3]>, CalibrationError> {
        let Some(Calibrated::Known { value, low, high }) = self.values.get(key) else { return Ok(None) };
        let number = |text: &String| {
            let number = text.strip_suffix(unit).and_then(|number| number.trim().parse::<f64>().ok());
            number.filter(|number| number.is_finite()).ok_or_else(|| {
                let message =
                    format!("hinge {}: {key}: expected a number in {unit}, found {text:?}", self.hinge);
                CalibrationError::Parse { message }
            })
        };
        Ok(Some([number(value)?, number(low)?, number(high)?]))
    }

    fn value<T: std::str::FromStr<Err: std::fmt::Display>>(
        &self,
        key: &str,
    ) -> Result<Option<T>, CalibrationError> {
        match self.values.get(key) {
            Some(Calibrated::Known { value, .. }) => match value.parse() {
                Ok(value) => Ok(Some(value)),
                Err(error) => {
                    Err(CalibrationError::Parse { message: format!("hinge {}: {key}: {error}", self.hinge) })
                }
            },
            Some(Calibrated::Unknown { .. }) | None => Ok(None),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn hinge(number: usize, ohm: &str) -> CalibratedHinge {
        let value = Calibrated::Known {
            value: ohm.to_owned(),
            low: "24.8 ohm".to_owned(),
            high: "25.4 ohm".to_owned(),
        };
        let unknown = Calibrated::Unknown { unknown: "the foil got 60 °C hot".to_owned() };
        CalibratedHinge {
            hinge: number,
            channel: 3,
            date: "2026-01-02T03:04:05Z".to_owned(),
            firmware: "0.1.0 abc".to_owned(),
            verdict: CalibrationVerdict::Incomplete,
            why: None,
            ambient: Some("22.1 degC".to_owned()),
            residuals: BTreeMap::from([("rmse".to_owned(), "0.08 K".to_owned())]),
            values: BTreeMap::from([
                ("heater_resistance".to_owned(), value),
                ("austenite_finish".to_owned(), unknown),
            ]),
            servo: None,
        }
    }

    fn calibration(hinges: Vec<CalibratedHinge>) -> Calibration {
        Calibration { hinges, ..Calibration::new("r", "board", "00ff") }
    }

    #[test]
    fn what_is_written_is_read() {
        let written = calibration(vec![hinge(1, "25.1 ohm"), hinge(2, "20 ohm")]);
        let text = written.text().unwrap();
        assert_eq!(Calibration::read(&text, "r"), Ok(written), "{text}");
        let known = Calibration::read(&text, "r").unwrap().hinges[0].known().unwrap();
        assert_eq!((known.heater_resistance, known.austenite_finish), (Some(Ohms(25.1)), None));
    }

    #[test]
    fn a_calibration_of_another_rig_version_or_board_is_refused() {
        let text = calibration(vec![]).text().unwrap();
        let error = Calibration::read(&text, "other").unwrap_err().to_string();
        assert_eq!(error, "a calibration of rig \"r\", expected \"other\": calibrate this rig");
        let newer = text.replace("version = 2", "version = 3\nnew = 1");
        assert_eq!(Calibration::read(&newer, "r"), Err(CalibrationError::Version { found: 3 }));
        assert!(matches!(Calibration::read("no", "r"), Err(CalibrationError::Parse { .. })));
        let mut old = calibration(vec![hinge(1, "25 ohm")]);
        let new = Calibration { unique_id: "01".to_owned(), ..calibration(vec![]) };
        assert!(matches!(old.take_in(new), Err(CalibrationError::OtherBoard { .. })));
    }

    #[test]
    fn a_file_of_the_first_version_is_read_and_written_as_the_newest() {
        let written = calibration(vec![hinge(1, "25.1 ohm")]);
        let first = written.text().unwrap().replace("version = 2", "version = 1");
        assert_eq!(Calibration::read(&first, "r"), Ok(written));
    }

    #[test]
    fn a_hinge_that_is_measured_again_replaces_what_was_known_of_it() {
        let mut calibration = calibration(vec![hinge(1, "25 ohm"), hinge(3, "26 ohm")]);
        let newer = Calibration { hinges: vec![hinge(2, "1 ohm"), hinge(1, "2 ohm")], ..calibration.clone() };
        calibration.take_in(newer).unwrap();
        let ohm =
            |hinge: &CalibratedHinge| (hinge.hinge, hinge.known().unwrap().heater_resistance.unwrap().0);
        assert_eq!(calibration.hinges.iter().map(ohm).collect::<Vec<_>>(), [(1, 2.0), (2, 1.0), (3, 26.0)]);
    }

    #[test]
    fn an_interval_is_read_in_its_own_unit_and_in_no_other() {
        let hinge = hinge(4, "25 ohm");
        assert_eq!(hinge.interval("heater_resistance", "ohm"), Ok(Some([25.0, 24.8, 25.4])));
        assert_eq!(hinge.interval("austenite_finish", "degC"), Ok(None));
        let error = hinge.interval("heater_resistance", "K/W").unwrap_err().to_string();
        assert!(
            error.contains("hinge 4: heater_resistance: expected a number in K/W, found \"25 ohm\""),
            "{error}"
        );
    }

    #[test]
    fn a_value_with_a_wrong_unit_is_refused_with_its_hinge() {
        let error = hinge(4, "25 V").known().unwrap_err().to_string();
        assert!(
            error.starts_with("no calibration: hinge 4: heater_resistance: expected a resistance"),
            "{error}"
        );
    }
}
