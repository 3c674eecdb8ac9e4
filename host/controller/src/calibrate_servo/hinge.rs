//! One servo hinge under calibration: what is known of it beforehand, what was read, and what came of it.

use zygote_calibration::servo::{
    FoundServo, Look, NextLook, ServoBounds, ServoNominal, ServoRecord, found, next_look,
};
use zygote_deployment::{Seconds, ServoSettings};
use zygote_protocol::Settings;

/// How a servo's calibration ended.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum ServoEnding {
    /// Every angle is found, or known to be out of reach.
    Done,
    /// It can't be calibrated.
    Refused(String),
}

/// A servo hinge.
#[derive(Debug, Clone)]
pub struct ServoHinge {
    /// Its number in the plan.
    pub number: usize,
    /// The servo output.
    pub channel: u16,
    /// What was read.
    pub record: ServoRecord,
    /// How it ended; not yet, where it goes on.
    pub ending: Option<ServoEnding>,
    pub(crate) settings: ServoSettings,
    pub(crate) nominal: ServoNominal,
    /// What it may be driven with, and how well it is to be met.
    pub bounds: ServoBounds,
}

impl ServoHinge {
    /// A hinge of a rig, at a board with these settings.
    pub fn new(
        number: usize,
        channel: u16,
        settings: ServoSettings,
        board: &Settings,
        tolerance_deg: f64,
    ) -> Self {
        let nominal =
            ServoNominal { pulse_0_us: settings.pulse_0.0 * 1e6, pulse_270_us: settings.pulse_270.0 * 1e6 };
        let bounds = ServoBounds {
            shortest_us: whole(settings.shortest_pulse).max(board.shortest_pulse_us),
            longest_us: whole(settings.longest_pulse).min(board.longest_pulse_us),
            tolerance_deg,
        };
        Self { number, channel, record: ServoRecord::default(), ending: None, settings, nominal, bounds }
    }

    /// What was found.
    pub fn found(&self) -> FoundServo {
        found(&self.record, &self.nominal, &self.bounds)
    }

    /// What it asks for next; nothing once it has ended.
    pub(crate) fn next(&mut self) -> Option<NextLook> {
        match next_look(&self.record, &self.nominal, &self.bounds) {
            Ok(NextLook::Done) => self.ending = Some(ServoEnding::Done),
            Ok(next @ NextLook::At { .. }) => return Some(next),
            Err(refusal) => self.ending = Some(ServoEnding::Refused(refusal.to_string())),
        }
        None
    }

    pub(crate) fn take(&mut self, look: Look) {
        self.record.take(look, &self.nominal, &self.bounds);
    }

    /// The pulse nearest to another at which it stood free.
    pub(crate) fn nearest_free_us(&self, pulse_us: u16) -> Option<u16> {
        let free = self.record.looks.iter().filter(|look| !look.pushes);
        free.map(|look| look.pulse_us).min_by_key(|free_us| free_us.abs_diff(pulse_us))
    }
}

fn whole(pulse: Seconds) -> u16 {
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "at most 10 ms by the rules of the rig file"
    )]
    let whole = (pulse.0 * 1e6).round() as u16;
    whole
}
