//! The core: raw bytes, good frames, requests in sequence, readings and the time between them, in any order. Nothing is on
//! unless Armed or Running, and no call says more than the link's window and seven frames.
//!
//! | byte | what follows | |
//! |---|---|---|
//! | 0 | n, n bytes | raw bytes |
//! | 1 | kind, session, seq, n, n bytes | a good frame |
//! | 2 | u16 | so many milliseconds pass, with control ticks between |
//! | 3 | u16, u16, u8 | readings of two thermistors; stop button |
//! | 4 | n, n bytes | a request in sequence |
//! | 5 | session | a hello |

#[path = "../../firmware/core/tests/a_board/mod.rs"]
mod a_board;

use zygote_core::{Core, Duty, Inputs};
use zygote_protocol::{
    Decoder, FrameKind, Header, Hello, MAX_ENCODED, MAX_PAYLOAD, Micros, Milliamps, Millis, Millivolts,
    State, WINDOW, encode,
};

const KINDS: [FrameKind; 9] = [
    FrameKind::Hello,
    FrameKind::HelloReply,
    FrameKind::Data,
    FrameKind::Ack,
    FrameKind::Nack,
    FrameKind::Urgent,
    FrameKind::UrgentAck,
    FrameKind::Telemetry,
    FrameKind::Reset,
];
/// The control tick, as slow as it may be.
const TICK: Millis = Millis(5);
/// Time that passes for one input at most.
const MOST: Micros = Micros(20_000_000);

type TheCore = Core<2, 1, 1, 8>;

struct Rig {
    core: TheCore,
    now: Micros,
    thermistors: [u16; 2],
    stop_pressed: bool,
    session: u32,
    /// Numbers of the next request and of the next frame of the MCU.
    seq: u8,
    ack: u8,
}

impl Rig {
    fn new() -> Self {
        let core = Core::new(a_board::config(2, 1, 1), Micros(0), None);
        Self {
            core,
            now: Micros(0),
            thermistors: [2_048; 2],
            stop_pressed: false,
            session: 1,
            seq: 0,
            ack: 0,
        }
    }

    fn frame(&mut self, header: Header, payload: &[u8]) {
        let mut out = [0; MAX_ENCODED];
        let length = encode(header, payload, &mut out).expect("the payload was cut to fit");
        self.core.handle_bytes(self.now, &out[..length]);
        self.store();
        self.drain();
    }

    /// What a board does with what is to be kept; with its stop button pressed it can't.
    fn store(&mut self) {
        if self.core.to_store().is_some() {
            self.hold();
            self.core.stored(!self.stop_pressed);
        }
    }

    /// Takes what the core says, and acknowledges it with the next request.
    fn drain(&mut self) {
        let mut out = [0; MAX_ENCODED];
        for said in 0.. {
            let length = self.core.poll_transmit(self.now, &mut out);
            if length == 0 {
                break;
            }
            assert!(said < WINDOW + 7, "more than {said} frames at once");
            let header =
                Decoder::new().next(&mut &out[..length]).expect("a whole frame").expect("a good frame");
            if header.kind == FrameKind::Data && header.session == self.session && header.seq == self.ack {
                self.ack = self.ack.wrapping_add(1);
            }
        }
        assert!(
            self.core.poll_timeout(self.now).is_none_or(|due| due > self.now),
            "something is due and not said"
        );
    }

    fn pass(&mut self, time: Millis) {
        // Long enough for a whole run, and short enough to try many.
        let until = self.now.plus(time).min(MOST);
        while self.now < until {
            self.now = self.now.plus(TICK).min(until);
            let inputs = Inputs {
                thermistors: &self.thermistors,
                supply: Millivolts(5_000),
                current: Milliamps(0),
                stop_pressed: self.stop_pressed,
                servos_lost: false,
            };
            self.core.tick(self.now, &inputs);
            self.drain();
            self.hold();
        }
    }

    /// S2.
    fn hold(&self) {
        let outputs = self.core.outputs();
        let heating = outputs.heaters.iter().any(|duty| *duty != Duty::OFF);
        let driving = outputs.servos.iter().any(Option::is_some) || outputs.springs.contains(&true);
        match self.core.state() {
            State::Running => {}
            State::Armed => assert!(!heating && !driving),
            State::Idle | State::Loaded | State::Finished | State::Safe => {
                assert!(!heating && !driving && !outputs.main_switch);
            }
        }
    }
}

/// Takes `n` bytes off the front.
fn take<'a>(data: &mut &'a [u8], n: usize) -> Option<&'a [u8]> {
    let (front, rest) = data.split_at_checked(n)?;
    *data = rest;
    Some(front)
}

fn byte(data: &mut &[u8]) -> Option<u8> {
    take(data, 1).and_then(|bytes| bytes.first().copied())
}

fn word(data: &mut &[u8]) -> Option<u16> {
    Some(u16::from_le_bytes([byte(data)?, byte(data)?]))
}

/// A length and so many bytes, or as many as there are.
fn bytes<'a>(data: &mut &'a [u8]) -> Option<&'a [u8]> {
    let n = usize::from(byte(data)?).min(MAX_PAYLOAD).min(data.len());
    take(data, n)
}

fn event(rig: &mut Rig, data: &mut &[u8]) -> Option<()> {
    match byte(data)? % 6 {
        0 => {
            rig.core.handle_bytes(rig.now, bytes(data)?);
            rig.store();
            rig.drain();
        }
        1 => {
            let kind = *KINDS.get(usize::from(byte(data)?) % KINDS.len())?;
            let header = Header { kind, session: u32::from(byte(data)?), seq: byte(data)?, ack: rig.ack };
            rig.frame(header, bytes(data)?);
        }
        2 => rig.pass(Millis(u32::from(word(data)? % 2_000))),
        3 => {
            rig.thermistors = [word(data)?, word(data)?];
            rig.stop_pressed = byte(data)? == 255;
        }
        4 => {
            let payload = bytes(data)?;
            let header = Header { kind: FrameKind::Data, session: rig.session, seq: rig.seq, ack: rig.ack };
            rig.frame(header, payload);
            rig.seq = rig.seq.wrapping_add(1);
        }
        _ => {
            let session = u32::from(byte(data)?);
            let mut payload = [0; 16];
            let hello = postcard::to_slice(&Hello::ours(), &mut payload).ok()?.to_vec();
            rig.frame(Header { kind: FrameKind::Hello, session, seq: 0, ack: 0 }, &hello);
            if rig.session != session {
                (rig.session, rig.seq, rig.ack) = (session, 0, 0);
            }
        }
    }
    rig.hold();
    Some(())
}

/// One event after the other until the bytes are used up.
pub(crate) fn check(mut data: &[u8]) {
    let mut rig = Rig::new();
    while event(&mut rig, &mut data).is_some() {}
}
