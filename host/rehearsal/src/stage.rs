//! The stage of a rehearsal: board, line, script and witness on one virtual clock.
//!
//! ```text
//!   host --Transport--> Line --> Board --> Plant
//!                        ^         ^         ^
//!                        +------ Script -----+     what goes wrong, when
//!                                Witness           what was truly the case
//! ```

use crate::board::BoardError;
use crate::cause::{Way, What};
use crate::script::Script;
use crate::subject::Subject;
use crate::witness::Witness;
use std::cell::Cell;
use std::rc::Rc;
use zygote_protocol::{Hello, Link, MAX_ENCODED, Micros, Urgent};
use zygote_sim::{Board, Chance, Device, Impairment, Line, Wire};

/// Session of a second host; that of the first one is another.
const SECOND_SESSION: u32 = 0xdead_beef;
/// Bytes of the host that are kept to be replayed.
const MOST_REPLAYED: usize = 1 << 16;

/// Everything but the host.
pub struct Stage<B = Board> {
    board: B,
    line: Line,
    script: Script,
    witness: Witness,
    chance: Chance,
    /// All that the host sent, to be replayed.
    tape: Vec<u8>,
    to_board: Vec<u8>,
    host_killed: bool,
    /// Bytes that have arrived at the host.
    pub(crate) arrived: Vec<u8>,
    user_stops: Rc<Cell<bool>>,
    /// The clock doesn't go on past this: a host that waits for ever has failed.
    end: Micros,
}

impl<B: Subject> Stage<B> {
    /// A board on a good line, with causes that wait; `seed` is that of all chance on the line.
    pub fn new(board: B, witness: Witness, script: Script, seed: u64) -> Self {
        Self {
            board,
            line: Line::new(seed),
            script,
            witness,
            chance: Chance::new(!seed),
            tape: Vec::new(),
            to_board: Vec::new(),
            host_killed: false,
            arrived: Vec::new(),
            user_stops: Rc::new(Cell::new(false)),
            end: Micros(u64::MAX),
        }
    }

    /// With an end of time.
    #[must_use]
    pub fn until(self, end: Micros) -> Self {
        Self { end, ..self }
    }

    /// The board, for a look at the truth.
    pub fn board(&self) -> &B {
        &self.board
    }

    /// The line, to make it worse.
    pub fn line_mut(&mut self) -> &mut Line {
        &mut self.line
    }

    /// What has happened.
    pub fn script(&self) -> &Script {
        &self.script
    }

    /// What was seen.
    pub fn witness(&self) -> &Witness {
        &self.witness
    }

    /// What was seen and what has happened, at the end.
    pub fn into_parts(self) -> (Witness, Script) {
        (self.witness, self.script)
    }

    /// Set when the user wants to stop.
    pub fn user_stops(&self) -> Rc<Cell<bool>> {
        Rc::clone(&self.user_stops)
    }

    /// The host's process was killed.
    pub fn host_is_killed(&self) -> bool {
        self.host_killed
    }

    /// The end of time has come.
    pub fn is_over(&self) -> bool {
        self.board.now() >= self.end
    }

    /// Takes bytes from the host.
    pub(crate) fn take_from_host(&mut self, bytes: &[u8]) -> Result<(), BoardError> {
        if self.tape.len() + bytes.len() <= MOST_REPLAYED {
            self.tape.extend_from_slice(bytes);
        }
        self.line.to_board.send(self.board.now(), bytes);
        self.settle()
    }

    /// Moves time on to `until`, or to the next thing that happens.
    pub(crate) fn step(&mut self, until: Micros) -> Result<(), BoardError> {
        let from = self.board.now();
        let arrivals = [self.line.to_board.next_arrival(), self.line.to_host.next_arrival()];
        let next = arrivals.into_iter().chain([self.script.next_time()]).flatten().min();
        let to = next.map_or(until, |next| next.min(until)).max(from);
        let then = self.board.state();
        self.board.advance(to)?;
        self.witness.look(from, self.board.state_meanwhile(then), &self.board);
        self.witness.look_at_decisions(&self.board);
        self.settle()
    }

    /// Lets everything happen that is due now.
    fn settle(&mut self) -> Result<(), BoardError> {
        loop {
            let now = self.board.now();
            let mut quiet = true;
            while let Some(what) = self.script.take(&self.board) {
                self.happen(&what)?;
                quiet = false;
            }
            while let Some(chunk) = self.line.to_board.take(now) {
                self.reach_board(&chunk);
                quiet = false;
            }
            self.to_board.clear();
            self.board.transmit(&mut self.to_board);
            if !self.to_board.is_empty() {
                self.line.to_host.send(now, &self.to_board);
            }
            while let Some(chunk) = self.line.to_host.take(now) {
                self.arrived.extend_from_slice(&chunk);
            }
            if quiet {
                return Ok(());
            }
        }
    }

    /// Frame by frame, so that no state between two of them goes unseen.
    fn reach_board(&mut self, bytes: &[u8]) {
        let now = self.board.now();
        for frame in bytes.split_inclusive(|byte| *byte == 0) {
            self.witness.heard.hear(now, self.board.boot(), frame);
            self.board.receive(frame);
            self.witness.look_at_decisions(&self.board);
        }
    }

    fn happen(&mut self, what: &What) -> Result<(), BoardError> {
        let now = self.board.now();
        self.witness.say(now, || format!("*** {what}"));
        match what {
            What::Break(fault) => self.board.plant_mut().inject(*fault)?,
            What::Hang(stuck) => self.board.hang(*stuck),
            What::Reset(cause) => self.board.reset(*cause),
            What::StopButton(pressed) => self.board.press_stop(*pressed),
            What::StopFrame => {
                let mut link = Link::new(now);
                // A stop fits a frame, and an empty link has room for it.
                link.send_urgent(&Urgent::Stop).ok();
                self.reach_board_from(&mut link);
            }
            What::Cut(way, span) => {
                let until = span.map_or(Micros(u64::MAX), |span| now.plus(span));
                self.wires(*way, |wire| wire.cut(until));
            }
            What::Impair(way, impairment) => self.wires(*way, |wire| wire.impair(*impairment)),
            What::KillHost => {
                self.line.kill_host();
                self.host_killed = true;
            }
            What::UserStops => self.user_stops.set(true),
            What::SecondHost => {
                let mut link = Link::new(now);
                link.send_hello(SECOND_SESSION, &Hello::ours()).ok();
                self.reach_board_from(&mut link);
            }
            What::Replay => {
                let tape = self.tape.clone();
                self.reach_board(&tape);
            }
            What::Garbage(count) => {
                let noise: Vec<u8> = (0..*count).map(|_| self.chance.bits().to_le_bytes()[0]).collect();
                self.reach_board(&noise);
            }
        }
        self.witness.look_at_decisions(&self.board);
        Ok(())
    }

    /// What another program on the same line has to say.
    fn reach_board_from(&mut self, link: &mut Link) {
        let mut frame = [0; MAX_ENCODED];
        let length = link.poll_transmit(self.board.now(), &mut frame);
        // The delimiter ends what another's cable left half-said.
        self.reach_board(&[0]);
        self.reach_board(frame.get(..length).unwrap_or_default());
    }

    fn wires(&mut self, way: Way, mut change: impl FnMut(&mut Wire)) {
        if matches!(way, Way::ToBoard | Way::Both) {
            change(&mut self.line.to_board);
        }
        if matches!(way, Way::ToHost | Way::Both) {
            change(&mut self.line.to_host);
        }
    }

    /// Makes the line worse from the start on.
    pub fn impair(&mut self, way: Way, impairment: Impairment) {
        self.wires(way, |wire| wire.impair(impairment));
    }
}

impl<B: Subject> Device for Stage<B> {
    type Error = BoardError;

    fn now(&self) -> Micros {
        self.board.now()
    }

    fn advance(&mut self, until: Micros) -> Result<(), BoardError> {
        self.step(until)
    }

    fn receive(&mut self, bytes: &[u8]) {
        self.line.to_board.send(self.board.now(), bytes);
        if self.tape.len() + bytes.len() <= MOST_REPLAYED {
            self.tape.extend_from_slice(bytes);
        }
    }

    fn transmit(&mut self, out: &mut Vec<u8>) {
        out.append(&mut self.arrived);
    }
}
