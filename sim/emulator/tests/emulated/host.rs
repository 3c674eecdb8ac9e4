//! A small host for tests: sends requests over the real link, collects what comes back, in the emulated board's time.

use std::path::PathBuf;
use zygote_emulator::{EmulatedBoard, Image};
use zygote_protocol::{
    Action, CentiCelsius, Command, Event, Fault, Heat, Hello, HelloReply, Identity, Limits, Link,
    MAX_ENCODED, Micros, Milliamps, Millis, Received, Refusal, Reply, Report, Request, Response, Snapshot,
    State, Step, Telemetry, Urgent, decode_payload, granted_session, program_crc,
};
use zygote_sim::plant::{Config, SmaConfig};

pub(crate) const RIG: &str = "test-rig";

pub(crate) const LIMITS: Limits = Limits {
    max_temperature: CentiCelsius(12_000),
    max_on: Millis(20_000),
    min_rest: Millis(500),
    supply: Milliamps(2_000),
    link_timeout: Millis(1_000),
};

/// The program under test.
pub(crate) fn program() -> PathBuf {
    std::env::var_os("ZYGOTE_BOARD_ELF").map_or_else(
        || {
            PathBuf::from(env!("CARGO_MANIFEST_DIR"))
                .join("../../target/firmware/thumbv7em-none-eabihf/release/zygote-nucleo-f446re")
        },
        PathBuf::from,
    )
}

/// A rig of four SMA hinges.
pub(crate) fn plant() -> Config {
    Config { heaters: vec![SmaConfig::opening(90.0); 4], seed: 7, ..Config::default() }
}

/// An SMA step that a hinge of the plant's defaults completes.
pub(crate) fn heat(channel: u16, after: &[u16]) -> Step {
    let action = Action::Heat(Heat {
        channel,
        target: CentiCelsius(9_500),
        hold: Millis(1_000),
        max_on: Millis(20_000),
        max_temperature: CentiCelsius(12_000),
        cool: CentiCelsius(4_500),
        rest: Millis(1_000),
        min_gain: CentiCelsius(500),
        gain_window: Millis(3_000),
        current: Milliamps(200),
    });
    Step { hinge: channel, after: after.iter().copied().collect(), action }
}

/// A host and the board that it talks to.
pub(crate) struct Host {
    pub(crate) board: EmulatedBoard,
    pub(crate) faults: Vec<Fault>,
    pub(crate) events: Vec<Event>,
    pub(crate) telemetry: Vec<Telemetry>,
    /// All that came over the line, with when.
    pub(crate) heard: Vec<(Micros, Vec<u8>)>,
    /// The cable is plugged in.
    pub(crate) connected: bool,
    pub(crate) identity: Option<Identity>,
    link: Link,
    responses: Vec<Response>,
    next_id: u16,
}

impl Host {
    /// With a board that has just been switched on.
    pub(crate) fn new(plant: &Config) -> Self {
        let image = Image::open(&program()).unwrap();
        Self {
            board: EmulatedBoard::new(&image, plant, 1).unwrap(),
            faults: Vec::new(),
            events: Vec::new(),
            telemetry: Vec::new(),
            heard: Vec::new(),
            connected: true,
            identity: None,
            link: Link::new(Micros(0)),
            responses: Vec::new(),
            next_id: 0,
        }
    }

    /// Connected to a board that has started.
    pub(crate) fn connected(plant: &Config) -> Self {
        let mut host = Self::new(plant);
        host.pass(Millis(20));
        host.connect(77);
        host
    }

    /// Opens a session. A board that has just started may miss a hello, so it is said again and again.
    pub(crate) fn connect(&mut self, session: u32) {
        self.identity = None;
        self.link = Link::new(self.board.now());
        for _ in 0..20 {
            self.link.send_hello(session, &Hello::ours()).unwrap();
            self.pass(Millis(50));
            if self.identity.is_some() {
                break;
            }
        }
        let boot = self.identity.as_ref().unwrap().boot;
        self.link.open(granted_session(session, boot), self.board.now());
    }

    fn exchange(&mut self) {
        let now = self.board.now();
        let mut frame = [0; MAX_ENCODED];
        loop {
            let length = self.link.poll_transmit(now, &mut frame);
            if length == 0 {
                break;
            }
            if self.connected {
                self.board.receive(&frame[..length]);
            }
        }
        let mut back = Vec::new();
        self.board.transmit(&mut back);
        if self.connected && !back.is_empty() {
            self.take(&back);
            self.heard.push((now, back));
        }
    }

    fn take(&mut self, mut bytes: &[u8]) {
        let now = self.board.now();
        while let Some(received) = self.link.receive(now, &mut bytes, true) {
            match received {
                Received::Message(payload) => match decode_payload(payload).unwrap() {
                    Report::Response(response) => self.responses.push(response),
                    Report::Event(event) => self.events.push(event),
                },
                Received::Urgent(payload) => self.faults.push(decode_payload(payload).unwrap()),
                Received::Telemetry(payload) => self.telemetry.push(decode_payload(payload).unwrap()),
                Received::HelloReply(_, payload) => {
                    let reply: HelloReply = decode_payload(payload).unwrap();
                    self.identity = Some(reply.identity);
                }
                Received::Hello(..) | Received::Reset => {}
            }
        }
    }

    /// Lets time pass, with the line alive.
    pub(crate) fn pass(&mut self, span: Millis) {
        let until = self.board.now().plus(span);
        while self.board.now() < until {
            self.board.advance(until).unwrap();
            self.exchange();
        }
    }

    /// Lets time pass until something holds, and returns how long it took; panics after `most`.
    pub(crate) fn pass_until(&mut self, most: Millis, mut holds: impl FnMut(&mut Self) -> bool) -> Millis {
        let start = self.board.now();
        while !holds(self) {
            assert!(self.board.now() < start.plus(most), "it didn't come to pass within {most}");
            self.pass(Millis(1));
        }
        Millis(u32::try_from(self.board.now().since(start) / 1000).unwrap())
    }

    pub(crate) fn ask(&mut self, command: Command) -> Result<Reply, Refusal> {
        let id = self.next_id;
        self.next_id += 1;
        self.link.send(&Request { id, command }).unwrap();
        for _ in 0..2_000 {
            self.pass(Millis(1));
            if let Some(at) = self.responses.iter().position(|response| response.id == id) {
                return self.responses.remove(at).result;
            }
        }
        panic!("no answer");
    }

    /// Uploads steps, up to the commit's answer.
    pub(crate) fn upload(&mut self, steps: &[Step]) -> Result<Reply, Refusal> {
        let count = u16::try_from(steps.len()).unwrap();
        let rig = RIG.try_into().unwrap();
        self.ask(Command::Upload { run: 5, rig, steps: count, crc: program_crc(steps) })?;
        for (first, chunk) in (0..).step_by(4).zip(steps.chunks(4)) {
            self.ask(Command::Steps { first, steps: chunk.iter().cloned().collect() })?;
        }
        self.ask(Command::Commit)
    }

    /// Uploads, arms and starts.
    pub(crate) fn run(&mut self, steps: &[Step]) {
        self.upload(steps).unwrap();
        self.ask(Command::Arm { rig: RIG.try_into().unwrap(), limits: LIMITS, lifetime: Millis(5_000) })
            .unwrap();
        self.ask(Command::Start { run: 5 }).unwrap();
    }

    /// Runs until the first heater is well warm.
    pub(crate) fn run_until_warm(&mut self, steps: &[Step]) {
        self.run(steps);
        self.pass_until(Millis(10_000), |host| host.board.plant().sma_hinges()[0].temperature_c() > 60.0);
    }

    pub(crate) fn stop(&mut self) {
        self.link.send_urgent(&Urgent::Stop).unwrap();
    }

    /// What the program is doing, by what it keeps in its memory.
    pub(crate) fn state(&self) -> State {
        self.board.snapshot().map_or(State::Idle, |snapshot| snapshot.state)
    }

    /// What the MCU says that it was doing before its latest reset.
    pub(crate) fn kept(&mut self) -> Snapshot {
        match self.ask(Command::LastRun) {
            Ok(Reply::LastRun(Some(snapshot))) => snapshot,
            other => panic!("{other:?}"),
        }
    }

    /// Nothing is energised: by the pins.
    pub(crate) fn all_off(&self) -> bool {
        self.board.drive() == zygote_emulator::Drive::OFF
    }
}
