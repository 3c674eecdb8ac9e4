//! Frames: a header, a payload and a CRC-32, COBS-encoded, ended by a zero byte.
//!
//! ```text
//! kind u8 | session u32 | seq u8 | ack u8 | payload 0..=240 bytes | crc32 u32      (little endian)
//! ```
//!
//! The checksum covers everything before it. A frame is at most 251 bytes, so that COBS adds exactly one.

use crate::crc::crc32;
use cobs::{DecodeResult, DecoderState};
use core::hash::{Hash, Hasher};
use serde::{Deserialize, Serialize};

const HEADER: usize = 7;
const CRC: usize = 4;
/// Most bytes of payload in a frame.
pub const MAX_PAYLOAD: usize = 240;
const MAX_RAW: usize = HEADER + MAX_PAYLOAD + CRC;
/// Most bytes of a frame on the wire, its delimiter included.
pub const MAX_ENCODED: usize = MAX_RAW + 2;

/// What a frame is for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum FrameKind {
    /// Opens a session.
    Hello,
    /// Answers a hello.
    HelloReply,
    /// A reliable message; `seq` numbers it.
    Data,
    /// Acknowledges reliable messages; keeps the link alive.
    Ack,
    /// Like [`Self::Ack`], and asks for what follows to be sent again.
    Nack,
    /// An urgent message; `seq` numbers it apart from the reliable ones.
    Urgent,
    /// Acknowledges the urgent message `seq`.
    UrgentAck,
    /// A lossy message.
    Telemetry,
    /// The sender knows no session of this number.
    Reset,
}

impl FrameKind {
    const ALL: [Self; 9] = [
        Self::Hello,
        Self::HelloReply,
        Self::Data,
        Self::Ack,
        Self::Nack,
        Self::Urgent,
        Self::UrgentAck,
        Self::Telemetry,
        Self::Reset,
    ];

    fn to_byte(self) -> u8 {
        Self::ALL.iter().zip(0u8..).find(|(kind, _)| **kind == self).map_or(u8::MAX, |(_, byte)| byte)
    }

    fn from_byte(byte: u8) -> Option<Self> {
        Self::ALL.get(usize::from(byte)).copied()
    }
}

/// What stands before a payload.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Header {
    /// What the frame is for.
    pub kind: FrameKind,
    /// The session it belongs to.
    pub session: u32,
    /// Number of a data or urgent frame.
    pub seq: u8,
    /// The next data frame that the sender waits for: all before it have arrived.
    pub ack: u8,
}

/// Why bytes up to a delimiter are no frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FrameError {
    /// Longer than any frame.
    TooLong,
    /// Not COBS.
    BadCobs,
    /// Too short for header and checksum.
    TooShort,
    /// The checksum doesn't fit.
    BadCrc,
    /// A kind of frame that this version doesn't know.
    UnknownKind,
}

/// Encodes a frame with its delimiter into `out`, which has room for [`MAX_ENCODED`] bytes, and returns its
/// length; `None` when the payload is too long or `out` too small.
pub fn encode(header: Header, payload: &[u8], out: &mut [u8]) -> Option<usize> {
    let mut raw = heapless::Vec::<u8, MAX_RAW>::new();
    raw.push(header.kind.to_byte()).ok()?;
    raw.extend_from_slice(&header.session.to_le_bytes()).ok()?;
    raw.extend_from_slice(&[header.seq, header.ack]).ok()?;
    raw.extend_from_slice(payload).ok()?;
    let sum = crc32(&raw);
    raw.extend_from_slice(&sum.to_le_bytes()).ok()?;
    if out.len() < MAX_ENCODED {
        return None;
    }
    let length = cobs::try_encode(&raw, out).ok()?;
    *out.get_mut(length)? = 0;
    Some(length + 1)
}

/// A message from a payload; trailing bytes are an error.
pub fn decode_payload<'a, T: Deserialize<'a>>(payload: &'a [u8]) -> Option<T> {
    match postcard::take_from_bytes(payload) {
        Ok((message, [])) => Some(message),
        Ok(_) | Err(_) => None,
    }
}

/// A payload from a message; `None` when it doesn't fit a frame.
pub(crate) fn encode_payload<T: Serialize + ?Sized>(message: &T) -> Option<heapless::Vec<u8, MAX_PAYLOAD>> {
    let mut buffer = [0; MAX_PAYLOAD];
    let used = postcard::to_slice(message, &mut buffer).ok()?;
    heapless::Vec::from_slice(used).ok()
}

/// Collects bytes up to a delimiter and checks them.
#[derive(Debug, Clone)]
pub struct Decoder {
    /// A frame without its delimiter.
    buffer: [u8; MAX_ENCODED - 1],
    length: usize,
    overrun: bool,
    payload_length: usize,
}

impl Decoder {
    /// An empty decoder.
    pub const fn new() -> Self {
        Self { buffer: [0; MAX_ENCODED - 1], length: 0, overrun: false, payload_length: 0 }
    }

    /// Takes bytes off the front of `bytes` up to the first frame's end, and returns its header or why it is no
    /// frame. `None`: `bytes` is used up and no frame ended.
    pub fn next(&mut self, bytes: &mut &[u8]) -> Option<Result<Header, FrameError>> {
        loop {
            let (&byte, rest) = bytes.split_first()?;
            *bytes = rest;
            if byte != 0 {
                match self.buffer.get_mut(self.length) {
                    Some(place) => {
                        *place = byte;
                        self.length += 1;
                    }
                    None => self.overrun = true,
                }
                continue;
            }
            let length = core::mem::take(&mut self.length);
            if core::mem::take(&mut self.overrun) {
                return Some(Err(FrameError::TooLong));
            }
            // Two delimiters in a row are an idle line, not a broken frame.
            if length > 0 {
                return Some(self.check(length));
            }
        }
    }

    /// The payload of the frame whose header [`Self::next`] returned last.
    pub fn payload(&self) -> &[u8] {
        self.buffer.get(HEADER..HEADER + self.payload_length).unwrap_or_default()
    }

    fn check(&mut self, length: usize) -> Result<Header, FrameError> {
        self.payload_length = 0;
        let raw_length = self.unstuff(length).ok_or(FrameError::BadCobs)?;
        let raw = self.buffer.get(..raw_length).ok_or(FrameError::BadCobs)?;
        let (body, sum) = raw.split_last_chunk::<CRC>().ok_or(FrameError::TooShort)?;
        if crc32(body) != u32::from_le_bytes(*sum) {
            return Err(FrameError::BadCrc);
        }
        let (head, payload) = body.split_first_chunk::<HEADER>().ok_or(FrameError::TooShort)?;
        let [kind, s0, s1, s2, s3, seq, ack] = *head;
        let kind = FrameKind::from_byte(kind).ok_or(FrameError::UnknownKind)?;
        self.payload_length = payload.len();
        Ok(Header { kind, session: u32::from_le_bytes([s0, s1, s2, s3]), seq, ack })
    }
}

impl Decoder {
    /// Undoes COBS in place and returns the length of what was in it. Byte by byte: what comes out is never longer than what
    /// went in, and no index can be out of bounds.
    fn unstuff(&mut self, length: usize) -> Option<usize> {
        let mut state = DecoderState::Idle;
        let mut raw_length = 0;
        for at in 0..length {
            match state.feed(*self.buffer.get(at)?).ok()? {
                DecodeResult::DataStart | DecodeResult::NoData => {}
                DecodeResult::DataContinue(byte) => {
                    *self.buffer.get_mut(raw_length)? = byte;
                    raw_length += 1;
                }
                DecodeResult::DataComplete => return None,
            }
        }
        matches!(state.feed(0), Ok(DecodeResult::DataComplete)).then_some(raw_length)
    }
}

/// What a decoder will do next depends on the bytes of the frame that is arriving, not on those of earlier ones.
impl Hash for Decoder {
    fn hash<H: Hasher>(&self, state: &mut H) {
        self.buffer.get(..self.length).unwrap_or_default().hash(state);
        self.overrun.hash(state);
    }
}

impl Default for Decoder {
    fn default() -> Self {
        Self::new()
    }
}
