//! The board's own program, as built by `cargo xtask firmware`, on the emulated chip: it starts, answers, deploys, and
//! keeps the safety rules that only its real pins, timers and watchdog can keep. Ignored unless asked for, because the
//! program has to be built first: `cargo xtask emulator`.
#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]

mod host;
#[path = "../../../tests/host/mod.rs"]
mod link_host;
mod memory;
mod rules;
mod standstill;
