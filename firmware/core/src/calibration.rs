//! Steps against what was measured of their actuators: a host that expects too little of a heater would see a loose thermistor late
//! (S6), one that declares too little current would overload the supply (S7), and a servo isn't pushed against its ends (S13).
//!
//! Pulses are free of this: they find out what a heater is like, and may find another one than was there before.

use crate::program::{index, refuse};
use zygote_protocol::{
    Action, Actuator, Calibration, CentiCelsius, Channels, Heat, HeaterCalibration, Kept, Milliamps, Millis,
    Refusal, RefusalCode, ServoCalibration, Step, Turn,
};

/// Of the measured current, the percentage that a step declares at least: the supply may be a little lower than it was.
const LEAST_CURRENT: u64 = 80;
/// A step expects at least this part of the measured gain.
const GAIN_PART: u64 = 4;

/// Holds a step against what is known of its actuator. By itself, so that no command's stack holds it but while it runs.
///
/// # Errors
/// The refusal of the step.
#[inline(never)]
pub(crate) fn check<const H: usize, const S: usize>(
    known: &Kept<H, S>,
    at: u16,
    step: &Step,
) -> Result<(), Refusal> {
    match &step.action {
        Action::Heat(heat) => known.heater(heat.channel).map_or(Ok(()), |known| check_heat(at, heat, known)),
        Action::Turn(turn) => known.servo(turn.channel).map_or(Ok(()), |known| check_turn(at, turn, known)),
        Action::Pulse(_) | Action::Release(_) => Ok(()),
    }
}

fn check_heat(at: u16, heat: &Heat, known: HeaterCalibration) -> Result<(), Refusal> {
    let least = u64::from(known.current.0) * LEAST_CURRENT / 100;
    if u64::from(heat.current.0) < least {
        return Err(refuse(RefusalCode::CalibratedCurrent, at, whole(least), heat.current.0));
    }
    let least = least_gain(known, heat.gain_window);
    if i64::from(heat.min_gain.0) < least {
        return Err(refuse(RefusalCode::CalibratedGain, at, least, heat.min_gain.0));
    }
    match known.opens_at {
        Some(opens_at) if heat.target <= opens_at => {
            Err(refuse(RefusalCode::CalibratedTarget, at, opens_at.0, heat.target.0))
        }
        Some(_) | None => Ok(()),
    }
}

/// A temperature rises slower and slower, so within a shorter time it gains more than in proportion.
fn least_gain(known: HeaterCalibration, window: Millis) -> i64 {
    let gain = u64::from(known.gain.0.unsigned_abs());
    let (window, whole_window) = (u64::from(window.0), u64::from(known.window.0.max(1)));
    whole(gain * window.min(whole_window) / whole_window / GAIN_PART)
}

fn check_turn(at: u16, turn: &Turn, known: ServoCalibration) -> Result<(), Refusal> {
    for pulse in [turn.from_us, turn.to_us] {
        let nearest = pulse.min(known.longest_us).max(known.shortest_us);
        if pulse != nearest {
            return Err(refuse(RefusalCode::ServoRange, at, nearest, pulse));
        }
    }
    Ok(())
}

/// Of so many channels the board has this one.
///
/// # Errors
/// The refusal of a channel that it doesn't have.
pub(crate) fn check_actuator(actuator: Actuator, channels: Channels) -> Result<(), Refusal> {
    let (channel, count) = match actuator {
        Actuator::Heater(channel) => (channel, channels.heaters),
        Actuator::Servo(channel) => (channel, channels.servos),
    };
    let unknown = || refuse(RefusalCode::UnknownChannel, channel, i64::from(count) - 1, channel);
    if channel < count { Ok(()) } else { Err(unknown()) }
}

/// What can be measured.
///
/// # Errors
/// The refusal of a calibration with a value that can't be.
pub(crate) fn check_values(calibration: &Calibration) -> Result<(), Refusal> {
    let (channel, value) = match *calibration {
        Calibration::Heater { channel, known: Some(known) } => (channel, wrong_heater(known)),
        Calibration::Servo { channel, known: Some(known) } => (channel, wrong_servo(known)),
        Calibration::Heater { known: None, .. } | Calibration::Servo { known: None, .. } => return Ok(()),
    };
    match value {
        Some((nearest, got)) => Err(refuse(RefusalCode::CalibrationValue, channel, nearest, got)),
        None => Ok(()),
    }
}

/// A heater that draws nothing, gains nothing or takes no time would switch its checks off.
fn wrong_heater(known: HeaterCalibration) -> Option<(i64, i64)> {
    let HeaterCalibration {
        current: Milliamps(current),
        gain: CentiCelsius(gain),
        window: Millis(window),
        ..
    } = known;
    [i64::from(current), i64::from(gain), i64::from(window)]
        .into_iter()
        .find(|value| *value <= 0)
        .map(|got| (1, got))
}

fn wrong_servo(known: ServoCalibration) -> Option<(i64, i64)> {
    let ServoCalibration { shortest_us, longest_us } = known;
    (shortest_us > longest_us).then_some((longest_us.into(), shortest_us.into()))
}

fn whole(value: u64) -> i64 {
    i64::try_from(value).unwrap_or(i64::MAX)
}

/// Holds every step of a program against what is known.
///
/// # Errors
/// The refusal of the first step that doesn't go with it.
pub(crate) fn check_all<const H: usize, const S: usize>(
    known: &Kept<H, S>,
    steps: &[Step],
) -> Result<(), Refusal> {
    steps.iter().enumerate().try_for_each(|(at, step)| check(known, index(at), step))
}
