//! A timer: a counter with a prescaler, four compare channels, interrupts, and PWM outputs. Counting up, reloading at
//! once: what the board's program uses. Nothing runs here: the counter is worked out from the time when it is asked for.

use zygote_core::Duty;

const CR1: u32 = 0x00;
const DIER: u32 = 0x0c;
const SR: u32 = 0x10;
const EGR: u32 = 0x14;
const CCMR1: u32 = 0x18;
const CCER: u32 = 0x20;
pub(crate) const CNT: u32 = 0x24;
const PSC: u32 = 0x28;
const ARR: u32 = 0x2c;
const CCR1: u32 = 0x34;
const BDTR: u32 = 0x44;
const END: u32 = 0x54;

const CEN: u32 = 1;
const URS: u32 = 1 << 2;
const UIF: u32 = 1;
const UG: u32 = 1;
const MOE: u32 = 1 << 15;
/// Update and four compare interrupts.
const INTERRUPTS: u32 = 0x1f;

/// What a timer has.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Kind {
    /// Sixteen bits; TIM3, TIM4, TIM6, TIM7.
    General,
    /// Thirty-two bits; TIM2 and TIM5.
    Wide,
    /// Outputs behind a main switch; TIM1 and TIM8.
    Advanced,
}

#[derive(Debug, Clone)]
pub(crate) struct Timer {
    kind: Kind,
    registers: [u32; (END / 4) as usize],
    /// The prescaler at work; the register is taken over at the next update.
    prescaler: u32,
    /// Cycles of the core's clock in one of the timer's.
    divisor: u64,
    /// When the count was 0, in cycles; while it stands, its value.
    origin: u64,
    /// The count up to which compare matches have been noted; -1 before the count of 0.
    seen: i64,
}

impl Timer {
    pub(crate) fn new(kind: Kind) -> Self {
        let mut timer =
            Self { kind, registers: [0; (END / 4) as usize], prescaler: 0, divisor: 1, origin: 0, seen: 0 };
        timer.set(ARR, timer.mask());
        timer
    }

    pub(crate) fn reset(&mut self) {
        *self = Self { divisor: self.divisor, ..Self::new(self.kind) };
    }

    /// Another clock.
    pub(crate) fn set_divisor(&mut self, divisor: u64, now: u64) {
        if divisor != self.divisor {
            let count = self.count(now);
            self.divisor = divisor;
            self.restart(count, now);
        }
    }

    pub(crate) fn read(&mut self, offset: u32, now: u64) -> u32 {
        self.sync(now);
        match offset {
            CNT => self.count(now),
            EGR => 0,
            _ => self.get(offset),
        }
    }

    pub(crate) fn write(&mut self, offset: u32, value: u32, now: u64) {
        self.sync(now);
        match offset {
            CR1 => {
                let (before, count) = (self.get(CR1), self.count(now));
                self.set(CR1, value);
                // One that goes on keeps its place within a count.
                if (before ^ value) & CEN != 0 {
                    self.restart(count, now);
                }
            }
            SR => self.set(SR, self.get(SR) & value),
            EGR => {
                if value & UG != 0 {
                    self.prescaler = self.get(PSC);
                    self.restart(0, now);
                    if self.get(CR1) & URS == 0 {
                        self.set(SR, self.get(SR) | UIF);
                    }
                }
                // Compare events by software.
                self.set(SR, self.get(SR) | value & 0x1e);
            }
            CNT => self.restart(value & self.mask(), now),
            ARR => {
                let count = self.count(now);
                self.set(ARR, value & self.mask());
                self.restart(count, now);
            }
            _ => self.set(offset, value),
        }
    }

    /// Notes what has happened by now.
    pub(crate) fn sync(&mut self, now: u64) {
        if self.get(CR1) & CEN == 0 {
            return;
        }
        loop {
            let (tick, period) = (self.tick(), self.period());
            let count = (now - self.origin) / tick;
            if count < period {
                self.note_matches(i64_from(count));
                return;
            }
            self.note_matches(i64_from(period) - 1);
            self.set(SR, self.get(SR) | UIF);
            self.origin += period * tick;
            self.seen = -1;
            if self.prescaler == self.get(PSC) {
                // Whole periods that nobody looked at.
                let whole = (now - self.origin) / (period * tick);
                if whole > 0 {
                    self.note_matches(i64_from(period) - 1);
                    self.origin += whole * period * tick;
                    self.seen = -1;
                }
            } else {
                self.prescaler = self.get(PSC);
            }
        }
    }

    /// The next cycle at which an interrupt is raised that isn't yet.
    pub(crate) fn next_event(&self) -> Option<u64> {
        let waited_for = self.get(DIER) & !self.get(SR) & INTERRUPTS;
        if waited_for == 0 || self.get(CR1) & CEN == 0 {
            return None;
        }
        let (tick, period) = (self.tick(), self.period());
        let update = (waited_for & UIF != 0 || self.prescaler != self.get(PSC)).then_some(period);
        let matches = (0..4).filter(|channel| waited_for >> (channel + 1) & 1 == 1).filter_map(|channel| {
            let compare = u64::from(self.compare(channel));
            let ahead = if i64_from(compare) > self.seen { compare } else { period + compare };
            (compare < period).then_some(ahead)
        });
        matches.chain(update).min().map(|ticks| self.origin + ticks * tick)
    }

    /// An interrupt is raised.
    pub(crate) fn interrupts(&self) -> bool {
        self.get(DIER) & self.get(SR) & INTERRUPTS != 0
    }

    /// What channel 0 to 3 puts out, on average.
    pub(crate) fn duty(&self, channel: u32) -> Duty {
        let enabled = self.get(CCER) >> (4 * channel) & 1 == 1
            && self.get(CR1) & CEN != 0
            && (self.kind != Kind::Advanced || self.get(BDTR) & MOE != 0);
        if !enabled {
            return Duty::OFF;
        }
        let inverted = self.get(CCER) >> (4 * channel + 1) & 1 == 1;
        let period = self.period();
        let below = u64::from(self.compare(channel)).min(period);
        let mode = self.get(CCMR1 + 4 * (channel / 2)) >> (8 * (channel % 2) + 4) & 7;
        let high = match mode {
            5 => period,
            6 => below,
            7 => period - below,
            _ => 0,
        };
        let high = if inverted { period - high } else { high };
        #[expect(clippy::cast_possible_truncation, reason = "0 to 1000")]
        let per_mille = ((high * 1000 + period / 2) / period) as u16;
        Duty::new(per_mille)
    }

    fn note_matches(&mut self, until: i64) {
        for channel in 0..4 {
            let compare = i64::from(self.compare(channel));
            if compare > self.seen && compare <= until {
                self.set(SR, self.get(SR) | 2 << channel);
            }
        }
        self.seen = until;
    }

    /// When the counter shows its next value; `None` while it stands.
    pub(crate) fn next_count(&self, now: u64) -> Option<u64> {
        let counts = self.get(CR1) & CEN != 0;
        counts.then(|| self.origin + ((now - self.origin) / self.tick() + 1) * self.tick())
    }

    fn count(&self, now: u64) -> u32 {
        if self.get(CR1) & CEN == 0 {
            #[expect(clippy::cast_possible_truncation, reason = "a count that stands")]
            return self.origin as u32;
        }
        #[expect(clippy::cast_possible_truncation, reason = "below the period")]
        let count = ((now - self.origin) / self.tick() % self.period()) as u32;
        count
    }

    /// Counts on from a value, or stands there.
    fn restart(&mut self, count: u32, now: u64) {
        let running = self.get(CR1) & CEN != 0;
        self.origin = if running { now.saturating_sub(u64::from(count) * self.tick()) } else { count.into() };
        self.seen = count.into();
    }

    fn tick(&self) -> u64 {
        (u64::from(self.prescaler) + 1) * self.divisor
    }

    fn period(&self) -> u64 {
        u64::from(self.get(ARR)) + 1
    }

    fn compare(&self, channel: u32) -> u32 {
        self.get(CCR1 + 4 * channel)
    }

    fn mask(&self) -> u32 {
        if self.kind == Kind::Wide { u32::MAX } else { 0xffff }
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

/// Counts are far below 2^63.
fn i64_from(count: u64) -> i64 {
    i64::try_from(count).unwrap_or(i64::MAX)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Counts microseconds at 83 MHz, from cycle 1000 on.
    fn counting(reload: u32) -> Timer {
        let mut timer = Timer::new(Kind::General);
        timer.set_divisor(2, 0);
        timer.write(PSC, 82, 1000);
        timer.write(ARR, reload, 1000);
        timer.write(EGR, UG, 1000);
        timer.write(SR, 0, 1000);
        timer.write(CR1, CEN, 1000);
        timer
    }

    const MICROSECOND: u64 = 166;

    #[test]
    fn the_count_follows_the_clock_and_wraps() {
        let mut timer = counting(99);
        assert_eq!(timer.read(CNT, 1000 + 41 * MICROSECOND), 41);
        assert_eq!(timer.read(CNT, 1000 + 42 * MICROSECOND - 1), 41);
        assert_eq!(timer.read(CNT, 1000 + 100 * MICROSECOND), 0);
        assert_eq!(timer.read(SR, 1000 + 100 * MICROSECOND) & UIF, UIF);
    }

    #[test]
    fn a_compare_match_is_the_next_event_and_then_an_interrupt() {
        let mut timer = counting(0xffff);
        timer.write(CCR1 + 4, 300, 1000);
        timer.write(DIER, 1 << 2, 1000);
        let event = timer.next_event();
        assert_eq!(event, Some(1000 + 300 * MICROSECOND));
        timer.sync(1000 + 300 * MICROSECOND - 1);
        assert!(!timer.interrupts());
        timer.sync(1000 + 300 * MICROSECOND);
        assert!(timer.interrupts());
        assert_eq!(timer.next_event(), None);
    }

    #[test]
    fn a_match_that_is_behind_comes_in_the_next_period() {
        let mut timer = counting(999);
        timer.write(CCR1, 10, 1000 + 500 * MICROSECOND);
        timer.write(DIER, 1 << 1, 1000 + 500 * MICROSECOND);
        assert_eq!(timer.next_event(), Some(1000 + 1010 * MICROSECOND));
    }

    #[test]
    fn a_prescaler_without_an_update_event_waits_for_the_first_overflow() {
        let mut timer = Timer::new(Kind::General);
        timer.write(PSC, 1, 0);
        timer.write(ARR, 99, 0);
        timer.write(DIER, 1, 0);
        timer.write(CR1, CEN, 0);
        assert_eq!(timer.next_event(), Some(100));
        timer.sync(100);
        timer.write(SR, 0, 100);
        assert_eq!(timer.next_event(), Some(300));
    }

    #[test]
    fn pwm_needs_channel_counter_and_main_output() {
        let mut timer = Timer::new(Kind::Advanced);
        timer.write(ARR, 999, 0);
        timer.write(CCMR1 + 4, 6 << 4, 0);
        timer.write(CCR1 + 8, 250, 0);
        timer.write(CR1, CEN, 0);
        timer.write(CCER, 1 << 8, 0);
        assert_eq!(timer.duty(2), Duty::OFF);
        timer.write(BDTR, MOE, 0);
        assert_eq!(timer.duty(2).per_mille(), 250);
        timer.write(CCR1 + 8, 1000, 0);
        assert_eq!(timer.duty(2), Duty::FULL);
    }
}
