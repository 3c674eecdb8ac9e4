//! Two ends over a line that drops, flips, repeats, delays, reorders, tears and joins what is sent, while sessions
//! replace each other: nothing is lost, doubled or reordered within a session, a stop overtakes everything, telemetry
//! delays nothing, and every call does bounded work. Time is virtual; proptest prints the seed of what fails.
#![allow(clippy::unwrap_used, clippy::expect_used, reason = "a test that cannot go on fails")]

use proptest::prelude::*;
use std::collections::{BTreeMap, VecDeque};
use zygote_protocol::{
    Decoder, FrameKind, Link, MAX_ENCODED, Micros, NO_SESSION, Received, SendError, WINDOW, decode_payload,
};

/// Frames that a link ever has to say at one moment: the window, and one each of urgent ack, urgent, reset,
/// handshake, nack or ack, telemetry, keep-alive.
const MOST_AT_ONCE: usize = WINDOW + 7;
/// Virtual time after which a line that isn't dead must have carried everything.
const PATIENCE_US: u64 = 600_000_000;
const HELLO_EVERY_US: u64 = 200_000;

/// What the line does, per mille and chunk, and how slow it is.
#[derive(Debug, Clone, Copy)]
struct Weather {
    drop: u32,
    flip: u32,
    repeat: u32,
    tear: u32,
    join: u32,
    delay_us: u64,
    /// Chunks arrive up to so much later than others, in whatever order comes of it.
    jitter_us: u64,
}

const FINE: Weather =
    Weather { drop: 0, flip: 0, repeat: 0, tear: 0, join: 0, delay_us: 2_000, jitter_us: 0 };

fn weather() -> impl Strategy<Value = Weather> {
    let odds = (0u32..250, 0u32..250, 0u32..300, 0u32..200, 0u32..500);
    (odds, 0u64..60_000, 0u64..20_000).prop_map(|((drop, flip, repeat, tear, join), delay_us, jitter_us)| {
        Weather { drop, flip, repeat, tear, join, delay_us, jitter_us }
    })
}

/// xorshift64: the same on every machine.
struct Chance(u64);

impl Chance {
    fn next(&mut self) -> u64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        self.0
    }

    fn is(&mut self, per_mille: u32) -> bool {
        self.next() % 1000 < u64::from(per_mille)
    }

    fn below(&mut self, bound: usize) -> usize {
        usize::try_from(self.next() >> 8).unwrap() % bound.max(1)
    }
}

/// One direction of a line.
struct Line {
    /// By time of arrival, then by order of sending.
    under_way: BTreeMap<(u64, u64), Vec<u8>>,
    held: Vec<u8>,
    sent: u64,
    weather: Weather,
    chance: Chance,
}

impl Line {
    fn new(weather: Weather, seed: u64) -> Self {
        Self { under_way: BTreeMap::new(), held: Vec::new(), sent: 0, weather, chance: Chance(seed | 1) }
    }

    fn put(&mut self, now: u64, bytes: &[u8]) {
        self.held.extend_from_slice(bytes);
        if self.chance.is(self.weather.join) {
            return;
        }
        self.flush(now);
    }

    fn flush(&mut self, now: u64) {
        let mut chunk = std::mem::take(&mut self.held);
        if chunk.is_empty() || self.chance.is(self.weather.drop) {
            return;
        }
        if self.chance.is(self.weather.flip) {
            let at = self.chance.below(chunk.len());
            chunk[at] ^= 1 << self.chance.below(8);
        }
        if self.chance.is(self.weather.repeat) {
            self.launch(now, chunk.clone());
        }
        if self.chance.is(self.weather.tear) {
            let rest = chunk.split_off(self.chance.below(chunk.len()));
            self.launch(now, rest);
        }
        self.launch(now, chunk);
    }

    fn launch(&mut self, now: u64, chunk: Vec<u8>) {
        let late =
            u64::try_from(self.chance.below(usize::try_from(self.weather.jitter_us + 1).unwrap())).unwrap();
        self.sent += 1;
        self.under_way.insert((now + self.weather.delay_us + late, self.sent), chunk);
    }

    fn due(&self) -> Option<u64> {
        self.under_way.keys().next().map(|(due, _)| *due)
    }

    fn get(&mut self, now: u64) -> Option<Vec<u8>> {
        self.due().filter(|due| *due <= now)?;
        self.under_way.pop_first().map(|(_, chunk)| chunk)
    }
}

/// A message that says where it belongs.
type Message = (u32, u32);

struct End {
    link: Link,
    is_mcu: bool,
    /// Numbers of the messages of this session that are to be sent.
    to_send: VecDeque<u32>,
    count: u32,
    /// What arrived, by session.
    got: BTreeMap<u32, Vec<u32>>,
    urgent: Vec<u32>,
    /// The session that the host wants, while it has no answer, and when it says hello again.
    wanted: Option<(u32, u64)>,
}

impl End {
    fn new(is_mcu: bool, count: u32) -> Self {
        let link = Link::new(Micros(0));
        let wanted = (!is_mcu).then_some((1, 0));
        let (got, urgent) = (BTreeMap::new(), Vec::new());
        Self { link, is_mcu, to_send: VecDeque::new(), count, got, urgent, wanted }
    }

    fn open(&mut self, session: u32, now: u64) {
        self.link.open(session, Micros(now));
        self.to_send = (0..self.count).collect();
    }

    fn take(&mut self, now: u64, chunk: &[u8]) {
        let ends = chunk.split(|byte| *byte == 0).count() - 1;
        let mut news = 0;
        let mut bytes = chunk;
        loop {
            let session = self.link.session();
            let Some(received) = self.link.receive(Micros(now), &mut bytes, true) else { break };
            news += 1;
            match received {
                Received::Message(payload) => {
                    let (of, number): Message = decode_payload(payload).unwrap();
                    assert_eq!(Some(of), session, "a message of one session was taken in another");
                    self.got.entry(of).or_default().push(number);
                }
                Received::Urgent(payload) => self.urgent.push(decode_payload(payload).unwrap()),

                Received::Hello(of, _) if self.is_mcu => {
                    let is_new = session != Some(of) && !self.link.was_replaced(of);
                    if is_new {
                        self.open(of, now);
                    }
                    self.link.send_hello_reply(of, &of).unwrap();
                }
                Received::HelloReply(of, _) => {
                    if self.wanted.is_some_and(|(wanted, _)| wanted == of) {
                        self.wanted = None;
                        self.open(of, now);
                    }
                }
                // An MCU heeds no reset: a host that isn't open yet may say so of what overtook the answer to its hello.
                Received::Reset if self.is_mcu => {}
                Received::Reset => self.want(session.unwrap_or(NO_SESSION) + 1, now),
                Received::Telemetry(_) | Received::Hello(..) => {}
            }
        }
        assert!(news <= ends, "{news} pieces of news from {ends} frames");
    }

    /// The host gives its session up for another.
    fn want(&mut self, session: u32, now: u64) {
        self.link.close();
        self.wanted = Some((session, now));
    }

    /// Says everything that is due now, and holds it to the rules of order and of bounded work.
    fn speak(&mut self, now: u64, line: &mut Line) {
        if let Some((wanted, at)) = self.wanted.filter(|(_, at)| *at <= now) {
            self.link.send_hello(wanted, &wanted).unwrap();
            self.wanted = Some((wanted, at + HELLO_EVERY_US));
        }
        while let (Some(session), Some(&next)) = (self.link.session(), self.to_send.front()) {
            match self.link.send(&(session, next)) {
                Ok(()) => self.to_send.pop_front(),
                Err(SendError::Full) => break,
                Err(error) => panic!("{error:?}"),
            };
        }
        let mut frame = [0; MAX_ENCODED];
        let mut kinds = Vec::new();
        loop {
            let length = self.link.poll_transmit(Micros(now), &mut frame);
            if length == 0 {
                break;
            }
            kinds.push(Decoder::new().next(&mut &frame[..length]).unwrap().unwrap().kind);
            assert!(kinds.len() <= MOST_AT_ONCE, "more than {MOST_AT_ONCE} frames at once: {kinds:?}");
            line.put(now, &frame[..length]);
        }
        line.flush(now);
        if let Some(at) = kinds.iter().position(|kind| *kind == FrameKind::Telemetry) {
            assert_eq!(at + 1, kinds.len(), "telemetry went before something: {kinds:?}");
        }
        if let Some(at) = kinds.iter().position(|kind| *kind == FrameKind::Urgent) {
            assert!(kinds[..at].iter().all(|kind| *kind == FrameKind::UrgentAck), "overtaken: {kinds:?}");
        }
        let soon = self.link.poll_timeout(Micros(now));
        assert!(soon.is_none_or(|due| due.0 > now), "nothing is said, but something is due: {soon:?}");
    }

    fn is_done(&self) -> bool {
        self.wanted.is_none()
            && self.to_send.is_empty()
            && self.link.is_settled()
            && self.link.session().is_some()
    }

    fn due(&self, now: u64) -> Option<u64> {
        let hello = self.wanted.map(|(_, at)| at);
        hello.into_iter().chain(self.link.poll_timeout(Micros(now)).map(|due| due.0)).min()
    }
}

/// Something that a user of the link does at some time.
#[derive(Debug, Clone, Copy)]
enum Deed {
    /// The host opens another session.
    Replace,
    /// An end says something urgent.
    Urgent { mcu: bool },
    /// The MCU sends telemetry.
    Telemetry,
}

fn deeds() -> impl Strategy<Value = Vec<(u64, Deed)>> {
    let deed = prop_oneof![
        1 => Just(Deed::Replace),
        2 => any::<bool>().prop_map(|mcu| Deed::Urgent { mcu }),
        4 => Just(Deed::Telemetry),
    ];
    prop::collection::vec((0u64..2_000_000, deed), 0..12)
}

/// Runs both ends until everything of the last session arrived, and returns them with the time that took.
fn converse(weather: Weather, seed: u64, count: u32, mut deeds: Vec<(u64, Deed)>) -> (End, End, u64) {
    let mut there = Line::new(weather, seed);
    let mut back = Line::new(weather, seed.rotate_left(32) ^ 0xabcd);
    let (mut host, mut mcu) = (End::new(false, count), End::new(true, count));
    deeds.sort_by_key(|(at, _)| *at);
    // No more replacements than a link remembers, less the one that is open.
    let mut replacements = 3;
    deeds.retain(|(_, deed)| {
        let counts = usize::from(matches!(deed, Deed::Replace));
        let keep = replacements >= counts;
        replacements = replacements.saturating_sub(counts);
        keep
    });
    let mut deeds = VecDeque::from(deeds);
    let (mut now, mut next_session) = (0, 2);
    loop {
        while let Some((_, deed)) = deeds.front().copied().filter(|(at, _)| *at <= now) {
            deeds.pop_front();
            match deed {
                Deed::Replace => {
                    next_session = next_session.max(host.link.session().unwrap_or(NO_SESSION) + 1);
                    host.want(next_session, now);
                    next_session += 1;
                }
                Deed::Urgent { mcu: true } => drop(mcu.link.send_urgent(&7_u32)),
                Deed::Urgent { mcu: false } => drop(host.link.send_urgent(&8_u32)),
                Deed::Telemetry => drop(mcu.link.send_telemetry(&[9_u8; 200].as_slice())),
            }
        }
        while let Some(chunk) = back.get(now) {
            host.take(now, &chunk);
        }
        while let Some(chunk) = there.get(now) {
            mcu.take(now, &chunk);
        }
        host.speak(now, &mut there);
        mcu.speak(now, &mut back);
        if (deeds.is_empty() && host.is_done() && mcu.is_done()) || now > PATIENCE_US {
            return (host, mcu, now);
        }
        let times = [there.due(), back.due(), host.due(now), mcu.due(now), deeds.front().map(|(at, _)| *at)];
        now = times.into_iter().flatten().min().unwrap_or(u64::MAX).max(now);
    }
}

fn in_order(got: &BTreeMap<u32, Vec<u32>>) -> bool {
    got.values().all(|numbers| numbers.iter().copied().eq(0..u32::try_from(numbers.len()).unwrap()))
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 96, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn nothing_is_lost_doubled_or_reordered_whatever_the_line_and_the_sessions_do(
        weather in weather(), seed: u64, deeds in deeds(),
    ) {
        let count = 40;
        let (host, mcu, now) = converse(weather, seed, count, deeds);
        prop_assert!(now <= PATIENCE_US, "no end after {now} us");
        prop_assert!(in_order(&host.got), "{:?}", host.got);
        prop_assert!(in_order(&mcu.got), "{:?}", mcu.got);
        prop_assert_eq!(host.link.session(), mcu.link.session());
        let session = host.link.session().unwrap();
        let complete: Vec<u32> = (0..count).collect();
        prop_assert_eq!(host.got.get(&session), Some(&complete));
        prop_assert_eq!(mcu.got.get(&session), Some(&complete));
    }

    #[test]
    fn noise_of_any_length_makes_a_link_say_no_more_than_its_window_and_seven(
        noise in prop::collection::vec(prop_oneof![1 => Just(0u8), 6 => any::<u8>()], 0..2_000), full: bool,
    ) {
        let mut end = End::new(true, if full { 40 } else { 0 });
        end.open(1, 0);
        end.take(0, &noise);
        end.speak(0, &mut Line::new(FINE, 1));
    }

    #[test]
    fn a_stop_is_the_next_frame_whatever_waits(
        queued in 0usize..=WINDOW, telemetry: bool, sent_before: bool,
    ) {
        let mut end = End::new(true, 0);
        end.open(1, 0);
        for number in 0..queued {
            end.link.send(&number).unwrap();
        }
        if telemetry {
            end.link.send_telemetry(&1_u8).unwrap();
        }
        if sent_before {
            end.speak(0, &mut Line::new(FINE, 1));
        }
        end.link.send_urgent(&5_u8).unwrap();
        let mut frame = [0; MAX_ENCODED];
        let length = end.link.poll_transmit(Micros(1), &mut frame);
        let header = Decoder::new().next(&mut &frame[..length]).unwrap().unwrap();
        prop_assert_eq!(header.kind, FrameKind::Urgent);
    }
}

#[test]
fn on_a_fine_line_every_urgent_message_arrives_within_one_way_of_the_line() {
    let deeds = (1..=4).map(|at| (at * 300_000, Deed::Urgent { mcu: at % 2 == 0 })).collect();
    let (host, mcu, _) = converse(FINE, 1, 40, deeds);
    assert_eq!((host.urgent, mcu.urgent), (vec![7, 7], vec![8, 8]));
}

#[test]
fn a_line_that_comes_back_after_a_minute_of_silence_carries_the_rest() {
    let mut line = [Line::new(FINE, 1), Line::new(FINE, 2)];
    let (mut host, mut mcu) = (End::new(false, 40), End::new(true, 40));
    let dead = 5_000..60_000_000;
    let mut now = 0;
    while !(host.is_done() && mcu.is_done()) && now < 70_000_000 {
        let [there, back] = &mut line;
        while let Some(chunk) = back.get(now) {
            host.take(now, &chunk);
        }
        while let Some(chunk) = there.get(now) {
            mcu.take(now, &chunk);
        }
        host.speak(now, there);
        mcu.speak(now, back);
        if dead.contains(&now) {
            for line in &mut line {
                line.under_way.clear();
            }
        }
        now += 1_000;
    }
    assert!(now < 62_100_000, "it took until {now} us: longer than the longest timeout after the silence");
    assert_eq!(mcu.got.get(&1).map(Vec::len), Some(40));
    assert_eq!(host.got.get(&1).map(Vec::len), Some(40));
}
