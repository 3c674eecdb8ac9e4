//! Virtual time: cycles of the core's clock, and what they are in seconds. Everything in the chip but the watchdog runs
//! on whole divisions of that clock, so cycles are exact.

/// Picoseconds of a second.
const SECOND_PS: u128 = 1_000_000_000_000;

/// The core's clock, which changes its rate while the program starts.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Clock {
    hz: u32,
    /// The latest change of rate, in cycles and in picoseconds.
    since: (u64, u64),
}

impl Clock {
    pub(crate) const fn new(hz: u32) -> Self {
        Self { hz, since: (0, 0) }
    }

    /// Another rate from `cycles` on.
    pub(crate) fn set_rate(&mut self, cycles: u64, hz: u32) {
        if hz != self.hz {
            *self = Self { hz, since: (cycles, self.ps(cycles)) };
        }
    }

    /// Picoseconds since power-on.
    #[expect(clippy::cast_possible_truncation, reason = "2^64 ps are seven months")]
    pub(crate) fn ps(&self, cycles: u64) -> u64 {
        let (from, ps) = self.since;
        ps + (u128::from(cycles.saturating_sub(from)) * SECOND_PS / u128::from(self.hz)) as u64
    }

    /// The first cycle that is not before a time.
    #[expect(clippy::cast_possible_truncation, reason = "fewer cycles than picoseconds")]
    pub(crate) fn cycles(&self, ps: u64) -> u64 {
        let (from, since) = self.since;
        from + (u128::from(ps.saturating_sub(since)) * u128::from(self.hz)).div_ceil(SECOND_PS) as u64
    }
}
