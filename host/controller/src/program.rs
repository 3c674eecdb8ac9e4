//! A schedule in the words of the wire: the steps, and the limits to ask for.

use std::fmt::Display;
use std::num::TryFromIntError;
use zygote_deployment::{Motion, Rig, Schedule};
use zygote_protocol::{
    Action, CentiCelsius, Heat, HelloReply, LimitName, Limits, Milliamps, Millis, Release, Step, Turn,
};

/// Why a schedule can't be given to an MCU.
#[derive(Debug, thiserror::Error)]
pub enum ProgramError {
    /// A number that the wire has no room for.
    #[error("schedule: step {step}: {what} of {value} is more than the protocol can carry")]
    TooLarge {
        /// Index of the step.
        step: usize,
        /// Which number.
        what: &'static str,
        /// The number.
        value: String,
        /// Why.
        #[source]
        source: TryFromIntError,
    },
    /// A step that waits for more others than the wire has room for.
    #[error(
        "schedule: step {step} waits for {count} others, a step may wait for {}",
        zygote_protocol::MAX_AFTER
    )]
    TooManyBefore {
        /// Index of the step.
        step: usize,
        /// How many it waits for.
        count: usize,
    },
    /// A schedule on several nodes, of which each has an MCU of its own.
    #[error(
        "the schedule is for {} nodes (numbers {nodes:?} of the rig file), with {crossings} waits from one to another; \
         for now a run drives one MCU: use a rig whose first node has channels for all hinges",
        nodes.len()
    )]
    SeveralNodes {
        /// Their numbers.
        nodes: Vec<usize>,
        /// Waits of a step of one for a step of another.
        crossings: usize,
    },
    /// The program is longer than the MCU's memory.
    #[error("the schedule has {steps} steps, the {board} has room for {room}")]
    TooLong {
        /// Steps of the schedule.
        steps: usize,
        /// Steps that the MCU has room for.
        room: u16,
        /// The board's name.
        board: String,
    },
    /// A channel that the board doesn't have.
    #[error(
        "hinge {hinge} is on {kind} channel {channel}, the {board} has {available} of them: the rig file promises \
         more than the board has"
    )]
    NoSuchChannel {
        /// The hinge.
        hinge: usize,
        /// Kind of channel.
        kind: &'static str,
        /// The channel.
        channel: u16,
        /// How many the board has.
        available: u16,
        /// The board's name.
        board: String,
    },
    /// A limit that the board doesn't allow.
    #[error("the rig asks for a limit {name:?} of {asked}, the {board} allows {ceiling} (0.01 °C, ms or mA)")]
    AboveCeiling {
        /// Which limit.
        name: LimitName,
        /// What is asked for.
        asked: i64,
        /// The board's ceiling.
        ceiling: i64,
        /// The board's name.
        board: String,
    },
}

/// Narrows a number of a step to what the wire carries.
fn fit<V: Copy + Display, N: TryFrom<V, Error = TryFromIntError>>(
    step: usize,
    what: &'static str,
    value: V,
) -> Result<N, ProgramError> {
    N::try_from(value).map_err(|source| ProgramError::TooLarge {
        step,
        what,
        value: value.to_string(),
        source,
    })
}

/// The steps of a schedule for this MCU.
///
/// # Errors
/// [`ProgramError`], when the MCU or the wire can't take it.
pub fn program(schedule: &Schedule, mcu: &HelloReply) -> Result<Vec<Step>, ProgramError> {
    let board = || mcu.identity.board.to_string();
    let nodes = schedule.nodes();
    if nodes.len() > 1 {
        return Err(ProgramError::SeveralNodes { nodes, crossings: schedule.crossings().len() });
    }
    if schedule.steps.len() > usize::from(mcu.buffers.steps) {
        return Err(ProgramError::TooLong {
            steps: schedule.steps.len(),
            room: mcu.buffers.steps,
            board: board(),
        });
    }
    schedule
        .steps
        .iter()
        .enumerate()
        .map(|(at, step)| {
            let (kind, available) = match step.motion {
                Motion::Sma(_) => ("heater", mcu.channels.heaters),
                Motion::Servo(_) => ("servo", mcu.channels.servos),
                Motion::Spring(_) => ("spring", mcu.channels.springs),
            };
            if step.channel >= available {
                let (hinge, channel) = (step.hinge, step.channel);
                return Err(ProgramError::NoSuchChannel { hinge, kind, channel, available, board: board() });
            }
            wire_step(at, step)
        })
        .collect()
}

fn wire_step(at: usize, step: &zygote_deployment::Step) -> Result<Step, ProgramError> {
    let millis = |what, value: zygote_deployment::Millis| fit(at, what, value.0).map(Millis);
    let celsius = |what, value: zygote_deployment::CentiCelsius| fit(at, what, value.0).map(CentiCelsius);
    let micros = |what, value: zygote_deployment::Micros| fit::<u32, u16>(at, what, value.0);
    let milliamps = |what, value: zygote_deployment::Milliamps| fit(at, what, value.0).map(Milliamps);
    let channel = step.channel;
    let current = milliamps("current", step.current)?;
    let action = match step.motion {
        Motion::Sma(sma) => Action::Heat(Heat {
            channel,
            target: celsius("target temperature", sma.target)?,
            hold: millis("hold", sma.hold)?,
            max_on: millis("longest on-time", sma.max_on)?,
            max_temperature: celsius("highest temperature", sma.max_temperature)?,
            cool: celsius("cooled temperature", sma.cool_to)?,
            rest: millis("rest", sma.rest)?,
            min_gain: celsius("least gain", sma.min_gain)?,
            gain_window: millis("gain window", sma.gain_window)?,
            current,
        }),
        Motion::Servo(servo) => Action::Turn(Turn {
            channel,
            from_us: micros("first pulse", servo.from)?,
            to_us: micros("last pulse", servo.to)?,
            duration: millis("duration", servo.duration)?,
            settle: millis("settling time", servo.settle)?,
            current,
            hold_current: milliamps("holding current", step.hold_current)?,
        }),
        Motion::Spring(spring) => Action::Release(Release {
            channel,
            pulse: millis("pulse", spring.pulse)?,
            settle: millis("settling time", spring.settle)?,
            current,
        }),
    };
    let after: Result<Vec<u16>, _> =
        step.after.iter().map(|before| fit(at, "step waited for", *before)).collect();
    let after = heapless::Vec::from_slice(&after?)
        .map_err(|_| ProgramError::TooManyBefore { step: at, count: step.after.len() })?;
    Ok(Step { hinge: fit(at, "hinge", step.hinge)?, after, action })
}

/// The limits to arm with: just what the program and the rig need, so that the MCU is as strict as it can be.
///
/// # Errors
/// [`ProgramError::AboveCeiling`], when the board allows less.
pub fn limits(
    schedule: &Schedule,
    steps: &[Step],
    rig: &Rig,
    mcu: &HelloReply,
) -> Result<Limits, ProgramError> {
    let heats = || {
        steps.iter().filter_map(|step| match step.action {
            Action::Heat(heat) => Some(heat),
            Action::Pulse(pulse) => Some(pulse.heat()),
            Action::Turn(_) | Action::Release(_) => None,
        })
    };
    let pulses = steps.iter().filter_map(|step| match step.action {
        Action::Release(release) => Some(release.pulse),
        Action::Heat(_) | Action::Turn(_) | Action::Pulse(_) => None,
    });
    let ceiling = &mcu.ceiling;
    let asked = Limits {
        max_temperature: heats().map(|heat| heat.max_temperature).max().unwrap_or(ceiling.max_temperature),
        max_on: heats().map(|heat| heat.max_on).chain(pulses).max().unwrap_or(ceiling.max_on),
        min_rest: heats().map(|heat| heat.rest).min().unwrap_or(ceiling.min_rest),
        supply: Milliamps(fit(0, "supply limit", schedule.supply_limit.0)?),
        link_timeout: link_timeout(rig),
    };
    match asked.laxer_than(ceiling) {
        Some((name, ceiling, asked)) => {
            Err(ProgramError::AboveCeiling { name, asked, ceiling, board: mcu.identity.board.to_string() })
        }
        None => Ok(asked),
    }
}

/// The rig's link timeout, which its file's rules keep below 5 s.
fn link_timeout(rig: &Rig) -> Millis {
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "0 to 5,000 by the rules of the file"
    )]
    let ms = (rig.link.timeout.0 * 1e3).round() as u32;
    Millis(ms)
}
