//! What a calibrated rig has a board keep of its actuators, so that the board refuses steps that don't go with them (S6, S13).

use std::num::TryFromIntError;
use zygote_deployment::{CalibrationError, HeaterExpectation, Rig};
use zygote_protocol::{Calibration, CentiCelsius, HeaterCalibration, Milliamps, Millis, ServoCalibration};

/// Why a board can't keep what was measured.
#[derive(Debug, thiserror::Error)]
pub enum UntoldError {
    /// A value far beyond that of any hinge.
    #[error("heater channel {channel}: what was measured is more than the protocol can carry")]
    TooLarge {
        /// The channel.
        channel: u16,
        /// Why.
        #[source]
        source: TryFromIntError,
    },
    /// A value that can't be read.
    #[error(transparent)]
    Unread(#[from] CalibrationError),
}

/// What was measured of the rig's heaters and servos, in the words of the wire; `rig` is driven by `calibration`.
///
/// # Errors
/// [`UntoldError`], for values that no hinge has.
pub fn known(
    rig: &Rig,
    calibration: &zygote_deployment::Calibration,
) -> Result<Vec<Calibration>, UntoldError> {
    let mut known =
        rig.heater_expectations().map(|heater| of_heater(&heater)).collect::<Result<Vec<_>, _>>()?;
    for hinge in &calibration.hinges {
        if let Some((shortest_us, longest_us)) = hinge.servo_range_us()? {
            let range = ServoCalibration { shortest_us, longest_us };
            known.push(Calibration::Servo { channel: hinge.channel, known: Some(range) });
        }
    }
    Ok(known)
}

/// Rounded so that schedules of the same rig surely go with it: the gain to the nearest as theirs, the current down.
fn of_heater(heater: &HeaterExpectation) -> Result<Calibration, UntoldError> {
    let channel = heater.channel;
    let too_large = |source| UntoldError::TooLarge { channel, source };
    let current = zygote_deployment::Milliamps::at_most(heater.current);
    let gain = zygote_deployment::CentiCelsius::from(heater.gain);
    let window = zygote_deployment::Millis::at_least(heater.window);
    let celsius = |value: zygote_deployment::CentiCelsius| value.0.try_into().map(CentiCelsius);
    let opens_at = heater.opens_at.map(zygote_deployment::CentiCelsius::from);
    let known = HeaterCalibration {
        current: Milliamps(current.0.try_into().map_err(too_large)?),
        gain: celsius(gain).map_err(too_large)?,
        window: Millis(window.0.try_into().map_err(too_large)?),
        opens_at: opens_at.map(celsius).transpose().map_err(too_large)?,
    };
    Ok(Calibration::Heater { channel, known: Some(known) })
}
