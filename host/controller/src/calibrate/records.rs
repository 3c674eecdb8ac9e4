//! What was measured, as a file: kept while a calibration goes on, so that one which was interrupted goes on with it.

use super::hinge::{Ending, Hinge};
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use std::fmt::Write;
use zygote_calibration::{Drive, Purpose, Record, RecordError, Sample};
use zygote_protocol::HelloReply;

/// The one version of the files of records.
pub(crate) const VERSION: u32 = 1;

/// Everything measured so far on one rig.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Measured {
    version: u32,
    /// The rig's name.
    pub rig: String,
    /// The board's name.
    pub board: String,
    /// The chip's unique id, in hex.
    pub unique_id: String,
    /// Firmware version and commit.
    pub firmware: String,
    /// Every hinge has ended.
    pub complete: bool,
    hinges: Vec<MeasuredHinge>,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct MeasuredHinge {
    hinge: usize,
    channel: u16,
    ending: Option<KeptEnding>,
    /// From, until (s), duty, purpose.
    drives: Vec<(f64, f64, f64, KeptPurpose)>,
    /// Time (s), reading (°C), voltage (V), current (A) if no other hinge was heated.
    samples: Vec<(f64, f64, f64, Option<f64>)>,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
enum KeptEnding {
    Done,
    Refused(String),
    Fault(String),
}

#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
enum KeptPurpose {
    Probe,
    Warm,
    Ramp,
    Again,
    HeldOut,
}

/// Why a calibration can't go on with a file.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum RecordsError {
    /// No such file.
    #[error("no records of a calibration: {0}")]
    Unreadable(String),
    /// Of another version.
    #[error("expected version {VERSION}, found {found}")]
    Version {
        /// What it says.
        found: u32,
    },
    /// Of another rig, board or firmware.
    #[error("these records are of another {what}: expected `{expected}`, found `{found}`")]
    Other {
        /// What differs.
        what: &'static str,
        /// Of the rig at hand.
        expected: String,
        /// Of the file.
        found: String,
    },
    /// Of other hinges than those to calibrate, or on other channels.
    #[error(
        "these records are of hinges {found:?}, expected {expected:?}: name the same hinges, on the same channels"
    )]
    Hinges {
        /// Hinge and channel asked for.
        expected: Vec<(usize, u16)>,
        /// Hinge and channel of the file.
        found: Vec<(usize, u16)>,
    },
    /// Numbers that no calibration measured.
    #[error("hinge {hinge}")]
    Record {
        /// The hinge.
        hinge: usize,
        /// What is wrong.
        #[source]
        source: RecordError,
    },
}

/// Reads a file of records.
pub(crate) fn read<T: DeserializeOwned>(
    bytes: &[u8],
    version: impl FnOnce(&T) -> u32,
) -> Result<T, RecordsError> {
    let measured =
        serde_json::from_slice(bytes).map_err(|error| RecordsError::Unreadable(error.to_string()))?;
    match version(&measured) {
        VERSION => Ok(measured),
        found => Err(RecordsError::Version { found }),
    }
}

/// Holds what a file says of where it was measured against what is at hand: name, ours, the file's.
pub(crate) fn hold<const N: usize>(places: [(&'static str, String, String); N]) -> Result<(), RecordsError> {
    match places.into_iter().find(|(_, expected, found)| expected != found) {
        Some((what, expected, found)) => Err(RecordsError::Other { what, expected, found }),
        None => Ok(()),
    }
}

/// Holds a file's hinges and channels against those asked for.
pub(crate) fn hold_hinges(
    expected: impl Iterator<Item = (usize, u16)>,
    found: impl Iterator<Item = (usize, u16)>,
) -> Result<(), RecordsError> {
    let (expected, found): (Vec<_>, Vec<_>) = (expected.collect(), found.collect());
    if expected == found { Ok(()) } else { Err(RecordsError::Hinges { expected, found }) }
}

/// The chip's unique id as files and people write it.
pub fn chip_id(board: &HelloReply) -> String {
    board.identity.unique_id.iter().fold(String::new(), |mut text, byte| {
        // Writing to a string cannot fail.
        let _ = write!(text, "{byte:02x}");
        text
    })
}

impl Measured {
    /// What these hinges have, on the rig of this name at this board.
    pub fn new(rig: &str, board: &HelloReply, hinges: &[Hinge]) -> Self {
        let identity = &board.identity;
        let unique_id = chip_id(board);
        Self {
            version: VERSION,
            rig: rig.to_owned(),
            board: identity.board.to_string(),
            unique_id,
            firmware: format!("{} {}", identity.firmware, identity.git),
            complete: hinges.iter().all(|hinge| hinge.ending.is_some()),
            hinges: hinges.iter().map(MeasuredHinge::new).collect(),
        }
    }

    /// Reads a file.
    ///
    /// # Errors
    /// [`RecordsError`], when it is none, or of another version.
    pub fn from_json(bytes: &[u8]) -> Result<Self, RecordsError> {
        read(bytes, |measured: &Self| measured.version)
    }

    /// Gives hinges what was measured of them before.
    ///
    /// # Errors
    /// [`RecordsError`], when it was measured on another rig, with another firmware, or of other hinges; they then have nothing.
    pub fn resume(self, rig: &str, board: &HelloReply, hinges: &mut [Hinge]) -> Result<(), RecordsError> {
        let ours = Self::new(rig, board, &[]);
        hold([
            ("rig", ours.rig, self.rig),
            ("board", ours.board, self.board),
            ("chip", ours.unique_id, self.unique_id),
            ("firmware", ours.firmware, self.firmware),
        ])?;
        let expected = hinges.iter().map(|hinge| (hinge.number, hinge.channel));
        hold_hinges(expected, self.hinges.iter().map(|hinge| (hinge.hinge, hinge.channel)))?;
        let records: Vec<(Record, Option<Ending>)> =
            self.hinges.into_iter().map(MeasuredHinge::into_record).collect();
        for (hinge, (record, _)) in hinges.iter().zip(&records) {
            record.check().map_err(|source| RecordsError::Record { hinge: hinge.number, source })?;
        }
        for (hinge, (record, ending)) in hinges.iter_mut().zip(records) {
            hinge.resume(record, ending);
        }
        Ok(())
    }
}

impl MeasuredHinge {
    fn new(hinge: &Hinge) -> Self {
        let drive = |drive: &Drive| (drive.from_s, drive.until_s, drive.duty, kept(drive.purpose));
        let sample = |sample: &Sample| (sample.t_s, sample.reading_c, sample.voltage_v, sample.current_a);
        Self {
            hinge: hinge.number,
            channel: hinge.channel,
            ending: hinge.ending.as_ref().map(|ending| match ending {
                Ending::Done => KeptEnding::Done,
                Ending::Refused(why) => KeptEnding::Refused(why.clone()),
                Ending::Fault(what) => KeptEnding::Fault(what.clone()),
            }),
            drives: hinge.record.drives.iter().map(drive).collect(),
            samples: hinge.record.samples.iter().map(sample).collect(),
        }
    }

    fn into_record(self) -> (Record, Option<Ending>) {
        let drive = |(from_s, until_s, duty, kept): (f64, f64, f64, KeptPurpose)| Drive {
            from_s,
            until_s,
            duty,
            purpose: purpose(kept),
        };
        let sample = |(t_s, reading_c, voltage_v, current_a): (f64, f64, f64, Option<f64>)| Sample {
            t_s,
            reading_c,
            voltage_v,
            current_a,
        };
        let record = Record {
            samples: self.samples.into_iter().map(sample).collect(),
            drives: self.drives.into_iter().map(drive).collect(),
        };
        let ending = self.ending.map(|ending| match ending {
            KeptEnding::Done => Ending::Done,
            KeptEnding::Refused(why) => Ending::Refused(why),
            KeptEnding::Fault(what) => Ending::Fault(what),
        });
        (record, ending)
    }
}

fn kept(purpose: Purpose) -> KeptPurpose {
    match purpose {
        Purpose::Probe => KeptPurpose::Probe,
        Purpose::Warm => KeptPurpose::Warm,
        Purpose::Ramp => KeptPurpose::Ramp,
        Purpose::Again => KeptPurpose::Again,
        Purpose::HeldOut => KeptPurpose::HeldOut,
    }
}

fn purpose(kept: KeptPurpose) -> Purpose {
    match kept {
        KeptPurpose::Probe => Purpose::Probe,
        KeptPurpose::Warm => Purpose::Warm,
        KeptPurpose::Ramp => Purpose::Ramp,
        KeptPurpose::Again => Purpose::Again,
        KeptPurpose::HeldOut => Purpose::HeldOut,
    }
}

/// A purpose for people.
pub(crate) fn name_of(purpose: Purpose) -> &'static str {
    match purpose {
        Purpose::Probe => "probe",
        Purpose::Warm => "warm",
        Purpose::Ramp => "ramp",
        Purpose::Again => "again",
        Purpose::HeldOut => "held out",
    }
}
