//! What happens to the core, and a host and a rig that let it happen.

use crate::call::CHANNELS;
use crate::pair::{Pair, PairError};
use crate::target::Applied;
use zygote_core::Inputs;
use zygote_protocol::{
    Command, Decoder, FrameKind, Header, Hello, MAX_ENCODED, MAX_PAYLOAD, Micros, Milliamps, Millivolts,
    NO_SESSION, Request, encode, granted_session,
};

/// Bytes that a board hands over at once.
pub(crate) const BUFFER: usize = 128;
/// The boot id at the start of every sequence.
pub(crate) const BOOT: u32 = 7;
/// A reading at about 25 °C.
pub(crate) const ROOM: u16 = 2_048;

/// One thing that happens.
#[derive(Debug, Clone)]
pub(crate) enum Event {
    Hello(u32),
    /// Requests in sequence, in one go.
    Requests(Vec<Command>),
    /// The payload of a request in sequence, whatever it is.
    Payload(Vec<u8>),
    /// A good frame out of sequence, of the session that a hello of this number opens.
    Frame {
        kind: FrameKind,
        session: u32,
        seq: u8,
        payload: Vec<u8>,
    },
    /// Any bytes, in one go.
    Raw(&'static str, Vec<u8>),
    /// So many control ticks, so many milliseconds apart; heaters heat and what isn't heated cools.
    Pass {
        ticks: u16,
        every_ms: u16,
    },
    /// From now on the thermistors read this; `None`, what the rig has.
    Readings(Option<[u16; CHANNELS]>),
    Current(u32),
    StopButton(bool),
    /// The host acknowledges what it hears, or doesn't.
    Listens(bool),
    Reset,
}

/// A host that is in session with the core, and the rig.
pub(crate) struct Host<'a> {
    pair: &'a mut Pair,
    now: Micros,
    boot: u32,
    session: u32,
    seq: u8,
    ack: u8,
    listens: bool,
    rig: [u16; CHANNELS],
    read_as: Option<[u16; CHANNELS]>,
    current: u32,
    stop_pressed: bool,
}

impl<'a> Host<'a> {
    pub(crate) fn new(pair: &'a mut Pair) -> Result<Self, PairError> {
        pair.power_off(Micros(0), BOOT)?;
        Ok(Self {
            pair,
            now: Micros(0),
            boot: BOOT,
            session: NO_SESSION,
            seq: 0,
            ack: 0,
            listens: true,
            rig: [ROOM; CHANNELS],
            read_as: None,
            current: 0,
            stop_pressed: false,
        })
    }

    pub(crate) fn play(&mut self, events: &[Event]) -> Result<(), PairError> {
        events.iter().try_for_each(|event| self.event(event))
    }

    fn event(&mut self, event: &Event) -> Result<(), PairError> {
        match event {
            Event::Hello(session) => {
                let granted = granted_session(*session, self.boot);
                if self.session != granted {
                    (self.session, self.seq, self.ack) = (granted, 0, 0);
                }
                let mut payload = [0; MAX_PAYLOAD];
                let payload = postcard::to_slice(&Hello::ours(), &mut payload).map_or(&[][..], |bytes| bytes);
                let bytes =
                    framed(Header { kind: FrameKind::Hello, session: *session, seq: 0, ack: 0 }, payload);
                self.say("hello", &bytes)
            }
            Event::Requests(commands) => {
                let mut bytes = Vec::new();
                for command in commands {
                    let request = Request { id: u16::from(self.seq), command: command.clone() };
                    let mut payload = [0; MAX_PAYLOAD];
                    let payload = postcard::to_slice(&request, &mut payload).map_or(&[][..], |bytes| bytes);
                    bytes.extend(self.data(payload));
                }
                self.say(name(commands), &bytes)
            }
            Event::Payload(payload) => {
                let bytes = self.data(payload);
                self.say("any request", &bytes)
            }
            Event::Frame { kind, session, seq, payload } => {
                let session =
                    if *session == NO_SESSION { NO_SESSION } else { granted_session(*session, self.boot) };
                let header = Header { kind: *kind, session, seq: *seq, ack: self.ack };
                self.say("any frame", &framed(header, payload))
            }
            Event::Raw(what, bytes) => self.say(what, bytes),
            Event::Pass { ticks, every_ms } => (0..*ticks).try_for_each(|_| self.tick(*every_ms)),
            Event::Reset => {
                self.boot = self.boot.wrapping_add(1);
                self.pair.reset(self.now, self.boot)
            }
            Event::Readings(read_as) => {
                self.read_as = *read_as;
                Ok(())
            }
            Event::Current(current) => {
                self.current = *current;
                Ok(())
            }
            Event::StopButton(pressed) => {
                self.stop_pressed = *pressed;
                Ok(())
            }
            Event::Listens(listens) => {
                self.listens = *listens;
                Ok(())
            }
        }
    }

    fn data(&mut self, payload: &[u8]) -> Vec<u8> {
        let header = Header { kind: FrameKind::Data, session: self.session, seq: self.seq, ack: self.ack };
        self.seq = self.seq.wrapping_add(1);
        framed(header, payload)
    }

    /// As a board hands it over.
    fn say(&mut self, what: &'static str, bytes: &[u8]) -> Result<(), PairError> {
        for buffer in bytes.chunks(BUFFER) {
            self.pair.handle_bytes(self.now, what, buffer)?;
        }
        self.hear()
    }

    fn tick(&mut self, every_ms: u16) -> Result<(), PairError> {
        self.now = self.now.plus(zygote_protocol::Millis(every_ms.into()));
        let thermistors = self.read_as.unwrap_or(self.rig);
        let inputs = Inputs {
            thermistors: &thermistors,
            supply: Millivolts(5_000),
            current: Milliamps(self.current),
            stop_pressed: self.stop_pressed,
            servos_lost: false,
        };
        let applied = self.pair.tick(self.now, &inputs)?;
        self.warm(&applied);
        self.hear()
    }

    /// A hinge that is heated gets warmer by about half a degree a tick, or cools towards the room.
    fn warm(&mut self, applied: &Applied) {
        for (counts, duty) in self.rig.iter_mut().zip(applied.heaters) {
            if duty > 0 {
                *counts -= *counts / 50;
            } else {
                *counts += (ROOM - *counts) / 50;
            }
        }
    }

    /// Everything that the core has to say.
    fn hear(&mut self) -> Result<(), PairError> {
        loop {
            let bytes = self.pair.poll_transmit(self.now)?;
            if bytes.is_empty() {
                return Ok(());
            }
            if let Some(Ok(header)) = Decoder::new().next(&mut bytes.as_slice()) {
                let is_next = header.session == self.session && header.seq == self.ack;
                if self.listens && header.kind == FrameKind::Data && is_next {
                    self.ack = self.ack.wrapping_add(1);
                }
            }
        }
    }
}

/// A frame; nothing where the payload is too long for one.
pub(crate) fn framed(header: Header, payload: &[u8]) -> Vec<u8> {
    let mut out = [0; MAX_ENCODED];
    let length = encode(header, payload, &mut out).unwrap_or(0);
    out.get(..length).unwrap_or_default().to_vec()
}

fn name(commands: &[Command]) -> &'static str {
    let [command] = commands else { return "several requests" };
    match command {
        Command::Status => "Status",
        Command::Progress { .. } => "Progress",
        Command::Upload { .. } => "Upload",
        Command::Steps { .. } => "Steps",
        Command::Commit => "Commit",
        Command::Arm { .. } => "Arm",
        Command::Start { .. } => "Start",
        Command::Disarm => "Disarm",
        Command::Clear => "Clear",
        Command::LastRun => "LastRun",
        Command::Settings => "Settings",
        Command::Configure(_) => "Configure",
        Command::Readings { .. } => "Readings",
        Command::Memory => "Memory",
        Command::Calibration(_) => "Calibration",
        Command::Calibrate(_) => "Calibrate",
    }
}
