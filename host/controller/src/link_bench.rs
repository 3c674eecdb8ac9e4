//! How good a line is: goodput of uploads, commands a second, round trips. Moves nothing; the MCU's program is forgotten.

use crate::Transport;
use crate::session::{RequestError, Session};
use serde::Serialize;
use std::collections::VecDeque;
use zygote_protocol::{
    Action, CentiCelsius, Command, Heat, LinkCounters, MAX_AFTER, Micros, Milliamps, Millis, Reply, RigId,
    STEPS_PER_COMMAND, Step, program_crc,
};

/// Bits on a serial line for a byte: start, eight, stop.
const BITS_PER_BYTE: f64 = 10.0;
/// Commands under way at once while commands are counted: as many as a link has room for.
const AT_ONCE: usize = 8;
/// The bench's programs are for no rig.
const RIG: &str = "link bench";

/// What was measured on one line.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct LinkFigures {
    /// Payload of acknowledged messages while programs were uploaded, bytes a second.
    pub goodput_bytes_per_s: f64,
    /// The same as a share of what the line carries.
    pub share_of_line_rate: f64,
    /// Status commands answered a second, with the link kept full.
    pub commands_per_s: f64,
    /// Time from a Status command to its answer, nothing else under way, ms: half took less.
    pub round_trip_p50_ms: f64,
    /// 99 of 100 took less.
    pub round_trip_p99_ms: f64,
    /// Round trips measured.
    pub round_trips: usize,
    /// Frames that arrived damaged at this end.
    pub damaged_frames: u32,
    /// Data frames that this end sent again.
    pub repeated_frames: u32,
}

/// Measures a line of `baud` for about `time`: half of it uploads, a quarter commands, a quarter round trips.
///
/// # Errors
/// A command was refused (the MCU is armed, running or safe), or the session ended.
pub fn link_bench<T: Transport>(
    session: &mut Session<T>,
    baud: u32,
    time: Millis,
) -> Result<LinkFigures, RequestError> {
    let before = session.link_counters();
    let goodput = uploads(session, Millis(time.0 / 2))?;
    let commands = commands(session, Millis(time.0 / 4))?;
    let trips = round_trips(session, Millis(time.0 / 4))?;
    let after = session.link_counters();
    Ok(LinkFigures {
        goodput_bytes_per_s: goodput,
        share_of_line_rate: goodput * BITS_PER_BYTE / f64::from(baud),
        commands_per_s: commands,
        round_trip_p50_ms: percentile(&trips, 50),
        round_trip_p99_ms: percentile(&trips, 99),
        round_trips: trips.len(),
        damaged_frames: after.bad.wrapping_sub(before.bad),
        repeated_frames: after.repeated.wrapping_sub(before.repeated),
    })
}

/// A program of heating steps with the numbers that they have on a rig.
fn program(steps: u16) -> Vec<Step> {
    let heat = |channel| Heat {
        channel,
        target: CentiCelsius(9_500),
        hold: Millis(1_000),
        max_on: Millis(20_000),
        max_temperature: CentiCelsius(12_000),
        cool: CentiCelsius(4_500),
        rest: Millis(1_000),
        min_gain: CentiCelsius(500),
        gain_window: Millis(3_000),
        current: Milliamps(350),
    };
    let before =
        |at: u16| (1..=MAX_AFTER).rev().filter_map(move |back| at.checked_sub(u16::try_from(back).ok()?));
    (0..steps)
        .map(|at| Step { hinge: at, after: before(at).take(2).collect(), action: Action::Heat(heat(at)) })
        .collect()
}

/// Uploads programs as fast as they go; payload bytes acknowledged a second.
fn uploads<T: Transport>(session: &mut Session<T>, time: Millis) -> Result<f64, RequestError> {
    let steps = program(session.info().buffers.steps);
    let rig = RigId::try_from(RIG).unwrap_or_default();
    // The link holds the bench's own questions of before: they are acknowledged first.
    session.status()?;
    let (start, before) = (session.now(), session.link_counters());
    let end = start.plus(time);
    let mut pending = VecDeque::new();
    while session.now() < end {
        // The next program follows at once on the last steps of the one before.
        let (rig, crc) = (rig.clone(), program_crc(&steps));
        let upload = Command::Upload { run: 0, rig, steps: session.info().buffers.steps, crc };
        pending.push_back(("upload", session.submit(upload)?));
        for (first, chunk) in (0..).step_by(STEPS_PER_COMMAND).zip(steps.chunks(STEPS_PER_COMMAND)) {
            if session.now() >= end {
                break;
            }
            let steps = chunk.iter().cloned().collect();
            pending.push_back(("steps", session.submit(Command::Steps { first, steps })?));
            // Answered long ago.
            if pending.len() > 2 * AT_ONCE {
                take_done(session, &mut pending)?;
            }
        }
    }
    while !pending.is_empty() {
        take_done(session, &mut pending)?;
    }

    let delivered = |counters: LinkCounters| counters.delivered.wrapping_sub(before.delivered);
    Ok(f64::from(delivered(session.link_counters())) / seconds(session.now().since(start)))
}

/// Waits for the oldest answer.
fn take_done<T: Transport>(
    session: &mut Session<T>,
    pending: &mut VecDeque<(&'static str, u16)>,
) -> Result<(), RequestError> {
    let Some((command, id)) = pending.pop_front() else { return Ok(()) };
    session.response(id)?.map_err(|refusal| RequestError::Refused { command, refusal }).map(|_| ())
}

/// Status commands answered a second, with as many under way as the link takes.
fn commands<T: Transport>(session: &mut Session<T>, time: Millis) -> Result<f64, RequestError> {
    let start = session.now();
    let end = start.plus(time);
    let mut answered = 0_u32;
    let mut pending = VecDeque::new();
    while session.now() < end || !pending.is_empty() {
        if session.now() < end && pending.len() < AT_ONCE {
            pending.push_back(session.submit(Command::Status)?);
            continue;
        }
        let Some(id) = pending.pop_front() else { break };
        take_status(session, id)?;
        answered += 1;
    }
    Ok(f64::from(answered) / seconds(session.now().since(start)))
}

fn take_status<T: Transport>(session: &mut Session<T>, id: u16) -> Result<(), RequestError> {
    match session.response(id)? {
        Ok(Reply::Status(_)) => Ok(()),
        Ok(_) => Err(RequestError::WrongReply { command: "status" }),
        Err(refusal) => Err(RequestError::Refused { command: "status", refusal }),
    }
}

/// Times of Status commands, one after the other, sorted, us.
fn round_trips<T: Transport>(session: &mut Session<T>, time: Millis) -> Result<Vec<u64>, RequestError> {
    let end = session.now().plus(time);
    let mut trips = Vec::new();
    while session.now() < end {
        let asked = session.now();
        session.status()?;
        trips.push(session.now().since(asked));
    }
    trips.sort_unstable();
    Ok(trips)
}

/// The value that so many of a hundred don't exceed, ms; 0 of none.
fn percentile(sorted_us: &[u64], percent: usize) -> f64 {
    let at = (sorted_us.len() * percent).div_ceil(100).saturating_sub(1);
    sorted_us.get(at).map_or(0.0, |us| seconds(*us) * 1e3)
}

#[expect(clippy::cast_precision_loss, reason = "a bench is far shorter than 2^52 us")]
fn seconds(us: u64) -> f64 {
    // Nothing takes no time at all; a bench of no length divides by this.
    Micros(us).0.max(1) as f64 / 1e6
}

#[cfg(test)]
mod checks {
    use super::*;

    #[test]
    fn a_percentile_is_the_value_that_so_many_do_not_exceed() {
        let hundred: Vec<u64> = (1..=100).map(|ms| ms * 1_000).collect();
        for (percent, expected_ms) in [(50, 50.0), (99, 99.0), (100, 100.0)] {
            assert!((percentile(&hundred, percent) - expected_ms).abs() < 1e-9, "{percent}");
        }
        assert!((percentile(&[7_000], 99) - 7.0).abs() < 1e-9);
        assert!(percentile(&[], 50).abs() < 1e-9);
    }
}
