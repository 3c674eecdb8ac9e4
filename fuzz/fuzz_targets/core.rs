//! See `bodies/core.rs`.
#![no_main]

#[path = "../bodies/core.rs"]
mod body;

libfuzzer_sys::fuzz_target!(|data: &[u8]| body::check(data));
