//! The readings as a file: kept while a calibration goes on, so that one which was interrupted goes on with them.

use super::hinge::{ServoEnding, ServoHinge};
use crate::calibrate::records::{VERSION, hold, hold_hinges, read};
use crate::calibrate::{RecordsError, chip_id};
use serde::{Deserialize, Serialize};
use zygote_calibration::servo::Look;
use zygote_protocol::HelloReply;

/// Everything read so far on one rig.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MeasuredServos {
    version: u32,
    /// The rig's name.
    pub rig: String,
    /// The board's name.
    pub board: String,
    /// The chip's unique id, in hex.
    pub unique_id: String,
    /// Every hinge has ended.
    pub complete: bool,
    hinges: Vec<MeasuredServo>,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct MeasuredServo {
    hinge: usize,
    channel: u16,
    /// Pulse (us), angle (degrees), whether it pushed.
    looks: Vec<(u16, f64, bool)>,
    /// Done, unless it says why not.
    refused: Option<String>,
    ended: bool,
}

impl MeasuredServos {
    /// What these hinges have, on the rig of this name at this board.
    pub fn new(rig: &str, board: &HelloReply, hinges: &[ServoHinge]) -> Self {
        Self {
            version: VERSION,
            rig: rig.to_owned(),
            board: board.identity.board.to_string(),
            unique_id: chip_id(board),
            complete: hinges.iter().all(|hinge| hinge.ending.is_some()),
            hinges: hinges.iter().map(MeasuredServo::new).collect(),
        }
    }

    /// Reads a file.
    ///
    /// # Errors
    /// [`RecordsError`], when it is none, or of another version.
    pub fn from_json(bytes: &[u8]) -> Result<Self, RecordsError> {
        read(bytes, |measured: &Self| measured.version)
    }

    /// Gives hinges what was read of them before. A servo is the same whatever firmware leads it.
    ///
    /// # Errors
    /// [`RecordsError`], when it was read on another rig or board, or of other hinges; they then have nothing.
    pub fn resume(
        self,
        rig: &str,
        board: &HelloReply,
        hinges: &mut [ServoHinge],
    ) -> Result<(), RecordsError> {
        let ours = Self::new(rig, board, &[]);
        hold([
            ("rig", ours.rig, self.rig),
            ("board", ours.board, self.board),
            ("chip", ours.unique_id, self.unique_id),
        ])?;
        let expected = hinges.iter().map(|hinge| (hinge.number, hinge.channel));
        hold_hinges(expected, self.hinges.iter().map(|hinge| (hinge.hinge, hinge.channel)))?;
        for (hinge, measured) in hinges.iter_mut().zip(self.hinges) {
            for (pulse_us, angle_deg, pushes) in measured.looks {
                if !angle_deg.is_finite() {
                    return Err(RecordsError::Unreadable(format!(
                        "hinge {}: an angle of {angle_deg}",
                        hinge.number
                    )));
                }
                hinge.take(Look { pulse_us, angle_deg, pushes });
            }
            let refused = measured.refused.map(ServoEnding::Refused);
            hinge.ending = refused.or(measured.ended.then_some(ServoEnding::Done));
        }
        Ok(())
    }
}

impl MeasuredServo {
    fn new(hinge: &ServoHinge) -> Self {
        let refused = match &hinge.ending {
            Some(ServoEnding::Refused(why)) => Some(why.clone()),
            Some(ServoEnding::Done) | None => None,
        };
        Self {
            hinge: hinge.number,
            channel: hinge.channel,
            looks: hinge
                .record
                .looks
                .iter()
                .map(|look| (look.pulse_us, look.angle_deg, look.pushes))
                .collect(),
            refused,
            ended: hinge.ending.is_some(),
        }
    }
}
