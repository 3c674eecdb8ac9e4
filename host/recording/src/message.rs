//! Our own messages: what the event log has, and what can be plotted.

use serde::{Deserialize, Serialize};
use zygote_controller::{MotionState, Record, Times};

/// A message of `/events`: a line of the event log, without telemetry.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Event {
    /// When.
    #[serde(flatten)]
    pub times: Times,
    /// What.
    #[serde(flatten)]
    pub record: Record,
}

/// A message of `/telemetry`: a look at the rig.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Telemetry {
    /// When.
    #[serde(flatten)]
    pub times: Times,
    /// MCU time.
    pub mcu_us: u64,
    /// Supply voltage, V.
    pub supply_v: f64,
    /// Measured sum of currents, A.
    pub current_a: f64,
    /// Steps opened.
    pub opened: u16,
    /// The hinges under way.
    pub motions: Vec<Reading>,
}

/// What is known of a hinge under way.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Reading {
    /// Number of the hinge in the plan.
    pub hinge: usize,
    /// What it is doing: heating, holding, cooling, turning, releasing.
    pub phase: String,
    /// Measured temperature, °C.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub temperature_c: Option<f64>,
    /// Share of the heater's power, 0 to 1.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub duty: Option<f64>,
    /// Estimated opening angle, degrees.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub opening_deg: Option<f64>,
}

impl From<&MotionState> for Reading {
    fn from(motion: &MotionState) -> Self {
        Self {
            hinge: motion.hinge,
            phase: motion.phase.to_owned(),
            temperature_c: motion.temperature_c,
            duty: motion.duty,
            opening_deg: motion.opening_deg.map(to_tenths),
        }
    }
}

/// Finer the estimate isn't.
fn to_tenths(degrees: f64) -> f64 {
    (degrees * 10.0).round() / 10.0
}
