//! Bytes to an MCU and back, with the clock that times them: real for a serial port, virtual for the simulator.

use std::io;
use zygote_protocol::Micros;

/// A byte stream and its clock.
pub trait Transport {
    /// Time on this side since some fixed start.
    fn now(&self) -> Micros;

    /// Sends all of `bytes`.
    ///
    /// # Errors
    /// The line is gone.
    fn send(&mut self, bytes: &[u8]) -> io::Result<()>;

    /// Waits until bytes arrive, but not past `deadline`, and returns how many; 0 at the deadline.
    ///
    /// # Errors
    /// The line is gone.
    fn receive(&mut self, buffer: &mut [u8], deadline: Micros) -> io::Result<usize>;

    /// What people call this line: a device, a simulator.
    fn name(&self) -> String;
}
