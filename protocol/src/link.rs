//! The reliable link: the same state machine on both ends.
//!
//! ```text
//!            open(session)                     close(), or another session is opened
//!   Closed ----------------> Open(session) ------------------------------------------> Closed
//! ```
//!
//! In a session every data frame has a number. The receiver takes them in order only and acknowledges
//! cumulatively; whoever misses one says `Nack`, and the sender goes back to it (go-back-N with a window of
//! [`WINDOW`]), at once after a `Nack`, else after a timeout from the smoothed round-trip time (RFC 6298).
//! Urgent frames have numbers of their own and are repeated until acknowledged. Telemetry has one place, which
//! the newest message takes.
//!
//! What is due goes out in this order: urgent ack, urgent, reset, handshake, nack, data, ack, telemetry,
//! keep-alive. A closed link sends urgent frames as session 0, which every receiver hears.

mod outbox;
mod round_trip;
mod urgent;

use crate::frame::encode_payload;
use crate::{Buffers, Decoder, FrameKind, Header, MAX_PAYLOAD, Micros, Millis, encode};
use core::hash::{Hash, Hasher};
use heapless::Vec;
use outbox::Outbox;
use round_trip::RoundTrip;
use serde::Serialize;
use urgent::UrgentBox;

/// Data frames under way at once.
pub const WINDOW: usize = 8;
/// Sessions that are remembered as replaced.
const REPLACED: usize = 4;
/// Something is said at least this often, so that the other end can tell silence from absence.
const KEEP_ALIVE: Millis = Millis(200);
/// The session of an urgent frame that belongs to none; no session has this number.
pub const NO_SESSION: u32 = 0;

type Payload = Vec<u8, MAX_PAYLOAD>;

/// What arrived.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Received<'a> {
    /// A hello, with the number that it asks for; [`crate::granted_session`] is the session that it opens.
    Hello(u32, &'a [u8]),
    /// The answer to a hello, with the number that was asked for.
    HelloReply(u32, &'a [u8]),
    /// The next reliable message.
    Message(&'a [u8]),
    /// An urgent message. It may arrive more than once, and from another session or none.
    Urgent(&'a [u8]),
    /// A lossy message.
    Telemetry(&'a [u8]),
    /// The other end doesn't know our session.
    Reset,
}

/// Why a message wasn't taken for sending.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SendError {
    /// No session is open.
    Closed,
    /// Too many messages are under way; try again later.
    Full,
    /// The message doesn't fit a frame.
    TooLong,
}

/// What a link has seen since it was made.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct LinkCounters {
    /// Frames that passed the check.
    pub good: u32,
    /// Frames that didn't.
    pub bad: u32,
    /// Frames of other sessions, repeated ones, and ones out of order.
    pub discarded: u32,
    /// Data frames sent again.
    pub repeated: u32,
    /// Bytes of payload of the messages that the other end has acknowledged.
    pub delivered: u32,
}

/// What the receiving half owes to the other end.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
enum Owed {
    Nothing,
    Ack,
    Nack,
}

/// One end of the link. Two links of one hash will do the same from now on; counters don't count.
#[derive(Debug, Clone, Hash)]
pub struct Link {
    decoder: Decoder,
    half: Half,
}

/// All of the link but the bytes of the frame that is being looked at.
#[derive(Debug, Clone)]
struct Half {
    session: Option<u32>,
    /// Sessions that another one replaced, the latest first; [`NO_SESSION`] where there was none.
    replaced: [u32; REPLACED],
    /// Longest payload that the other end takes.
    longest: usize,
    counters: LinkCounters,
    last_heard: Micros,
    last_said: Micros,
    round_trip: RoundTrip,
    outbox: Outbox,
    urgent: UrgentBox,
    urgent_ack: Option<(u32, u8)>,
    telemetry: Option<Payload>,
    handshake: Option<(FrameKind, u32, Payload)>,
    reset: Option<u32>,
    /// Number of the next data frame.
    expected: u8,
    owed: Owed,
}

/// Whether reliable messages are taken.
#[derive(Debug, Clone, Copy)]
enum Accept {
    Always,
    Never,
    /// While there is room for an answer, counted after the acknowledgement that the message's own frame brings.
    WithRoom,
}

/// How a good frame goes on to the caller.
#[derive(Debug, Clone, Copy)]
enum Route {
    Nowhere,
    Hello,
    HelloReply,
    Message,
    Urgent,
    Telemetry,
    Reset,
}

impl Link {
    /// A closed link.
    pub const fn new(now: Micros) -> Self {
        let half = Half {
            session: None,
            replaced: [NO_SESSION; REPLACED],
            longest: MAX_PAYLOAD,
            counters: LinkCounters { good: 0, bad: 0, discarded: 0, repeated: 0, delivered: 0 },
            last_heard: now,
            last_said: now,
            round_trip: RoundTrip::new(),
            outbox: Outbox::new(),
            urgent: UrgentBox::new(),
            urgent_ack: None,
            telemetry: None,
            handshake: None,
            reset: None,
            expected: 0,
            owed: Owed::Nothing,
        };
        Self { decoder: Decoder::new(), half }
    }

    /// Opens a session with nothing under way; one that was open is forgotten.
    pub fn open(&mut self, session: u32, now: Micros) {
        self.half.remember_replaced(session);
        self.close();
        self.half.session = Some(session);
        self.half.last_heard = now;
    }

    /// Ends the session; what was under way is dropped.
    pub fn close(&mut self) {
        let half = &mut self.half;
        half.session = None;
        half.round_trip = RoundTrip::new();
        half.outbox.clear();
        half.longest = MAX_PAYLOAD;
        half.urgent.clear();
        half.telemetry = None;
        half.expected = 0;
        half.owed = Owed::Nothing;
    }

    /// This session was open once and another one replaced it: a hello of it is an old one that comes late, and
    /// opening it again would let its commands be executed twice (S11).
    pub fn was_replaced(&self, session: u32) -> bool {
        session != NO_SESSION && self.half.replaced.contains(&session)
    }

    /// Heeds what the other end can take in: frames under way at once, and bytes of payload in one. To be called
    /// once the session is open, and forgotten with it.
    pub fn heed(&mut self, buffers: Buffers) {
        self.half.outbox.narrow(usize::from(buffers.window));
        self.half.longest = usize::from(buffers.payload).min(MAX_PAYLOAD);
    }

    /// The open session.
    pub fn session(&self) -> Option<u32> {
        self.half.session
    }

    /// When a frame of this session last arrived.
    pub fn last_heard(&self) -> Micros {
        self.half.last_heard
    }

    /// What the link has seen.
    pub fn counters(&self) -> LinkCounters {
        let (repeated, delivered) = self.half.outbox.totals();
        LinkCounters { repeated, delivered, ..self.half.counters }
    }

    /// How many more messages [`Self::send`] takes now.
    pub fn room(&self) -> usize {
        self.half.outbox.room()
    }

    /// Everything that was sent for sure has been acknowledged.
    pub fn is_settled(&self) -> bool {
        self.half.outbox.is_empty() && self.half.urgent.is_empty()
    }

    /// Takes a message that arrives for sure, once and in order.
    ///
    /// # Errors
    /// No session, no room, or a message that is too long.
    pub fn send<T: Serialize + ?Sized>(&mut self, message: &T) -> Result<(), SendError> {
        self.half.session.ok_or(SendError::Closed)?;
        let payload = encode_payload(message).ok_or(SendError::TooLong)?;
        if payload.len() > self.half.longest {
            return Err(SendError::TooLong);
        }
        self.half.outbox.push(payload)
    }

    /// Takes a message that overtakes all others.
    ///
    /// # Errors
    /// No room, or a message that is too long.
    pub fn send_urgent<T: Serialize + ?Sized>(&mut self, message: &T) -> Result<(), SendError> {
        let payload = encode_payload(message).ok_or(SendError::TooLong)?;
        self.half.urgent.push(payload)
    }

    /// Takes a message that may be lost; one that still waits is replaced.
    ///
    /// # Errors
    /// No session, or a message that is too long.
    pub fn send_telemetry<T: Serialize + ?Sized>(&mut self, message: &T) -> Result<(), SendError> {
        self.half.session.ok_or(SendError::Closed)?;
        self.half.telemetry = Some(encode_payload(message).ok_or(SendError::TooLong)?);
        Ok(())
    }

    /// Sends a hello, once; the caller repeats it until it is answered.
    ///
    /// # Errors
    /// A message that is too long.
    pub fn send_hello<T: Serialize + ?Sized>(&mut self, session: u32, message: &T) -> Result<(), SendError> {
        let payload = encode_payload(message).ok_or(SendError::TooLong)?;
        self.half.handshake = Some((FrameKind::Hello, session, payload));
        Ok(())
    }

    /// Answers the hello of a session, once.
    ///
    /// # Errors
    /// A message that is too long.
    pub fn send_hello_reply<T: Serialize + ?Sized>(
        &mut self,
        session: u32,
        message: &T,
    ) -> Result<(), SendError> {
        let payload = encode_payload(message).ok_or(SendError::TooLong)?;
        self.half.handshake = Some((FrameKind::HelloReply, session, payload));
        Ok(())
    }

    /// Takes bytes off the front of `bytes` until something arrived that the caller must know. `None`: `bytes`
    /// is used up. With `accept` false, reliable messages are turned away and will be sent again: for a caller
    /// that has no room for the answer.
    pub fn receive<'a>(&'a mut self, now: Micros, bytes: &mut &[u8], accept: bool) -> Option<Received<'a>> {
        self.receive_by(now, bytes, if accept { Accept::Always } else { Accept::Never })
    }

    /// As [`Self::receive`], for a caller that answers every reliable message with one of its own: one that finds no
    /// room for its answer is turned away and will be sent again.
    pub fn receive_with_room<'a>(&'a mut self, now: Micros, bytes: &mut &[u8]) -> Option<Received<'a>> {
        self.receive_by(now, bytes, Accept::WithRoom)
    }

    fn receive_by<'a>(&'a mut self, now: Micros, bytes: &mut &[u8], accept: Accept) -> Option<Received<'a>> {
        loop {
            let Ok(header) = self.decoder.next(bytes)? else {
                self.half.counters.bad = self.half.counters.bad.wrapping_add(1);
                self.half.owe_nack();
                continue;
            };
            self.half.counters.good = self.half.counters.good.wrapping_add(1);
            let route = self.half.take(now, header, accept);
            if !matches!(route, Route::Nowhere) {
                return self.deliver(route, header.session);
            }
        }
    }

    fn deliver(&self, route: Route, session: u32) -> Option<Received<'_>> {
        let payload = self.decoder.payload();
        match route {
            Route::Nowhere => None,
            Route::Hello => Some(Received::Hello(session, payload)),
            Route::HelloReply => Some(Received::HelloReply(session, payload)),
            Route::Message => Some(Received::Message(payload)),
            Route::Urgent => Some(Received::Urgent(payload)),
            Route::Telemetry => Some(Received::Telemetry(payload)),
            Route::Reset => Some(Received::Reset),
        }
    }

    /// Writes the next frame that is due into `out`, which has room for [`crate::MAX_ENCODED`] bytes, and
    /// returns its length; 0 when nothing is due.
    pub fn poll_transmit(&mut self, now: Micros, out: &mut [u8]) -> usize {
        self.half.next_frame(now, out).unwrap_or(0)
    }

    /// When [`Self::poll_transmit`] will next have something to send, if nothing else happens before.
    pub fn poll_timeout(&self, now: Micros) -> Option<Micros> {
        self.half.next_time(now)
    }
}

impl Half {
    /// Another session than the open one is opened: the open one is over for good.
    fn remember_replaced(&mut self, by: u32) {
        if let Some(session) = self.session.filter(|session| *session != by) {
            self.replaced.rotate_right(1);
            if let Some(latest) = self.replaced.first_mut() {
                *latest = session;
            }
        }
    }

    fn take(&mut self, now: Micros, header: Header, accept: Accept) -> Route {
        match header.kind {
            FrameKind::Hello => return Route::Hello,
            FrameKind::HelloReply => return Route::HelloReply,
            // A stop is obeyed whoever says it.
            FrameKind::Urgent if header.session == NO_SESSION => return self.take_urgent(header),
            FrameKind::Reset if self.session == Some(header.session) => return Route::Reset,
            FrameKind::Reset => return Route::Nowhere,
            _ if self.session != Some(header.session) => return self.refuse_stranger(header),
            _ => {}
        }
        self.last_heard = now;
        if header.kind != FrameKind::UrgentAck {
            self.outbox.acknowledged(header.ack, now, &mut self.round_trip);
        }
        match header.kind {
            FrameKind::Data => {
                let accept = match accept {
                    Accept::Always => true,
                    Accept::Never => false,
                    Accept::WithRoom => self.outbox.room() > 0,
                };
                self.take_data(header.seq, accept)
            }
            FrameKind::Nack => {
                self.outbox.go_back_on_request(now);
                Route::Nowhere
            }
            FrameKind::Urgent => self.take_urgent(header),
            FrameKind::UrgentAck => {
                self.urgent.acknowledged(header.seq);
                Route::Nowhere
            }
            FrameKind::Telemetry => Route::Telemetry,
            FrameKind::Ack | FrameKind::Hello | FrameKind::HelloReply | FrameKind::Reset => Route::Nowhere,
        }
    }

    fn refuse_stranger(&mut self, header: Header) -> Route {
        self.counters.discarded = self.counters.discarded.wrapping_add(1);
        match header.kind {
            FrameKind::Urgent => self.take_urgent(header),
            // An urgent ack is no claim to a session.
            FrameKind::UrgentAck if header.session == NO_SESSION => {
                self.urgent.acknowledged(header.seq);
                Route::Nowhere
            }
            _ => {
                self.reset = Some(header.session);
                Route::Nowhere
            }
        }
    }

    fn take_urgent(&mut self, header: Header) -> Route {
        self.urgent_ack = Some((header.session, header.seq));
        Route::Urgent
    }

    fn take_data(&mut self, seq: u8, accept: bool) -> Route {
        if seq == self.expected && accept {
            self.expected = self.expected.wrapping_add(1);
            self.owed = Owed::Ack;
            return Route::Message;
        }
        self.counters.discarded = self.counters.discarded.wrapping_add(1);
        // A frame from behind was a repetition, its ack was lost; one from ahead means that one is missing.
        let ahead = seq.wrapping_sub(self.expected);
        if seq != self.expected && usize::from(ahead) < WINDOW {
            self.owe_nack();
        } else if self.owed == Owed::Nothing {
            self.owed = Owed::Ack;
        }
        Route::Nowhere
    }

    fn owe_nack(&mut self) {
        if self.session.is_some() {
            self.owed = Owed::Nack;
        }
    }

    fn next_time(&self, now: Micros) -> Option<Micros> {
        let at_once = self.urgent_ack.is_some() || self.reset.is_some() || self.handshake.is_some();
        if at_once || self.owed != Owed::Nothing || self.telemetry.is_some() {
            return Some(now);
        }
        let keep_alive = self.session.map(|_| self.last_said.plus(KEEP_ALIVE));
        let times = [
            self.urgent.next_time(now, &self.round_trip),
            self.outbox.next_time(now, &self.round_trip),
            keep_alive,
        ];
        times.into_iter().flatten().min()
    }

    fn next_frame(&mut self, now: Micros, out: &mut [u8]) -> Option<usize> {
        let ack = self.expected;
        let session = self.session.unwrap_or(NO_SESSION);
        let header = |kind, session, seq| Header { kind, session, seq, ack };
        if let Some((session, seq)) = self.urgent_ack.take() {
            return encode(header(FrameKind::UrgentAck, session, seq), &[], out);
        }
        if let Some((seq, payload)) = self.urgent.next(now, &self.round_trip) {
            return encode(header(FrameKind::Urgent, session, seq), payload, out);
        }
        if let Some(stranger) = self.reset.take() {
            return encode(header(FrameKind::Reset, stranger, 0), &[], out);
        }
        if let Some((kind, session, payload)) = self.handshake.take() {
            return encode(header(kind, session, 0), &payload, out);
        }
        self.session?;
        if self.owed == Owed::Nack {
            return self.plain(now, FrameKind::Nack, out);
        }
        self.outbox.check_timeout(now, &mut self.round_trip);
        if let Some((seq, payload)) = self.outbox.next(now) {
            self.last_said = now;
            self.owed = Owed::Nothing;
            return encode(header(FrameKind::Data, session, seq), payload, out);
        }
        if self.owed == Owed::Ack {
            return self.plain(now, FrameKind::Ack, out);
        }
        if let Some(payload) = self.telemetry.take() {
            self.last_said = now;
            return encode(header(FrameKind::Telemetry, session, 0), &payload, out);
        }
        if now >= self.last_said.plus(KEEP_ALIVE) {
            return self.plain(now, FrameKind::Ack, out);
        }
        None
    }

    /// A frame without payload, which says what has arrived.
    fn plain(&mut self, now: Micros, kind: FrameKind, out: &mut [u8]) -> Option<usize> {
        self.last_said = now;
        self.owed = Owed::Nothing;
        let session = self.session.unwrap_or(NO_SESSION);
        encode(Header { kind, session, seq: 0, ack: self.expected }, &[], out)
    }
}

impl Hash for Half {
    fn hash<H: Hasher>(&self, state: &mut H) {
        (self.session, self.replaced, self.longest, self.last_heard, self.last_said).hash(state);
        (&self.round_trip, &self.outbox, &self.urgent, &self.urgent_ack, &self.telemetry).hash(state);
        (&self.handshake, self.reset, self.expected, self.owed).hash(state);
    }
}
