//! What outlives power: a count of starts, settings and calibrations, in two sectors of flash that take turns.
//!
//! Each change is a record behind the one before it; the highest number whose checksum is right counts. So a write that power cut
//! falls back to the last good record. A full sector stays as it is until the other one, erased, has taken over.

use crate::record::{RECORD, Record, VERSION};
use core::fmt;
use embedded_storage::nor_flash::NorFlash;
use zygote_protocol::{Kept, MemoryReport, MemoryState};

/// Places that are tried before a flash is given up as worn.
const TRIES: u32 = 4;
const BLANK: [u8; RECORD] = [0xff; RECORD];
/// `RECORD` as flash addresses have it.
const STEP: u32 = 512;

/// Why something can't be kept or found.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MemoryError<E> {
    /// The flash itself failed.
    Flash(E),
    /// What was written doesn't read back: the flash is worn out.
    Worn,
    /// What is kept is of another firmware.
    Version {
        /// What stands in the record.
        got: u8,
    },
    /// What is to be kept is longer than a record, or the sectors don't hold whole ones.
    Room,
}

impl<E: fmt::Debug> fmt::Display for MemoryError<E> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Flash(error) => write!(f, "the flash failed: {error:?}"),
            Self::Worn => write!(f, "what was written to flash doesn't read back"),
            Self::Version { got } => {
                write!(f, "what is stored is of version {got}, expected {VERSION}")
            }
            Self::Room => write!(f, "there is no room for the record"),
        }
    }
}

impl<E: fmt::Debug> core::error::Error for MemoryError<E> {}

/// The records in two sectors of a flash, of a board with so many heaters and servos.
#[derive(Debug)]
pub struct Memory<F, const HEATERS: usize, const SERVOS: usize> {
    flash: F,
    /// Where the first sector begins; the other one follows it.
    begin: u32,
    sector: u32,
    /// The record that counts, and where it stands.
    latest: Option<(u32, Record)>,
    /// Places that are neither blank nor a whole record.
    damaged: u16,
}

impl<F: NorFlash, const HEATERS: usize, const SERVOS: usize> Memory<F, HEATERS, SERVOS> {
    /// The records in the two sectors from `begin` on.
    ///
    /// # Errors
    /// [`MemoryError::Room`], or the flash's own.
    pub fn open(flash: F, begin: u32) -> Result<Self, MemoryError<F::Error>> {
        let sector = u32::try_from(F::ERASE_SIZE).map_err(|_| MemoryError::Room)?;
        let is_whole = sector.is_multiple_of(STEP) && begin.is_multiple_of(sector);
        let fits = usize::try_from(begin + 2 * sector).is_ok_and(|end| end <= flash.capacity());
        if !is_whole || !fits || !RECORD.is_multiple_of(F::WRITE_SIZE) {
            return Err(MemoryError::Room);
        }
        let mut memory = Self { flash, begin, sector, latest: None, damaged: 0 };
        for at in (begin..begin + 2 * sector).step_by(RECORD) {
            let bytes = memory.read(at)?;
            match Record::from_bytes(&bytes) {
                Some(record) if memory.latest.is_none_or(|(_, latest)| record.number > latest.number) => {
                    memory.latest = Some((at, record));
                }
                None if bytes != BLANK => memory.damaged = memory.damaged.saturating_add(1),
                Some(_) | None => {}
            }
        }
        Ok(memory)
    }

    /// Counts this start and gives its number, which no earlier start had. The first one ever, and the first one after
    /// everything was lost, is `first`. May erase, and so take a second.
    ///
    /// # Errors
    /// [`MemoryError`]; then there is no number that is surely new.
    pub fn count_start(&mut self, first: u32) -> Result<u32, MemoryError<F::Error>> {
        let record = match self.latest {
            Some((_, latest)) => Record { start: latest.start.wrapping_add(1), ..latest },
            None => Record::first(first),
        };
        self.append(&record).map(|()| record.start)
    }

    /// What is kept, if anything ever was.
    ///
    /// # Errors
    /// [`MemoryError::Version`]
    pub fn kept(&self) -> Result<Option<Kept<HEATERS, SERVOS>>, MemoryError<F::Error>> {
        let Some((_, latest)) = &self.latest else { return Ok(None) };
        latest.kept().map_err(|got| MemoryError::Version { got })
    }

    /// What was found, for a host that asks.
    pub fn report(&self) -> MemoryReport {
        let state = match self.kept() {
            Ok(Some(_)) => MemoryState::Kept,
            Ok(None) => MemoryState::Blank,
            Err(_) => MemoryState::OtherVersion,
        };
        MemoryReport { state, damaged: self.damaged }
    }

    /// Keeps this from now on. May erase, and so take a second.
    ///
    /// # Errors
    /// [`MemoryError`]; what was kept before then still is.
    pub fn keep(&mut self, kept: &Kept<HEATERS, SERVOS>) -> Result<(), MemoryError<F::Error>> {
        self.keep_as(VERSION, kept)
    }

    /// As a firmware with another version would keep it; for tests.
    #[doc(hidden)]
    pub fn keep_as(
        &mut self,
        version: u8,
        kept: &Kept<HEATERS, SERVOS>,
    ) -> Result<(), MemoryError<F::Error>> {
        let latest = self.latest.map_or(Record::first(0), |(_, latest)| latest);
        self.append(&latest.with(version, kept).ok_or(MemoryError::Room)?)
    }

    /// Gives the flash back.
    pub fn into_flash(self) -> F {
        self.flash
    }

    /// Writes a record behind all others, and sees that it is there.
    fn append(&mut self, record: &Record) -> Result<(), MemoryError<F::Error>> {
        let number = self.latest.map_or(0, |(_, latest)| latest.number.wrapping_add(1));
        let record = Record { number, ..*record };
        let bytes = record.to_bytes();
        let mut after = self.latest.map(|(at, _)| at + STEP);
        for _ in 0..TRIES {
            let at = self.room(after)?;
            self.flash.write(at, &bytes).map_err(MemoryError::Flash)?;
            if self.read(at)? == bytes {
                self.latest = Some((at, record));
                return Ok(());
            }
            after = Some(at + STEP);
        }
        Err(MemoryError::Worn)
    }

    /// A blank place: the next one in the sector of the latest record, else the front of the other sector.
    fn room(&mut self, after: Option<u32>) -> Result<u32, MemoryError<F::Error>> {
        let middle = self.begin + self.sector;
        let Some(after) = after else { return self.blank_sector(self.begin) };
        // What lies behind the last place of a sector belongs to that sector still.
        let (end, other) =
            if after <= middle { (middle, middle) } else { (middle + self.sector, self.begin) };
        for at in (after..end).step_by(RECORD) {
            if self.read(at)? == BLANK {
                return Ok(at);
            }
        }
        self.blank_sector(other)
    }

    /// Erases a sector, unless it is blank; gives its front.
    fn blank_sector(&mut self, begin: u32) -> Result<u32, MemoryError<F::Error>> {
        for at in (begin..begin + self.sector).step_by(RECORD) {
            if self.read(at)? != BLANK {
                self.flash.erase(begin, begin + self.sector).map_err(MemoryError::Flash)?;
                break;
            }
        }
        Ok(begin)
    }

    fn read(&mut self, at: u32) -> Result<[u8; RECORD], MemoryError<F::Error>> {
        let mut bytes = [0; RECORD];
        self.flash.read(at, &mut bytes).map_err(MemoryError::Flash)?;
        Ok(bytes)
    }
}
