//! From a **plan** and a **rig** to a **schedule** of hinge motions, and how the panels move along it.
//!
//! ```text
//! rig.toml -> Rig --fit--> a fitting a hinge ---+
//!                                               +--> Schedule (steps, one a hinge) --verify--> a run
//! plan ------> Tree --order--> hinges in order -+
//! plan ------> Tolerance: how far panels are off, and cut edges gape, when hinges aren't exact
//! plan + order -> motion --> collisions of panels as plates, over the whole of every turn
//! plan + order -> dense --> the same seen again by sampling, with code of its own
//! plan + rig + order -> statics --> torque on every hinge against its rating, tipping of the whole
//! plan ------> Kinematics --> poses of all panels --> picture (SVG), scene (animated glTF), playback (for a viewer)
//! ```
//!
//! Pure: no clock, no file, no wire. Words and signs are those of `docs/src/geometry.md`.

mod calibrated_servo;
mod calibration;
pub mod dense;
mod heating;
mod kinematics;
pub mod motion;
mod order;
pub mod picture;
mod playback;
mod rig;
pub mod scene;
mod schedule;
pub mod statics;
pub mod table;
#[cfg(test)]
mod testing;
mod tolerance;
mod tree;

pub use calibrated_servo::{CalibratedServo, NoPulse, ServoPoint};
pub use calibration::{
    Calibrated, CalibratedAt, CalibratedHinge, Calibration, CalibrationError, CalibrationVerdict, Known,
};
pub use kinematics::Kinematics;
pub use order::{Order, WaitError};
pub use playback::{Column, Joined, Playback, Pose, Turned};
pub use rig::*;
pub use schedule::*;
pub use tolerance::{HingeErrors, SingleStripError, Spread, Tolerance, ToleranceError, single_strip};
pub use tree::{Branch, Tree, TreeError};
