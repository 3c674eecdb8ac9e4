//! Calibrates servo hinges, one after the other: leads each to the pulses that `zygote_calibration::servo` asks for, holds it there
//! while somebody or something reads its angle, and relaxes it.
//!
//! ```text
//!   next pulse --> lead it there slowly --> hold, ask for the angle --> relax --> believe the reading, or ask again
//!                        |                        |  +5 or -5: a nudge
//!                        +------- it pushes ------+-> relax at once, ask for the angle
//! ```
//!
//! Every reading is kept by the caller before the next, so that a calibration which was interrupted goes on where it was.

mod approach;
mod hinge;
mod protractor;
mod records;

pub use hinge::{ServoEnding, ServoHinge};
pub use protractor::{Answer, Protractor, Question, ReadingError};
pub use records::MeasuredServos;

use crate::deploy::make_ready;
use crate::session::{RequestError, Session};
use crate::{DeployError, Transport};
use approach::{Approach, Arrival};
use zygote_calibration::servo::{Look, NextLook, doubt};
use zygote_deployment::Rig;
use zygote_protocol::Fault;

/// A reading that is another one every time is none.
const MOST_DOUBTS: u32 = 6;

/// Why a calibration ended before its time. What was read is kept.
#[derive(Debug, thiserror::Error)]
pub enum ServoError {
    /// It didn't start, or a program was refused.
    #[error(transparent)]
    Start(#[from] DeployError),
    /// A command was refused, or the session ended.
    #[error(transparent)]
    Request(#[from] RequestError),
    /// A fault that isn't the servo's pushing.
    #[error("{}: measured {}, limit {}, at hinge {hinge}; everything is off", .fault.code, .fault.value, .fault.limit)]
    Fault {
        /// What the MCU says.
        fault: Fault,
        /// The hinge under calibration.
        hinge: usize,
    },
    /// It pushed on a way on which it was free before.
    #[error(
        "hinge {hinge} pushes against something at about {pulse_us} us, where it was free before: look at it; everything is off"
    )]
    Obstructed {
        /// The hinge.
        hinge: usize,
        /// The pulse by then.
        pulse_us: u16,
    },
    /// The sensor gives no angle.
    #[error("hinge {hinge}: the angle can't be read")]
    Reading {
        /// The hinge.
        hinge: usize,
        /// Why.
        #[source]
        source: ReadingError,
    },
    /// Every reading was another one.
    #[error("hinge {hinge}: {MOST_DOUBTS} readings at {pulse_us} us, and no two of them alike: {last}")]
    Unsteady {
        /// The hinge.
        hinge: usize,
        /// The pulse.
        pulse_us: u16,
        /// What was wrong with the last one.
        last: String,
    },
    /// The user stopped it, or there is nobody to ask any more.
    #[error("stopped, everything is off; --resume goes on with it")]
    Interrupted,
    /// What was read can't be kept.
    #[error("what was read can't be kept: {0}")]
    Keep(String),
}

/// What to calibrate, and how.
pub struct ServoCalibration<'a> {
    /// The rig.
    pub rig: &'a Rig,
    /// Number of the first program; each has another.
    pub run: u32,
    /// Leave the safe state first: a person has looked at the rig.
    pub clear: bool,
    /// Asked often: does the user want to stop?
    pub interrupted: &'a dyn Fn() -> bool,
}

/// What is read at a pulse, or that it was nudged to another.
enum Reading {
    At(Look),
    Nudged(u16),
}

/// Reads until every servo has ended; how, stands with it.
///
/// # Errors
/// [`ServoError`]; nothing is energised then.
pub fn calibrate_servos<T: Transport>(
    session: &mut Session<T>,
    calibration: &ServoCalibration<'_>,
    hinges: &mut [ServoHinge],
    protractor: &mut dyn Protractor<T>,
    keep: &mut dyn FnMut(&[ServoHinge]) -> Result<(), String>,
) -> Result<(), ServoError> {
    make_ready(session, calibration.clear)?;
    let mut approach = Approach::new(calibration);
    let mut ended = Ok(());
    for at in 0..hinges.len() {
        while let Some(hinge) = hinges.get_mut(at).filter(|hinge| hinge.ending.is_none()) {
            ended = one_look(session, hinge, &mut approach, protractor);
            let kept = keep(hinges).map_err(ServoError::Keep);
            ended = ended.and(kept);
            if ended.is_err() {
                // Perhaps something is armed; the error is what the user must know, not whether this last word got through.
                session.stop().ok();
                return ended;
            }
        }
    }
    ended
}

/// Has one more reading taken, or ends the hinge.
fn one_look<T: Transport>(
    session: &mut Session<T>,
    hinge: &mut ServoHinge,
    approach: &mut Approach<'_>,
    protractor: &mut dyn Protractor<T>,
) -> Result<(), ServoError> {
    let Some(NextLook::At { mut pulse_us, via_us, for_deg }) = hinge.next() else { return Ok(()) };
    let number = hinge.number;
    let start_us = approach.stands_at(number).or(hinge.nearest_free_us(pulse_us)).unwrap_or(pulse_us);
    let mut from_us = start_us;
    if let Some(via_us) = via_us {
        match approach.lead(session, hinge, (start_us, via_us))? {
            Arrival::Free => approach.relax(session, number, via_us)?,
            Arrival::Pushes { pulse_us } => return Err(ServoError::Obstructed { hinge: number, pulse_us }),
        }
        from_us = via_us;
    }
    let mut last: Option<(f64, String)> = None;
    for _ in 0..MOST_DOUBTS {
        let why = last.as_ref().map(|(_, why)| why.clone());
        let look = loop {
            let question = Question { hinge: number, pulse_us, for_deg, relaxed: false, again: why.clone() };
            match approach.read(session, hinge, (from_us, pulse_us), question, protractor)? {
                Reading::At(look) => break look,
                Reading::Nudged(to_us) => (from_us, pulse_us) = (pulse_us, to_us),
            }
        };
        from_us = pulse_us;
        let Some(doubt) = doubt(&hinge.record, &hinge.nominal, &hinge.bounds, &look) else {
            hinge.take(look);
            return Ok(());
        };
        let steady = |(angle_deg, _): &(f64, String)| {
            (angle_deg - look.angle_deg).abs() <= hinge.bounds.tolerance_deg.max(1.0)
        };
        if !doubt.is_final() && last.as_ref().is_some_and(steady) {
            hinge.take(look);
            return Ok(());
        }
        last = Some((look.angle_deg, doubt.to_string()));
    }
    let last = last.map_or_else(String::new, |(_, why)| why);
    Err(ServoError::Unsteady { hinge: number, pulse_us, last })
}
