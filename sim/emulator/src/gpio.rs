//! A port: what its pins are set up for, what they show, and what is applied to them from outside.

const MODER: u32 = 0x00;
const IDR: u32 = 0x10;
const ODR: u32 = 0x14;
const BSRR: u32 = 0x18;
const AFRL: u32 = 0x20;
const AFRH: u32 = 0x24;
const END: u32 = 0x28;

/// What drives a pin.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Pin {
    /// Nobody: an input, or an analog pin. The pull-down that every actuator has keeps it low.
    Floating,
    /// The output register.
    Level(bool),
    /// A peripheral, by its number in the table of alternate functions.
    Alternate(u8),
}

#[derive(Debug, Clone)]
pub(crate) struct Gpio {
    /// Configuration registers as they were written, by word.
    registers: [u32; (END / 4) as usize],
    /// Levels applied from outside, a bit a pin.
    applied: u32,
}

impl Gpio {
    /// After a reset: everything an input but the debugger's pins.
    pub(crate) fn new(letter: char) -> Self {
        let mut registers = [0; (END / 4) as usize];
        registers[(MODER / 4) as usize] = match letter {
            'A' => 0xa800_0000,
            'B' => 0x0000_0280,
            _ => 0,
        };
        Self { registers, applied: 0 }
    }

    /// A reset, which what is applied from outside outlives.
    pub(crate) fn reset(&mut self, letter: char) {
        *self = Self { applied: self.applied, ..Self::new(letter) };
    }

    pub(crate) fn apply(&mut self, pin: u8, high: bool) {
        self.applied = self.applied & !(1 << pin) | u32::from(high) << pin;
    }

    pub(crate) fn read(&self, offset: u32) -> u32 {
        match offset {
            IDR => (0..16).fold(0, |levels, pin| levels | u32::from(self.level(pin)) << pin),
            BSRR => 0,
            _ => self.registers.get((offset / 4) as usize).copied().unwrap_or(0),
        }
    }

    pub(crate) fn write(&mut self, offset: u32, value: u32) {
        match offset {
            BSRR => {
                let odr = &mut self.registers[(ODR / 4) as usize];
                *odr = *odr & !(value >> 16) | value & 0xffff;
            }
            IDR => {}
            _ => {
                if let Some(register) = self.registers.get_mut((offset / 4) as usize) {
                    *register = value;
                }
            }
        }
    }

    pub(crate) fn pin(&self, pin: u8) -> Pin {
        match self.registers[(MODER / 4) as usize] >> (2 * pin) & 3 {
            1 => Pin::Level(self.output(pin)),
            2 => {
                let half = if pin < 8 { AFRL } else { AFRH };
                Pin::Alternate((self.registers[(half / 4) as usize] >> (4 * (pin % 8)) & 0xf) as u8)
            }
            _ => Pin::Floating,
        }
    }

    /// The level that a pin shows to the input register.
    pub(crate) fn level(&self, pin: u8) -> bool {
        match self.pin(pin) {
            Pin::Level(high) => high,
            Pin::Floating | Pin::Alternate(_) => self.applied >> pin & 1 == 1,
        }
    }

    fn output(&self, pin: u8) -> bool {
        self.registers[(ODR / 4) as usize] >> pin & 1 == 1
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_port_is_all_inputs_after_a_reset_whatever_it_was_before() {
        let mut port = Gpio::new('C');
        port.apply(13, true);
        port.write(MODER, 1 << 20);
        port.write(BSRR, 1 << 10);
        assert_eq!(port.pin(10), Pin::Level(true));
        port.reset('C');
        assert_eq!(port.pin(10), Pin::Floating);
        assert!(port.level(13), "what is applied from outside outlives a reset");
    }

    #[test]
    fn a_bit_that_is_set_and_reset_at_once_is_set() {
        let mut port = Gpio::new('C');
        port.write(BSRR, 1 << 19 | 1 << 3);
        assert_eq!(port.read(ODR), 1 << 3);
    }

    #[test]
    fn a_pin_shows_its_alternate_function() {
        let mut port = Gpio::new('B');
        port.write(MODER, 2 << 18);
        port.write(AFRH, 2 << 4);
        assert_eq!(port.pin(9), Pin::Alternate(2));
    }
}
