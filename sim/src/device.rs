//! What can be served to a serial program: a board, or a board with what is to go wrong around it.

use crate::board::Board;
use crate::plant::PlantError;
use zygote_protocol::Micros;

/// Bytes in, bytes out, and a virtual clock that somebody moves on.
pub trait Device {
    /// Why it can't go on.
    type Error: std::error::Error + Send + Sync + 'static;

    /// Virtual time.
    fn now(&self) -> Micros;

    /// Moves time on to `until`, or less far.
    ///
    /// # Errors
    /// What it is made of can't do that.
    fn advance(&mut self, until: Micros) -> Result<(), Self::Error>;

    /// Takes bytes from the host, now.
    fn receive(&mut self, bytes: &[u8]);

    /// Appends the bytes that there are for the host, now.
    fn transmit(&mut self, out: &mut Vec<u8>);
}

impl Device for Board {
    type Error = PlantError;

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
