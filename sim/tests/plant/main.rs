//! The plant against physics on paper: closed forms, balances and data sheets, not against itself.

#![expect(
    clippy::expect_used,
    reason = "clippy.toml's leave for tests does not reach their helper functions"
)]

mod actuators;
mod faults;
mod guide;
mod rig;
mod sensors;
mod supply;
mod thermal;
mod transformation;
