//! What can be measured of a program without touching it: how long interrupts wait for their handlers, and when each round
//! of readings begins.

use std::collections::BTreeMap;

/// How long an interrupt waited for its handler.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Latency {
    /// How often it was handled.
    pub handled: u64,
    /// The longest wait in picoseconds, from the event to the first instruction of the handler.
    pub worst_ps: u64,
}

#[derive(Debug, Default)]
pub(crate) struct Probe {
    /// Since when lines are raised that nobody has handled yet, in cycles.
    raised: BTreeMap<u16, u64>,
    latencies: BTreeMap<u16, Latency>,
}

impl Probe {
    /// A line is up, or down, as of `now`.
    pub(crate) fn line(&mut self, number: u16, up: bool, now: u64) {
        if up {
            self.raised.entry(number).or_insert(now);
        } else {
            self.raised.remove(&number);
        }
    }

    /// The core has entered a handler; `ps` turns cycles to picoseconds.
    pub(crate) fn entered(&mut self, number: u16, now: u64, ps: impl Fn(u64) -> u64) {
        // A handler that didn't clear its line is entered again for the same event: that is no wait.
        let Some(since) = self.raised.get_mut(&number) else { return };
        let wait_ps = ps(now) - ps(*since);
        *since = now;
        let latency = self.latencies.entry(number).or_default();
        latency.handled += 1;
        latency.worst_ps = latency.worst_ps.max(wait_ps);
    }

    pub(crate) fn latencies(&self) -> &BTreeMap<u16, Latency> {
        &self.latencies
    }
}
