//! A rig whose hinges are known by measurement: what a calibration found counts more than what the rig file says of them.

use super::rules::Rules;
use super::settings::{Drive, ServoSettings, SmaSettings};
use super::{Amps, Celsius, Kelvins, Place, Rig, RigError, Seconds};
use crate::calibration::{Calibration, CalibrationError, Known};
use crate::heating;

/// Of the gain that a calibrated hinge is expected to have within `gain_window`, the share below which heating it is a fault (S6). A
/// supply that is loaded, or a colder room, costs less; a thermistor that came off or a broken heater costs more.
const LEAST_SHARE: f64 = 1.0 / 3.0;

/// A hinge as it was measured.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Measured {
    pub(super) hinge: usize,
    /// The heater or servo that it was measured with.
    pub(super) channel: u16,
    pub(super) drive: Drive,
    pub(super) heater: Option<HeaterExpectation>,
}

/// What a board is to expect of a heater that was measured, so that it can refuse steps that don't go with it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HeaterExpectation {
    /// Heater and thermistor.
    pub channel: u16,
    /// Current at full power.
    pub current: Amps,
    /// Rise at full power within [`Self::window`], the supply loaded to its limit.
    pub gain: Kelvins,
    /// From switching on.
    pub window: Seconds,
    /// Austenite finish, where it was seen.
    pub opens_at: Option<Celsius>,
}

/// A rig and a calibration that don't go together.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum CalibratedError {
    /// The calibration has a value that can't be read.
    #[error("{file}: {error}")]
    Calibration {
        /// The calibration file.
        file: String,
        /// What is wrong.
        error: CalibrationError,
    },
    /// The rig can't do with what was measured.
    #[error(transparent)]
    Rig(#[from] RigError),
}

impl Rig {
    /// The rig with what a calibration, read from `file`, knows of its hinges. Hinges that it knows nothing of stay as they were.
    ///
    /// # Errors
    /// [`CalibratedError`]: a hinge that is of another kind here, or whose measured values break a rule of the rig file, such as a
    /// target that isn't above its austenite finish.
    pub fn calibrated(mut self, file: &str, calibration: &Calibration) -> Result<Self, CalibratedError> {
        for hinge in &calibration.hinges {
            let unread = |error| CalibratedError::Calibration { file: file.to_owned(), error };
            let place = |key: &str| Place {
                file: file.to_owned(),
                line: None,
                key: format!("hinge {}: {key}", hinge.hinge),
            };
            let channel = hinge.channel;
            let (drive, heater) = match (self.drive_of(hinge.hinge), &hinge.servo) {
                (Drive::Sma(sma), None) => {
                    let (sma, heater) = measured(&self, &sma, &hinge.known().map_err(unread)?, channel);
                    (Drive::Sma(sma), heater)
                }
                (Drive::Servo(servo), Some(measured)) => {
                    let curve = measured.curve(hinge.hinge).map_err(unread)?;
                    (Drive::Servo(ServoSettings { curve, ..servo }), None)
                }
                (Drive::Sma(_) | Drive::Servo(_) | Drive::Spring(_), servo) => {
                    let kind = if servo.is_some() { "servo" } else { "shape-memory" };
                    let (expected, found) = (format!("a {kind} hinge of the rig"), "a hinge of another kind");
                    let found = found.to_owned();
                    return Err(RigError::Value { place: place("hinge"), expected, found }.into());
                }
            };
            Rules { place, rig: &self }.drive(&drive)?;
            self.measured.push(Measured { hinge: hinge.hinge, channel, drive, heater });
        }
        self.calibrated_by = Some(calibration.clone());
        Ok(self)
    }

    /// What the board is to expect of the heaters that were measured.
    pub fn heater_expectations(&self) -> impl Iterator<Item = HeaterExpectation> {
        self.measured.iter().filter_map(|measured| measured.heater)
    }

    /// What the rig file says of a hinge.
    pub(super) fn drive_of(&self, hinge: usize) -> Drive {
        let own = self.entries.iter().find(|entry| entry.hinge == hinge);
        own.map_or_else(|| self.shared(self.default_kind), |entry| entry.drive)
    }
}

/// The settings with all that is known in their place, and what is to be expected of the heater if enough is known.
fn measured(
    rig: &Rig,
    sma: &SmaSettings,
    known: &Known,
    channel: u16,
) -> (SmaSettings, Option<HeaterExpectation>) {
    let sma = SmaSettings {
        heater_resistance: known.heater_resistance.unwrap_or(sma.heater_resistance),
        thermal_resistance: known.foil_rise.unwrap_or(sma.thermal_resistance),
        time_constant: known.time_constant.unwrap_or(sma.time_constant),
        latent_heat: known.latent_heat.unwrap_or(sma.latent_heat),
        austenite_start: known.austenite_start.unwrap_or(sma.austenite_start),
        austenite_finish: known.austenite_finish.unwrap_or(sma.austenite_finish),
        ..*sma
    };
    // Without these there is nothing to expect.
    if known.heater_resistance.and(known.foil_rise).and(known.time_constant).is_none() {
        return (sma, None);
    }
    let (gain, window) = (heating::gain(rig, &sma, sma.gain_window), sma.gain_window);
    let (current, opens_at) = (heating::current(rig, &sma), known.austenite_finish);
    let expected = HeaterExpectation { channel, current, gain, window, opens_at };
    (SmaSettings { min_gain: Kelvins(gain.0 * LEAST_SHARE), ..sma }, Some(expected))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::rig_text;

    /// A calibration of hinge 0 at channel `channel`, with values of these keys.
    fn calibration(channel: u16, values: &[(&str, &str)]) -> Calibration {
        let values: Vec<_> = values
            .iter()
            .map(|(key, value)| {
                format!("[hinge.values.{key}]\nvalue = \"{value}\"\nlow = \"{value}\"\nhigh = \"{value}\"\n")
            })
            .collect();
        let text = format!(
            "version = 1\nrig = \"bench-1\"\nboard = \"b\"\nunique_id = \"00\"\n[[hinge]]\nhinge = 0\nchannel = {channel}\n\
             date = \"2026-01-02T03:04:05Z\"\nfirmware = \"f\"\nverdict = \"calibrated\"\n{}",
            values.concat()
        );
        Calibration::read(&text, "bench-1").unwrap()
    }

    fn rig(extra: &str) -> Rig {
        Rig::read("rig.toml", &rig_text(extra)).unwrap()
    }

    fn sma_of(rig: &Rig) -> SmaSettings {
        let Drive::Sma(sma) = rig.fit(1).unwrap()[0].drive else { panic!("the default kind is sma") };
        sma
    }

    const MEASURED: [(&str, &str); 4] = [
        ("heater_resistance", "27 ohm"),
        ("foil_rise", "120 K/W"),
        ("time_constant", "6 s"),
        ("austenite_finish", "80 degC"),
    ];

    #[test]
    fn what_was_measured_counts_and_the_rest_stays() {
        let rig = rig("");
        let before = sma_of(&rig);
        let after = sma_of(&rig.calibrated("c.toml", &calibration(0, &MEASURED)).unwrap());
        assert_eq!((after.heater_resistance.0, after.thermal_resistance.0), (27.0, 120.0));
        assert_eq!((after.time_constant.0, after.austenite_finish.0), (6.0, 80.0));
        assert_eq!((after.austenite_start, after.latent_heat), (before.austenite_start, before.latent_heat));
        assert_eq!((after.target, after.gain_window), (before.target, before.gain_window));
    }

    #[test]
    fn s6_the_least_gain_is_a_third_of_what_the_hinge_is_expected_to_gain() {
        let rig = rig("").calibrated("c.toml", &calibration(0, &MEASURED)).unwrap();
        let sma = sma_of(&rig);
        // All of it below the austenite's start: 3 s of 6 s towards what 4.9 V at 27 ohm settle at.
        let settled = 4.9_f64.powi(2) / 27.0 * 120.0;
        let expected = settled * (1.0 - (-0.5_f64).exp());
        assert!((sma.min_gain.0 - expected / 3.0).abs() < 1e-9, "{} K, {expected} K", sma.min_gain.0);
        let heater = rig.heater_expectations().next().unwrap();
        assert!((heater.gain.0 - expected).abs() < 1e-9 && (heater.current.0 - 5.0 / 27.0).abs() < 1e-9);
        assert_eq!((heater.channel, heater.window, heater.opens_at), (0, Seconds(3.0), Some(Celsius(80.0))));
    }

    #[test]
    fn a_hinge_of_which_too_little_is_known_keeps_its_least_gain() {
        let rig = rig("");
        let before = sma_of(&rig).min_gain;
        let after = rig.calibrated("c.toml", &calibration(0, &MEASURED[..1])).unwrap();
        assert_eq!((sma_of(&after).min_gain, sma_of(&after).heater_resistance.0), (before, 27.0));
        assert_eq!(after.heater_expectations().next(), None);
    }

    #[test]
    fn a_hinge_that_has_moved_to_another_channel_is_refused() {
        let rig = rig("").calibrated("c.toml", &calibration(1, &MEASURED)).unwrap();
        let error = rig.fit(1).unwrap_err().to_string();
        assert!(
            error.contains("hinge 0 at channel 0") && error.contains("a calibration at channel 1"),
            "{error}"
        );
    }

    #[test]
    fn a_target_below_the_measured_austenite_finish_is_refused_with_file_and_hinge() {
        let error = rig("").calibrated("c.toml", &calibration(0, &[("austenite_finish", "97 degC")]));
        let error = error.unwrap_err().to_string();
        assert!(error.starts_with("c.toml: hinge 0: austenite_finish: expected less than target"), "{error}");
    }

    /// A calibration of the servo of hinge 0 at channel `channel`, with pulses in microseconds.
    fn servo_calibration(channel: u16, points: &[(u16, u16)]) -> Calibration {
        let point = |(angle, pulse): &(u16, u16)| {
            format!(
                "[[hinge.servo.point]]\nangle = \"{angle} deg\"\npulse = \"{pulse} us\"\nread = \"{angle} deg\"\n"
            )
        };
        let text = format!(
            "version = 2\nrig = \"bench-1\"\nboard = \"b\"\nunique_id = \"00\"\n[[hinge]]\nhinge = 0\nchannel = {channel}\n\
             date = \"2026-01-02T03:04:05Z\"\nfirmware = \"f\"\nverdict = \"calibrated\"\n[hinge.servo]\ntolerance = \"1 deg\"\n{}",
            points.iter().map(point).collect::<String>()
        );
        Calibration::read(&text, "bench-1").unwrap()
    }

    const SERVO: &str = "[[hinge]]\nhinge = 0\nkind = \"servo\"\n";

    #[test]
    fn a_servos_pulses_are_those_that_were_found_and_one_that_failed_keeps_the_rig_files() {
        let points = [(0, 640), (90, 1100), (180, 1700)];
        let rig = |calibration| rig(SERVO).calibrated("c.toml", &calibration).unwrap();
        let curve = |rig: &Rig| match rig.fit(1).unwrap()[0].drive {
            Drive::Servo(servo) => servo.curve,
            other => panic!("{other:?}"),
        };
        let found = curve(&rig(servo_calibration(0, &points))).unwrap();
        let pulses: Vec<_> = found.points().iter().map(|(_, pulse)| (pulse.0 * 1e6).round()).collect();
        assert_eq!(pulses, [640.0, 1100.0, 1700.0]);
        assert_eq!(curve(&rig(servo_calibration(0, &[]))), None);
        let moved = rig(servo_calibration(1, &points)).fit(1).unwrap_err().to_string();
        assert!(moved.contains("expected hinge 0 at channel 0"), "{moved}");
    }

    #[test]
    fn pulses_beyond_the_rigs_are_refused_and_so_is_a_servo_that_is_none_here() {
        let narrow =
            SERVO.to_owned() + "servo = { shortest_pulse = \"450 us\", longest_pulse = \"2600 us\" }\n";
        let beyond = rig(&narrow).calibrated("c.toml", &servo_calibration(0, &[(0, 440), (90, 1100)]));
        let beyond = beyond.unwrap_err().to_string();
        assert!(
            beyond.starts_with("c.toml: hinge 0: pulse at 0 deg: expected 0.00045 s to 0.0026 s"),
            "{beyond}"
        );
        let other = rig("").calibrated("c.toml", &servo_calibration(0, &[])).unwrap_err().to_string();
        assert_eq!(
            other,
            "c.toml: hinge 0: hinge: expected a servo hinge of the rig, found a hinge of another kind"
        );
    }

    #[test]
    fn a_hinge_that_is_a_servo_here_is_refused() {
        let rig = rig("[[hinge]]\nhinge = 0\nkind = \"servo\"\n");
        let error = rig.calibrated("c.toml", &calibration(0, &MEASURED)).unwrap_err().to_string();
        assert_eq!(
            error,
            "c.toml: hinge 0: hinge: expected a shape-memory hinge of the rig, found a hinge of another kind"
        );
    }
}
