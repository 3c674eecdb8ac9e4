//! The I2C master to the servo driver, a byte at a time, polled: what the board's program uses.

use crate::pca9685::Pca9685;

const CR1: u32 = 0x00;
const DR: u32 = 0x10;
const SR1: u32 = 0x14;
const SR2: u32 = 0x18;
const CCR: u32 = 0x1c;
const END: u32 = 0x28;

const PE: u32 = 1;
const START: u32 = 1 << 8;
const STOP: u32 = 1 << 9;
const SWRST: u32 = 1 << 15;

const SB: u32 = 1;
const ADDR: u32 = 1 << 1;
const BTF: u32 = 1 << 2;
const RXNE: u32 = 1 << 6;
const TXE: u32 = 1 << 7;
const AF: u32 = 1 << 10;
/// Flags that the program clears by writing 0.
const ERRORS: u32 = 0xdf00;

const MASTER_BUSY: u32 = 3;
const TRANSMITS: u32 = 1 << 2;

const FAST: u32 = 1 << 15;
const DUTY: u32 = 1 << 14;
/// A byte and its acknowledge.
const BITS: u64 = 9;

/// What goes over the wires.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Transfer {
    Start,
    Address(u8),
    Send(u8),
    Receive,
}

#[derive(Debug, Clone)]
pub(crate) struct I2c {
    registers: [u32; (END / 4) as usize],
    divisor: u64,
    status: u32,
    /// The second status register.
    line: u32,
    under_way: Option<(u64, Transfer)>,
    received: u8,
}

impl I2c {
    pub(crate) fn new() -> Self {
        Self {
            registers: [0; (END / 4) as usize],
            divisor: 1,
            status: 0,
            line: 0,
            under_way: None,
            received: 0,
        }
    }

    pub(crate) fn reset(&mut self) {
        *self = Self { divisor: self.divisor, ..Self::new() };
    }

    pub(crate) fn set_divisor(&mut self, divisor: u64) {
        self.divisor = divisor;
    }

    pub(crate) fn read(&mut self, offset: u32, now: u64, chip: &mut Pca9685) -> u32 {
        self.sync(now, chip);
        match offset {
            SR1 => self.status,
            SR2 => {
                let line = self.line;
                if self.status & ADDR != 0 {
                    self.status &= !ADDR;
                    if line & TRANSMITS == 0 {
                        self.begin(now, BITS, Transfer::Receive);
                    } else {
                        self.status |= TXE;
                    }
                }
                line
            }
            DR => {
                self.status &= !(RXNE | BTF);
                if self.line == MASTER_BUSY && self.under_way.is_none() {
                    self.begin(now, BITS, Transfer::Receive);
                }
                self.received.into()
            }
            _ => self.get(offset),
        }
    }

    pub(crate) fn write(&mut self, offset: u32, value: u32, now: u64, chip: &mut Pca9685) {
        self.sync(now, chip);
        match offset {
            CR1 if value & SWRST != 0 || value & PE == 0 => {
                chip.stop();
                (self.status, self.line, self.under_way) = (0, 0, None);
                self.set(CR1, value & !(START | STOP));
            }
            CR1 => {
                self.set(CR1, value);
                if value & START != 0 && self.under_way.is_none() {
                    self.begin(now, 1, Transfer::Start);
                }
                if value & STOP != 0 && self.under_way.is_none() {
                    self.stop(chip);
                }
            }
            SR1 => self.status &= value | !ERRORS,
            DR => {
                let byte = value.to_le_bytes()[0];
                if self.status & SB != 0 {
                    self.status &= !SB;
                    self.begin(now, BITS, Transfer::Address(byte));
                } else if self.line & TRANSMITS != 0 {
                    self.status &= !(TXE | BTF);
                    self.begin(now, BITS, Transfer::Send(byte));
                }
            }
            SR2 => {}
            _ => self.set(offset, value),
        }
    }

    fn sync(&mut self, now: u64, chip: &mut Pca9685) {
        let Some((_, transfer)) = self.under_way.take_if(|(over, _)| *over <= now) else { return };
        match transfer {
            Transfer::Start => {
                self.status = self.status & !(TXE | BTF) | SB;
                self.line = MASTER_BUSY;
                self.set(CR1, self.get(CR1) & !START);
            }
            Transfer::Address(byte) if chip.address(byte) => {
                self.status |= ADDR;
                self.line = MASTER_BUSY | if byte & 1 == 0 { TRANSMITS } else { 0 };
            }
            Transfer::Address(_) => self.status |= AF,
            Transfer::Send(byte) => {
                chip.take(byte);
                self.status |= TXE | BTF;
            }
            Transfer::Receive => {
                self.received = chip.give();
                self.status |= RXNE;
            }
        }
        if self.get(CR1) & STOP != 0 {
            self.stop(chip);
        }
    }

    fn stop(&mut self, chip: &mut Pca9685) {
        chip.stop();
        self.line = 0;
        self.status &= !(TXE | BTF | ADDR | SB);
        self.set(CR1, self.get(CR1) & !STOP);
    }

    fn begin(&mut self, now: u64, bits: u64, transfer: Transfer) {
        self.under_way = Some((now + bits * self.bit(), transfer));
    }

    /// Cycles of the core's clock in a bit.
    fn bit(&self) -> u64 {
        let ccr = self.get(CCR);
        let phases = match (ccr & FAST != 0, ccr & DUTY != 0) {
            (false, _) => 2,
            (true, false) => 3,
            (true, true) => 25,
        };
        u64::from(ccr & 0xfff).max(1) * phases * self.divisor
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

    /// Waits for a flag as a program does.
    fn wait(i2c: &mut I2c, now: &mut u64, chip: &mut Pca9685, flag: u32) {
        let start = *now;
        while i2c.read(SR1, *now, chip) & flag == 0 {
            *now += 1;
            assert!(*now < start + 10_000, "no {flag:#x}, but {:#x}", i2c.status);
        }
    }

    fn begin(i2c: &mut I2c, now: &mut u64, chip: &mut Pca9685, address: u32) {
        i2c.write(CR1, PE | START, *now, chip);
        wait(i2c, now, chip, SB);
        i2c.write(DR, address, *now, chip);
    }

    #[test]
    fn a_register_that_was_written_is_read_back_after_a_repeated_start() {
        let (mut i2c, mut chip, mut now) = (I2c::new(), Pca9685::new(), 0);
        i2c.write(CCR, FAST | 0x23, now, &mut chip);
        begin(&mut i2c, &mut now, &mut chip, 0x80);
        wait(&mut i2c, &mut now, &mut chip, ADDR);
        i2c.read(SR2, now, &mut chip);
        let before = now;
        for byte in [0xfe, 121] {
            i2c.write(DR, byte, now, &mut chip);
            wait(&mut i2c, &mut now, &mut chip, BTF);
        }
        assert_eq!(now - before, 2 * 9 * 105, "a byte takes nine bits");
        i2c.write(CR1, PE | STOP, now, &mut chip);
        begin(&mut i2c, &mut now, &mut chip, 0x80);
        wait(&mut i2c, &mut now, &mut chip, ADDR);
        i2c.read(SR2, now, &mut chip);
        i2c.write(DR, 0xfe, now, &mut chip);
        wait(&mut i2c, &mut now, &mut chip, BTF);
        begin(&mut i2c, &mut now, &mut chip, 0x81);
        wait(&mut i2c, &mut now, &mut chip, ADDR);
        i2c.read(SR2, now, &mut chip);
        i2c.write(CR1, PE | STOP, now, &mut chip);
        wait(&mut i2c, &mut now, &mut chip, RXNE);
        assert_eq!(i2c.read(DR, now, &mut chip), 121);
        assert_eq!(i2c.read(SR2, now, &mut chip), 0, "the bus is free");
    }

    #[test]
    fn nobody_answers_at_another_address() {
        let (mut i2c, mut chip, mut now) = (I2c::new(), Pca9685::new(), 0);
        begin(&mut i2c, &mut now, &mut chip, 0x90);
        wait(&mut i2c, &mut now, &mut chip, AF);
        assert_eq!(i2c.read(SR1, now, &mut chip) & ADDR, 0);
    }
}
