//! Where a hinge is, as far as its MCU's measurements tell: the temperature of an SMA hinge, the pulse of a servo.

use zygote_deployment::{Drive, Motion as Planned, Step};
use zygote_protocol::{Motion, Phase};

/// A hinge on its way.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MotionState {
    /// Number of the hinge in the plan.
    pub hinge: usize,
    /// What it is doing.
    pub phase: &'static str,
    /// Measured temperature, °C, of an SMA hinge.
    pub temperature_c: Option<f64>,
    /// Share of the heater's power, 0 to 1, of an SMA hinge that is heated.
    pub duty: Option<f64>,
    /// Estimated opening angle, degrees: from the temperature between the rig's austenite start and finish, or from
    /// the servo's pulse. A spring gives no hint.
    pub opening_deg: Option<f64>,
}

impl MotionState {
    /// What a motion of the telemetry means for its step.
    pub(crate) fn new(motion: Motion, step: &Step, drive: &Drive) -> Self {
        let (from, to) = (f64::from(step.from_opening_deg), f64::from(step.opening_deg));
        let celsius = |temperature: zygote_protocol::CentiCelsius| f64::from(temperature.0) / 100.0;
        let (phase, temperature_c, share) = match motion.phase {
            Phase::Heating { temperature, .. } => {
                ("heating", Some(celsius(temperature)), austenite(drive, celsius(temperature)))
            }
            Phase::Holding { temperature, .. } => ("holding", Some(celsius(temperature)), Some(1.0)),
            Phase::Cooling { temperature } => ("cooling", Some(celsius(temperature)), Some(1.0)),
            Phase::Turning { pulse_us } => ("turning", None, turned(step, pulse_us)),
            Phase::Releasing => ("releasing", None, None),
        };
        let duty = match motion.phase {
            Phase::Heating { duty, .. } | Phase::Holding { duty, .. } => Some(f64::from(duty) / 1e3),
            Phase::Cooling { .. } | Phase::Turning { .. } | Phase::Releasing => None,
        };
        let opening_deg = share.map(|share| from + share * (to - from));
        Self { hinge: step.hinge, phase, temperature_c, duty, opening_deg }
    }
}

/// Share of the motion that an SMA hinge has made while it is heated: none at As, all at Af, a line between.
fn austenite(drive: &Drive, celsius: f64) -> Option<f64> {
    let Drive::Sma(sma) = drive else { return None };
    let (start, finish) = (sma.austenite_start.0, sma.austenite_finish.0);
    Some(((celsius - start) / (finish - start)).clamp(0.0, 1.0))
}

/// Share of the motion that a servo has been led through.
fn turned(step: &Step, pulse_us: u16) -> Option<f64> {
    let Planned::Servo(servo) = step.motion else { return None };
    let (from, to) = (f64::from(servo.from.0), f64::from(servo.to.0));
    let way = to - from;
    Some(if way == 0.0 { 1.0 } else { ((f64::from(pulse_us) - from) / way).clamp(0.0, 1.0) })
}
