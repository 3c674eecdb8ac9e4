//! Holds the measured current against the limit, and against what the steps under way should draw (S7). The sequencer
//! keeps the planned sum below the limit; this guard catches what the plan doesn't know: a heater whose windings touch, a
//! MOSFET that sticks, long before its heat is felt.

use crate::trip::Trip;
use zygote_protocol::{FaultCode, Micros, Milliamps, Millis};

/// Readings in a row that make a fault.
const FILTER: u8 = 3;
/// Per cent above the limit that measurement error may show.
const MARGIN_PER_CENT: u32 = 10;
/// Above what is planned by this share, for heaters colder and wires shorter than the rig file says, ..
const PLAN_MARGIN_PER_CENT: u32 = 25;
/// .. and by this much, for the offset of a shunt amplifier and the current of what is always on.
const PLAN_MARGIN: Milliamps = Milliamps(100);
/// Longer than capacitors take to charge.
const PLAN_FILTER: Millis = Millis(250);

#[derive(Debug, Clone, Copy)]
pub(crate) struct SupplyGuard {
    over: u8,
    /// Since when every reading was above the plan.
    unplanned: Option<Micros>,
}

impl SupplyGuard {
    pub(crate) const fn new() -> Self {
        Self { over: 0, unplanned: None }
    }

    /// # Errors
    /// The third reading in a row above the limit and its margin.
    pub(crate) fn check(&mut self, measured: Milliamps, limit: Milliamps) -> Result<(), Trip> {
        let most = limit.0.saturating_add(limit.0 / 100 * MARGIN_PER_CENT);
        self.over = if measured.0 > most { self.over.saturating_add(1) } else { 0 };
        if self.over < FILTER { Ok(()) } else { Err(Trip::new(FaultCode::OverCurrent, measured.0, limit.0)) }
    }

    /// `planned` is what all that is on should draw at most; `None` while nobody can say.
    ///
    /// # Errors
    /// Readings above that and its margin for [`PLAN_FILTER`].
    pub(crate) fn check_planned(
        &mut self,
        now: Micros,
        measured: Milliamps,
        planned: Option<Milliamps>,
    ) -> Result<(), Trip> {
        let above = planned.filter(|planned| measured > most_of(*planned));
        let Some(planned) = above else {
            self.unplanned = None;
            return Ok(());
        };
        let since = *self.unplanned.get_or_insert(now);
        if now < since.plus(PLAN_FILTER) {
            return Ok(());
        }
        Err(Trip::new(FaultCode::UnplannedCurrent, measured.0, planned.0))
    }
}

fn most_of(planned: Milliamps) -> Milliamps {
    let share = planned.0 / 100 * PLAN_MARGIN_PER_CENT;
    Milliamps(planned.0.saturating_add(share).saturating_add(PLAN_MARGIN.0))
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

    #[test]
    fn s7_current_that_nobody_planned_trips_after_a_quarter_of_a_second() {
        let planned = Some(Milliamps(400));
        let after = |millis: u64, guard: &mut SupplyGuard, measured, planned| {
            guard.check_planned(Micros(millis * 1_000), Milliamps(measured), planned)
        };
        let mut guard = SupplyGuard::new();
        for (at, measured, planned) in [
            (0, 601, planned),
            (249, 601, planned),
            // What is allowed starts the time anew, and so does a time in which nobody can say.
            (260, 600, planned),
            (300, 601, planned),
            (500, 601, None),
            (501, 601, planned),
            (750, 601, planned),
        ] {
            assert_eq!(after(at, &mut guard, measured, planned), Ok(()), "at {at} ms");
        }
        let trip = after(751, &mut guard, 601, planned).unwrap_err();
        assert_eq!(trip, Trip::new(FaultCode::UnplannedCurrent, 601, 400));
        let mut guard = SupplyGuard::new();
        for (measured, trips) in [(100, false), (101, true)] {
            assert_eq!(after(0, &mut guard, measured, Some(Milliamps(0))), Ok(()));
            assert_eq!(after(1_000, &mut guard, measured, Some(Milliamps(0))).is_err(), trips);
        }
    }
}
