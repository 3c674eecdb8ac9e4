//! The wire between a host and an MCU: messages, units, frames and the reliable link.
//!
//! `no_std`, no allocation, no I/O and no clock: both ends run the same state machine on bytes and times that
//! are handed in. The bytes are described for people in `docs/src/protocol.md`.
#![no_std]
#![warn(clippy::indexing_slicing, clippy::as_conversions)]

mod units;

pub use units::{CentiCelsius, Micros, Milliamps, Millis, Millivolts};
