//! Holds the measured current against the limit (S7). The sequencer keeps the planned sum below it; this guard
//! catches what the plan doesn't know.

use crate::trip::Trip;
use zygote_protocol::{FaultCode, Milliamps};

/// Readings in a row that make a fault.
const FILTER: u8 = 3;
/// Per cent above the limit that measurement error may show.
const MARGIN_PER_CENT: u32 = 10;

#[derive(Debug, Clone, Copy)]
pub(crate) struct SupplyGuard {
    over: u8,
}

impl SupplyGuard {
    pub(crate) const fn new() -> Self {
        Self { over: 0 }
    }

    /// # Errors
    /// The third reading in a row above the limit and its margin.
    pub(crate) fn check(&mut self, measured: Milliamps, limit: Milliamps) -> Result<(), Trip> {
        let most = limit.0.saturating_add(limit.0 / 100 * MARGIN_PER_CENT);
        self.over = if measured.0 > most { self.over.saturating_add(1) } else { 0 };
        if self.over < FILTER { Ok(()) } else { Err(Trip::new(FaultCode::OverCurrent, measured.0, limit.0)) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn s7_current_over_the_limit_trips_at_the_third_reading() {
        let (mut guard, limit) = (SupplyGuard::new(), Milliamps(1_000));
        for measured in [1_101, 1_101, 1_100, 1_101, 1_101] {
            assert_eq!(guard.check(Milliamps(measured), limit), Ok(()), "{measured}");
        }
        let trip = guard.check(Milliamps(1_200), limit).unwrap_err();
        assert_eq!(trip, Trip::new(FaultCode::OverCurrent, 1_200, 1_000));
    }
}
