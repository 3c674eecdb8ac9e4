//! The message decoder: what it takes of any bytes encodes and decodes to the same message again, and never to more bytes
//! than a frame has.

use serde::Serialize;
use serde::de::DeserializeOwned;
use std::fmt::Debug;
use zygote_protocol::{
    Fault, Hello, HelloReply, MAX_PAYLOAD, Report, Request, Telemetry, Urgent, decode_payload,
    peek_request_id, peek_versions,
};

fn stays<T: Serialize + DeserializeOwned + PartialEq + Debug>(payload: &[u8]) {
    let Some(message) = decode_payload::<T>(payload) else { return };
    let mut buffer = [0; MAX_PAYLOAD];
    let encoded = postcard::to_slice(&message, &mut buffer).expect("what came in a payload fits one");
    assert!(encoded.len() <= payload.len(), "the encoding is the shortest");
    assert_eq!(decode_payload::<T>(encoded), Some(message));
}

/// Up to a frame's payload of bytes, as every message.
pub(crate) fn check(data: &[u8]) {
    let payload = &data[..data.len().min(MAX_PAYLOAD)];
    stays::<Hello>(payload);
    stays::<HelloReply>(payload);
    stays::<Request>(payload);
    stays::<Report>(payload);
    stays::<Urgent>(payload);
    stays::<Fault>(payload);
    stays::<Telemetry>(payload);
    if let Some(request) = decode_payload::<Request>(payload) {
        assert_eq!(peek_request_id(payload), Some(request.id));
    }
    if let Some(hello) = decode_payload::<Hello>(payload) {
        assert_eq!(peek_versions(payload), Some(hello));
    }
}
