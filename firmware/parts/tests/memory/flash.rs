//! A NOR flash whose supply fails at a given operation: the word being programmed keeps any of its old bits, the sector
//! being erased any of its bits, and nothing works until power is back.

use embedded_storage::nor_flash::{ErrorType, NorFlash, NorFlashError, NorFlashErrorKind, ReadNorFlash};

pub(crate) const SECTOR: usize = 4_096;
pub(crate) const SIZE: usize = 2 * SECTOR;
const WORD: usize = 4;

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Failure {
    PowerIsOff,
    /// A word that isn't erased was programmed, or the place isn't aligned.
    Misused,
}

impl NorFlashError for Failure {
    fn kind(&self) -> NorFlashErrorKind {
        NorFlashErrorKind::Other
    }
}

#[derive(Debug, Clone)]
pub(crate) struct Flash {
    pub(crate) bytes: Vec<u8>,
    /// Words and sectors until power fails, if it does.
    pub(crate) left: Option<u32>,
    /// Erasures of each sector.
    pub(crate) erasures: [u32; 2],
    /// Words don't take what is written.
    pub(crate) worn: bool,
    chance: u64,
}

impl Flash {
    pub(crate) fn new(seed: u64) -> Self {
        Self {
            bytes: vec![0xff; SIZE],
            left: None,
            erasures: [0; 2],
            worn: false,
            chance: seed.wrapping_mul(2) | 1,
        }
    }

    /// Any byte, the same for the same seed.
    pub(crate) fn any(&mut self) -> u8 {
        self.chance ^= self.chance << 13;
        self.chance ^= self.chance >> 7;
        self.chance ^= self.chance << 17;
        self.chance.to_le_bytes()[3]
    }

    /// Counts an operation; power fails within the last one.
    fn power(&mut self) -> Result<bool, Failure> {
        match &mut self.left {
            None => Ok(true),
            Some(0) => Err(Failure::PowerIsOff),
            Some(left) => {
                *left -= 1;
                Ok(*left > 0)
            }
        }
    }
}

impl ErrorType for Flash {
    type Error = Failure;
}

impl ReadNorFlash for Flash {
    const READ_SIZE: usize = 1;

    fn read(&mut self, offset: u32, bytes: &mut [u8]) -> Result<(), Failure> {
        if self.left == Some(0) {
            return Err(Failure::PowerIsOff);
        }
        bytes.copy_from_slice(&self.bytes[offset as usize..][..bytes.len()]);
        Ok(())
    }

    fn capacity(&self) -> usize {
        SIZE
    }
}

impl NorFlash for Flash {
    const WRITE_SIZE: usize = WORD;
    const ERASE_SIZE: usize = SECTOR;

    fn erase(&mut self, from: u32, to: u32) -> Result<(), Failure> {
        let (from, to) = (from as usize, to as usize);
        if from % SECTOR != 0 || to % SECTOR != 0 {
            return Err(Failure::Misused);
        }
        for sector in from / SECTOR..to / SECTOR {
            let ends_well = self.power()?;
            self.erasures[sector] += 1;
            for at in sector * SECTOR..(sector + 1) * SECTOR {
                self.bytes[at] = if ends_well { 0xff } else { self.bytes[at] | self.any() };
            }
            if !ends_well {
                return Err(Failure::PowerIsOff);
            }
        }
        Ok(())
    }

    fn write(&mut self, offset: u32, bytes: &[u8]) -> Result<(), Failure> {
        let offset = offset as usize;
        if !offset.is_multiple_of(WORD) || !bytes.len().is_multiple_of(WORD) {
            return Err(Failure::Misused);
        }
        for (at, word) in (offset..).step_by(WORD).zip(bytes.chunks(WORD)) {
            // This chip has no way to say which bits were programmed before.
            if self.bytes[at..at + WORD] != [0xff; WORD] {
                return Err(Failure::Misused);
            }
            let ends_well = self.power()?;
            for (at, &byte) in (at..).zip(word) {
                let kept = if ends_well && !self.worn { 0 } else { self.any() };
                self.bytes[at] = byte | kept;
            }
            if !ends_well {
                return Err(Failure::PowerIsOff);
            }
        }
        Ok(())
    }
}
