//! Every decision that the MCU takes: may this hinge be heated, is that step done, is the host still there.
//!
//! No hardware, no executor, no clock: bytes, readings and the time come in, bytes and actuator commands go
//! out. The boards under `firmware/boards` and the simulator run this same crate.
#![no_std]
#![warn(clippy::indexing_slicing, clippy::as_conversions)]

mod io;

pub use io::{ADC_FULL_SCALE, Duty, Inputs, Outputs, PulseMicros};
