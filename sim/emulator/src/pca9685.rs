//! The servo driver's chip: registers behind the I2C bus, sixteen pulses out. It has a supply and an oscillator of its own,
//! so a reset of the MCU changes nothing in it.

use zygote_core::PulseMicros;

/// Its address with the address pins open, as on the bus: a bit for the direction stands after it.
const ADDRESS: u8 = 0x40 << 1;

const MODE1: u8 = 0x00;
const LED0: u8 = 0x06;
const LED_END: u8 = 0x46;
const ALL_LED: u8 = 0xfa;
const PRE_SCALE: u8 = 0xfe;

const AUTO_INCREMENT: u8 = 0x20;
const SLEEP: u8 = 0x10;
/// In the last register of a channel.
const FULL_OFF: u8 = 0x10;
/// Of its oscillator.
const CYCLES_PER_MICROSECOND: u32 = 25;
/// Registers that aren't zero after power-on: asleep and answering to all-call; open address; 200 Hz.
const POWER_ON: [(u8, u8); 3] = [(MODE1, 0x11), (0x01, 0x04), (PRE_SCALE, 0x1e)];

#[derive(Debug, Clone)]
pub(crate) struct Pca9685 {
    registers: [u8; 256],
    /// The register that comes next, once it has been named in a transfer.
    pointer: Option<u8>,
    addressed: bool,
    latest: u8,
}

impl Pca9685 {
    pub(crate) fn new() -> Self {
        let mut registers = [0; 256];
        for (register, value) in POWER_ON {
            registers[usize::from(register)] = value;
        }
        for channel in 0..16 {
            registers[usize::from(LED0) + 4 * channel + 3] = FULL_OFF;
        }
        Self { registers, pointer: None, addressed: false, latest: 0 }
    }

    /// An address on the bus; whether it is this chip's.
    pub(crate) fn address(&mut self, byte: u8) -> bool {
        self.addressed = byte & !1 == ADDRESS;
        // A read goes on where the write before it pointed.
        self.pointer = if byte & 1 == 1 { Some(self.latest) } else { None };
        self.addressed
    }

    /// A byte for it.
    pub(crate) fn take(&mut self, byte: u8) {
        if !self.addressed {
            return;
        }
        let Some(register) = self.pointer else {
            (self.pointer, self.latest) = (Some(byte), byte);
            return;
        };
        match register {
            // The prescaler only while the oscillator is off.
            PRE_SCALE if self.get(MODE1) & SLEEP == 0 => {}
            ALL_LED..PRE_SCALE => {
                for channel in 0..16 {
                    self.registers[usize::from(LED0 + (register - ALL_LED)) + 4 * channel] = byte;
                }
            }
            _ => self.registers[usize::from(register)] = byte,
        }
        self.advance();
    }

    /// A byte of it.
    pub(crate) fn give(&mut self) -> u8 {
        let byte = self.pointer.map_or(0xff, |register| self.get(register));
        self.advance();
        byte
    }

    /// The end of a transfer.
    pub(crate) fn stop(&mut self) {
        self.addressed = false;
    }

    /// The pulses that it makes while its enable pin is low.
    pub(crate) fn pulses(&self) -> [Option<PulseMicros>; 16] {
        let awake = self.get(MODE1) & SLEEP == 0;
        let cycles = u32::from(self.get(PRE_SCALE)) + 1;
        let mut channel = (LED0..LED_END).step_by(4);
        std::array::from_fn(|_| {
            let at = channel.next()?;
            let [low, high] = [self.get(at + 2), self.get(at + 3)];
            let counts = u32::from(u16::from_le_bytes([low, high & 0xf]));
            let on = awake && high & FULL_OFF == 0 && counts > 0;
            let micros = (counts * cycles + CYCLES_PER_MICROSECOND / 2) / CYCLES_PER_MICROSECOND;
            on.then(|| PulseMicros(u16::try_from(micros).unwrap_or(u16::MAX)))
        })
    }

    fn advance(&mut self) {
        if self.get(MODE1) & AUTO_INCREMENT != 0 {
            self.pointer = self.pointer.map(|register| register.wrapping_add(1));
            self.latest = self.pointer.unwrap_or(self.latest);
        }
    }

    fn get(&self, register: u8) -> u8 {
        self.registers[usize::from(register)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn write(chip: &mut Pca9685, bytes: &[u8]) {
        assert!(chip.address(ADDRESS));
        for byte in bytes {
            chip.take(*byte);
        }
        chip.stop();
    }

    #[test]
    fn a_pulse_is_as_long_as_its_counts_and_none_before_the_chip_is_awake() {
        let mut chip = Pca9685::new();
        write(&mut chip, &[PRE_SCALE, 121]);
        write(&mut chip, &[MODE1, AUTO_INCREMENT | SLEEP]);
        write(&mut chip, &[LED0 + 8, 0, 0, 0x33, 0x01]);
        assert_eq!(chip.pulses(), [None; 16]);
        write(&mut chip, &[MODE1, AUTO_INCREMENT]);
        // 307 counts of 4.88 us.
        assert_eq!(chip.pulses()[2], Some(PulseMicros(1498)));
        assert_eq!(chip.pulses()[1], None);
        write(&mut chip, &[ALL_LED, 0, 0, 0, FULL_OFF]);
        assert_eq!(chip.pulses(), [None; 16]);
    }

    #[test]
    fn the_prescaler_is_locked_while_it_runs_and_nobody_else_is_answered() {
        let mut chip = Pca9685::new();
        write(&mut chip, &[MODE1, AUTO_INCREMENT]);
        write(&mut chip, &[PRE_SCALE, 9]);
        assert_eq!(chip.get(PRE_SCALE), 0x1e);
        assert!(!chip.address(0x42 << 1));
    }
}
