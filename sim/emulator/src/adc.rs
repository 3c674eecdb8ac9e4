//! The converter: one channel at a time, started by the program, at the speed of its clock.

const SR: u32 = 0x00;
const CR2: u32 = 0x08;
const SMPR1: u32 = 0x0c;
const SMPR2: u32 = 0x10;
const SQR3: u32 = 0x34;
const DR: u32 = 0x4c;
const CCR: u32 = 0x304;
const END: u32 = 0x50;

const EOC: u32 = 1 << 1;
const STRT: u32 = 1 << 4;
const ADON: u32 = 1;
const SWSTART: u32 = 1 << 30;
/// Cycles of sampling, by the three bits of a channel.
const SAMPLING: [u64; 8] = [3, 15, 28, 56, 84, 112, 144, 480];
/// Cycles of converting twelve bits.
const CONVERTING: u64 = 12;

/// What lies at the inputs, as the converter would count it.
#[derive(Debug, Clone, Default)]
pub(crate) struct Analog {
    /// Behind the multiplexer.
    pub(crate) thermistors: [u16; 16],
    /// PA1.
    pub(crate) supply: u16,
    /// PA4.
    pub(crate) current: u16,
}

#[derive(Debug, Clone)]
pub(crate) struct Adc {
    registers: [u32; (END / 4) as usize],
    common: u32,
    divisor: u64,
    /// When the conversion under way is over, and what it will say.
    converting: Option<(u64, u16)>,
}

impl Adc {
    pub(crate) fn new() -> Self {
        Self { registers: [0; (END / 4) as usize], common: 0, divisor: 1, converting: None }
    }

    pub(crate) fn reset(&mut self) {
        *self = Self { divisor: self.divisor, ..Self::new() };
    }

    pub(crate) fn set_divisor(&mut self, divisor: u64) {
        self.divisor = divisor;
    }

    /// When the conversion under way is over.
    pub(crate) fn over(&self) -> Option<u64> {
        self.converting.map(|(over, _)| over)
    }

    /// The channel that is converted next.
    pub(crate) fn channel(&self) -> u32 {
        self.get(SQR3) & 0x1f
    }

    pub(crate) fn read(&mut self, offset: u32, now: u64) -> u32 {
        self.sync(now);
        match offset {
            DR => {
                self.registers[(SR / 4) as usize] &= !EOC;
                self.get(DR)
            }
            CCR => self.common,
            _ => self.get(offset),
        }
    }

    /// `input` is what lies at a channel.
    pub(crate) fn write(&mut self, offset: u32, value: u32, now: u64, input: impl Fn(u32) -> u16) {
        self.sync(now);
        match offset {
            SR => self.registers[(SR / 4) as usize] &= value,
            CR2 => {
                self.registers[(CR2 / 4) as usize] = value & !SWSTART;
                if value & SWSTART != 0 && value & ADON != 0 && self.converting.is_none() {
                    let channel = self.channel();
                    let clocks = (self.sampling(channel) + CONVERTING) * self.clock();
                    self.converting = Some((now + clocks, input(channel)));
                    self.registers[(SR / 4) as usize] |= STRT;
                }
            }
            CCR => self.common = value,
            _ => {
                if let Some(register) = self.registers.get_mut((offset / 4) as usize) {
                    *register = value;
                }
            }
        }
    }

    fn sync(&mut self, now: u64) {
        if let Some((_, reading)) = self.converting.take_if(|(over, _)| *over <= now) {
            self.registers[(DR / 4) as usize] = reading.into();
            self.registers[(SR / 4) as usize] |= EOC;
        }
    }

    fn sampling(&self, channel: u32) -> u64 {
        let bits = if channel < 10 {
            self.get(SMPR2) >> (3 * channel)
        } else {
            self.get(SMPR1) >> (3 * (channel - 10))
        };
        SAMPLING[(bits & 7) as usize]
    }

    /// Cycles of the core's clock in one of the converter's.
    fn clock(&self) -> u64 {
        self.divisor * 2 * u64::from((self.common >> 16 & 3) + 1)
    }

    fn get(&self, offset: u32) -> u32 {
        self.registers.get((offset / 4) as usize).copied().unwrap_or(0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_conversion_takes_its_time_and_says_what_lay_at_its_channel() {
        let mut adc = Adc::new();
        adc.set_divisor(2);
        let input = |channel| if channel == 4 { 1234 } else { 0 };
        adc.write(CCR, 1 << 16, 0, input);
        adc.write(SMPR2, 6 << 12, 0, input);
        adc.write(SQR3, 4, 0, input);
        adc.write(CR2, ADON | SWSTART, 100, input);
        let over = 100 + (144 + 12) * 8;
        assert_eq!(adc.over(), Some(over));
        assert_eq!(adc.read(SR, over - 1), STRT);
        assert_eq!(adc.read(SR, over), STRT | EOC);
        assert_eq!(adc.read(DR, over), 1234);
        assert_eq!(adc.read(SR, over) & EOC, 0);
    }

    #[test]
    fn a_converter_that_is_off_converts_nothing() {
        let mut adc = Adc::new();
        adc.write(CR2, SWSTART, 0, |_| 7);
        assert_eq!(adc.over(), None);
    }
}
