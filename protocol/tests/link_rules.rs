//! The rules of the link, one by one: what a frame changes, what a link says, in which order and when.
#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]

use std::hash::{DefaultHasher, Hash, Hasher};
use zygote_protocol::{
    Buffers, Decoder, FrameKind, Header, Link, MAX_ENCODED, Micros, NO_SESSION, Received, SendError, WINDOW,
    encode,
};

const OURS: u32 = 7;
const OTHER: u32 = 8;
/// Longest silence of an open link.
const KEEP_ALIVE_US: u64 = 200_000;
/// Before a round trip was measured, a frame goes out again after this time.
const TIMEOUT_US: u64 = 300_000;

fn open_link() -> Link {
    let mut link = Link::new(Micros(0));
    link.open(OURS, Micros(0));
    link
}

fn frame(kind: FrameKind, session: u32, seq: u8, ack: u8) -> Vec<u8> {
    let mut bytes = [0; MAX_ENCODED];
    let length = encode(Header { kind, session, seq, ack }, &[42], &mut bytes).unwrap();
    bytes[..length].to_vec()
}

fn hear<'a>(link: &'a mut Link, now: u64, frame: &[u8]) -> Option<Received<'a>> {
    link.receive(Micros(now), &mut &*frame, true)
}

/// Tells a link something that it is known to hear.
fn told(link: &mut Link, kind: FrameKind, session: u32) {
    hear(link, 0, &frame(kind, session, 0, 0));
}

fn say(link: &mut Link, now: u64) -> Option<Header> {
    let mut bytes = [0; MAX_ENCODED];
    let length = link.poll_transmit(Micros(now), &mut bytes);
    Decoder::new().next(&mut &bytes[..length]).map(Result::unwrap)
}

/// Everything that a link says at a time.
fn say_all(link: &mut Link, now: u64) -> Vec<Header> {
    std::iter::from_fn(|| say(link, now)).collect()
}

fn kinds(headers: &[Header]) -> Vec<FrameKind> {
    headers.iter().map(|header| header.kind).collect()
}

#[test]
fn what_is_due_goes_out_in_the_order_of_its_urgency() {
    let mut link = open_link();
    link.send_telemetry(&1_u8).unwrap();
    link.send(&2_u8).unwrap();
    assert_eq!(hear(&mut link, 0, &frame(FrameKind::Data, OURS, 1, 0)), None, "one is missing before it");
    link.send_hello_reply(OTHER, &3_u8).unwrap();
    assert_eq!(hear(&mut link, 0, &frame(FrameKind::Data, OTHER, 0, 0)), None);
    link.send_urgent(&4_u8).unwrap();
    assert!(matches!(hear(&mut link, 0, &frame(FrameKind::Urgent, OURS, 9, 0)), Some(Received::Urgent(_))));
    let header = |kind, session, seq| Header { kind, session, seq, ack: 0 };
    let expected = [
        header(FrameKind::UrgentAck, OURS, 9),
        header(FrameKind::Urgent, OURS, 0),
        header(FrameKind::Reset, OTHER, 0),
        header(FrameKind::HelloReply, OTHER, 0),
        header(FrameKind::Nack, OURS, 0),
        header(FrameKind::Data, OURS, 0),
        header(FrameKind::Telemetry, OURS, 0),
    ];
    assert_eq!(say_all(&mut link, 0), expected);
}

#[test]
fn what_the_other_end_cannot_take_in_is_refused_until_the_session_ends() {
    let mut link = open_link();
    link.heed(Buffers { steps: 1, window: 2, payload: 3 });
    assert_eq!(link.send(&[0_u8; 4]), Err(SendError::TooLong));
    assert_eq!((link.room(), link.send(&[0_u8; 3])), (2, Ok(())));
    assert_eq!((link.room(), link.send(&[0_u8; 2])), (1, Ok(())));
    assert_eq!((link.room(), link.send(&0_u8)), (0, Err(SendError::Full)));
    link.open(OTHER, Micros(0));
    assert_eq!((link.room(), link.send(&[0_u8; 4])), (WINDOW, Ok(())));
}

#[test]
fn a_message_for_no_session_or_longer_than_a_frame_is_refused() {
    let mut link = Link::new(Micros(0));
    let long = [[0_u8; 31]; 8];
    assert_eq!(
        (link.send(&1_u8), link.send_telemetry(&1_u8)),
        (Err(SendError::Closed), Err(SendError::Closed))
    );
    assert_eq!(link.send_urgent(&long), Err(SendError::TooLong));
    assert_eq!(link.send_hello(OURS, &long), Err(SendError::TooLong));
    assert_eq!(link.send_hello_reply(OURS, &long), Err(SendError::TooLong));
    link.open(OURS, Micros(0));
    assert_eq!(
        (link.send(&long), link.send_telemetry(&long)),
        (Err(SendError::TooLong), Err(SendError::TooLong))
    );
    assert_eq!(say(&mut link, 0), None, "nothing of it is sent");
}

#[test]
fn a_link_counts_what_it_heard_and_what_became_of_what_it_said() {
    let mut link = open_link();
    link.send(&[1_u8; 3]).unwrap();
    assert_eq!(kinds(&say_all(&mut link, 0)), [FrameKind::Data]);
    assert_eq!(kinds(&say_all(&mut link, TIMEOUT_US)), [FrameKind::Data]);
    assert_eq!(hear(&mut link, 0, &frame(FrameKind::Ack, OURS, 0, 1)), None);
    assert_eq!(hear(&mut link, 0, &frame(FrameKind::Data, OTHER, 0, 0)), None);
    assert_eq!(hear(&mut link, 0, &[1, 2, 3, 0]), None);
    let counters = link.counters();
    assert_eq!((counters.good, counters.bad, counters.discarded), (2, 1, 1));
    assert_eq!((counters.repeated, counters.delivered), (1, 3));
    link.close();
    assert_eq!(link.counters(), counters, "what was seen outlives the session");
}

#[test]
fn everything_is_settled_once_reliable_and_urgent_messages_are_acknowledged() {
    let mut link = open_link();
    assert!(link.is_settled());
    link.send(&1_u8).unwrap();
    assert!(!link.is_settled(), "a reliable message is under way");
    say_all(&mut link, 0);
    link.send_urgent(&1_u8).unwrap();
    say_all(&mut link, 0);
    hear(&mut link, 0, &frame(FrameKind::Ack, OURS, 0, 1));
    assert!(!link.is_settled(), "an urgent message is under way");
    hear(&mut link, 0, &frame(FrameKind::UrgentAck, OURS, 0, 1));
    assert!(link.is_settled());
}

#[test]
fn closing_drops_what_was_under_way() {
    let mut link = open_link();
    link.send(&1_u8).unwrap();
    link.send_urgent(&2_u8).unwrap();
    link.send_telemetry(&3_u8).unwrap();
    link.close();
    assert_eq!((link.session(), link.is_settled()), (None, true));
    assert_eq!((say(&mut link, 0), link.poll_timeout(Micros(0))), (None, None));
}

#[test]
fn a_session_that_another_one_replaced_is_remembered_until_four_others_are() {
    let mut link = Link::new(Micros(0));
    link.open(1, Micros(0));
    link.open(1, Micros(0));
    assert!(!link.was_replaced(1), "it was opened again, not replaced");
    for session in 2..=5 {
        link.open(session, Micros(0));
    }
    assert!([1, 2, 3, 4].into_iter().all(|session| link.was_replaced(session)));
    assert!(!link.was_replaced(5), "it is open");
    link.open(6, Micros(0));
    assert!(!link.was_replaced(1), "it is forgotten");
    assert!(!Link::new(Micros(0)).was_replaced(NO_SESSION), "no session has this number");
}

#[test]
fn only_frames_of_its_session_tell_a_link_that_the_other_end_lives() {
    let mut link = Link::new(Micros(3));
    assert_eq!((link.session(), link.last_heard()), (None, Micros(3)));
    link.open(OURS, Micros(5));
    assert_eq!((link.session(), link.last_heard()), (Some(OURS), Micros(5)));
    for (now, kind) in (10..).zip([
        FrameKind::Data,
        FrameKind::Ack,
        FrameKind::Nack,
        FrameKind::Urgent,
        FrameKind::UrgentAck,
        FrameKind::Telemetry,
    ]) {
        hear(&mut link, now, &frame(kind, OURS, 0, 0));
        assert_eq!(link.last_heard(), Micros(now), "{kind:?}");
        hear(&mut link, 99, &frame(kind, OTHER, 0, 0));
        hear(&mut link, 99, &frame(kind, NO_SESSION, 0, 0));
        assert_eq!(link.last_heard(), Micros(now), "{kind:?} of another session, or of none");
    }
}

#[test]
fn a_hello_and_its_answer_are_heard_whatever_session_is_open_and_change_none() {
    for asked in [OURS, OTHER] {
        let mut link = open_link();
        link.send(&1_u8).unwrap();
        say_all(&mut link, 0);
        let hello = hear(&mut link, 9, &frame(FrameKind::Hello, asked, 0, 1));
        assert_eq!(hello, Some(Received::Hello(asked, &[42])));
        let reply = hear(&mut link, 9, &frame(FrameKind::HelloReply, asked, 0, 1));
        assert_eq!(reply, Some(Received::HelloReply(asked, &[42])));
        assert_eq!((link.session(), link.last_heard(), link.is_settled()), (Some(OURS), Micros(0), false));
        assert_eq!((say(&mut link, 9), link.counters().discarded), (None, 0));
    }
}

#[test]
fn a_stop_of_another_session_or_of_none_is_heard_and_acknowledged_to_its_sender() {
    for (session, discarded) in [(OTHER, 1), (NO_SESSION, 0)] {
        let mut link = open_link();
        let heard = hear(&mut link, 0, &frame(FrameKind::Urgent, session, 3, 0));
        assert_eq!(heard, Some(Received::Urgent(&[42])));
        assert_eq!(link.counters().discarded, discarded);
        let ack = Header { kind: FrameKind::UrgentAck, session, seq: 3, ack: 0 };
        assert_eq!(say_all(&mut link, 0), [ack], "no reset answers a stop");
    }
}

#[test]
fn an_urgent_frame_of_the_session_acknowledges_and_an_urgent_ack_does_not() {
    for (kind, settled) in [(FrameKind::Urgent, true), (FrameKind::UrgentAck, false)] {
        let mut link = open_link();
        link.send(&1_u8).unwrap();
        say_all(&mut link, 0);
        hear(&mut link, 0, &frame(kind, OURS, 0, 1));
        assert_eq!(link.is_settled(), settled, "{kind:?}");
    }
}

#[test]
fn an_urgent_message_is_acknowledged_in_its_session_or_in_none() {
    for (session, seq, settled) in
        [(OURS, 0, true), (NO_SESSION, 0, true), (OTHER, 0, false), (OURS, 1, false)]
    {
        let mut link = open_link();
        link.send_urgent(&1_u8).unwrap();
        say_all(&mut link, 0);
        assert_eq!(hear(&mut link, 0, &frame(FrameKind::UrgentAck, session, seq, 0)), None);
        assert_eq!(link.is_settled(), settled, "session {session}, number {seq}");
        let answer = say_all(&mut link, 0);
        let stranger = Header { kind: FrameKind::Reset, session: OTHER, seq: 0, ack: 0 };
        assert_eq!(answer, if session == OTHER { vec![stranger] } else { vec![] });
    }
}

#[test]
fn a_reset_of_another_session_is_neither_heeded_nor_answered() {
    let mut link = open_link();
    assert_eq!(hear(&mut link, 0, &frame(FrameKind::Reset, OTHER, 0, 0)), None);
    assert_eq!((say(&mut link, 0), link.counters().discarded), (None, 0));
    assert_eq!(hear(&mut link, 0, &frame(FrameKind::Reset, OURS, 0, 0)), Some(Received::Reset));
}

#[test]
fn a_number_ahead_within_the_window_asks_for_what_is_missing_and_any_other_is_acknowledged() {
    for seq in 0..=u8::MAX {
        let mut link = open_link();
        let heard = hear(&mut link, 0, &frame(FrameKind::Data, OURS, seq, 0));
        assert_eq!(heard.is_some(), seq == 0, "number {seq}");
        assert_eq!(link.counters().discarded, u32::from(seq != 0), "number {seq}");
        let kind = if (1..8).contains(&seq) { FrameKind::Nack } else { FrameKind::Ack };
        let answer = Header { kind, session: OURS, seq: 0, ack: u8::from(seq == 0) };
        assert_eq!(say_all(&mut link, 0), [answer], "number {seq}");
    }
}

#[test]
fn a_message_that_is_turned_away_is_acknowledged_up_to_it() {
    let mut link = open_link();
    let message = frame(FrameKind::Data, OURS, 0, 0);
    assert_eq!(link.receive(Micros(0), &mut &message[..], false), None);
    assert_eq!(say_all(&mut link, 0), [Header { kind: FrameKind::Ack, session: OURS, seq: 0, ack: 0 }]);
}

#[test]
fn a_repetition_takes_no_request_back() {
    let mut link = open_link();
    hear(&mut link, 0, &frame(FrameKind::Data, OURS, 1, 0));
    hear(&mut link, 0, &frame(FrameKind::Data, OURS, u8::MAX, 0));
    assert_eq!(kinds(&say_all(&mut link, 0)), [FrameKind::Nack]);
}

#[test]
fn noise_is_answered_with_a_request_in_a_session_and_with_nothing_outside() {
    let mut link = open_link();
    hear(&mut link, 0, &[1, 2, 3, 0]);
    assert_eq!(kinds(&say_all(&mut link, 0)), [FrameKind::Nack]);
    let mut closed = Link::new(Micros(0));
    hear(&mut closed, 0, &[1, 2, 3, 0]);
    assert_eq!((closed.poll_timeout(Micros(0)), say(&mut closed, 0)), (None, None));
}

#[test]
fn a_message_is_taken_with_room_for_its_answer_which_its_own_acknowledgement_may_make() {
    let with_room = |link: &mut Link, ack| {
        let message = frame(FrameKind::Data, OURS, 0, ack);
        link.receive_with_room(Micros(0), &mut &message[..]).is_some()
    };
    assert!(with_room(&mut open_link(), 0));
    let mut link = open_link();
    while link.send(&1_u8).is_ok() {}
    say_all(&mut link, 0);
    assert!(!with_room(&mut link, 0), "no room");
    assert!(with_room(&mut link, 1), "room for one");
}

#[test]
fn what_waits_is_due_at_once() {
    let due = |prepare: fn(&mut Link)| {
        let mut link = open_link();
        prepare(&mut link);
        link.poll_timeout(Micros(50))
    };
    let now = Some(Micros(50));
    assert_eq!(due(|link| told(link, FrameKind::Urgent, OURS)), now);
    assert_eq!(due(|link| told(link, FrameKind::Data, OTHER)), now);
    assert_eq!(due(|link| told(link, FrameKind::Data, OURS)), now);
    assert_eq!(due(|link| link.send_hello(OURS, &1_u8).unwrap()), now);
    assert_eq!(due(|link| link.send_telemetry(&1_u8).unwrap()), now);
    assert_eq!(due(|link| link.send_urgent(&1_u8).unwrap()), now);
    assert_eq!(due(|link| link.send(&1_u8).unwrap()), now);
    assert_eq!(due(|_| ()), Some(Micros(KEEP_ALIVE_US)), "nothing waits");
}

#[test]
fn what_was_said_is_due_again_at_its_timeout() {
    let mut closed = Link::new(Micros(0));
    closed.send_urgent(&1_u8).unwrap();
    assert_eq!(kinds(&say_all(&mut closed, 5)), [FrameKind::Urgent]);
    assert_eq!(closed.poll_timeout(Micros(5)), Some(Micros(5 + TIMEOUT_US)));
    let mut link = open_link();
    link.send(&1_u8).unwrap();
    assert_eq!(kinds(&say_all(&mut link, 150_000)), [FrameKind::Data]);
    assert_eq!(link.poll_timeout(Micros(150_000)), Some(Micros(150_000 + KEEP_ALIVE_US)));
    assert_eq!(kinds(&say_all(&mut link, 350_000)), [FrameKind::Ack]);
    assert_eq!(link.poll_timeout(Micros(350_000)), Some(Micros(150_000 + TIMEOUT_US)));
    assert_eq!(say(&mut link, 449_999), None);
    assert_eq!(kinds(&say_all(&mut link, 450_000)), [FrameKind::Data]);
}

#[test]
fn a_link_keeps_itself_alive_after_its_longest_silence() {
    let mut link = open_link();
    assert_eq!(say(&mut link, KEEP_ALIVE_US - 1), None);
    assert_eq!(kinds(&say_all(&mut link, KEEP_ALIVE_US)), [FrameKind::Ack]);
    assert_eq!(say(&mut link, 2 * KEEP_ALIVE_US - 1), None);
    link.send_telemetry(&1_u8).unwrap();
    assert_eq!(kinds(&say_all(&mut link, 2 * KEEP_ALIVE_US - 1)), [FrameKind::Telemetry]);
    assert_eq!(say(&mut link, 3 * KEEP_ALIVE_US - 2), None, "telemetry is a sign of life, too");
    assert_eq!(kinds(&say_all(&mut link, 3 * KEEP_ALIVE_US - 1)), [FrameKind::Ack]);
}

#[test]
fn numbers_go_round_and_every_message_arrives_in_order() {
    let (mut from, mut to) = (open_link(), open_link());
    let mut bytes = [0; MAX_ENCODED];
    for number in 0..1_000_u16 {
        from.send(&number.to_be_bytes()).unwrap();
        let length = from.poll_transmit(Micros(0), &mut bytes);
        assert_eq!(hear(&mut to, 0, &bytes[..length]), Some(Received::Message(&number.to_be_bytes())));
        let length = to.poll_transmit(Micros(0), &mut bytes);
        assert_eq!(hear(&mut from, 0, &bytes[..length]), None);
        assert!(from.is_settled(), "message {number}");
    }
}

fn hash(value: &impl Hash) -> u64 {
    let mut hasher = DefaultHasher::new();
    value.hash(&mut hasher);
    hasher.finish()
}

#[test]
fn links_that_will_do_something_else_have_other_hashes_and_counters_do_not_count() {
    let prepare: [fn(&mut Link); 10] = [
        |_| (),
        |link| link.close(),
        |link| link.open(OTHER, Micros(0)),
        |link| link.send(&1_u8).unwrap(),
        |link| link.send(&2_u8).unwrap(),
        |link| link.send_urgent(&1_u8).unwrap(),
        |link| link.send_urgent(&2_u8).unwrap(),
        |link| link.send_telemetry(&1_u8).unwrap(),
        |link| told(link, FrameKind::Data, OURS),
        |link| {
            hear(link, 0, &[1]);
        },
    ];
    let hashes = prepare.map(|prepare| {
        let mut link = open_link();
        prepare(&mut link);
        hash(&link)
    });
    for (at, one) in hashes.iter().enumerate() {
        assert!(!hashes[..at].contains(one), "state {at} has the hash of an earlier one");
    }
    let mut counted = open_link();
    hear(&mut counted, 0, &frame(FrameKind::Reset, OTHER, 0, 0));
    assert_ne!(counted.counters(), open_link().counters());
    assert_eq!(hash(&counted), hashes[0]);
}

#[test]
fn decoders_that_hold_other_bytes_have_other_hashes_and_earlier_frames_do_not_count() {
    let fed = |bytes: &[u8]| {
        let mut decoder = Decoder::new();
        let mut rest = bytes;
        while decoder.next(&mut rest).is_some() {}
        hash(&decoder)
    };
    let (full, over) = ([5; MAX_ENCODED - 1], [5; MAX_ENCODED]);
    let hashes = [fed(&[]), fed(&[1]), fed(&[2]), fed(&full), fed(&over)];
    for (at, one) in hashes.iter().enumerate() {
        assert!(!hashes[..at].contains(one), "state {at} has the hash of an earlier one");
    }
    assert_eq!(fed(&[9, 9, 0, 1]), fed(&[1]));
}
