//! Clocks and resets: how fast the core runs, which peripherals have a clock, and why the chip started.

const CR: u32 = 0x00;
const PLLCFGR: u32 = 0x04;
const CFGR: u32 = 0x08;
const AHB1ENR: u32 = 0x30;
const APB1ENR: u32 = 0x40;
const APB2ENR: u32 = 0x44;
const CSR: u32 = 0x74;
const END: u32 = 0x98;

/// Internal oscillator; external clock of the NUCLEO, from its debugger.
const HSI_HZ: u32 = 16_000_000;
const HSE_HZ: u32 = 8_000_000;

const REMOVE_FLAGS: u32 = 1 << 24;
const FLAGS: u32 = 0xfe << 24;
const PIN: u32 = 1 << 26;

/// Why the chip starts.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Reset {
    Power,
    Pin,
    Software,
    Watchdog,
}

impl Reset {
    /// Every reset also pulls the pin.
    fn flags(self) -> u32 {
        PIN | match self {
            Self::Power => 1 << 27 | 1 << 25,
            Self::Pin => 0,
            Self::Software => 1 << 28,
            Self::Watchdog => 1 << 29,
        }
    }
}

/// A bus of peripherals.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Bus {
    Ahb1,
    Apb1,
    Apb2,
}

impl Bus {
    const ALL: [Self; 3] = [Self::Ahb1, Self::Apb1, Self::Apb2];

    fn enable(self) -> u32 {
        match self {
            Self::Ahb1 => AHB1ENR,
            Self::Apb1 => APB1ENR,
            Self::Apb2 => APB2ENR,
        }
    }
}

#[derive(Debug, Clone)]
pub(crate) struct Rcc {
    registers: [u32; (END / 4) as usize],
}

impl Rcc {
    pub(crate) fn new(reset: Reset) -> Self {
        let mut rcc = Self { registers: [0; (END / 4) as usize] };
        rcc.set(CR, 0x83);
        rcc.set(PLLCFGR, 0x2400_3010);
        rcc.set(CSR, reset.flags());
        rcc
    }

    /// After a reset, which leaves the flags of earlier ones alone but for power-on.
    pub(crate) fn reset(&mut self, reset: Reset) {
        let before = if reset == Reset::Power { 0 } else { self.get(CSR) & FLAGS };
        *self = Self::new(reset);
        self.set(CSR, self.get(CSR) | before);
    }

    pub(crate) fn read(&self, offset: u32) -> u32 {
        let value = self.get(offset);
        match offset {
            // Every oscillator and PLL is ready as soon as it is on.
            CR => value | (value & 0x1501_0001) << 1,
            CFGR => value & !0xc | (value & 3) << 2,
            CSR => value | (value & 1) << 1,
            _ => value,
        }
    }

    pub(crate) fn write(&mut self, offset: u32, value: u32) {
        match offset {
            CSR => {
                let flags = if value & REMOVE_FLAGS == 0 { self.get(CSR) & FLAGS } else { 0 };
                self.set(CSR, flags | value & 1);
            }
            _ => self.set(offset, value),
        }
    }

    /// A peripheral has a clock.
    pub(crate) fn enabled(&self, bus: Bus, bit: u32) -> bool {
        self.get(bus.enable()) >> bit & 1 == 1
    }

    /// The bus whose reset register this is.
    pub(crate) fn resets(offset: u32) -> Option<Bus> {
        // Each reset register stands eight words before its enable register.
        Bus::ALL.into_iter().find(|bus| bus.enable() - 0x20 == offset)
    }

    /// The core's clock.
    pub(crate) fn core_hz(&self) -> u32 {
        let system = match self.get(CFGR) & 3 {
            0 => HSI_HZ,
            1 => HSE_HZ,
            _ => self.pll_hz(),
        };
        match self.get(CFGR) >> 4 & 0xf {
            divided @ 8..12 => system >> (divided - 7),
            divided @ 12.. => system >> (divided - 6),
            _ => system,
        }
    }

    /// Cycles of the core's clock in one of a bus.
    pub(crate) fn divisor(&self, bus: Bus) -> u64 {
        let bits = match bus {
            Bus::Ahb1 => 0,
            Bus::Apb1 => self.get(CFGR) >> 10 & 7,
            Bus::Apb2 => self.get(CFGR) >> 13 & 7,
        };
        if bits < 4 { 1 } else { 1 << (bits - 3) }
    }

    /// Cycles of the core's clock in one of a bus's timers, which run at twice the rate of a slow bus.
    pub(crate) fn timer_divisor(&self, bus: Bus) -> u64 {
        self.divisor(bus).div_ceil(2)
    }

    fn pll_hz(&self) -> u32 {
        let config = self.get(PLLCFGR);
        let source = if config >> 22 & 1 == 0 { HSI_HZ } else { HSE_HZ };
        let (m, n, p) = (config & 0x3f, config >> 6 & 0x1ff, 2 * ((config >> 16 & 3) + 1));
        // Below 500 MHz times 432.
        let hz = u64::from(source) * u64::from(n) / u64::from(m.max(1)) / u64::from(p);
        u32::try_from(hz).unwrap_or(u32::MAX).max(1)
    }

    fn get(&self, offset: u32) -> u32 {
        self.registers.get((offset / 4) as usize).copied().unwrap_or(0)
    }

    fn set(&mut self, offset: u32, value: u32) {
        if let Some(register) = self.registers.get_mut((offset / 4) as usize) {
            *register = value;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_clock_tree_gives_the_rates_of_the_reference_manual() {
        let mut rcc = Rcc::new(Reset::Power);
        assert_eq!(rcc.core_hz(), 16_000_000);
        rcc.write(PLLCFGR, 8 | 166 << 6);
        rcc.write(CFGR, 2 | 5 << 10 | 4 << 13);
        assert_eq!(rcc.core_hz(), 166_000_000);
        assert_eq!((rcc.divisor(Bus::Apb1), rcc.divisor(Bus::Apb2)), (4, 2));
        assert_eq!((rcc.timer_divisor(Bus::Apb1), rcc.timer_divisor(Bus::Apb2)), (2, 1));
        rcc.write(CFGR, 2 | 8 << 4);
        assert_eq!(rcc.core_hz(), 83_000_000);
        rcc.write(CFGR, 2 | 12 << 4);
        assert_eq!(rcc.core_hz(), 166_000_000 / 64);
    }

    #[test]
    fn flags_of_a_reset_stay_until_they_are_removed() {
        let mut rcc = Rcc::new(Reset::Power);
        rcc.write(CSR, REMOVE_FLAGS);
        assert_eq!(rcc.read(CSR), 0);
        rcc.reset(Reset::Watchdog);
        rcc.reset(Reset::Software);
        assert_eq!(rcc.read(CSR), 1 << 29 | 1 << 28 | PIN);
    }
}
