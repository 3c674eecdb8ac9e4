//! The longest frame, and one that is a byte longer.

use zygote_protocol::{Decoder, FrameError, FrameKind, Header, MAX_ENCODED, MAX_PAYLOAD, encode};

const HEADER: Header = Header { kind: FrameKind::Data, session: 1, seq: 2, ack: 3 };

#[test]
fn the_longest_frame_arrives() {
    let payload = [0xa5; MAX_PAYLOAD];
    let mut frame = [0; MAX_ENCODED];
    assert_eq!(encode(HEADER, &payload, &mut frame), Some(MAX_ENCODED));
    let mut decoder = Decoder::new();
    assert_eq!(decoder.next(&mut &frame[..]), Some(Ok(HEADER)));
    assert_eq!(decoder.payload(), payload);
}

#[test]
fn a_frame_that_is_one_byte_longer_is_refused_and_the_next_one_arrives() {
    let mut good = [0; MAX_ENCODED];
    let length = encode(HEADER, &[1], &mut good).unwrap();
    let long = [[0xa5; MAX_ENCODED].as_slice(), &[0], &good[..length]].concat();
    let (mut decoder, mut bytes) = (Decoder::new(), long.as_slice());
    assert_eq!(decoder.next(&mut bytes), Some(Err(FrameError::TooLong)));
    assert_eq!(decoder.next(&mut bytes), Some(Ok(HEADER)));
}

#[test]
fn a_longer_buffer_serves_and_one_without_room_for_the_longest_frame_does_not() {
    let mut frame = [0; MAX_ENCODED + 1];
    assert_eq!(encode(HEADER, &[1], &mut frame), Some(14));
    assert_eq!(encode(HEADER, &[1], &mut frame[..MAX_ENCODED]), Some(14));
    assert_eq!(encode(HEADER, &[1], &mut frame[..MAX_ENCODED - 1]), None);
}

#[test]
fn an_idle_line_is_no_broken_frame() {
    assert_eq!(Decoder::new().next(&mut &[0, 0, 0][..]), None);
}
