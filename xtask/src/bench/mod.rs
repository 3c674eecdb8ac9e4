//! `cargo xtask bench NAME`: measured tables. Not part of the tests, and nothing is written but to `target/`.

mod blob;
pub(crate) mod calibration;
pub(crate) mod deployment;
mod hard;
mod measure;
pub(crate) mod motion;
mod peers;
pub(crate) mod stacking;
