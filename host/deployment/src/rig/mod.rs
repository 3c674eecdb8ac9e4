//! The rig: supply, link, nodes and what drives each hinge, read from a TOML file that people write.
//!
//! [`Rig::read`] looks at the file by itself, [`Rig::fit`] puts the rig to a plan. `docs/src/rig-file.md` is
//! the page for the file.

mod calibrated;
mod error;
mod file;
mod fit;
mod places;
mod quantity;
mod rating;
mod rules;
mod servo_curve;
mod settings;
mod sim;
mod weight;

pub use calibrated::{CalibratedError, HeaterExpectation};
pub use error::RigError;
pub use fit::Fitting;
pub use places::Place;
pub use quantity::{
    Amps, Celsius, Degrees, DegreesPerSecond, Grams, GramsPerSquareMetre, Joules, Kelvins, KelvinsPerWatt,
    Millimetres, NewtonMetres, Ohms, QuantityError, Seconds, Volts, WattsPerKelvin,
    WattsPerSquareMetreKelvin,
};
pub use rating::{MOST_POINTS, Rating};
pub use servo_curve::{SERVO_ANGLES, ServoCurve};
pub use settings::{Drive, Kind, ServoSettings, SmaSettings, SpringSettings};
pub use sim::{ServoPlant, Sim, SmaPlant, TruePulse};
pub use weight::{Gravity, Weight};

use crate::calibration::Calibration;
use file::RigFile;
use places::{Places, line_of};
use toml::de::{DeTable, DeValue};

/// The one version of the rig file.
const VERSION: &str = "1";

/// A rig, as its file says, with every default filled in.
#[derive(Debug, Clone, PartialEq)]
pub struct Rig {
    /// Named when the rig is armed; 1 to 32 bytes.
    pub id: String,
    /// Temperature around the hinges, for estimates of time.
    pub ambient: Celsius,
    /// The calibration file of its hinges, as the rig file names it; see [`Rig::calibrated`].
    pub calibration: Option<String>,
    /// What that file says, once it was taken in.
    pub calibrated_by: Option<Calibration>,
    /// What powers the actuators.
    pub supply: Supply,
    /// How host and MCU talk.
    pub link: Link,
    /// The MCUs; at least one.
    pub nodes: Vec<Node>,
    /// What the panels weigh, where the file says it.
    pub panel: Option<Weight>,
    /// Where down is.
    pub gravity: Gravity,
    /// What only the simulator reads.
    pub sim: Sim,
    /// Kind of every hinge that has no entry of its own.
    default_kind: Kind,
    sma: SmaSettings,
    servo: ServoSettings,
    spring: SpringSettings,
    /// Hinges with an entry of their own, in the order of the file.
    entries: Vec<Entry>,
    /// Hinges that are known by measurement.
    measured: Vec<calibrated::Measured>,
    places: Places,
}

/// The supply of all actuators.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Supply {
    /// Voltage without load.
    pub voltage: Volts,
    /// The sum of all currents stays at or under this (S7).
    pub limit: Amps,
    /// Inner resistance with its wires and the main switch.
    pub resistance: Ohms,
}

/// The line to an MCU.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Link {
    /// Silence after which the MCU turns everything off (S3); at most 5 s.
    pub timeout: Seconds,
    /// Bits per second of a serial port.
    pub baud: u32,
}

/// An MCU and its channels.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Node {
    /// For people.
    pub name: String,
    /// Channels for SMA hinges.
    pub heaters: u16,
    /// Channels for servo hinges.
    pub servos: u16,
    /// Channels for spring hinges.
    pub springs: u16,
}

impl Node {
    /// How many hinges of a kind the node can drive.
    pub const fn channels(&self, kind: Kind) -> u16 {
        match kind {
            Kind::Sma => self.heaters,
            Kind::Servo => self.servos,
            Kind::Spring => self.springs,
        }
    }
}

/// A `[[hinge]]` of the file.
#[derive(Debug, Clone, PartialEq)]
struct Entry {
    hinge: usize,
    /// Name of its node.
    node: Option<String>,
    channel: Option<u16>,
    drive: Drive,
}

impl Rig {
    /// Reads a rig file; `file` is its name in messages.
    ///
    /// # Errors
    /// [`RigError`] with the line, for anything that isn't as `docs/src/rig-file.md` says.
    pub fn read(file: &str, text: &str) -> Result<Self, RigError> {
        let refuse = |error: &toml::de::Error| RigError::Parse {
            place: Place {
                file: file.to_owned(),
                line: error.span().map(|span| line_of(text, &span)),
                key: String::new(),
            },
            message: error.message().to_owned(),
        };
        let table = DeTable::parse(text).map_err(|error| refuse(&error))?;
        let places = Places::new(file, text, table.get_ref());
        // Before the keys: a file of another version may have keys that this one doesn't know.
        match table.get_ref().get("version").map(toml::Spanned::get_ref) {
            Some(DeValue::Integer(version)) if version.as_str() == VERSION => {}
            found => {
                let found = match found {
                    None => "none".to_owned(),
                    Some(DeValue::Integer(version)) => version.as_str().to_owned(),
                    Some(other) => format!("a {}", other.type_str()),
                };
                let place = places.of("version");
                return Err(RigError::Value { place, expected: format!("version {VERSION}"), found });
            }
        }
        let file: RigFile = toml::from_str(text).map_err(|error| refuse(&error))?;
        let rig = Self::from_file(file, places);
        rig.check()?;
        Ok(rig)
    }

    fn from_file(file: RigFile, places: Places) -> Self {
        let entries = file
            .hinge
            .iter()
            .map(|entry| {
                let drive = match entry.kind.unwrap_or(file.hinges.default) {
                    Kind::Sma => Drive::Sma(SmaSettings::resolve(entry.sma.as_ref(), &file.sma)),
                    Kind::Servo => Drive::Servo(ServoSettings::resolve(entry.servo.as_ref(), &file.servo)),
                    Kind::Spring => {
                        Drive::Spring(SpringSettings::resolve(entry.spring.as_ref(), &file.spring))
                    }
                };
                Entry { hinge: entry.hinge, node: entry.node.clone(), channel: entry.channel, drive }
            })
            .collect();
        Self {
            id: file.rig.id,
            ambient: file.rig.ambient,
            calibration: file.rig.calibration,
            calibrated_by: None,
            supply: Supply {
                voltage: file.supply.voltage,
                limit: file.supply.limit,
                resistance: file.supply.resistance,
            },
            link: Link { timeout: file.link.timeout, baud: file.link.baud },
            nodes: file
                .node
                .into_iter()
                .map(|node| Node {
                    name: node.name,
                    heaters: node.heaters,
                    servos: node.servos,
                    springs: node.springs,
                })
                .collect(),
            panel: file.panel.weight(),
            gravity: file.gravity,
            sim: file.sim.resolve(file.rig.ambient),
            default_kind: file.hinges.default,
            sma: SmaSettings::resolve(None, &file.sma),
            servo: ServoSettings::resolve(None, &file.servo),
            spring: SpringSettings::resolve(None, &file.spring),
            entries,
            measured: Vec::new(),
            places,
        }
    }

    /// The settings of a hinge without an entry of its own.
    fn shared(&self, kind: Kind) -> Drive {
        match kind {
            Kind::Sma => Drive::Sma(self.sma),
            Kind::Servo => Drive::Servo(self.servo),
            Kind::Spring => Drive::Spring(self.spring),
        }
    }
}

#[cfg(test)]
mod tests;
