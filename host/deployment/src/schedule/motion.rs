//! What the MCU is told to do with one hinge: the rig's settings, resolved for that hinge.

use super::units::{CentiCelsius, Micros, Milliamps, Millis};
use crate::heating;
use crate::rig::{Degrees, Drive, Kind, Rig, RigError, Seconds, ServoSettings, SmaSettings, SpringSettings};
use serde::{Deserialize, Serialize};
use zygote_stacking::{Hinge, HingeKind};

/// The motion of one hinge.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "lowercase")]
pub enum Motion {
    /// Heat, hold, then cool without being waited for.
    Sma(SmaMotion),
    /// Lead the pulse from one width to another, then hold it.
    Servo(ServoMotion),
    /// Energise the release, then wait.
    Spring(SpringMotion),
}

/// Heating of a shape-memory hinge.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SmaMotion {
    /// Temperature to heat to and to hold.
    #[serde(rename = "target_centi_celsius")]
    pub target: CentiCelsius,
    /// Time at the target after which the hinge is opened.
    #[serde(rename = "hold_ms")]
    pub hold: Millis,
    /// Longest time that the heater may be on (S4).
    #[serde(rename = "max_on_ms")]
    pub max_on: Millis,
    /// Hotter is a fault (S4).
    #[serde(rename = "max_temperature_centi_celsius")]
    pub max_temperature: CentiCelsius,
    /// Cooled at this temperature.
    #[serde(rename = "cool_to_centi_celsius")]
    pub cool_to: CentiCelsius,
    /// Least time without heating afterwards (S4).
    #[serde(rename = "rest_ms")]
    pub rest: Millis,
    /// A smaller rise than this in `gain_window` while heating is a fault (S6).
    #[serde(rename = "min_gain_centi_celsius")]
    pub min_gain: CentiCelsius,
    /// See `min_gain`.
    #[serde(rename = "gain_window_ms")]
    pub gain_window: Millis,
}

/// Move of a servo hinge.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ServoMotion {
    /// Pulse at the start.
    #[serde(rename = "from_us")]
    pub from: Micros,
    /// Pulse at the end, held until the run ends.
    #[serde(rename = "to_us")]
    pub to: Micros,
    /// Time from one to the other.
    #[serde(rename = "move_ms")]
    pub duration: Millis,
    /// Wait after it.
    #[serde(rename = "settle_ms")]
    pub settle: Millis,
}

/// Release of a spring hinge.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SpringMotion {
    /// How long the release is energised.
    #[serde(rename = "pulse_ms")]
    pub pulse: Millis,
    /// Wait after it.
    #[serde(rename = "settle_ms")]
    pub settle: Millis,
}

/// A motion with what planning needs to know of it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Cost {
    pub(crate) motion: Motion,
    /// From the start until the hinge is opened, as expected.
    pub(crate) duration: Millis,
    /// The most that it draws in that time.
    pub(crate) current: Milliamps,
    /// What it draws from then on.
    pub(crate) hold_current: Milliamps,
}

impl Motion {
    /// What moves the hinge.
    pub const fn kind(&self) -> Kind {
        match self {
            Self::Sma(_) => Kind::Sma,
            Self::Servo(_) => Kind::Servo,
            Self::Spring(_) => Kind::Spring,
        }
    }
}

impl Motion {
    /// What of it isn't as expected, in words.
    pub(crate) fn differences(&self, expected: &Self) -> String {
        match (self, expected) {
            (Self::Sma(found), Self::Sma(expected)) => told(&[
                ("target", celsius(expected.target), celsius(found.target)),
                ("hold", expected.hold.to_string(), found.hold.to_string()),
                ("longest on-time", expected.max_on.to_string(), found.max_on.to_string()),
                ("highest temperature", celsius(expected.max_temperature), celsius(found.max_temperature)),
                ("cooled temperature", celsius(expected.cool_to), celsius(found.cool_to)),
                ("rest", expected.rest.to_string(), found.rest.to_string()),
                ("least gain", kelvins(expected.min_gain), kelvins(found.min_gain)),
                ("gain window", expected.gain_window.to_string(), found.gain_window.to_string()),
            ]),
            (Self::Servo(found), Self::Servo(expected)) => told(&[
                ("first pulse", expected.from.to_string(), found.from.to_string()),
                ("last pulse", expected.to.to_string(), found.to.to_string()),
                ("time of the move", expected.duration.to_string(), found.duration.to_string()),
                ("settling time", expected.settle.to_string(), found.settle.to_string()),
            ]),
            (Self::Spring(found), Self::Spring(expected)) => told(&[
                ("pulse", expected.pulse.to_string(), found.pulse.to_string()),
                ("settling time", expected.settle.to_string(), found.settle.to_string()),
            ]),
            (Self::Sma(_) | Self::Servo(_) | Self::Spring(_), _) => {
                format!("it should be a {} hinge, found a {}", expected.kind().name(), self.kind().name())
            }
        }
    }
}

fn celsius(temperature: CentiCelsius) -> String {
    format!("{:.2} °C", f64::from(temperature.0) / 100.0)
}

fn kelvins(difference: CentiCelsius) -> String {
    format!("{:.2} K", f64::from(difference.0) / 100.0)
}

/// Of names with what is expected and what was found, those that differ.
fn told(rows: &[(&str, String, String)]) -> String {
    let differ = rows.iter().filter(|(_, expected, found)| expected != found);
    let words = differ.map(|(name, expected, found)| format!("{name} should be {expected}, found {found}"));
    words.collect::<Vec<_>>().join(", ")
}

/// Opening angle of a hinge in the zygote, degrees: a fold is closed, a bridge is flat.
pub(crate) const fn start_opening_deg(hinge: &Hinge) -> u16 {
    match hinge.kind {
        HingeKind::Fold => 0,
        HingeKind::Bridge => 180,
    }
}

impl Cost {
    /// What moving `hinge`, which has this number, with `drive` takes.
    ///
    /// # Errors
    /// [`RigError`] for a servo that doesn't reach the hinge's angles.
    pub(crate) fn new(rig: &Rig, number: usize, hinge: &Hinge, drive: &Drive) -> Result<Self, RigError> {
        match drive {
            Drive::Sma(sma) => Ok(Self::sma(rig, sma)),
            Drive::Servo(servo) => Self::servo(rig, number, hinge, servo),
            Drive::Spring(spring) => Ok(Self::spring(spring)),
        }
    }

    fn sma(rig: &Rig, sma: &SmaSettings) -> Self {
        let motion = SmaMotion {
            target: sma.target.into(),
            hold: Millis::at_least(sma.hold),
            max_on: Millis::at_least(sma.max_on),
            max_temperature: sma.max_temperature.into(),
            cool_to: sma.cool_to.into(),
            rest: Millis::at_least(sma.rest),
            min_gain: sma.min_gain.into(),
            gain_window: Millis::at_least(sma.gain_window),
        };
        Self {
            motion: Motion::Sma(motion),
            duration: Millis::at_least(heating::time_to_target(rig, sma)) + motion.hold,
            current: Milliamps::at_least(heating::current(rig, sma)),
            hold_current: Milliamps(0),
        }
    }

    fn servo(rig: &Rig, number: usize, hinge: &Hinge, servo: &ServoSettings) -> Result<Self, RigError> {
        let (from, to) = (f64::from(start_opening_deg(hinge)), f64::from(hinge.opening_deg));
        let pulse = |deg: f64| Ok::<_, RigError>(Micros::nearest(rig.pulse(number, servo, Degrees(deg))?));
        let motion = ServoMotion {
            from: pulse(from)?,
            to: pulse(to)?,
            duration: Millis::at_least(Seconds((to - from).abs() / servo.speed.0)),
            settle: Millis::at_least(servo.settle),
        };
        Ok(Self {
            motion: Motion::Servo(motion),
            duration: motion.duration + motion.settle,
            current: Milliamps::at_least(servo.current),
            hold_current: Milliamps::at_least(servo.hold_current),
        })
    }

    /// The current counts for the settling too: a little unused supply is cheaper than a second figure a step.
    fn spring(spring: &SpringSettings) -> Self {
        let motion =
            SpringMotion { pulse: Millis::at_least(spring.pulse), settle: Millis::at_least(spring.settle) };
        Self {
            motion: Motion::Spring(motion),
            duration: motion.pulse + motion.settle,
            current: Milliamps::at_least(spring.current),
            hold_current: Milliamps(0),
        }
    }
}
