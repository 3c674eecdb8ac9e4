//! A small host for tests: sends requests over the real link, collects what comes back, in virtual time.

use zygote_protocol::{
    Action, CentiCelsius, Channels, Command, Event, Fault, Heat, Hello, HelloReply, Identity, Limits, Link,
    MAX_ENCODED, Micros, Milliamps, Millis, Received, Refusal, Release, Reply, Report, Request, ResetCause,
    Response, Step, StepState, Telemetry, Turn, Urgent, decode_payload, granted_session, program_crc,
};
use zygote_sim::Board;
use zygote_sim::plant::{Config, ServoConfig, SmaConfig, SpringConfig};

pub(crate) const RIG: &str = "test-rig";

pub(crate) const LIMITS: Limits = Limits {
    max_temperature: CentiCelsius(12_000),
    max_on: Millis(20_000),
    min_rest: Millis(500),
    supply: Milliamps(2_000),
    link_timeout: Millis(1_000),
};

/// A rig of four SMA hinges, a servo and a spring.
pub(crate) fn plant() -> Config {
    Config {
        heaters: vec![SmaConfig::opening(90.0); 4],
        servos: vec![ServoConfig::default()],
        springs: vec![SpringConfig::opening(180.0)],
        seed: 7,
        ..Config::default()
    }
}

pub(crate) const CHANNELS: Channels = Channels { heaters: 4, servos: 1, springs: 1 };

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

pub(crate) fn turn(hinge: u16, after: &[u16]) -> Step {
    let action = Action::Turn(Turn {
        channel: 0,
        from_us: 500,
        to_us: 1_500,
        duration: Millis(1_000),
        settle: Millis(300),
        current: Milliamps(300),
        hold_current: Milliamps(10),
    });
    Step { hinge, after: after.iter().copied().collect(), action }
}

pub(crate) fn release(hinge: u16, after: &[u16]) -> Step {
    let action = Action::Release(Release {
        channel: 0,
        pulse: Millis(1_200),
        settle: Millis(500),
        current: Milliamps(1_000),
    });
    Step { hinge, after: after.iter().copied().collect(), action }
}

/// A host and the board that it talks to.
pub(crate) struct Host {
    pub(crate) board: Board,
    pub(crate) faults: Vec<Fault>,
    pub(crate) events: Vec<Event>,
    pub(crate) telemetry: Vec<Telemetry>,
    /// The cable is plugged in.
    pub(crate) connected: bool,
    /// Every frame of the host goes out so often.
    pub(crate) copies: usize,
    link: Link,
    responses: Vec<Response>,
    next_id: u16,
    identity: Option<Identity>,
    /// Every byte that it ever sent.
    pub(crate) said: Vec<u8>,
}

impl Host {
    /// Connected to a board on this plant.
    pub(crate) fn new(plant: &Config) -> Self {
        Self::of(Board::new(plant, CHANNELS, 1).unwrap())
    }

    /// Connected to this board.
    pub(crate) fn of(board: Board) -> Self {
        let mut host = Self {
            board,
            faults: Vec::new(),
            events: Vec::new(),
            telemetry: Vec::new(),
            connected: true,
            copies: 1,
            link: Link::new(Micros(0)),
            responses: Vec::new(),
            next_id: 0,
            identity: None,
            said: Vec::new(),
        };
        host.connect(77);
        host
    }

    /// Opens a session: asks for this number.
    pub(crate) fn connect(&mut self, session: u32) {
        self.link.send_hello(session, &Hello::ours()).unwrap();
        self.exchange();
        self.link.open(granted_session(session, self.boot()), self.board.now());
    }

    /// Why the MCU says that it started.
    pub(crate) fn reset_cause(&self) -> Option<ResetCause> {
        self.identity.as_ref().map(|identity| identity.reset)
    }

    /// The MCU's boot id.
    pub(crate) fn boot(&self) -> u32 {
        self.identity.as_ref().unwrap().boot
    }

    /// Sends and receives without letting time pass.
    pub(crate) fn exchange(&mut self) {
        let now = self.board.now();
        for _ in 0..20 {
            let mut frame = [0; MAX_ENCODED];
            loop {
                let length = self.link.poll_transmit(now, &mut frame);
                if length == 0 {
                    break;
                }
                self.said.extend_from_slice(&frame[..length]);
                for _ in 0..if self.connected { self.copies } else { 0 } {
                    self.board.receive(&frame[..length]);
                }
            }
            let mut back = Vec::new();
            self.board.transmit(&mut back);
            if back.is_empty() {
                return;
            }
            if self.connected {
                self.take(&back);
            }
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
                Received::Hello(..) | Received::Reset => panic!("{received:?}"),
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
            self.exchange();
            if let Some(at) = self.responses.iter().position(|response| response.id == id) {
                return self.responses.remove(at).result;
            }
            self.pass(Millis(1));
        }
        panic!("no answer");
    }

    pub(crate) fn step_states(&mut self) -> Vec<StepState> {
        match self.ask(Command::Progress { first: 0 }) {
            Ok(Reply::Progress { steps, .. }) => steps.iter().copied().collect(),
            other => panic!("{other:?}"),
        }
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

    pub(crate) fn arm(&mut self, limits: Limits) -> Result<Reply, Refusal> {
        self.ask(Command::Arm { rig: RIG.try_into().unwrap(), limits, lifetime: Millis(5_000) })
    }

    /// Uploads, arms and starts.
    pub(crate) fn run(&mut self, steps: &[Step]) {
        self.upload(steps).unwrap();
        self.arm(LIMITS).unwrap();
        self.ask(Command::Start { run: 5 }).unwrap();
    }

    /// Runs until the first heater is well warm.
    pub(crate) fn run_until_warm(&mut self, steps: &[Step]) {
        self.run(steps);
        self.pass_until(Millis(10_000), |host| host.board.plant().sma_hinges()[0].temperature_c() > 60.0);
    }

    pub(crate) fn stop(&mut self) {
        self.link.send_urgent(&Urgent::Stop).unwrap();
        self.exchange();
    }

    /// Nothing is energised: by the outputs, and by the current out of the supply.
    pub(crate) fn all_off(&self) -> bool {
        let outputs = self.board.core().outputs();
        !outputs.main_switch
            && outputs.heaters.iter().all(|duty| duty.per_mille() == 0)
            && outputs.servos.iter().all(Option::is_none)
            && outputs.springs.iter().all(|on| !on)
    }
}
