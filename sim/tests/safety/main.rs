//! The safety rules of `docs/src/safety.md`, by number, on the simulated board: judged by the plant's true
//! temperatures and by the outputs, not by what the firmware says.
#![allow(clippy::unwrap_used, clippy::expect_used, reason = "a test that cannot go on fails")]

mod edges;
mod host;
mod pulses;
mod readings;
mod rules;
