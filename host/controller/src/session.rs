//! A session with one MCU: requests with their responses, and the news in between. `connect` opens it.

use crate::Transport;
use crate::clock::Clock;
use crate::connect::{self, ConnectError, transmit};
use crate::inbox::{Broken, Inbox, Notice};
use std::io;
use zygote_protocol::{
    Actuator, Calibration, Command, HelloReply, Link, LinkCounters, MemoryReport, Micros, Millis, Readings,
    Refusal, Reply, Request, SendError, Settings, SettingsReport, Snapshot, Status, Urgent,
};

/// An MCU that says nothing for so long is gone; it says something at least every 200 ms.
const SILENCE: Millis = Millis(2_000);
/// An MCU that is heard, but has acknowledged nothing new for so long while something waits, doesn't hear this host.
const UNHEARD: Millis = Millis(4_000);
/// The session asks for the MCU's time so often.
const PROBE_EVERY: Millis = Millis(1_000);
/// Room in the link that commands leave free.
const ROOM_TO_SPARE: usize = 2;

/// Why a session ended.
#[derive(Debug, thiserror::Error)]
pub enum SessionError {
    /// The MCU stopped talking.
    #[error("{line}: the MCU was silent for {silent_ms} ms; it turns everything off by itself")]
    Silent {
        /// The line.
        line: String,
        /// For how long.
        silent_ms: u64,
    },
    /// The MCU talks but doesn't hear.
    #[error(
        "{line}: the MCU is heard, but has acknowledged nothing for {unheard_ms} ms: what goes to it is lost; look at that wire. It turns \
         everything off by itself"
    )]
    Unheard {
        /// The line.
        line: String,
        /// For how long.
        unheard_ms: u64,
    },
    /// The MCU doesn't know this session: it was reset, or another host opened one.
    #[error(
        "{line}: the MCU has forgotten this session: it was reset, or another program has connected to it"
    )]
    Forgotten {
        /// The line.
        line: String,
    },
    /// A command that the MCU has no room for in a frame.
    #[error("{line}: the command `{command}` is longer than the MCU takes in one frame ({longest} bytes)")]
    TooLong {
        /// The line.
        line: String,
        /// The command's name.
        command: &'static str,
        /// Most bytes of payload.
        longest: u16,
    },
    /// The MCU sent a message that this program can't read.
    #[error("{line}: a message of {length} bytes passed its checksum but can't be read")]
    Unreadable {
        /// The line.
        line: String,
        /// Length of its payload.
        length: usize,
    },
    /// The line broke.
    #[error("{line}: the line failed")]
    Line {
        /// The line.
        line: String,
        /// What the system says.
        #[source]
        source: io::Error,
    },
}

/// Why a request came to nothing.
#[derive(Debug, thiserror::Error)]
pub enum RequestError {
    /// The MCU refused it.
    #[error("the MCU refused `{command}`: {} (at {}, expected {}, got {})", .refusal.code, .refusal.at, .refusal.expected, .refusal.got)]
    Refused {
        /// The command's name.
        command: &'static str,
        /// Why.
        refusal: Refusal,
    },
    /// The answer belongs to another command.
    #[error("the MCU answered `{command}` with something else")]
    WrongReply {
        /// The command's name.
        command: &'static str,
    },
    /// The session ended.
    #[error(transparent)]
    Session(#[from] SessionError),
}

/// An open session.
pub struct Session<T> {
    transport: T,
    link: Link,
    number: u32,
    info: HelloReply,
    next_id: u16,
    inbox: Inbox,
    /// When this session asks for the MCU's time again.
    next_probe: Micros,
    /// When the MCU last acknowledged something, or had nothing to, and how much it had by then.
    progress: (Micros, u32),
}

impl<T: Transport> Session<T> {
    /// Opens the session `number` with whatever is at the other end, waiting at most `patience`.
    ///
    /// # Errors
    /// Nobody there, another version, or a broken line.
    pub fn connect(mut transport: T, number: u32, patience: Millis) -> Result<Self, ConnectError> {
        let mut link = Link::new(transport.now());
        let info = connect::shake_hands(&mut transport, &mut link, number, patience)?;
        let next_probe = transport.now();
        Ok(Self {
            transport,
            link,
            number,
            info,
            next_id: 0,
            inbox: Inbox::default(),
            next_probe,
            progress: (next_probe, 0),
        })
    }

    /// What the MCU said about itself.
    pub fn info(&self) -> &HelloReply {
        &self.info
    }

    /// Time on this side.
    pub fn now(&self) -> Micros {
        self.transport.now()
    }

    /// The MCU's clock as seen from here.
    pub fn clock(&self) -> &Clock {
        self.inbox.clock()
    }

    /// What the link has seen.
    pub fn link_counters(&self) -> LinkCounters {
        self.link.counters()
    }

    /// The line, for a look at what is behind it.
    pub fn transport(&self) -> &T {
        &self.transport
    }

    /// Gives the line back; the MCU then misses its host and turns everything off.
    pub fn into_transport(self) -> T {
        self.transport
    }

    /// Sends a command without waiting for its response, which [`Self::response`] gets.
    ///
    /// # Errors
    /// The session ended.
    pub fn submit(&mut self, command: Command) -> Result<u16, SessionError> {
        let id = self.take_id();
        let request = Request { id, command };
        loop {
            // The MCU's answers and events share a window like this one: commands that fill it would be turned away.
            // What is heard meanwhile needs no acknowledgement of its own: the command carries it.
            while self.link.room() <= ROOM_TO_SPARE {
                let soon = self.transport.now().plus(SILENCE);
                self.hear(soon)?;
            }

            match self.link.send(&request) {
                Ok(()) => break,
                Err(SendError::Full) => {}

                Err(SendError::TooLong) => {
                    let (line, longest) = (self.transport.name(), self.info.buffers.payload);
                    return Err(SessionError::TooLong { line, command: name_of(&request.command), longest });
                }
                Err(SendError::Closed) => {
                    return Err(SessionError::Forgotten { line: self.transport.name() });
                }
            }
        }
        if matches!(request.command, Command::Status) {
            self.inbox.expect_time(id, self.transport.now(), false);
        }
        Ok(id)
    }

    fn take_id(&mut self) -> u16 {
        let id = self.next_id;
        self.next_id = self.next_id.wrapping_add(1);
        id
    }

    /// Asks for the MCU's time now and then, while there is room to spare and one question is open at most.
    fn probe(&mut self) {
        let now = self.transport.now();
        if now < self.next_probe || self.inbox.is_probing() || self.link.room() <= ROOM_TO_SPARE {
            return;
        }
        let id = self.take_id();
        if self.link.send(&Request { id, command: Command::Status }).is_ok() {
            self.inbox.expect_time(id, now, true);
            self.next_probe = now.plus(PROBE_EVERY);
        }
    }

    /// Waits for the response to a submitted command.
    ///
    /// # Errors
    /// The session ended.
    pub fn response(&mut self, id: u16) -> Result<Result<Reply, Refusal>, SessionError> {
        loop {
            if let Some(result) = self.inbox.response(id) {
                return Ok(result);
            }
            let soon = self.transport.now().plus(SILENCE);
            self.pump(soon)?;
        }
    }

    /// Sends a command and waits for its reply.
    ///
    /// # Errors
    /// Refused, or the session ended.
    pub fn request(&mut self, command: Command) -> Result<Reply, RequestError> {
        let name = name_of(&command);
        let id = self.submit(command)?;
        self.response(id)?.map_err(|refusal| RequestError::Refused { command: name, refusal })
    }

    /// Asks how the MCU is.
    ///
    /// # Errors
    /// As [`Self::request`].
    pub fn status(&mut self) -> Result<Status, RequestError> {
        let Reply::Status(status) = self.request(Command::Status)? else {
            return Err(RequestError::WrongReply { command: "status" });
        };
        Ok(status)
    }

    /// Asks what the MCU was doing when it was reset.
    ///
    /// # Errors
    /// As [`Self::request`].
    pub fn last_run(&mut self) -> Result<Option<Snapshot>, RequestError> {
        let Reply::LastRun(snapshot) = self.request(Command::LastRun)? else {
            return Err(RequestError::WrongReply { command: "last run" });
        };
        Ok(snapshot)
    }

    /// Asks which settings are in force, and which are compiled into the board.
    ///
    /// # Errors
    /// As [`Self::request`].
    pub fn settings(&mut self) -> Result<SettingsReport, RequestError> {
        let Reply::Settings(report) = self.request(Command::Settings)? else {
            return Err(RequestError::WrongReply { command: "settings" });
        };
        Ok(report)
    }

    /// Asks what the heaters' thermistors read, from channel `first` on.
    ///
    /// # Errors
    /// As [`Self::request`].
    pub fn readings(&mut self, first: u16) -> Result<Readings, RequestError> {
        let Reply::Readings(readings) = self.request(Command::Readings { first })? else {
            return Err(RequestError::WrongReply { command: "readings" });
        };
        Ok(readings)
    }

    /// Asks what became of what the board keeps over power cycles.
    ///
    /// # Errors
    /// As [`Self::request`].
    pub fn memory(&mut self) -> Result<MemoryReport, RequestError> {
        let Reply::Memory(report) = self.request(Command::Memory)? else {
            return Err(RequestError::WrongReply { command: "memory" });
        };
        Ok(report)
    }

    /// Has the board keep these settings for good; returns once they are stored and in force.
    ///
    /// # Errors
    /// As [`Self::request`].
    pub fn configure(&mut self, settings: Settings) -> Result<(), RequestError> {
        self.request(Command::Configure(settings)).map(drop)
    }

    /// Asks what the board knows of an actuator by measurement.
    ///
    /// # Errors
    /// As [`Self::request`].
    pub fn calibration(&mut self, actuator: Actuator) -> Result<Calibration, RequestError> {
        let Reply::Calibration(calibration) = self.request(Command::Calibration(actuator))? else {
            return Err(RequestError::WrongReply { command: "calibration" });
        };
        Ok(calibration)
    }

    /// Has the board keep these calibrations for good, each in force once it is stored; those that it knows already are left alone, for
    /// flash wears out. How many were new.
    ///
    /// # Errors
    /// As [`Self::request`]; those before the refused one are kept.
    pub fn calibrate(&mut self, calibrations: &[Calibration]) -> Result<usize, RequestError> {
        let mut new = 0;
        for &calibration in calibrations {
            if self.calibration(calibration.actuator())? != calibration {
                self.request(Command::Calibrate(calibration))?;
                new += 1;
            }
        }
        Ok(new)
    }

    /// Opens the next session on the same line, after this one was lost.
    ///
    /// # Errors
    /// As [`Self::connect`].
    pub fn reconnect(&mut self, patience: Millis) -> Result<(), ConnectError> {
        // 0 is no session.
        let number = self.number.checked_add(1).unwrap_or(1);
        self.link = Link::new(self.transport.now());
        let info = connect::shake_hands(&mut self.transport, &mut self.link, number, patience)?;
        // An MCU that was reset has started its clock anew.
        self.inbox.restart(info.identity.boot == self.info.identity.boot);
        self.info = info;
        self.number = number;
        self.progress = (self.transport.now(), 0);
        Ok(())
    }

    /// The next piece of news, waiting for it until `deadline` at most.
    ///
    /// # Errors
    /// The session ended.
    pub fn notice(&mut self, deadline: Micros) -> Result<Option<Notice>, SessionError> {
        loop {
            if let Some(notice) = self.inbox.notice() {
                return Ok(Some(notice));
            }
            if self.transport.now() >= deadline {
                return Ok(None);
            }
            self.pump(deadline)?;
        }
    }

    /// Stops everything, and returns the time until the MCU had confirmed it.
    ///
    /// # Errors
    /// The session ended before; the MCU then turns everything off after its link timeout.
    pub fn stop(&mut self) -> Result<Micros, SessionError> {
        let asked = self.transport.now();
        // No room: stops are waiting to be confirmed already.
        self.link.send_urgent(&Urgent::Stop).ok();
        while !self.link.is_settled() {
            let soon = self.transport.now().plus(SILENCE);
            self.pump(soon)?;
        }
        Ok(Micros(self.transport.now().since(asked)))
    }

    /// Sends what is due, waits for bytes until `deadline` or until something more is due, takes what came, and
    /// acknowledges it: perhaps nobody asks this session for anything for a while.
    fn pump(&mut self, deadline: Micros) -> Result<(), SessionError> {
        self.hear(deadline)?;
        self.speak()
    }

    fn speak(&mut self) -> Result<(), SessionError> {
        let sent = transmit(&mut self.transport, &mut self.link);
        sent.map_err(|source| SessionError::Line { line: self.transport.name(), source })
    }

    /// Sends what is due, waits for bytes until `deadline` or until something more is due, and takes what came.
    fn hear(&mut self, deadline: Micros) -> Result<(), SessionError> {
        self.probe();
        self.speak()?;

        let wake = self.link.poll_timeout(self.transport.now()).map_or(deadline, |due| due.min(deadline));
        let mut buffer = [0; 1024];
        let received = self.transport.receive(&mut buffer, wake);
        let count = received.map_err(|source| SessionError::Line { line: self.transport.name(), source })?;
        let now = self.transport.now();
        let mut bytes = buffer.get(..count).unwrap_or_default();
        while let Some(received) = self.link.receive(now, &mut bytes, true) {
            let taken = self.inbox.take(now, received);
            taken.map_err(|broken| match broken {
                Broken::Forgotten => SessionError::Forgotten { line: self.transport.name() },
                Broken::Unreadable(length) => {
                    SessionError::Unreadable { line: self.transport.name(), length }
                }
            })?;
        }
        let silent = now.since(self.link.last_heard());
        if silent > SILENCE.to_micros() {
            return Err(SessionError::Silent { line: self.transport.name(), silent_ms: silent / 1000 });
        }
        let delivered = self.link.counters().delivered;
        if self.link.is_settled() || delivered != self.progress.1 {
            self.progress = (now, delivered);
        }
        let unheard = now.since(self.progress.0);
        if unheard > UNHEARD.to_micros() {
            return Err(SessionError::Unheard { line: self.transport.name(), unheard_ms: unheard / 1000 });
        }
        Ok(())
    }
}

fn name_of(command: &Command) -> &'static str {
    match command {
        Command::Status => "status",
        Command::Progress { .. } => "progress",
        Command::Upload { .. } => "upload",
        Command::Steps { .. } => "steps",
        Command::Commit => "commit",
        Command::Arm { .. } => "arm",
        Command::Start { .. } => "start",
        Command::Disarm => "disarm",
        Command::Clear => "clear",
        Command::LastRun => "last run",
        Command::Settings => "settings",
        Command::Memory => "memory",
        Command::Calibration(_) => "calibration",
        Command::Calibrate(_) => "calibrate",
        Command::Configure(_) => "configure",
        Command::Readings { .. } => "readings",
    }
}
