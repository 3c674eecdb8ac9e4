//! The way from the core to the peripherals. The core only knows addresses; what an access leaves to do afterwards is
//! left in [`Shared`] for [`crate::chip`].

use crate::chip::FLASH;
use crate::peripherals::{After, Peripherals};
use crate::store::Store;
use rsemu::core::BusError;
use rsemu::core::space::{MemAttrs, MemOps, MemResult};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// What the core's side and the peripherals' side of the chip both see. One thread runs both: the atomics and the lock
/// are for the borrow checker.
#[derive(Debug)]
pub(crate) struct Shared {
    peripherals: Mutex<Peripherals>,
    /// The cycle that it is.
    now: AtomicU64,
    /// Nothing happens by itself before.
    horizon: AtomicU64,
    /// Interrupts and the next event have to be looked at.
    look: AtomicBool,
}

impl Shared {
    pub(crate) fn new(peripherals: Peripherals) -> Self {
        Self {
            peripherals: Mutex::new(peripherals),
            now: AtomicU64::new(0),
            horizon: AtomicU64::new(0),
            look: AtomicBool::new(true),
        }
    }

    /// The peripherals. A panic in the middle of an access leaves nothing that a next one couldn't stand.
    pub(crate) fn peripherals(&self) -> MutexGuard<'_, Peripherals> {
        self.peripherals.lock().unwrap_or_else(PoisonError::into_inner)
    }

    pub(crate) fn now(&self) -> u64 {
        self.now.load(Ordering::Relaxed)
    }

    pub(crate) fn set_now(&self, now: u64) {
        self.now.store(now, Ordering::Relaxed);
    }

    pub(crate) fn set_horizon(&self, horizon: u64) {
        self.horizon.store(horizon, Ordering::Relaxed);
    }

    /// Something has to be looked at; asking settles it.
    pub(crate) fn take_look(&self) -> bool {
        self.look.load(Ordering::Relaxed) && self.look.swap(false, Ordering::Relaxed)
    }

    /// Something has to be looked at, without settling it.
    pub(crate) fn wants_look(&self) -> bool {
        self.look.load(Ordering::Relaxed)
    }

    /// Something has to be looked at.
    pub(crate) fn look(&self) {
        self.look.store(true, Ordering::Relaxed);
    }

    /// Reads a register.
    pub(crate) fn read(&self, address: u32) -> Option<u32> {
        let mut peripherals = self.peripherals();
        let mut now = self.now();
        // A program that asks again and again whether a conversion is over, or what a counter shows, gets its answer when there
        // is another one, or when something else happens: the same course of events, without a thousand rounds of one loop.
        if let Some(over) = peripherals.awaited(address, now) {
            now = over.min(self.horizon.load(Ordering::Relaxed)).max(now);
            self.set_now(now);
        }
        let answer = peripherals.read(address, now);
        if answer.is_none_or(|(_, after)| after == After::Look) {
            self.look();
        }
        answer.map(|(value, _)| value)
    }

    /// Writes a register.
    pub(crate) fn write(&self, address: u32, value: u32) -> Option<()> {
        let mut peripherals = self.peripherals();
        let after = peripherals.write(address, value, self.now());
        self.stand_still(&mut peripherals);
        if after != Some(After::Go) {
            self.look();
        }
        after.map(drop)
    }

    /// Writes to the flash's array.
    pub(crate) fn program(&self, address: u32, bytes: u32, value: u32) {
        let mut peripherals = self.peripherals();
        peripherals.program(address, bytes, value);
        self.stand_still(&mut peripherals);
        self.look();
    }

    fn stand_still(&self, peripherals: &mut Peripherals) {
        let now = self.now();
        self.set_now(now + peripherals.take_stall(now));
    }
}

/// The flash as the core sees it: read like memory, written through its controller.
#[derive(Debug)]
pub(crate) struct FlashWindow {
    pub(crate) array: Arc<Store>,
    pub(crate) shared: Arc<Shared>,
}

impl MemOps for FlashWindow {
    fn read(&self, offset: u64, bytes: &mut [u8], attributes: MemAttrs) -> MemResult {
        MemOps::read(&*self.array, offset, bytes, attributes)
    }

    fn write(&self, offset: u64, bytes: &[u8], attributes: MemAttrs) -> MemResult {
        if attributes.debug {
            return Err(BusError::BadAccess);
        }
        let mut word = [0; 4];
        word.get_mut(..bytes.len()).ok_or(BusError::BadAccess)?.copy_from_slice(bytes);
        let address = FLASH.start + u32::try_from(offset).map_err(|_| BusError::BadAccess)?;
        let width = u32::try_from(bytes.len()).map_err(|_| BusError::BadAccess)?;
        self.shared.program(address, width, u32::from_le_bytes(word));
        Ok(())
    }
}

/// A window of the address space that shows peripherals.
#[derive(Debug)]
pub(crate) struct Window {
    pub(crate) base: u32,
    pub(crate) shared: Arc<Shared>,
}

impl Window {
    #[expect(clippy::cast_possible_truncation, reason = "offsets within a window of a 32-bit space")]
    fn address(&self, offset: u64) -> u32 {
        self.base + offset as u32
    }
}

impl MemOps for Window {
    fn read(&self, offset: u64, bytes: &mut [u8], attributes: MemAttrs) -> MemResult {
        if attributes.debug {
            return Err(BusError::BadAccess);
        }
        let address = self.address(offset);
        let word = self.shared.read(address).ok_or(BusError::BadAccess)?.to_le_bytes();
        let from = (address & 3) as usize;
        let part = word.get(from..from + bytes.len()).ok_or(BusError::BadAccess)?;
        bytes.copy_from_slice(part);
        Ok(())
    }

    fn write(&self, offset: u64, bytes: &[u8], attributes: MemAttrs) -> MemResult {
        if attributes.debug {
            return Err(BusError::BadAccess);
        }
        let address = self.address(offset);
        let from = (address & 3) as usize;
        let mut word = [0; 4];
        word.get_mut(from..from + bytes.len()).ok_or(BusError::BadAccess)?.copy_from_slice(bytes);
        self.shared.write(address, u32::from_le_bytes(word)).ok_or(BusError::BadAccess)
    }
}
