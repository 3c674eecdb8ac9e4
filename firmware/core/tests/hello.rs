//! Who may open a session, and what the core answers to those who may not.
#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]

mod a_board;

use zygote_core::Core;
use zygote_protocol::{
    Decoder, FrameKind, Header, Hello, HelloReply, MAX_ENCODED, Micros, Millis, NO_SESSION, VERSION,
    VERSION_MIN, decode_payload, encode, schema,
};

const NOW: Micros = Micros(1_000);

fn core() -> Core<1, 1, 1, 4> {
    Core::new(a_board::config(1, 1, 1), NOW, None)
}

/// What the core answers to a hello frame of these bytes.
fn answer(core: &mut Core<1, 1, 1, 4>, session: u32, payload: &[u8]) -> Option<(Header, HelloReply)> {
    let mut frame = [0; MAX_ENCODED];
    let header = Header { kind: FrameKind::Hello, session, seq: 0, ack: 0 };
    let length = encode(header, payload, &mut frame)?;
    core.handle_bytes(NOW, &frame[..length]);
    let length = core.poll_transmit(NOW, &mut frame);
    let mut decoder = Decoder::new();
    let header = decoder.next(&mut &frame[..length])?.ok()?;
    Some((header, decode_payload(decoder.payload())?))
}

/// The versions, the schema hash in its five bytes, and what follows in some later version.
fn hello(min: u16, current: u16, schema: u32, more: &[u8]) -> Vec<u8> {
    // Below 128 a version is one byte.
    let mut bytes = vec![u8::try_from(min).unwrap(), u8::try_from(current).unwrap()];
    bytes.extend((0..5).map(|at| (schema >> (7 * at) & 0x7f) as u8 | if at < 4 { 0x80 } else { 0 }));
    bytes.extend(more);
    bytes
}

/// The core opened no session: it never speaks unasked.
fn is_closed(core: &mut Core<1, 1, 1, 4>) -> bool {
    core.poll_transmit(NOW.plus(Millis(10_000)), &mut [0; MAX_ENCODED]) == 0
}

#[test]
fn a_hello_of_this_version_opens_its_session() {
    let mut core = core();
    assert_eq!(decode_payload(&hello(VERSION, VERSION, schema::hash(), &[])), Some(Hello::ours()));
    let (header, reply) = answer(&mut core, 5, &hello(VERSION, VERSION, schema::hash(), &[])).unwrap();
    assert_eq!((header.kind, header.session, reply.identity.boot), (FrameKind::HelloReply, 5, 0));
    assert!(!is_closed(&mut core));
}

#[test]
fn a_hello_of_a_later_version_with_more_fields_is_answered_and_opens_nothing() {
    let mut core = core();
    let (header, reply) =
        answer(&mut core, 5, &hello(VERSION + 1, VERSION + 2, 0x1234_5678, &[1, 2, 3])).unwrap();
    assert_eq!((header.kind, header.session), (FrameKind::HelloReply, 5));
    assert_eq!((reply.min, reply.current), (VERSION_MIN, VERSION));
    assert!(is_closed(&mut core));
}

#[test]
fn a_hello_of_session_0_is_answered_and_opens_nothing() {
    let mut core = core();
    let (header, _) = answer(&mut core, NO_SESSION, &hello(VERSION, VERSION, schema::hash(), &[])).unwrap();
    assert_eq!(header.session, NO_SESSION);
    assert!(is_closed(&mut core));
}

#[test]
fn a_hello_that_is_wrong_in_one_thing_only_opens_nothing() {
    let ours = schema::hash();
    for (min, current, schema) in
        [(VERSION + 1, VERSION + 2, ours), (0, VERSION_MIN - 1, ours), (VERSION, VERSION, !ours)]
    {
        let mut core = core();
        assert!(answer(&mut core, 5, &hello(min, current, schema, &[])).is_some());
        assert!(is_closed(&mut core), "versions {min} to {current}, schema {schema:#x}");
    }
}

#[test]
fn a_hello_that_spans_several_versions_opens_its_session() {
    let mut core = core();
    answer(&mut core, 5, &hello(VERSION_MIN - 1, VERSION + 1, schema::hash(), &[])).unwrap();
    assert!(!is_closed(&mut core));
}
