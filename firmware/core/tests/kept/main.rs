//! What a board keeps: settings lowered by the host, and calibrations that steps are held against.
#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]

#[path = "../a_bench/mod.rs"]
mod a_bench;
#[path = "../a_board/mod.rs"]
mod a_board;
mod calibration;
mod settings;
