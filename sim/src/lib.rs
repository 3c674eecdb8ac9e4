//! The firmware core on a simulated plant, in virtual time or served on a pseudo-terminal.

mod board;
pub mod plant;
mod pty;

pub use board::{Board, CEILING, SimCore, Stuck};
pub use pty::{Pty, ServeError};
