//! What of a hello every version understands.
#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]

use zygote_protocol::{Hello, VERSION, VERSION_MIN, peek_versions, schema};

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
