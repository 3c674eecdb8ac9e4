//! The independent watchdog: it has an oscillator of its own, so its time is no multiple of the core's cycles.

const KR: u32 = 0x00;
const PR: u32 = 0x04;
const RLR: u32 = 0x08;

const RELOAD: u32 = 0xaaaa;
const UNLOCK: u32 = 0x5555;
const START: u32 = 0xcccc;

/// Its oscillator is anywhere between 17 and 47 kHz, by the data sheet.
const SLOWEST_HZ: u32 = 17_000;
const SECOND_PS: u64 = 1_000_000_000_000;

#[derive(Debug, Clone)]
pub(crate) struct Watchdog {
    oscillator_hz: u32,
    prescaler: u32,
    reload: u32,
    unlocked: bool,
    /// When it resets the chip, in picoseconds; nothing before it is started, and then nothing stops it.
    due: Option<u64>,
}

impl Watchdog {
    /// With the slowest oscillator that a chip may have: what is shown with it holds for every other.
    pub(crate) fn new() -> Self {
        Self { oscillator_hz: SLOWEST_HZ, prescaler: 0, reload: 0xfff, unlocked: false, due: None }
    }

    pub(crate) fn due(&self) -> Option<u64> {
        self.due
    }

    pub(crate) fn read(&self, offset: u32) -> u32 {
        match offset {
            PR => self.prescaler,
            RLR => self.reload,
            // The status register: no update is under way.
            _ => 0,
        }
    }

    pub(crate) fn write(&mut self, offset: u32, value: u32, now_ps: u64) {
        match (offset, value) {
            (KR, START) => {
                self.unlocked = false;
                self.due = Some(now_ps + self.span());
            }
            (KR, RELOAD) => {
                self.unlocked = false;
                self.due = self.due.map(|_| now_ps + self.span());
            }
            (KR, _) => self.unlocked = value == UNLOCK,
            (PR, _) if self.unlocked => self.prescaler = value & 7,
            (RLR, _) if self.unlocked => self.reload = value & 0xfff,
            _ => {}
        }
    }

    fn span(&self) -> u64 {
        let ticks = (u64::from(self.reload) + 1) * (4 << self.prescaler.min(6));
        ticks * SECOND_PS / u64::from(self.oscillator_hz)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_is_due_when_nobody_reloads_it_and_not_before_it_was_started() {
        let mut watchdog = Watchdog::new();
        watchdog.write(KR, UNLOCK, 0);
        watchdog.write(RLR, 1999, 0);
        watchdog.write(KR, RELOAD, 0);
        assert_eq!(watchdog.due(), None);
        watchdog.write(KR, START, 5);
        assert_eq!(watchdog.due(), Some(5 + 8000 * SECOND_PS / 17_000));
        watchdog.write(RLR, 1, 0);
        watchdog.write(KR, RELOAD, 1000);
        assert_eq!(watchdog.due(), Some(1000 + 8000 * SECOND_PS / 17_000), "the registers are locked again");
    }
}
