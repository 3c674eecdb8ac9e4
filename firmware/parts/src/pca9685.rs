//! A PCA9685: sixteen servo pulses at 50 Hz behind an I2C bus.
//!
//! It has an output enable pin of its own, which the board drives: what is said here decides only which pulses
//! there are while that pin lets them out.

use core::fmt;
use embedded_hal::i2c::I2c;
use zygote_core::PulseMicros;

/// Servos of one chip.
pub const CHANNELS: usize = 16;

const MODE1: u8 = 0x00;
const MODE2: u8 = 0x01;
const LED0: u8 = 0x06;
const ALL_LED: u8 = 0xfa;
const PRE_SCALE: u8 = 0xfe;

/// Registers count up by themselves within a transfer.
const AUTO_INCREMENT: u8 = 0x20;
/// Oscillator off; the prescaler can only be written in it.
const SLEEP: u8 = 0x10;
/// Push-pull, and low while the enable pin is high.
const PUSH_PULL: u8 = 0x04;
/// In the last register of a channel: no pulse at all.
const FULL_OFF: u8 = 0x10;
/// 25 MHz / 4096 / (121 + 1) = 50.03 Hz.
const PRESCALER: u8 = 121;
/// A count is (121 + 1) / 25 MHz = 4.88 us: so many counts are so many microseconds.
const COUNTS: u32 = 25;
const MICROS: u32 = 122;

/// Why the servos can't be relied on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Lost<E> {
    /// The bus failed, or nobody answered.
    Bus(E),
    /// It answers, but isn't set up as it was: it lost its supply for a moment, or isn't a PCA9685.
    Changed {
        /// Its number.
        register: u8,
        /// What was written.
        expected: u8,
        /// What was read.
        got: u8,
    },
}

impl<E: fmt::Debug> fmt::Display for Lost<E> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Bus(error) => write!(f, "the servo driver doesn't answer: {error:?}"),
            Self::Changed { register, expected, got } => {
                write!(
                    f,
                    "register {register:#04x} of the servo driver is {got:#04x}, expected {expected:#04x}"
                )
            }
        }
    }
}

impl<E: fmt::Debug> core::error::Error for Lost<E> {}

/// A PCA9685, and what it was told.
#[derive(Debug)]
pub struct Pca9685<B> {
    bus: B,
    address: u8,
    sent: [Option<PulseMicros>; CHANNELS],
}

impl<B: I2c> Pca9685<B> {
    /// A chip that hasn't been spoken to.
    pub const fn new(bus: B, address: u8) -> Self {
        Self { bus, address, sent: [None; CHANNELS] }
    }

    /// The bus, to mend it.
    pub fn bus(&mut self) -> &mut B {
        &mut self.bus
    }

    /// Sets the chip up from whatever state it is in, every channel without a pulse, and sees that it took it.
    ///
    /// # Errors
    /// [`Lost`]
    pub fn start(&mut self) -> Result<(), Lost<B::Error>> {
        self.write(&[MODE1, SLEEP | AUTO_INCREMENT])?;
        self.write(&[PRE_SCALE, PRESCALER])?;
        self.write(&[MODE2, PUSH_PULL])?;
        self.write(&[ALL_LED, 0, 0, 0, FULL_OFF])?;
        self.sent = [None; CHANNELS];
        self.write(&[MODE1, AUTO_INCREMENT])?;
        self.check()
    }

    /// Sees that the chip is there and set up as it was left. One that was without power for a moment sleeps.
    ///
    /// # Errors
    /// [`Lost`]
    pub fn check(&mut self) -> Result<(), Lost<B::Error>> {
        for (register, expected) in [(MODE1, AUTO_INCREMENT), (MODE2, PUSH_PULL), (PRE_SCALE, PRESCALER)] {
            let mut got = [0];
            self.bus.write_read(self.address, &[register], &mut got).map_err(Lost::Bus)?;
            let [got] = got;
            if got != expected {
                return Err(Lost::Changed { register, expected, got });
            }
        }
        Ok(())
    }

    /// Tells the chip the pulses that have changed; `None` sends none. The error leaves the rest untold.
    ///
    /// # Errors
    /// [`Lost`]
    pub fn send(&mut self, pulses: &[Option<PulseMicros>; CHANNELS]) -> Result<(), Lost<B::Error>> {
        for (channel, (&pulse, before)) in (0..).zip(pulses.iter().zip(self.sent)) {
            if pulse != before {
                let [low, high] = pulse.map_or([0, FULL_OFF], |pulse| counts(pulse).to_le_bytes());
                self.write(&[LED0 + 4 * channel, 0, 0, low, high])?;
                if let Some(sent) = self.sent.get_mut(usize::from(channel)) {
                    *sent = pulse;
                }
            }
        }
        Ok(())
    }

    fn write(&mut self, bytes: &[u8]) -> Result<(), Lost<B::Error>> {
        self.bus.write(self.address, bytes).map_err(Lost::Bus)
    }
}

/// The length of a pulse in counts, to the nearest; the core sends none that is longer than the period.
fn counts(pulse: PulseMicros) -> u16 {
    let counts = (u32::from(pulse.0) * COUNTS + MICROS / 2) / MICROS;
    u16::try_from(counts).unwrap_or(u16::MAX).min(4095)
}

#[cfg(test)]
mod tests {
    extern crate std;
    use super::*;
    use core::convert::Infallible;
    use embedded_hal::i2c::{ErrorKind, ErrorType, Operation};
    use std::string::ToString;

    /// A chip as its data sheet has it: registers, and a count of the transfers that reached it.
    struct Chip {
        registers: [u8; 256],
        transfers: usize,
        silent: bool,
    }

    impl Chip {
        fn new() -> Self {
            let mut registers = [0; 256];
            (registers[0x00], registers[0x01], registers[0xfe]) = (0x11, 0x04, 0x1e);
            Self { registers, transfers: 0, silent: false }
        }

        fn write(&mut self, bytes: &[u8]) {
            let (&at, values) = bytes.split_first().unwrap();
            for (at, &value) in (usize::from(at)..).zip(values) {
                let asleep = self.registers[0x00] & SLEEP != 0;
                match at {
                    0xfe if !asleep => {}
                    0xfa..=0xfd => (0..CHANNELS).for_each(|n| self.registers[6 + 4 * n + at - 0xfa] = value),
                    _ => self.registers[at] = value,
                }
            }
        }

        fn channel(&self, channel: usize) -> [u8; 4] {
            self.registers[6 + 4 * channel..][..4].try_into().unwrap()
        }
    }

    impl ErrorType for Chip {
        type Error = ErrorKind;
    }

    impl I2c for Chip {
        fn transaction(&mut self, address: u8, operations: &mut [Operation<'_>]) -> Result<(), Self::Error> {
            if self.silent || address != 0x40 {
                return Err(ErrorKind::Bus);
            }
            self.transfers += 1;
            let mut at = 0;
            for operation in operations {
                match operation {
                    Operation::Write(bytes) => {
                        at = usize::from(bytes[0]);
                        self.write(bytes);
                    }
                    Operation::Read(bytes) => bytes.copy_from_slice(&self.registers[at..][..bytes.len()]),
                }
            }
            Ok(())
        }
    }

    fn started() -> Pca9685<Chip> {
        let mut servos = Pca9685::new(Chip::new(), 0x40);
        servos.start().unwrap();
        servos
    }

    #[test]
    fn a_fresh_chip_gives_fifty_hertz_and_no_pulse() {
        let mut servos = started();
        assert_eq!((servos.bus().registers[0x00], servos.bus().registers[0xfe]), (0x20, 121));
        assert!((0..CHANNELS).all(|channel| servos.bus().channel(channel) == [0, 0, 0, 0x10]));
    }

    #[test]
    fn pulses_are_right_to_a_count_and_told_only_when_they_change() {
        let mut servos = started();
        let mut pulses = [None; CHANNELS];
        (pulses[0], pulses[15]) = (Some(PulseMicros(500)), Some(PulseMicros(2500)));
        servos.send(&pulses).unwrap();
        // 500 us / 4.88 us = 102.46, 2500 us / 4.88 us = 512.3
        assert_eq!(servos.bus().channel(0), [0, 0, 102, 0]);
        assert_eq!(servos.bus().channel(15), [0, 0, 0, 2]);
        assert_eq!(servos.bus().channel(1), [0, 0, 0, 0x10]);
        let transfers = servos.bus().transfers;
        servos.send(&pulses).unwrap();
        assert_eq!(servos.bus().transfers, transfers, "nothing to tell");
        pulses[0] = None;
        servos.send(&pulses).unwrap();
        assert_eq!(servos.bus().transfers, transfers + 1);
        assert_eq!(servos.bus().channel(0), [0, 0, 0, 0x10]);
    }

    #[test]
    fn a_chip_that_lost_its_supply_for_a_moment_is_noticed() {
        let mut servos = started();
        assert_eq!(servos.check(), Ok(()));
        *servos.bus() = Chip::new();
        assert_eq!(servos.check(), Err(Lost::Changed { register: 0, expected: 0x20, got: 0x11 }));
        servos.start().unwrap();
        assert_eq!(servos.check(), Ok(()));
    }

    #[test]
    fn a_silent_bus_is_noticed_and_what_was_not_told_is_told_later() {
        let mut servos = started();
        let mut pulses = [None; CHANNELS];
        pulses[3] = Some(PulseMicros(1500));
        servos.bus().silent = true;
        assert_eq!(servos.send(&pulses), Err(Lost::Bus(ErrorKind::Bus)));
        assert_eq!(servos.check(), Err(Lost::Bus(ErrorKind::Bus)));
        servos.bus().silent = false;
        servos.send(&pulses).unwrap();
        assert_eq!(servos.bus().channel(3), [0, 0, 51, 1], "307 counts");
    }

    #[test]
    fn what_is_lost_is_said_with_its_numbers() {
        let lost = Lost::<Infallible>::Changed { register: 0, expected: 0x20, got: 0x11 };
        assert_eq!(lost.to_string(), "register 0x00 of the servo driver is 0x11, expected 0x20");
    }

    #[test]
    fn no_pulse_reaches_beyond_the_counter() {
        assert_eq!((counts(PulseMicros(0)), counts(PulseMicros(u16::MAX))), (0, 4095));
    }
}
