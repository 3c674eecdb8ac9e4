//! What a calibration file says of a servo hinge: the pulses at which it stood at its angles, and the angles that it doesn't reach.

use crate::calibration::{CalibratedHinge, CalibrationError};
use crate::rig::{Degrees, Seconds, ServoCurve};
use serde::{Deserialize, Serialize};
use std::fmt::Display;
use std::str::FromStr;

/// A servo as it was found.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CalibratedServo {
    /// How far from its angle a pulse may have been found.
    pub tolerance: String,
    /// How far the servo is from a straight line at the worst.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub worst_off_line: Option<String>,
    /// Lower end stop, where one was met.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub stop_low: Option<String>,
    /// Upper end stop, where one was met.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub stop_high: Option<String>,
    /// By rising angle.
    #[serde(default, rename = "point", skip_serializing_if = "Vec::is_empty")]
    pub points: Vec<ServoPoint>,
    /// By rising angle.
    #[serde(default, rename = "no_pulse", skip_serializing_if = "Vec::is_empty")]
    pub unreached: Vec<NoPulse>,
}

/// An angle with its pulse.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ServoPoint {
    /// The opening angle.
    pub angle: String,
    /// Its pulse.
    pub pulse: String,
    /// What was read at that pulse.
    pub read: String,
}

/// An angle without a pulse.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct NoPulse {
    /// The opening angle.
    pub angle: String,
    /// Why.
    pub why: String,
}

impl CalibratedServo {
    /// The pulses as a curve; none of a servo of which fewer than two are known.
    ///
    /// # Errors
    /// A value whose unit isn't its own, or points that no servo has; `hinge` is for the message.
    pub fn curve(&self, hinge: usize) -> Result<Option<ServoCurve>, CalibrationError> {
        let point = |point: &ServoPoint| {
            let angle: Degrees = quantity(hinge, "angle", &point.angle)?;
            let pulse: Seconds = quantity(hinge, "pulse", &point.pulse)?;
            Ok((angle, pulse))
        };
        let points = self.points.iter().map(point).collect::<Result<Vec<_>, CalibrationError>>()?;
        if points.len() < 2 {
            return Ok(None);
        }
        let curve = ServoCurve::new(&points).ok_or_else(|| CalibrationError::Parse {
            message: format!(
                "hinge {hinge}: servo.point: expected up to four rising angles whose pulses all rise or all fall, found {points:?}"
            ),
        })?;
        Ok(Some(curve))
    }
}

impl CalibratedHinge {
    /// Of a calibrated servo hinge the shortest and the longest pulse, in microseconds, that it may be driven with: it was seen to stand
    /// free at both. None for other hinges, and for servos of which fewer than two pulses are known.
    ///
    /// # Errors
    /// As [`CalibratedServo::curve`].
    pub fn servo_range_us(&self) -> Result<Option<(u16, u16)>, CalibrationError> {
        let Some(servo) = &self.servo else { return Ok(None) };
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "it saturates, and a rig refuses such pulses"
        )]
        let whole = |pulse: Seconds| (pulse.0 * 1e6).round() as u16;
        Ok(servo.curve(self.hinge)?.map(|curve| {
            let (shortest, longest) = curve.range();
            (whole(shortest), whole(longest))
        }))
    }
}

fn quantity<T: FromStr<Err: Display>>(hinge: usize, key: &str, text: &str) -> Result<T, CalibrationError> {
    text.parse().map_err(|error| CalibrationError::Parse {
        message: format!("hinge {hinge}: servo.point.{key}: {error}"),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Calibration;

    fn file(points: &[(&str, &str)]) -> String {
        let points: Vec<_> = points
            .iter()
            .map(|(angle, pulse)| {
                format!(
                    "[[hinge.servo.point]]\nangle = \"{angle}\"\npulse = \"{pulse}\"\nread = \"{angle}\"\n"
                )
            })
            .collect();
        format!(
            "version = 2\nrig = \"r\"\nboard = \"b\"\nunique_id = \"00\"\n[[hinge]]\nhinge = 4\nchannel = 1\n\
             date = \"2026-01-02T03:04:05Z\"\nfirmware = \"f\"\nverdict = \"calibrated\"\n[hinge.servo]\ntolerance = \"1 deg\"\n{}",
            points.concat()
        )
    }

    fn hinge(points: &[(&str, &str)]) -> CalibratedHinge {
        Calibration::read(&file(points), "r").unwrap().hinges.remove(0)
    }

    #[test]
    fn a_servo_may_be_driven_between_its_outermost_pulses_whichever_way_it_turns() {
        assert_eq!(
            hinge(&[("0 deg", "612 us"), ("90 deg", "1.2 ms")]).servo_range_us(),
            Ok(Some((612, 1200)))
        );
        assert_eq!(
            hinge(&[("0 deg", "2400 us"), ("180 deg", "700 us")]).servo_range_us(),
            Ok(Some((700, 2400)))
        );
        assert_eq!(hinge(&[("90 deg", "1500 us")]).servo_range_us(), Ok(None));
        assert_eq!(CalibratedHinge { servo: None, ..hinge(&[]) }.servo_range_us(), Ok(None));
    }

    #[test]
    fn points_that_no_servo_has_are_refused_with_their_hinge() {
        for (points, message) in [
            (&[("0 deg", "612 V"), ("90 deg", "1 ms")][..], "hinge 4: servo.point.pulse: expected a time"),
            (&[("0 V", "612 us"), ("90 deg", "1 ms")], "hinge 4: servo.point.angle: expected an angle"),
            (
                &[("0 deg", "1 ms"), ("90 deg", "1 ms")],
                "hinge 4: servo.point: expected up to four rising angles",
            ),
        ] {
            let error = hinge(points).servo_range_us().unwrap_err().to_string();
            assert!(error.contains(message), "{error}");
        }
    }

    #[test]
    fn what_is_written_of_a_servo_is_read() {
        let text = file(&[("0 deg", "612 us"), ("90 deg", "1200 us")]);
        let calibration = Calibration::read(&text, "r").unwrap();
        assert_eq!(Calibration::read(&calibration.text().unwrap(), "r"), Ok(calibration));
    }
}
