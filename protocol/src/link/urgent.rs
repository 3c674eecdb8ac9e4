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
