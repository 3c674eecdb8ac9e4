//! A core with one channel of each kind and a host that talk without a line between them: for tests.

use crate::a_board;
use zygote_core::{Core, Inputs};
use zygote_protocol::{
    Command, Link, Micros, Milliamps, Millis, Millivolts, Received, Refusal, Reply, Report, Request,
    Response, decode_payload, granted_session,
};

type TheCore = Core<1, 1, 1, 4>;
pub(crate) type Answer = Result<Reply, Refusal>;

const BOOT: u32 = 0;

/// A core and a host that talk without a line between them.
pub(crate) struct Bench {
    pub(crate) core: TheCore,
    host: Link,
    now: Micros,
    id: u16,
}

impl Bench {
    /// With an open session.
    pub(crate) fn new() -> Self {
        let core = Core::new(a_board::config(1, 1, 1), Micros(0), None);
        let mut bench = Self { core, host: Link::new(Micros(0)), now: Micros(1_000), id: 0 };
        bench.open(5);
        bench
    }

    /// Opens a session.
    pub(crate) fn open(&mut self, asked: u32) {
        self.host.send_hello(asked, &zygote_protocol::Hello::ours()).unwrap();
        self.carry();
        self.host.open(granted_session(asked, BOOT), self.now);
        self.carry();
    }

    /// Carries all that there is to say both ways; the responses.
    pub(crate) fn carry(&mut self) -> Vec<Response> {
        let (mut frame, mut responses) = ([0; zygote_protocol::MAX_ENCODED], Vec::new());
        loop {
            let length = self.host.poll_transmit(self.now, &mut frame);
            self.core.handle_bytes(self.now, &frame[..length]);
            let back = self.core.poll_transmit(self.now, &mut frame);
            let mut bytes = &frame[..back];
            while let Some(received) = self.host.receive(self.now, &mut bytes, true) {
                if let Received::Message(payload) = received
                    && let Some(Report::Response(response)) = decode_payload(payload)
                {
                    responses.push(response);
                }
            }
            if length == 0 && back == 0 {
                return responses;
            }
        }
    }

    /// Sends a command; its number.
    pub(crate) fn send(&mut self, command: Command) -> u16 {
        self.id += 1;
        self.host.send(&Request { id: self.id, command }).unwrap();
        self.id
    }

    /// Sends a command and takes its answer.
    pub(crate) fn ask(&mut self, command: Command) -> Answer {
        let id = self.send(command);
        let responses = self.carry();
        assert_eq!(responses.iter().map(|response| response.id).collect::<Vec<_>>(), [id]);
        responses.into_iter().next().unwrap().result
    }

    /// A millisecond passes, and the thermistor reads this.
    pub(crate) fn tick(&mut self, counts: u16, servos_lost: bool) {
        let inputs = Inputs {
            thermistors: &[counts],
            supply: Millivolts(12_000),
            current: Milliamps(0),
            stop_pressed: false,
            servos_lost,
        };
        self.now = self.now.plus(Millis(1));
        self.core.tick(self.now, &inputs);
    }
}
