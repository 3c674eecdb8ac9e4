//! Calibration of shape-memory hinges: which pulses to drive, and what the readings say of the hinge. Servo hinges are in [`servo`].
//!
//! The mathematics alone: no port, no clock, no file. A caller asks [`next`] what to do, does it, adds what it read to the
//! [`Record`], and asks again until [`Next::Done`]; then [`fit`] gives every parameter a 95 % interval, or says why the data
//! have none. The model and what it can't see are described in `docs/src/calibration.md`.
//!
//! ```text
//!   Nominal, Bounds, Record --next--> Pulse --(caller)--> Record --fit--> Fit { estimates, residuals, held out }
//! ```

mod course;
mod diagnosis;
mod estimate;
mod fit;
mod model;
mod nominal;
mod phase;
mod picture;
mod pulse_plan;
mod record;
mod residuals;
pub mod servo;
mod solve;
mod space;

pub use diagnosis::Diagnosis;
pub use estimate::{Estimate, Interval, Quantity, Verdict, Why};
pub use fit::{Fit, fit};
pub use model::{Model, State};
pub use nominal::{Bounds, Nominal, Sensor, Transformation};
pub use picture::picture;
pub use pulse_plan::{Next, Pulse, Purpose, Refusal, next};
pub use record::{Drive, Record, RecordError, Sample};
pub use residuals::{HeldOut, Residuals};
