//! The firmware core on a simulated plant, in virtual time or served on a pseudo-terminal, and what can go wrong:
//! faults of the plant, impairments of the line.

mod board;
mod chance;
mod device;
mod line;
pub mod plant;
mod pty;

pub use board::{Board, CEILING, SimCore, Stuck, TICK};
pub use chance::Chance;
pub use device::Device;
pub use line::{Impairment, Line, Wire};
pub use pty::{Pty, ServeError};
