//! See `bodies/schedule.rs`.
#![no_main]

#[path = "../bodies/schedule.rs"]
mod body;

libfuzzer_sys::fuzz_target!(|data: &[u8]| body::check(data));
