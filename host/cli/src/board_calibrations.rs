//! What a board keeps of its actuators by measurement: told to it, and told by it for people and programs.

use crate::failure::{Failure, OrFail};
use serde::Serialize;
use serde_json::{Value, json};
use std::path::Path;
use zygote_controller::{RequestError, Session, Transport};
use zygote_deployment::{CalibrationVerdict, Rig};
use zygote_protocol::{Actuator, Calibration};

/// All that the board knows, channel by channel.
pub(crate) fn of<T: Transport>(session: &mut Session<T>) -> Result<Vec<Calibration>, RequestError> {
    let channels = session.info().channels;
    let heaters = (0..channels.heaters).map(Actuator::Heater);
    let actuators = heaters.chain((0..channels.servos).map(Actuator::Servo));
    let mut known = Vec::new();
    for actuator in actuators {
        let calibration = session.calibration(actuator)?;
        if calibration != forgotten(&calibration) {
            known.push(calibration);
        }
    }
    Ok(known)
}

/// What a board was told to keep.
#[derive(Debug, Serialize)]
pub(crate) struct Taught {
    /// Heaters and servos of which it knows something.
    known: usize,
    /// Those of which it didn't know that before.
    new: usize,
}

/// Has the board keep what is known of hinges that are calibrated, so that it refuses steps that don't go with it.
pub(crate) fn teach<T: Transport>(
    session: &mut Session<T>,
    rig: &Rig,
    file: &Path,
    result: &zygote_deployment::Calibration,
) -> Result<Taught, Failure> {
    let mut sound = result.clone();
    sound.hinges.retain(|hinge| hinge.verdict == CalibrationVerdict::Calibrated);
    let rig = rig.clone().calibrated(&file.display().to_string(), &sound).or_failed()?;
    let known = zygote_controller::known(&rig, &sound).or_failed()?;
    let new = session.calibrate(&known).or_failed()?;
    Ok(Taught { known: known.len(), new })
}

impl Taught {
    /// As a line of text.
    pub(crate) fn line(&self) -> String {
        let Self { known, new } = self;
        format!("the board keeps what is known of {known} heater(s) and servo(s), {new} of them new")
    }
}

/// Has the board forget what is known of the servos of these channels.
pub(crate) fn forget<T: Transport>(
    session: &mut Session<T>,
    channels: impl Iterator<Item = u16>,
) -> Result<usize, RequestError> {
    let nothing: Vec<_> = channels.map(|channel| Calibration::Servo { channel, known: None }).collect();
    session.calibrate(&nothing)
}

/// The same actuator, of which nothing is known.
pub(crate) fn forgotten(calibration: &Calibration) -> Calibration {
    match *calibration {
        Calibration::Heater { channel, .. } => Calibration::Heater { channel, known: None },
        Calibration::Servo { channel, .. } => Calibration::Servo { channel, known: None },
    }
}

/// As JSON, in the units of the protocol.
pub(crate) fn value(calibration: &Calibration) -> Value {
    match calibration {
        Calibration::Heater { channel, known: Some(known) } => json!({
            "heater": channel,
            "current_ma": known.current.0,
            "gain_centi_k": known.gain.0,
            "window_ms": known.window.0,
            "opens_at_centi_c": known.opens_at.map(|opens_at| opens_at.0),
        }),
        Calibration::Servo { channel, known: Some(known) } => json!({
            "servo": channel,
            "shortest_pulse_us": known.shortest_us,
            "longest_pulse_us": known.longest_us,
        }),
        Calibration::Heater { channel, known: None } => json!({ "heater": channel }),
        Calibration::Servo { channel, known: None } => json!({ "servo": channel }),
    }
}

/// As a line of text.
pub(crate) fn line(calibration: &Calibration) -> String {
    match calibration {
        Calibration::Heater { channel, known: Some(known) } => {
            let opens_at = known
                .opens_at
                .map_or_else(String::new, |at| format!(", open at {:.1} °C", f64::from(at.0) / 100.0));
            let gain = f64::from(known.gain.0) / 100.0;
            let (current, window) = (known.current, known.window);
            format!("heater {channel}: {current} at full power, {gain:.1} K in {window}{opens_at}")
        }
        Calibration::Servo { channel, known: Some(known) } => {
            format!("servo {channel}: {} to {} us", known.shortest_us, known.longest_us)
        }
        Calibration::Heater { channel, known: None } => format!("heater {channel}: nothing is known"),
        Calibration::Servo { channel, known: None } => format!("servo {channel}: nothing is known"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use zygote_protocol::{CentiCelsius, HeaterCalibration, Milliamps, Millis, ServoCalibration};

    #[test]
    fn what_is_known_is_told_in_a_line_each() {
        let heater = HeaterCalibration {
            current: Milliamps(197),
            gain: CentiCelsius(4_812),
            window: Millis(3_000),
            opens_at: Some(CentiCelsius(7_790)),
        };
        let of_heater = |known| line(&Calibration::Heater { channel: 3, known: Some(known) });
        assert_eq!(of_heater(heater), "heater 3: 197 mA at full power, 48.1 K in 3000 ms, open at 77.9 °C");
        let unseen = HeaterCalibration { opens_at: None, ..heater };
        assert_eq!(of_heater(unseen), "heater 3: 197 mA at full power, 48.1 K in 3000 ms");
        let servo = ServoCalibration { shortest_us: 600, longest_us: 2_400 };
        assert_eq!(line(&Calibration::Servo { channel: 0, known: Some(servo) }), "servo 0: 600 to 2400 us");
    }
}
