//! The schedule: one step a hinge, in the order in which the MCU gets them. `docs/src/schedule.md` is the page
//! for its JSON.
//!
//! [`Schedule::plan`] makes one, [`Schedule::verify`] holds it against plan and rig without using what made it.
//!
//! ```text
//! Order + Rig + Limits -> Problem --lower_bound--> time that none is shorter than
//!                            |
//!                            +--search (greedy, timeline, exact)--> starts --waiting--> after --> Schedule
//! ```

mod crossing;
mod exact;
mod fingerprint;
mod greedy;
mod heaviest;
mod lower_bound;
mod make;
mod motion;
mod problem;
mod progress;
mod reduction;
mod rest;
mod reversed;
mod search;
mod timeline;
mod units;
mod verify;
mod waiting;

pub use crossing::Crossing;
pub use fingerprint::Fingerprint;
pub use make::{Limits, SchedulingError};
pub(crate) use motion::start_opening_deg;
pub use motion::{Motion, ServoMotion, SmaMotion, SpringMotion};
pub use reversed::{Direction, ReverseError};
pub use units::{CentiCelsius, Micros, Milliamps, Millis};
pub use verify::VerifyError;

use crate::calibration::CalibratedAt;
use crate::motion::Certificate;
use crate::statics::Loads;
use serde::{Deserialize, Serialize};

/// The one version of the schedule.
const VERSION: u32 = 2;

/// A step waits for at most this many others: the wire has room for no more.
pub const MOST_AFTER: usize = 4;

/// A deployment: one step a hinge.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Schedule {
    version: u32,
    /// The rig that it was made for.
    pub rig: String,
    /// The board at which the rig's hinges were calibrated; without it none was.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub calibrated_at: Option<CalibratedAt>,
    /// The plan that it was made for.
    pub plan_crc64: Fingerprint,
    /// Of what its steps move and wait for.
    pub order_crc64: Fingerprint,
    /// What was checked of its order's motion; without it nothing was, and hinges open in the order of the tree.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub certificate: Option<Certificate>,
    /// What gravity does to it; without it nothing was weighed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub loads: Option<Loads>,
    /// Most motions at once, where that is limited beside the supply.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub parallel: Option<usize>,
    /// Whether of a node's servos one moves at a time.
    pub one_servo_a_node: bool,
    /// The supply limit that it keeps.
    #[serde(rename = "supply_limit_ma")]
    pub supply_limit: Milliamps,
    /// The highest sum of currents.
    #[serde(rename = "peak_current_ma")]
    pub peak_current: Milliamps,
    /// When the last hinge is opened, as expected.
    #[serde(rename = "makespan_ms")]
    pub makespan: Millis,
    /// No schedule of the same order on the same rig is shorter.
    #[serde(rename = "lower_bound_ms")]
    pub lower_bound: Millis,
    /// The steps; each comes after all that it waits for.
    pub steps: Vec<Step>,
}

/// The motion of one hinge.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Step {
    /// Number of the hinge in the plan.
    pub hinge: usize,
    /// Index of the node in the rig file.
    pub node: usize,
    /// Channel of the node, of the motion's kind.
    pub channel: u16,
    /// Indices of the steps that must be opened before this one starts, rising, each below this step's own.
    /// What those wait for in turn is waited for as well.
    pub after: Vec<usize>,
    /// Opening angle in the zygote, degrees.
    pub from_opening_deg: u16,
    /// Opening angle in the target, degrees.
    pub opening_deg: u16,
    /// When it starts, as expected; a run goes by `after`.
    #[serde(rename = "start_ms")]
    pub start: Millis,
    /// From the start until the hinge is opened, as expected.
    #[serde(rename = "duration_ms")]
    pub duration: Millis,
    /// The most that it draws in that time.
    #[serde(rename = "current_ma")]
    pub current: Milliamps,
    /// What it draws from then until the run ends.
    #[serde(rename = "hold_current_ma")]
    pub hold_current: Milliamps,
    /// What the MCU does.
    pub motion: Motion,
}

impl Step {
    /// When the hinge is opened, as expected.
    pub fn opened(&self) -> Millis {
        self.start + self.duration
    }
}

/// A schedule that can't be read.
#[derive(Debug, thiserror::Error)]
pub enum ReadError {
    /// Made by another version of this program.
    #[error("schedule: expected version {VERSION}, found {found}; make it anew with `zygote schedule`")]
    Version {
        /// What stands there.
        found: String,
    },
    /// No JSON, a key too many, missing or of the wrong kind.
    #[error("schedule: {source}")]
    Json {
        /// What the reader of JSON says.
        #[from]
        source: serde_json::Error,
    },
}

impl Schedule {
    /// With what was checked of its order.
    #[must_use]
    pub fn with_certificate(self, certificate: Certificate) -> Self {
        Self { certificate: Some(certificate), ..self }
    }

    /// With what was weighed of its steps.
    #[must_use]
    pub fn with_loads(self, loads: Loads) -> Self {
        Self { loads: Some(loads), ..self }
    }

    /// The hinges in the order of its steps.
    pub fn hinges(&self) -> Vec<usize> {
        self.steps.iter().map(|step| step.hinge).collect()
    }

    /// How many times as long as the lower bound it takes; 1 is the shortest there is.
    pub fn ratio(&self) -> f64 {
        if self.makespan == self.lower_bound {
            1.0
        } else {
            self.makespan.0 as f64 / self.lower_bound.0 as f64
        }
    }

    /// The most motions at once, as expected.
    pub fn most_at_once(&self) -> usize {
        // At one time endings come first.
        let ends = self.steps.iter().map(|step| (step.opened(), -1));
        let mut changes: Vec<(Millis, isize)> =
            self.steps.iter().map(|step| (step.start, 1)).chain(ends).collect();
        changes.sort_unstable();
        let moving = changes.iter().scan(0, |moving, (_, change)| {
            *moving += change;
            Some(*moving)
        });
        moving.max().map_or(0, isize::unsigned_abs)
    }

    /// Reads the value of a plan's `zygote:schedule`.
    ///
    /// # Errors
    /// [`ReadError`] if it isn't a schedule of this version; [`Schedule::verify`] looks at what it says.
    pub fn from_json(value: &serde_json::Value) -> Result<Self, ReadError> {
        // Before the keys: another version may have keys that this one doesn't know.
        match value.get("version") {
            Some(version) if version.as_u64() == Some(u64::from(VERSION)) => Ok(Self::deserialize(value)?),
            found => Err(ReadError::Version { found: found.map_or("none".to_owned(), ToString::to_string) }),
        }
    }

    /// Reads a schedule file.
    ///
    /// # Errors
    /// As [`Schedule::from_json`].
    pub fn from_text(text: &str) -> Result<Self, ReadError> {
        Self::from_json(&serde_json::from_str(text)?)
    }

    /// The value for a plan's `zygote:schedule`.
    ///
    /// # Errors
    /// [`ReadError::Json`] if a number doesn't fit JSON.
    pub fn to_json(&self) -> Result<serde_json::Value, ReadError> {
        Ok(serde_json::to_value(self)?)
    }

    /// A schedule file, ending with a line end.
    ///
    /// # Errors
    /// [`ReadError::Json`] if a number doesn't fit JSON.
    pub fn to_text(&self) -> Result<String, ReadError> {
        Ok(serde_json::to_string_pretty(self)? + "\n")
    }
}

#[cfg(test)]
mod solve_tests;
#[cfg(test)]
mod tests;
