//! Calibration of servo hinges: which pulse to look at next, what a reading is worth, and at which pulses the hinge stands at 0, 90,
//! 180 and 270 degrees.
//!
//! The mathematics alone, as for shape-memory hinges: a caller asks [`next_look`], leads the servo there, reads the angle off a
//! protractor or a sensor, lets [`doubt`] judge the reading, has it taken, and asks again.
//!
//! ```text
//!   middle --> 90 --> 0 --> 180 --> 270 --> Done
//!              |  by the line through what was seen, at most 45 degrees past it at once
//!              +--> an angle that stays although the pulse goes on, or a servo that pushes: an end stop, never gone past again
//! ```

mod found;
mod judge;
mod picture;
mod record;
mod search;
mod view;

pub use found::{FoundPoint, FoundServo, NotReached, found};
pub use judge::{Doubt, doubt};
pub use picture::servo_picture;
pub use record::{Look, ServoBounds, ServoNominal, ServoRecord};
pub use search::{NextLook, ServoRefusal, next_look};

/// The opening angles that are looked for, degrees.
pub const ANGLES_DEG: [u16; 4] = [0, 90, 180, 270];
