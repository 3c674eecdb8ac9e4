//! Holds a message against its bytes, both ways.

use std::fmt::Write;
use zygote_protocol::decode_payload;

/// The message encodes to these bytes, and the bytes decode to the message.
pub(crate) fn golden<T>(message: &T, expected: &str)
where
    T: serde::Serialize + for<'a> serde::Deserialize<'a> + PartialEq + std::fmt::Debug,
{
    let encoded = bytes(message);
    assert_eq!(hex(&encoded), expected, "{message:?}");
    assert_eq!(decode_payload::<T>(&encoded).as_ref(), Some(message));
}

/// A message's payload.
pub(crate) fn bytes<T: serde::Serialize>(message: &T) -> Vec<u8> {
    let mut buffer = [0; 240];
    postcard::to_slice(message, &mut buffer).unwrap().to_vec()
}

/// Bytes as people write them.
pub(crate) fn hex(bytes: &[u8]) -> String {
    bytes.iter().fold(String::new(), |mut text, byte| {
        write!(text, "{byte:02x}").unwrap();
        text
    })
}
