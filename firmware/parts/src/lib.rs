//! What boards share and what needs no chip, so that a host can test it: the servo driver behind an I2C bus, the
//! roll call without which the watchdog isn't fed, and what outlives power.
#![no_std]
#![warn(clippy::indexing_slicing, clippy::as_conversions)]

mod memory;
mod pca9685;
mod record;
mod roll_call;

pub use memory::{Memory, MemoryError};
pub use pca9685::{CHANNELS, Lost, Pca9685};
pub use roll_call::{Beats, RollCall};
