//! Memory as ordinary instructions see it: RAM, flash to read, and the peripherals a word, a half or a byte at a time.
//! Everything else, faults among it, is the core's.

use super::exec::Run;
use crate::chip::{FLASH, RAM};

const PERIPHERALS: u32 = 0x4;

impl Run<'_> {
    /// Reads memory that has no side effects.
    #[inline]
    pub(super) fn peek(&self, address: u32, bytes: u32) -> Option<u32> {
        let (memory, offset) = match inside(address, bytes, RAM.start, RAM.end) {
            Some(offset) => (self.ram, offset),
            None => (self.flash, inside(address, bytes, FLASH.start, FLASH.end)?),
        };
        memory.read(offset, bytes)
    }

    /// Reads a value; one access.
    #[inline]
    pub(super) fn load(&mut self, address: u32, bytes: u32) -> Option<u32> {
        self.cycles += 1;
        if let Some(value) = self.peek(address, bytes) {
            return Some(value);
        }
        if address >> 28 != PERIPHERALS || !address.is_multiple_of(bytes) || bit_band(address) {
            return None;
        }
        self.touch();
        let word = self.shared.read(address)?;
        self.now = self.shared.now();
        let part = word >> (8 * (address & 3));
        Some(if bytes == 4 { part } else { part & ((1 << (8 * bytes)) - 1) })
    }

    /// Writes a value; one access.
    #[inline]
    pub(super) fn store(&mut self, address: u32, bytes: u32, value: u32) -> Option<()> {
        self.cycles += 1;
        if let Some(offset) = inside(address, bytes, RAM.start, RAM.end) {
            return self.ram.write(offset, bytes, value);
        }
        if address >> 28 != PERIPHERALS || !address.is_multiple_of(bytes) || bit_band(address) {
            return None;
        }
        self.touch();
        let part = if bytes == 4 { value } else { value & ((1 << (8 * bytes)) - 1) };
        let done = self.shared.write(address, part << (8 * (address & 3)));
        self.now = self.shared.now();
        done
    }

    /// All of a block lies in RAM, or in flash to be read.
    pub(super) fn is_plain(address: u32, bytes: u32, write: bool) -> bool {
        inside(address, bytes, RAM.start, RAM.end).is_some()
            || !write && inside(address, bytes, FLASH.start, FLASH.end).is_some()
    }

    /// Peripherals see the time at which the instruction began.
    fn touch(&mut self) {
        self.shared.set_now(self.now);
        self.touched = true;
    }
}

/// The aliases in which every word is a bit of a peripheral.
fn bit_band(address: u32) -> bool {
    (0x4200_0000..0x4400_0000).contains(&address)
}

#[inline]
fn inside(address: u32, bytes: u32, start: u32, end: u32) -> Option<u32> {
    let offset = address.wrapping_sub(start);
    (offset <= end - start - bytes).then_some(offset)
}
