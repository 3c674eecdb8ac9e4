//! Calibration of shape-memory hinges: which pulses to drive, and what the readings say of the hinge. Servo hinges are in [`servo`].
//!
//! The mathematics alone: no port, no clock, no file. A caller asks [`next`] what to do, does it, adds what it read to the
//! [`Record`], and asks again until [`Next::Done`]; then [`fit`] gives every parameter a 95 % interval, or says why the data
//! have none. Later, [`drift`] holds what a run saw of a hinge against that. The model and what it can't see are described in
//! `docs/src/calibration.md`.
//!
//! ```text
//!   Nominal, Bounds, Record --next--> Pulse --(caller)--> Record --fit--> Fit { estimates, residuals, held out }
//!   Known, Sighting --drift--> keep, recalibrate, or can't tell
//! ```

mod course;
mod currents;
mod diagnosis;
mod drift;
mod estimate;
mod fit;
mod interval;
mod model;
mod nominal;
mod phase;
mod picture;
mod pulse_plan;
mod record;
mod residuals;
pub mod servo;
mod sighting;
mod solve;
mod space;

pub use currents::{Currents, heaters};
pub use diagnosis::{Diagnosis, Electrical};
pub use drift::{Change, Drift, Known, Unclear, drift};
pub use estimate::{Estimate, Interval, Quantity, Verdict, Why};
pub use fit::{Fit, fit};
pub use model::{Model, State};
pub use nominal::{Bounds, Nominal, Sensor, Transformation};
pub use picture::picture;
pub use pulse_plan::{Next, Pulse, Purpose, Refusal, next};
pub use record::{Drive, Record, RecordError, Sample};
pub use residuals::{HeldOut, Residuals};
pub use sighting::{Doing, Look, Sighting};
