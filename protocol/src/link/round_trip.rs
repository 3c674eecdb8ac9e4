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
