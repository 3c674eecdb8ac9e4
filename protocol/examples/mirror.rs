//! Reads messages and writes them again, so that an implementation in another language can be held against this one: a line
//! `request 0a00`, kind and hex, is answered with the bytes as this crate encodes what it decoded, or with `refused`.
//! `hil-tests/test_mirror.py` is such a comparison.

use serde::{Serialize, de::DeserializeOwned};
use std::io::{self, BufRead, Write};
use zygote_protocol::{
    Decoder, Fault, Hello, HelloReply, MAX_ENCODED, Report, Request, Telemetry, Urgent, decode_payload,
    encode,
};

/// Longer than any message.
const ROOM: usize = 1024;

fn main() -> io::Result<()> {
    let mut out = io::stdout().lock();
    for line in io::stdin().lock().lines() {
        writeln!(out, "{}", answer(&line?).unwrap_or_else(|| "refused".to_owned()))?;
        out.flush()?;
    }
    Ok(())
}

fn answer(line: &str) -> Option<String> {
    let (kind, hex) = line.split_once(' ')?;
    let bytes = bytes_of(hex)?;
    match kind {
        "hello" => again::<Hello>(&bytes),
        "hello-reply" => again::<HelloReply>(&bytes),
        "request" => again::<Request>(&bytes),
        "urgent" => again::<Urgent>(&bytes),
        "report" => again::<Report>(&bytes),
        "fault" => again::<Fault>(&bytes),
        "telemetry" => again::<Telemetry>(&bytes),
        "frame" => frame_again(&bytes),
        _ => None,
    }
}

fn again<T: Serialize + DeserializeOwned>(payload: &[u8]) -> Option<String> {
    let message: T = decode_payload(payload)?;
    let mut room = [0; ROOM];
    postcard::to_slice(&message, &mut room).ok().map(|used| hex_of(used))
}

/// The one frame that these bytes are.
fn frame_again(mut bytes: &[u8]) -> Option<String> {
    let mut decoder = Decoder::new();
    let header = decoder.next(&mut bytes)?.ok()?;
    let mut room = [0; MAX_ENCODED];
    let length = encode(header, decoder.payload(), &mut room)?;
    if bytes.is_empty() { room.get(..length).map(hex_of) } else { None }
}

fn bytes_of(hex: &str) -> Option<Vec<u8>> {
    let pairs = (0..hex.len()).step_by(2);
    pairs.map(|at| u8::from_str_radix(hex.get(at..at + 2)?, 16).ok()).collect()
}

fn hex_of(bytes: &[u8]) -> String {
    bytes.iter().fold(String::new(), |hex, byte| hex + &format!("{byte:02x}"))
}
