//! The firmware core on a simulated plant, in virtual time or served on a PTY.

pub mod plant;
