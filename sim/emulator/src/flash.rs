//! The flash and its controller. While it erases or programs, nothing is fetched from it, so the core stands still: the
//! time that it takes is a stall.

use crate::chip::FLASH;
use crate::store::Store;
use std::sync::Arc;

const KEYR: u32 = 0x04;
const SR: u32 = 0x0c;
const CR: u32 = 0x10;
const END: u32 = 0x18;

const KEYS: [u32; 2] = [0x4567_0123, 0xcdef_89ab];
const LOCK: u32 = 1 << 31;
const START: u32 = 1 << 16;
const PROGRAM: u32 = 1;
const ERASE: u32 = 1 << 1;
/// Programming of another width than was said; programming that wasn't asked for.
const WIDTH_ERROR: u32 = 1 << 6;
const SEQUENCE_ERROR: u32 = 1 << 7;

/// Sizes of the sectors in KiB, and the longest that erasing one takes with words of 32 bits, in milliseconds (data sheet,
/// table 47).
const SECTORS: [(u32, u64); 8] =
    [(16, 500), (16, 500), (16, 500), (16, 500), (64, 1100), (128, 2000), (128, 2000), (128, 2000)];
/// Bits that aren't programmed yet when the supply fails in the middle.
const HALF_DONE: u32 = 0x5555_5555;
/// The longest that programming takes.
const PROGRAM_US: u64 = 100;

/// The array, which outlives resets, and its controller, which doesn't.
#[derive(Debug)]
pub(crate) struct Flash {
    pub(crate) array: Arc<Store>,
    registers: [u32; (END / 4) as usize],
    /// Keys given so far.
    keys: usize,
    /// Microseconds that the core has yet to stand still.
    stall_us: u64,
    /// Something in the array is not as it was.
    changed: bool,
    /// The supply fails after so many more things that are done to the array.
    failing: Option<u32>,
    failed: bool,
}

impl Flash {
    pub(crate) fn new(array: Arc<Store>) -> Self {
        let mut flash = Self {
            array,
            registers: [0; (END / 4) as usize],
            keys: 0,
            stall_us: 0,
            changed: false,
            failing: None,
            failed: false,
        };
        flash.reset();
        flash
    }

    pub(crate) fn reset(&mut self) {
        self.registers = [0; (END / 4) as usize];
        self.registers[(CR / 4) as usize] = LOCK;
        (self.keys, self.stall_us) = (0, 0);
        (self.failing, self.failed) = (None, false);
    }

    /// The supply fails in the `count`-th thing from now on that is done to the array.
    pub(crate) fn fail_in(&mut self, count: u32) {
        self.failing = Some(count);
    }

    /// The supply has failed.
    pub(crate) fn has_failed(&self) -> bool {
        self.failed
    }

    /// Turns bits of a byte over.
    pub(crate) fn spoil(&mut self, address: u32, bits: u8) {
        let at = address.wrapping_sub(FLASH.start);
        if let Some(before) = self.array.read(at, 1) {
            self.changed |= self.array.write(at, 1, before ^ u32::from(bits)).is_some();
        }
    }

    /// The supply fails in this one.
    fn fails_now(&mut self) -> bool {
        let left = self.failing.map(|left| left.saturating_sub(1));
        self.failed = left == Some(0);
        self.failing = left.filter(|left| *left > 0);
        self.failed
    }

    pub(crate) fn read(&self, offset: u32) -> u32 {
        if offset == KEYR { 0 } else { self.get(offset) }
    }

    pub(crate) fn write(&mut self, offset: u32, value: u32) {
        match offset {
            KEYR => {
                self.keys = if KEYS.get(self.keys) == Some(&value) { self.keys + 1 } else { 0 };
                if self.keys == KEYS.len() {
                    self.keys = 0;
                    self.registers[(CR / 4) as usize] &= !LOCK;
                }
            }
            SR => self.registers[(SR / 4) as usize] &= !value,
            CR if self.get(CR) & LOCK != 0 => {}
            CR => {
                self.registers[(CR / 4) as usize] = value & !START;
                if value & (START | ERASE) == START | ERASE {
                    self.erase(value >> 3 & 0xf);
                }
            }
            _ => {
                if let Some(register) = self.registers.get_mut((offset / 4) as usize) {
                    *register = value;
                }
            }
        }
    }

    /// A write to the array; it only ever turns ones to zeros.
    pub(crate) fn program(&mut self, address: u32, bytes: u32, value: u32) {
        let control = self.get(CR);
        if control & (LOCK | PROGRAM) != PROGRAM {
            self.registers[(SR / 4) as usize] |= SEQUENCE_ERROR;
            return;
        }
        if 1 << (control >> 8 & 3) != bytes {
            self.registers[(SR / 4) as usize] |= WIDTH_ERROR;
            return;
        }
        let at = address - FLASH.start;
        // Half of the bits are done when the supply fails.
        let value = if self.fails_now() { value | HALF_DONE } else { value };
        if let Some(before) = self.array.read(at, bytes) {
            self.changed |= self.array.write(at, bytes, before & value).is_some();
        }
        self.stall_us += PROGRAM_US;
    }

    /// The time that the core has to stand still, which it does by that.
    pub(crate) fn take_stall_us(&mut self) -> u64 {
        std::mem::take(&mut self.stall_us)
    }

    /// Whether the array has changed since this was last asked.
    pub(crate) fn take_changed(&mut self) -> bool {
        std::mem::take(&mut self.changed)
    }

    fn erase(&mut self, sector: u32) {
        let sector = sector as usize;
        let Some((size, time)) = SECTORS.get(sector) else {
            self.registers[(SR / 4) as usize] |= SEQUENCE_ERROR;
            return;
        };
        let at: u32 = SECTORS.iter().take(sector).map(|(size, _)| size * 1024).sum();
        let erased = if self.fails_now() { size / 2 } else { *size };
        self.array.fill(at, erased * 1024, u32::MAX);
        self.changed = true;
        self.stall_us += time * 1000;
    }

    fn get(&self, offset: u32) -> u32 {
        self.registers.get((offset / 4) as usize).copied().unwrap_or(0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const WORDS: u32 = 2 << 8;

    fn word(flash: &Flash, at: u32) -> u32 {
        flash.array.read(at, 4).unwrap()
    }

    #[test]
    fn a_locked_flash_keeps_what_it_holds_and_an_unlocked_one_only_loses_ones() {
        let mut flash = Flash::new(Arc::new(Store::new(512 * 1024)));
        let place = FLASH.start + 0x4000;
        flash.write(CR, PROGRAM | WORDS);
        flash.program(place, 4, 5);
        assert_eq!(flash.read(SR), SEQUENCE_ERROR);
        flash.write(SR, SEQUENCE_ERROR);
        for key in KEYS {
            flash.write(KEYR, key);
        }
        flash.write(CR, ERASE | 1 << 3 | START);
        assert_eq!(
            (word(&flash, 0x4000), word(&flash, 0x7ffc), word(&flash, 0x8000)),
            (0xffff_ffff, 0xffff_ffff, 0)
        );
        assert_eq!(flash.take_stall_us(), 500_000);
        flash.write(CR, PROGRAM | WORDS);
        flash.program(place, 4, 0xf0f0_f0f0);
        flash.program(place, 4, 0xff00_ff00);
        assert_eq!(word(&flash, 0x4000), 0xf000_f000);
        assert_eq!(flash.read(SR), 0);
        flash.program(place, 2, 0);
        assert_eq!(flash.read(SR), WIDTH_ERROR);
        assert!(flash.take_changed() && !flash.take_changed());
    }
}
