//! See `bodies/rig.rs`.
#![no_main]

#[path = "../bodies/rig.rs"]
mod body;

libfuzzer_sys::fuzz_target!(|data: &[u8]| body::check(data));
