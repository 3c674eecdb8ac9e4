//! What can be served to a serial program: a board, or a board with what is to go wrong around it.

use crate::board::Board;
use crate::plant::PlantError;
use zygote_protocol::Micros;

/// Bytes in, bytes out, and a virtual clock that somebody moves on.
pub trait Device {
    /// Virtual time.
    fn now(&self) -> Micros;

    /// Moves time on to `until`, or less far.
    ///
    /// # Errors
    /// [`PlantError`] for what the plant can't do.
    fn advance(&mut self, until: Micros) -> Result<(), PlantError>;

    /// Takes bytes from the host, now.
    fn receive(&mut self, bytes: &[u8]);

    /// Appends the bytes that there are for the host, now.
    fn transmit(&mut self, out: &mut Vec<u8>);
}

impl Device for Board {
    fn now(&self) -> Micros {
        Self::now(self)
    }

    fn advance(&mut self, until: Micros) -> Result<(), PlantError> {
        Self::advance(self, until)
    }

    fn receive(&mut self, bytes: &[u8]) {
        Self::receive(self, bytes);
    }

    fn transmit(&mut self, out: &mut Vec<u8>) {
        Self::transmit(self, out);
    }
}
