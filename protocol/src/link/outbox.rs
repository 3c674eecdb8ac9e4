//! The sending half of the reliable stream: a window of packets, each kept until acknowledged.

use super::round_trip::RoundTrip;
use super::{Payload, SendError, WINDOW};
use crate::Micros;
use core::hash::{Hash, Hasher};
use heapless::Deque;

#[derive(Debug, Clone, Hash)]
struct Packet {
    payload: Payload,
    /// When it went out last.
    sent: Option<Micros>,
    /// It went out more than once, so its acknowledgement measures nothing (Karn).
    repeated: bool,
}

#[derive(Debug, Clone)]
pub(super) struct Outbox {
    window: Deque<Packet, WINDOW>,
    /// How many packets the other end takes at once, 1 to [`WINDOW`].
    most: usize,
    /// Number of the oldest packet.
    oldest: u8,
    /// How many packets, from the oldest on, are out; the rest waits its turn.
    out: usize,
    /// The oldest packet has been gone back to on request, and so many further requests mean the same loss: one for each
    /// packet that was out behind it, which the other end can't take.
    gone_back: Option<usize>,
    /// When the other end last said something that tells of the packets out: it is no time yet to think them lost.
    heard: Micros,
    repeats: u32,
    delivered: u32,
}

impl Outbox {
    pub(super) const fn new() -> Self {
        Self {
            window: Deque::new(),
            most: WINDOW,
            oldest: 0,
            out: 0,
            gone_back: None,
            heard: Micros(0),
            repeats: 0,
            delivered: 0,
        }
    }

    pub(super) fn clear(&mut self) {
        let (repeats, delivered) = self.totals();
        *self = Self { repeats, delivered, ..Self::new() };
    }

    pub(super) fn room(&self) -> usize {
        self.most.saturating_sub(self.window.len())
    }

    /// From now on at most so many packets are under way; one at least, and never more than [`WINDOW`].
    pub(super) fn narrow(&mut self, most: usize) {
        self.most = most.clamp(1, WINDOW);
    }

    pub(super) fn is_empty(&self) -> bool {
        self.window.is_empty()
    }

    /// Packets sent again, and bytes of payload acknowledged, so far.
    pub(super) fn totals(&self) -> (u32, u32) {
        (self.repeats, self.delivered)
    }

    /// Takes a packet.
    pub(super) fn push(&mut self, payload: Payload) -> Result<(), SendError> {
        if self.room() == 0 {
            return Err(SendError::Full);
        }
        let packet = Packet { payload, sent: None, repeated: false };
        self.window.push_back(packet).map_err(|_| SendError::Full)
    }

    /// Drops what the other end has: everything before `ack`. An `ack` outside the window says nothing.
    pub(super) fn acknowledged(&mut self, ack: u8, now: Micros, round_trip: &mut RoundTrip) {
        let count = usize::from(ack.wrapping_sub(self.oldest));
        if count == 0 || count > self.window.len() {
            return;
        }

        for _ in 0..count {
            let Some(packet) = self.window.pop_front() else { break };
            let length = u32::try_from(packet.payload.len()).unwrap_or(u32::MAX);
            self.delivered = self.delivered.wrapping_add(length);
            if let (Some(sent), false) = (packet.sent, packet.repeated) {
                round_trip.measured(now.since(sent));
            }
        }
        self.oldest = ack;
        self.out = self.out.saturating_sub(count);
        self.gone_back = None;
        self.heard = now;
    }

    /// The other end misses what follows its last acknowledgement.
    pub(super) fn go_back_on_request(&mut self, now: Micros) {
        self.heard = now;
        match &mut self.gone_back {
            Some(same) if *same > 0 => *same -= 1,
            // The first request, or one more than the packets behind explain: the repetition is lost as well.
            None | Some(_) => {
                self.gone_back = Some(self.out.saturating_sub(1));
                self.out = 0;
            }
        }
    }

    /// Goes back to the oldest packet when its time is over.
    pub(super) fn check_timeout(&mut self, now: Micros, round_trip: &mut RoundTrip) {
        if self.deadline(round_trip).is_some_and(|deadline| now >= deadline) {
            round_trip.timed_out();
            self.out = 0;
            self.gone_back = None;
        }
    }

    /// When the oldest packet is to be sent again; `None` while none is out.
    fn deadline(&self, round_trip: &RoundTrip) -> Option<Micros> {
        let oldest = self.window.front().filter(|_| self.out > 0)?;
        // From the last sign of life on (RFC 6298, 5.3): a full window takes longer than one packet.
        oldest.sent.map(|sent| round_trip.deadline(sent.max(self.heard)))
    }

    /// When something is to be sent: at once, at a deadline, or not at all.
    pub(super) fn next_time(&self, now: Micros, round_trip: &RoundTrip) -> Option<Micros> {
        if self.out < self.window.len() { Some(now) } else { self.deadline(round_trip) }
    }

    /// The next packet to put on the wire, with its number; it counts as sent.
    pub(super) fn next(&mut self, now: Micros) -> Option<(u8, &[u8])> {
        let packet = self.window.iter_mut().nth(self.out)?;
        let offset = u8::try_from(self.out).ok()?;
        self.out += 1;
        packet.repeated = packet.sent.is_some();
        if packet.repeated {
            self.repeats = self.repeats.wrapping_add(1);
        }
        packet.sent = Some(now);
        Some((self.oldest.wrapping_add(offset), &packet.payload))
    }
}

/// What an outbox will do next doesn't depend on its totals.
impl Hash for Outbox {
    fn hash<H: Hasher>(&self, state: &mut H) {
        self.window.iter().for_each(|packet| packet.hash(state));
        (self.window.len(), self.most, self.oldest, self.out, self.gone_back, self.heard).hash(state);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Before a round trip was measured, a packet goes out again after this time.
    const TIMEOUT_US: u64 = 300_000;

    /// An outbox with so many packets, all of which went out at 0.
    fn out(packets: u8) -> Outbox {
        let mut outbox = Outbox::new();
        for byte in 0..packets {
            outbox.push(Payload::from_slice(&[byte; 2]).unwrap()).unwrap();
        }
        assert_eq!(say(&mut outbox, 0), packets);
        outbox
    }

    /// How many packets go out at a time. They go out in order, each under its number.
    fn say(outbox: &mut Outbox, now: u64) -> u8 {
        let mut said = 0;
        while let Some((seq, payload)) = outbox.next(Micros(now)) {
            assert_eq!(payload, [seq; 2]);
            said += 1;
        }
        said
    }

    #[test]
    fn an_ack_that_tells_nothing_changes_nothing() {
        let (mut outbox, mut round_trip) = (out(3), RoundTrip::new());
        outbox.go_back_on_request(Micros(10));
        assert_eq!(say(&mut outbox, 10), 3);
        for ack in [0, 4, 5, u8::MAX] {
            outbox.acknowledged(ack, Micros(20), &mut round_trip);
            assert_eq!((outbox.room(), outbox.totals()), (WINDOW - 3, (3, 0)), "ack {ack}");
            assert_eq!(outbox.deadline(&round_trip), Some(Micros(10 + TIMEOUT_US)), "ack {ack}");
        }
        outbox.go_back_on_request(Micros(20));
        assert_eq!(say(&mut outbox, 20), 0, "the request still means the same loss");
        outbox.acknowledged(3, Micros(30), &mut round_trip);
        assert_eq!((outbox.is_empty(), outbox.totals()), (true, (3, 6)));
    }

    #[test]
    fn an_ack_of_some_gives_the_rest_another_timeout() {
        let (mut outbox, mut round_trip) = (out(3), RoundTrip::new());
        outbox.acknowledged(2, Micros(80_000), &mut round_trip);
        assert_eq!((outbox.room(), say(&mut outbox, 80_000)), (WINDOW - 1, 0));
        // Twice 80 ms: a deviation of 40, then of 30.
        assert_eq!(outbox.deadline(&round_trip), Some(Micros(80_000 + 80_000 + 4 * 30_000)));
    }

    #[test]
    fn the_ack_of_a_repetition_measures_no_round_trip() {
        let (mut outbox, mut round_trip) = (out(1), RoundTrip::new());
        outbox.go_back_on_request(Micros(10));
        assert_eq!(say(&mut outbox, 10), 1);
        outbox.acknowledged(1, Micros(20), &mut round_trip);
        assert_eq!(round_trip.deadline(Micros(0)), Micros(TIMEOUT_US));
    }

    #[test]
    fn one_loss_is_repeated_once_and_again_when_more_requests_come_than_it_explains() {
        let mut outbox = out(3);
        // Of three packets the first was lost: the other two, and then the noise that damaged the repetition, ask for it.
        for (request, repeated) in [(1, 3), (2, 0), (3, 0), (4, 3), (5, 0)] {
            outbox.go_back_on_request(Micros(request));
            assert_eq!(say(&mut outbox, request), repeated, "request {request}");
        }
        assert_eq!(outbox.totals(), (6, 0));
    }

    #[test]
    fn at_its_deadline_everything_goes_out_again_and_not_before() {
        let (mut outbox, mut round_trip) = (out(3), RoundTrip::new());
        assert_eq!(outbox.next_time(Micros(5), &round_trip), Some(Micros(TIMEOUT_US)));
        outbox.check_timeout(Micros(TIMEOUT_US - 1), &mut round_trip);
        assert_eq!(say(&mut outbox, TIMEOUT_US - 1), 0);
        outbox.check_timeout(Micros(TIMEOUT_US), &mut round_trip);
        assert_eq!(outbox.next_time(Micros(TIMEOUT_US), &round_trip), Some(Micros(TIMEOUT_US)), "at once");
        assert_eq!(say(&mut outbox, TIMEOUT_US), 3);
        assert_eq!(
            outbox.next_time(Micros(TIMEOUT_US), &round_trip),
            Some(Micros(3 * TIMEOUT_US)),
            "twice as long"
        );
    }

    #[test]
    fn what_waits_to_be_repeated_cannot_time_out() {
        let (mut outbox, mut round_trip) = (out(1), RoundTrip::new());
        outbox.go_back_on_request(Micros(10));
        outbox.check_timeout(Micros(9 * TIMEOUT_US), &mut round_trip);
        assert_eq!(say(&mut outbox, 9 * TIMEOUT_US), 1);
        assert_eq!(outbox.deadline(&round_trip), Some(Micros(10 * TIMEOUT_US)), "its timeout hasn't doubled");
    }

    #[test]
    fn an_empty_one_has_nothing_to_send() {
        let (mut outbox, round_trip) = (out(0), RoundTrip::new());
        assert_eq!((outbox.next_time(Micros(5), &round_trip), say(&mut outbox, 5)), (None, 0));
    }
}
