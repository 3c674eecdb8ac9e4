//! Urgent messages: few, numbered apart, repeated until acknowledged.

use super::round_trip::RoundTrip;
use super::{Payload, SendError};
use crate::Micros;
use core::hash::{Hash, Hasher};
use heapless::Deque;

/// Urgent messages that may wait for their acknowledgement.
const ROOM: usize = 4;

#[derive(Debug, Clone, Hash)]
struct Packet {
    seq: u8,
    payload: Payload,
    sent: Option<Micros>,
}

#[derive(Debug, Clone)]
pub(super) struct UrgentBox {
    waiting: Deque<Packet, ROOM>,
    next_seq: u8,
}

impl UrgentBox {
    pub(super) const fn new() -> Self {
        Self { waiting: Deque::new(), next_seq: 0 }
    }

    /// Drops what waits; numbers go on, so that a late acknowledgement hits nothing new.
    pub(super) fn clear(&mut self) {
        self.waiting.clear();
    }

    pub(super) fn is_empty(&self) -> bool {
        self.waiting.is_empty()
    }

    /// Takes a message.
    pub(super) fn push(&mut self, payload: Payload) -> Result<(), SendError> {
        let packet = Packet { seq: self.next_seq, payload, sent: None };
        self.waiting.push_back(packet).map_err(|_| SendError::Full)?;
        self.next_seq = self.next_seq.wrapping_add(1);
        Ok(())
    }

    /// One message at a time: the oldest.
    pub(super) fn acknowledged(&mut self, seq: u8) {
        if self.waiting.front().is_some_and(|packet| packet.seq == seq) {
            self.waiting.pop_front();
        }
    }

    /// When the oldest message is to be sent (again).
    pub(super) fn next_time(&self, now: Micros, round_trip: &RoundTrip) -> Option<Micros> {
        self.waiting.front().map(|packet| packet.sent.map_or(now, |sent| round_trip.deadline(sent)))
    }

    /// The oldest message with its number, when it is due; it counts as sent.
    pub(super) fn next(&mut self, now: Micros, round_trip: &RoundTrip) -> Option<(u8, &[u8])> {
        self.next_time(now, round_trip).filter(|due| now >= *due)?;
        let packet = self.waiting.front_mut()?;
        packet.sent = Some(now);
        Some((packet.seq, &packet.payload))
    }
}

impl Hash for UrgentBox {
    fn hash<H: Hasher>(&self, state: &mut H) {
        self.waiting.iter().for_each(|packet| packet.hash(state));
        (self.waiting.len(), self.next_seq).hash(state);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Before a round trip was measured, a message goes out again after this time.
    const TIMEOUT_US: u64 = 300_000;

    fn full() -> UrgentBox {
        let mut urgent = UrgentBox::new();
        for byte in 0..4 {
            urgent.push(Payload::from_slice(&[byte]).unwrap()).unwrap();
        }
        assert_eq!(urgent.push(Payload::new()), Err(SendError::Full));
        urgent
    }

    #[test]
    fn the_oldest_goes_out_until_it_is_acknowledged() {
        let (mut urgent, round_trip) = (full(), RoundTrip::new());
        let payload: &[u8] = &[0];
        assert_eq!(urgent.next_time(Micros(5), &round_trip), Some(Micros(5)));
        assert_eq!(urgent.next(Micros(5), &round_trip), Some((0, payload)));
        assert_eq!(urgent.next_time(Micros(6), &round_trip), Some(Micros(5 + TIMEOUT_US)));
        assert_eq!(urgent.next(Micros(4 + TIMEOUT_US), &round_trip), None);
        assert_eq!(urgent.next(Micros(5 + TIMEOUT_US), &round_trip), Some((0, payload)));
        urgent.acknowledged(1);
        assert_eq!(
            urgent.next(Micros(9 * TIMEOUT_US), &round_trip),
            Some((0, payload)),
            "not the one acknowledged"
        );
    }

    #[test]
    fn acknowledged_ones_make_way_for_the_next() {
        let (mut urgent, round_trip) = (full(), RoundTrip::new());
        for byte in 0..4 {
            assert!(!urgent.is_empty());
            assert_eq!(urgent.next(Micros(0), &round_trip), Some((byte, [byte].as_slice())));
            urgent.acknowledged(byte);
        }
        assert!(urgent.is_empty());
        assert_eq!(
            (urgent.next_time(Micros(0), &round_trip), urgent.next(Micros(0), &round_trip)),
            (None, None)
        );
    }

    #[test]
    fn numbers_go_on_after_a_clear_and_go_round() {
        let (mut urgent, round_trip) = (full(), RoundTrip::new());
        urgent.clear();
        assert!(urgent.is_empty());
        for seq in (4..=u8::MAX).chain(0..4) {
            urgent.push(Payload::new()).unwrap();
            assert_eq!(urgent.next(Micros(0), &round_trip), Some((seq, [].as_slice())));
            urgent.acknowledged(seq);
        }
    }
}
