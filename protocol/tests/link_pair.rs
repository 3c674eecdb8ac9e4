//! Two ends over a line that drops, flips, repeats and delays: whatever the line does, reliable messages arrive
//! once and in order, and urgent ones arrive.
#![allow(clippy::unwrap_used, clippy::expect_used, reason = "a test that cannot go on fails")]

use proptest::prelude::*;
use std::collections::VecDeque;
use zygote_protocol::{Link, MAX_ENCODED, Micros, Received, decode_payload};

/// How often the line does what, per mille and frame.
#[derive(Debug, Clone, Copy)]
struct Weather {
    drop: u32,
    flip: u32,
    repeat: u32,
    delay_us: u64,
}

/// One direction of a line. Chunks keep their order, as on any serial line.
struct Line {
    chunks: VecDeque<(u64, Vec<u8>)>,
    weather: Weather,
    random: u64,
}

impl Line {
    fn new(weather: Weather, seed: u64) -> Self {
        Self { chunks: VecDeque::new(), weather, random: seed | 1 }
    }

    /// xorshift64: enough for weather, and the same on every machine.
    fn chance(&mut self, per_mille: u32) -> bool {
        self.random ^= self.random << 13;
        self.random ^= self.random >> 7;
        self.random ^= self.random << 17;
        self.random % 1000 < u64::from(per_mille)
    }

    fn put(&mut self, now: u64, mut bytes: Vec<u8>) {
        if self.chance(self.weather.drop) {
            return;
        }
        if self.chance(self.weather.flip) {
            let at = usize::try_from(self.random >> 20).unwrap() % bytes.len();
            bytes[at] ^= 1 << (self.random >> 50 & 7);
        }
        let copies = if self.chance(self.weather.repeat) { 2 } else { 1 };
        for _ in 0..copies {
            self.chunks.push_back((now + self.weather.delay_us, bytes.clone()));
        }
    }

    fn get(&mut self, now: u64) -> Option<Vec<u8>> {
        self.chunks.front().filter(|(due, _)| *due <= now)?;
        self.chunks.pop_front().map(|(_, bytes)| bytes)
    }
}

struct End {
    link: Link,
    to_send: VecDeque<u32>,
    got: Vec<u32>,
    urgent: Vec<u32>,
}

impl End {
    fn new(count: u32) -> Self {
        let mut link = Link::new(Micros(0));
        link.open(7, Micros(0));
        Self { link, to_send: (0..count).collect(), got: Vec::new(), urgent: Vec::new() }
    }

    fn turn(&mut self, now: u64, input: &mut Line, output: &mut Line) {
        while let Some(chunk) = input.get(now) {
            let mut bytes = chunk.as_slice();
            while let Some(received) = self.link.receive(Micros(now), &mut bytes, true) {
                match received {
                    Received::Message(payload) => self.got.push(decode_payload(payload).unwrap()),
                    Received::Urgent(payload) => self.urgent.push(decode_payload(payload).unwrap()),
                    other => panic!("unasked for: {other:?}"),
                }
            }
        }
        while let Some(&next) = self.to_send.front() {
            if self.link.send(&next).is_err() {
                break;
            }
            self.to_send.pop_front();
        }
        let mut buffer = [0; MAX_ENCODED];
        let mut budget = 2 * MAX_ENCODED;
        loop {
            let length = self.link.poll_transmit(Micros(now), &mut buffer);
            if length == 0 || budget < length {
                break;
            }
            budget -= length;
            output.put(now, buffer[..length].to_vec());
        }
    }
}

/// Runs both ends until everything arrived or ten simulated minutes are over.
fn converse(weather: Weather, seed: u64, count: u32) -> (End, End, u64) {
    let (mut there, mut back) = (Line::new(weather, seed), Line::new(weather, seed.rotate_left(32) ^ 0xabcd));
    let (mut a, mut b) = (End::new(count), End::new(count));
    a.link.send_urgent(&99_u32).unwrap();
    let mut now = 0;
    while now < 600_000_000 {
        a.turn(now, &mut back, &mut there);
        b.turn(now, &mut there, &mut back);
        let all = |end: &End| end.to_send.is_empty() && end.link.is_settled();
        if all(&a) && all(&b) {
            break;
        }
        now += 1_000;
    }
    (a, b, now)
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 64, ..ProptestConfig::default() })]

    #[test]
    fn reliable_messages_arrive_once_and_in_order_whatever_the_line_does(
        drop in 0u32..300, flip in 0u32..300, repeat in 0u32..300, delay_us in 0u64..60_000, seed: u64,
    ) {
        let count = 60;
        let (a, b, now) = converse(Weather { drop, flip, repeat, delay_us }, seed, count);
        let sent: Vec<u32> = (0..count).collect();
        prop_assert_eq!(&a.got, &sent, "after {} us", now);
        prop_assert_eq!(&b.got, &sent, "after {} us", now);
        prop_assert!(b.urgent.contains(&99), "the urgent message is missing after {} us", now);
    }
}

#[test]
fn a_clean_line_repeats_nothing() {
    let (a, b, _) = converse(Weather { drop: 0, flip: 0, repeat: 0, delay_us: 5_000 }, 1, 200);
    assert_eq!(a.link.counters().repeated + b.link.counters().repeated, 0);
    assert_eq!(a.link.counters().bad + b.link.counters().bad, 0);
}

#[test]
fn a_dead_line_delivers_nothing_and_the_window_stays_bounded() {
    let (a, b, _) = converse(Weather { drop: 1000, flip: 0, repeat: 0, delay_us: 0 }, 1, 200);
    assert!(a.got.is_empty() && b.got.is_empty());
    assert_eq!(a.link.room(), 0);
}

#[test]
fn an_urgent_message_overtakes_a_full_window() {
    let mut link = Link::new(Micros(0));
    link.open(1, Micros(0));
    while link.send(&1_u32).is_ok() {}
    link.send_urgent(&2_u32).unwrap();
    let mut buffer = [0; MAX_ENCODED];
    let length = link.poll_transmit(Micros(0), &mut buffer);
    let mut other = Link::new(Micros(0));
    other.open(1, Micros(0));
    let mut bytes = &buffer[..length];
    assert_eq!(other.receive(Micros(0), &mut bytes, true), Some(Received::Urgent(&[2])));
}

#[test]
fn a_message_that_is_turned_away_comes_again() {
    let (mut a, mut b) = (Link::new(Micros(0)), Link::new(Micros(0)));
    a.open(1, Micros(0));
    b.open(1, Micros(0));
    a.send(&5_u32).unwrap();
    let mut buffer = [0; MAX_ENCODED];
    let length = a.poll_transmit(Micros(0), &mut buffer);
    assert_eq!(b.receive(Micros(0), &mut &buffer[..length], false), None);
    let later = a.poll_timeout(Micros(0)).unwrap();
    let length = a.poll_transmit(Micros(later.0 + 1_000_000), &mut buffer);
    assert_eq!(b.receive(later, &mut &buffer[..length], true), Some(Received::Message(&[5])));
}

#[test]
fn frames_of_another_session_change_nothing_and_are_answered_with_reset() {
    let (mut a, mut b) = (Link::new(Micros(0)), Link::new(Micros(0)));
    a.open(1, Micros(0));
    b.open(2, Micros(0));
    a.send(&5_u32).unwrap();
    let mut buffer = [0; MAX_ENCODED];
    let length = a.poll_transmit(Micros(0), &mut buffer);
    assert_eq!(b.receive(Micros(0), &mut &buffer[..length], true), None);
    let length = b.poll_transmit(Micros(0), &mut buffer);
    assert_eq!(a.receive(Micros(0), &mut &buffer[..length], true), Some(Received::Reset));
}

#[test]
fn a_stop_without_a_session_is_heard_in_any_session() {
    let (mut a, mut b) = (Link::new(Micros(0)), Link::new(Micros(0)));
    b.open(2, Micros(0));
    a.send_urgent(&1_u32).unwrap();
    let mut buffer = [0; MAX_ENCODED];
    let length = a.poll_transmit(Micros(0), &mut buffer);
    assert_eq!(b.receive(Micros(0), &mut &buffer[..length], true), Some(Received::Urgent(&[1])));
    let length = b.poll_transmit(Micros(0), &mut buffer);
    assert_eq!(a.receive(Micros(0), &mut &buffer[..length], true), None);
    assert!(a.is_settled(), "the acknowledgement reached a sender without a session");
}
