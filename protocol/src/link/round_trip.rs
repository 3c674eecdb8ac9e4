//! Smoothed round-trip time and the timeout that follows from it (RFC 6298), in microseconds.

use crate::Micros;

/// Timeout before anything was measured: a full window at 115,200 baud and its acknowledgement.
const INITIAL_US: u64 = 300_000;
const SHORTEST_US: u64 = 30_000;
const LONGEST_US: u64 = 1_000_000;

#[derive(Debug, Clone, Hash)]
pub(super) struct RoundTrip {
    /// Smoothed time and its mean deviation.
    smoothed: Option<(u64, u64)>,
    backoff: u32,
}

impl RoundTrip {
    pub(super) const fn new() -> Self {
        Self { smoothed: None, backoff: 0 }
    }

    /// A packet that was sent once was acknowledged after this time.
    pub(super) fn measured(&mut self, sample: u64) {
        self.backoff = 0;
        self.smoothed = Some(match self.smoothed {
            None => (sample, sample / 2),
            Some((mean, deviation)) => ((7 * mean + sample) / 8, (3 * deviation + mean.abs_diff(sample)) / 4),
        });
    }

    /// A packet timed out: wait twice as long for the next, until one that went out once is acknowledged. Nothing less
    /// ends it: on a line slower than the timeout, everything would go out twice forever.
    pub(super) fn timed_out(&mut self) {
        self.backoff = (self.backoff + 1).min(6);
    }

    fn timeout_us(&self) -> u64 {
        let base = self.smoothed.map_or(INITIAL_US, |(mean, deviation)| mean + 4 * deviation);
        (base.clamp(SHORTEST_US, LONGEST_US) << self.backoff).min(LONGEST_US)
    }

    /// When a packet that went out at `sent` is to be sent again.
    pub(super) fn deadline(&self, sent: Micros) -> Micros {
        Micros(sent.0.saturating_add(self.timeout_us()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_timeout_is_the_smoothed_time_and_four_times_its_deviation() {
        let mut round_trip = RoundTrip::new();
        assert_eq!(round_trip.deadline(Micros(7)), Micros(INITIAL_US + 7), "nothing was measured");
        // By hand, from RFC 6298, 2.2 and 2.3, with gains of 1/8 and 1/4.
        for (sample, timeout) in
            [(80_000, 80_000 + 4 * 40_000), (160_000, 90_000 + 4 * 50_000), (10_000, 80_000 + 4 * 57_500)]
        {
            round_trip.measured(sample);
            assert_eq!(round_trip.deadline(Micros(0)), Micros(timeout), "after {sample} us");
        }
    }

    #[test]
    fn the_timeout_keeps_its_bounds() {
        let mut round_trip = RoundTrip::new();
        round_trip.measured(10);
        assert_eq!(round_trip.deadline(Micros(0)), Micros(SHORTEST_US));
        round_trip.measured(9_000_000);
        assert_eq!(round_trip.deadline(Micros(0)), Micros(LONGEST_US));
    }

    #[test]
    fn every_timeout_doubles_the_next_up_to_the_longest_until_something_is_measured() {
        let mut round_trip = RoundTrip::new();
        round_trip.measured(10_000);
        for timeout in [60_000, 120_000, 240_000, 480_000, 960_000, 1_000_000, 1_000_000] {
            round_trip.timed_out();
            assert_eq!(round_trip.deadline(Micros(0)), Micros(timeout));
        }
        round_trip.measured(10_000);
        assert_eq!(round_trip.deadline(Micros(0)), Micros(SHORTEST_US));
    }
}
