//! The flash behind what outlives power: sectors 1 and 2, 16 KiB each, which the linker script keeps free of code.
//!
//! Erasing halts the processor for up to 0.8 s, because code runs from the same flash. It happens at the start and while something is
//! stored, with everything off; the watchdog is told before, and the clock stopped and set right.

use crate::{
    board::{HEATERS, SERVOS},
    standstill, supervisor,
};
use embassy_stm32::{
    Peri,
    flash::{Bank1Region1, Blocking, Flash},
    peripherals::FLASH,
};
use zygote_parts::Memory;
use zygote_protocol::{Kept, MemoryReport, MemoryState};

/// Where sector 1 begins, counted from the start of the flash.
const SECTORS: u32 = 0x4000;

/// What outlives power; `None` where the flash can't be used.
pub(crate) struct Keeping(Option<Memory<Bank1Region1<'static, Blocking>, HEATERS, SERVOS>>);

impl Keeping {
    /// Finds the latest record.
    pub(crate) fn open(flash: Peri<'static, FLASH>) -> Self {
        let flash = Flash::new_blocking(flash).into_blocking_regions().bank1_region1;
        Self(said(Memory::open(flash, SECTORS)))
    }

    /// The number of this start, which no other had; `first` if there is no earlier one. `None` if that can't be had.
    /// The watchdog is patient at the start.
    pub(crate) fn count_start(&mut self, first: u32) -> Option<u32> {
        let memory = self.0.as_mut()?;
        said(standstill::through(|| memory.count_start(first)))
    }

    /// Settings and calibrations.
    pub(crate) fn kept(&self) -> Option<Kept<HEATERS, SERVOS>> {
        said(self.0.as_ref()?.kept()).flatten()
    }

    /// What was found, for a host that asks.
    pub(crate) fn report(&self) -> MemoryReport {
        let unusable = MemoryReport { state: MemoryState::Unusable, damaged: 0 };
        self.0.as_ref().map_or(unusable, Memory::report)
    }

    /// Keeps this; whether that is done. Nothing may be energised.
    pub(crate) fn keep(&mut self, kept: &Kept<HEATERS, SERVOS>) -> bool {
        let Some(memory) = &mut self.0 else { return false };
        supervisor::be_patient();
        let kept = said(standstill::through(|| memory.keep(kept))).is_some();
        supervisor::be_strict();
        kept
    }
}

/// The good half, or a line in the log: a board without memory works, with the ceilings compiled into it.
fn said<T, E: core::fmt::Display>(result: Result<T, E>) -> Option<T> {
    result.inspect_err(|error| defmt::error!("memory: {}", defmt::Display2Format(error))).ok()
}
