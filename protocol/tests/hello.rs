//! What of a hello every version understands, and which session an MCU opens for it.
#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]

use zygote_protocol::{Hello, NO_SESSION, VERSION, VERSION_MIN, granted_session, peek_versions, schema};

#[test]
fn the_versions_of_a_hello_are_read_whatever_follows_and_not_from_half_of_it() {
    let hello = Hello { min: 3, current: 300, schema: 0x1234_5678 };
    let mut buffer = [0xff; 32];
    let length = postcard::to_slice(&hello, &mut buffer).unwrap().len();
    assert_eq!(peek_versions(&buffer), Some(hello.clone()), "more follows");
    assert_eq!(peek_versions(&buffer[..length]), Some(hello));
    assert_eq!(peek_versions(&buffer[..length - 1]), None);
}

#[test]
fn our_hello_tells_our_versions_and_our_messages() {
    assert_eq!(Hello::ours(), Hello { min: VERSION_MIN, current: VERSION, schema: schema::compute() });
}

#[test]
fn every_boot_grants_other_sessions_and_never_none() {
    assert_eq!(granted_session(7, 0), 7);
    assert_eq!(granted_session(7, 1), 0x9e37_79be);
    assert_eq!(granted_session(0x9e37_79b8, 1), 1);
    // The number that would come to none is granted as it is.
    assert_eq!(granted_session(0x9e37_79b9, 1), 0x9e37_79b9);
    for boot in 0..1_000 {
        assert_ne!(granted_session(7, boot), granted_session(7, boot + 1), "boot {boot}");
        assert_ne!(granted_session(7, boot), NO_SESSION);
    }
}
