//! What boards share and what needs no chip, so that a host can test it: the servo driver behind an I2C bus, and
//! the roll call without which the watchdog isn't fed.
#![no_std]
#![warn(clippy::indexing_slicing, clippy::as_conversions)]

mod pca9685;
mod roll_call;

pub use pca9685::{CHANNELS, Lost, Pca9685};
pub use roll_call::{Beats, RollCall};
