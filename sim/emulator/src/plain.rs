//! Peripherals of which the program needs no more than that they keep what is written: voltage regulator, DMA
//! controllers that nobody starts, debugger. The regulator is ready at once.

use std::collections::BTreeMap;

/// Regulator: control, and status with the ready flags at the places of the control's bits.
const PWR: u32 = 0x4000_7000;
const PWR_STATUS: u32 = PWR + 4;
/// Over-drive and its switch.
const PWR_READY: u32 = 3 << 16;

#[derive(Debug, Clone, Default)]
pub(crate) struct Plain {
    written: BTreeMap<u32, u32>,
}

impl Plain {
    /// An address that is one of theirs.
    pub(crate) fn holds(address: u32) -> bool {
        matches!(address, 0x4000_7000..0x4000_7400 // PWR
            | 0x4002_6000..0x4002_6800 // DMA1, DMA2
            | 0xe004_2000..0xe004_2400) // DBGMCU
    }

    pub(crate) fn read(&self, address: u32) -> u32 {
        let value = |address| self.written.get(&address).copied().unwrap_or(0);
        match address {
            PWR_STATUS => value(PWR) & PWR_READY | 1 << 14,
            _ => value(address),
        }
    }

    pub(crate) fn write(&mut self, address: u32, value: u32) {
        self.written.insert(address, value);
    }
}
