//! A line that flips a bit in one byte of so many, in both directions; the same bytes for the same seed.

use std::io;
use zygote_controller::Transport;
use zygote_protocol::Micros;

/// A line around another.
pub(crate) struct NoisyLine<T> {
    line: T,
    /// A byte is damaged when a random number of 53 bits is below this.
    threshold: u64,
    random: u64,
}

impl<T> NoisyLine<T> {
    /// Damages this share of all bytes, 0 to 1.
    pub(crate) fn new(line: T, share: f64, seed: u64) -> Self {
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to 2^53")]
        let threshold = (share.clamp(0.0, 1.0) * (1_u64 << 53) as f64) as u64;
        Self { line, threshold, random: seed | 1 }
    }

    /// xorshift64*.
    fn next(&mut self) -> u64 {
        self.random ^= self.random >> 12;
        self.random ^= self.random << 25;
        self.random ^= self.random >> 27;
        self.random.wrapping_mul(0x2545_f491_4f6c_dd1d)
    }

    fn damage(&mut self, bytes: &mut [u8]) {
        if self.threshold == 0 {
            return;
        }
        for byte in bytes {
            if self.next() >> 11 < self.threshold {
                *byte ^= 1 << (self.next() >> 61);
            }
        }
    }
}

impl<T: Transport> Transport for NoisyLine<T> {
    fn now(&self) -> Micros {
        self.line.now()
    }

    fn send(&mut self, bytes: &[u8]) -> io::Result<()> {
        let mut bytes = bytes.to_vec();
        self.damage(&mut bytes);
        self.line.send(&bytes)
    }

    fn receive(&mut self, buffer: &mut [u8], deadline: Micros) -> io::Result<usize> {
        let count = self.line.receive(buffer, deadline)?;
        self.damage(buffer.get_mut(..count).unwrap_or_default());
        Ok(count)
    }

    fn name(&self) -> String {
        self.line.name()
    }
}
