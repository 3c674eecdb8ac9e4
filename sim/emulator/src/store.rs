//! Memory of the chip, RAM or flash: words that are read and written in one piece, which is most of what programs do.

use rsemu::core::BusError;
use rsemu::core::space::{MemAttrs, MemOps, MemResult};
use std::sync::atomic::{AtomicU32, Ordering};

/// Bytes by their offset. One thread runs the chip: the atomics are for the core, which wants what it shares to be [`Sync`].
#[derive(Debug)]
pub(crate) struct Store {
    words: Box<[AtomicU32]>,
}

impl Store {
    /// Of zeros.
    pub(crate) fn new(bytes: usize) -> Self {
        Self { words: (0..bytes.div_ceil(4)).map(|_| AtomicU32::new(0)).collect() }
    }

    /// Reads 1, 2 or 4 bytes, wherever they lie; `None` past the end.
    #[inline]
    pub(crate) fn read(&self, offset: u32, bytes: u32) -> Option<u32> {
        let word = self.word(offset)?;
        let shift = 8 * (offset & 3);
        if shift + 8 * bytes <= 32 {
            return Some(word >> shift & mask(bytes));
        }
        let next = self.word(offset + 4)?;
        Some((word >> shift | next << (32 - shift)) & mask(bytes))
    }

    /// Writes 1, 2 or 4 bytes; `None` past the end.
    #[inline]
    pub(crate) fn write(&self, offset: u32, bytes: u32, value: u32) -> Option<()> {
        let shift = 8 * (offset & 3);
        if bytes == 4 && shift == 0 {
            self.place(offset)?.store(value, Ordering::Relaxed);
            return Some(());
        }
        let over = shift + 8 * bytes > 32;
        let next = if over { Some(self.place(offset + 4)?) } else { None };
        change(self.place(offset)?, mask(bytes) << shift, value << shift);
        if let Some(next) = next {
            change(next, mask(bytes) >> (32 - shift), value >> (32 - shift));
        }
        Some(())
    }

    /// Fills whole words.
    pub(crate) fn fill(&self, offset: u32, bytes: u32, value: u32) {
        let first = (offset / 4) as usize;
        let words = self.words.iter().skip(first).take((bytes / 4) as usize);
        words.for_each(|word| word.store(value, Ordering::Relaxed));
    }

    #[inline]
    fn word(&self, offset: u32) -> Option<u32> {
        self.place(offset).map(|word| word.load(Ordering::Relaxed))
    }

    #[inline]
    fn place(&self, offset: u32) -> Option<&AtomicU32> {
        self.words.get((offset / 4) as usize)
    }
}

#[inline]
fn mask(bytes: u32) -> u32 {
    u32::MAX >> (32 - 8 * bytes)
}

#[inline]
fn change(word: &AtomicU32, mask: u32, value: u32) {
    word.store(word.load(Ordering::Relaxed) & !mask | value & mask, Ordering::Relaxed);
}

/// As the core sees it.
impl MemOps for Store {
    fn read(&self, offset: u64, bytes: &mut [u8], _attributes: MemAttrs) -> MemResult {
        for (at, byte) in (offset..).zip(bytes) {
            let value = u32::try_from(at).ok().and_then(|at| self.read(at, 1)).ok_or(BusError::BadAccess)?;
            *byte = value.to_le_bytes()[0];
        }
        Ok(())
    }

    fn write(&self, offset: u64, bytes: &[u8], _attributes: MemAttrs) -> MemResult {
        for (at, byte) in (offset..).zip(bytes) {
            let written = u32::try_from(at).ok().and_then(|at| self.write(at, 1, (*byte).into()));
            written.ok_or(BusError::BadAccess)?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_width_at_every_place_is_what_its_bytes_are() {
        let store = Store::new(12);
        for (at, byte) in (0..12).zip(0x11..) {
            store.write(at, 1, byte).unwrap();
        }
        for (bytes, whole) in [(1, 0x11), (2, 0x1211), (4, 0x1413_1211)] {
            for at in 0..8 {
                let expected = whole + (0x0101_0101 & mask(bytes)) * at;
                assert_eq!(store.read(at, bytes), Some(expected), "{bytes} at {at}");
                store.write(at, bytes, !expected).unwrap();
                assert_eq!(store.read(at, bytes), Some(!expected & mask(bytes)), "{bytes} at {at}");
                store.write(at, bytes, expected).unwrap();
            }
        }
        assert_eq!((store.read(0, 4), store.read(8, 4)), (Some(0x1413_1211), Some(0x1c1b_1a19)));
    }

    #[test]
    fn nothing_is_past_the_end_and_nothing_is_half_written_there() {
        let store = Store::new(8);
        store.fill(0, 8, u32::MAX);
        assert_eq!((store.read(6, 4), store.write(6, 4, 0), store.read(8, 1)), (None, None, None));
        assert_eq!(store.read(4, 4), Some(u32::MAX));
    }
}
