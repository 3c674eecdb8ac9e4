//! The event log of a run: one JSON object a line, in the order of arrival.
//!
//! Every record has `host_us` (this program's clock, from the start of the log) and `kind`; what the MCU tells also
//! has `mcu_us` (its clock, from its boot) and, once its clock is known, `at_host_us`: when that was by this program's
//! clock, from the start of the log. An [`Observer`] is told the same.

use crate::{ClockFit, MotionState};
use serde::{Deserialize, Serialize};
use std::io::{self, Write};
use zygote_protocol::Micros;

/// One line of the log, without its host time.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "snake_case")]
pub enum Record {
    /// The session is open.
    Connected {
        /// The line.
        line: String,
        /// The board's name.
        board: String,
        /// Version of its firmware.
        firmware: String,
        /// Its boot id.
        boot: u32,
        /// The chip's unique id, in hex.
        #[serde(default)]
        chip: String,
    },
    /// The program is stored and checked.
    Uploaded {
        /// The run's number.
        run: u32,
        /// Its steps.
        steps: usize,
    },
    /// The MCU went into another state.
    State {
        /// MCU time.
        mcu_us: u64,
        /// The state.
        state: String,
    },
    /// A hinge began to move.
    Started {
        /// MCU time.
        mcu_us: u64,
        /// Index of the step.
        step: u16,
        /// Number of the hinge.
        hinge: usize,
    },
    /// A hinge is open.
    Opened {
        /// MCU time.
        mcu_us: u64,
        /// Index of the step.
        step: u16,
        /// Number of the hinge.
        hinge: usize,
    },
    /// A hinge is open and, if it was heated, cool.
    Done {
        /// MCU time.
        mcu_us: u64,
        /// Index of the step.
        step: u16,
        /// Number of the hinge.
        hinge: usize,
        /// Highest temperature measured, °C.
        #[serde(skip_serializing_if = "Option::is_none")]
        peak_c: Option<f64>,
    },
    /// Everything was turned off.
    Fault {
        /// MCU time.
        mcu_us: u64,
        /// The code with its meaning.
        fault: String,
        /// What was measured.
        value: i64,
        /// What it was held against.
        limit: i64,
        /// The hinge concerned.
        #[serde(skip_serializing_if = "Option::is_none")]
        hinge: Option<usize>,
    },
    /// A look at the rig.
    Telemetry {
        /// MCU time.
        mcu_us: u64,
        /// Supply voltage, mV.
        supply_mv: u32,
        /// Measured current, mA.
        current_ma: u32,
        /// Steps opened.
        opened: u16,
        /// Temperature, °C, of each hinge under way that has one.
        temperatures: Vec<(usize, f64)>,
        /// All that is known of the hinges under way; for observers, the log's lines don't have it.
        #[serde(skip)]
        motions: Vec<MotionState>,
    },
    /// The run was paused: its MCU is disarmed, and everything is off.
    Paused,
    /// The user stopped the run.
    StopRequested,
    /// The MCU has confirmed the stop.
    StopConfirmed {
        /// Time from the request to the confirmation.
        after_us: u64,
    },
    /// The session broke.
    Lost {
        /// Why.
        message: String,
    },
}

impl Record {
    /// When it happened, for what the MCU tells.
    pub fn mcu_us(&self) -> Option<Micros> {
        match self {
            Self::State { mcu_us, .. }
            | Self::Started { mcu_us, .. }
            | Self::Opened { mcu_us, .. }
            | Self::Done { mcu_us, .. }
            | Self::Fault { mcu_us, .. }
            | Self::Telemetry { mcu_us, .. } => Some(Micros(*mcu_us)),
            Self::Connected { .. }
            | Self::Uploaded { .. }
            | Self::Paused
            | Self::StopRequested
            | Self::StopConfirmed { .. }
            | Self::Lost { .. } => None,
        }
    }
}

/// Host time of an MCU time from the start of the log, us; negative for what happened before.
#[expect(clippy::cast_possible_truncation, reason = "2^53 us are 285 years")]
#[expect(clippy::cast_precision_loss, reason = "so are 2^53 us of host time")]
fn since_start(clock: ClockFit, mcu: Micros, start: Micros) -> i64 {
    (clock.host_from_mcu(mcu) - start.0 as f64).round() as i64
}

/// Host times of a record, from the start of the log.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct Times {
    /// When it was told.
    pub host_us: u64,
    /// When it happened, for what the MCU tells once its clock is known; negative for what happened before.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub at_host_us: Option<i64>,
}

/// Is told every record beside the log. A failure of its own ends no run, so it keeps it.
pub trait Observer {
    /// Takes a record.
    fn observe(&mut self, times: Times, record: &Record);

    /// What went wrong first, if anything did.
    fn error(&self) -> Option<String>;
}

#[derive(Serialize)]
struct Line<'a> {
    #[serde(flatten)]
    times: Times,
    #[serde(flatten)]
    record: &'a Record,
}

/// Where records go. A log that can't be written doesn't stop a run: the first error is kept and told at the end.
pub struct EventLog<'a> {
    sink: Box<dyn Write>,
    observers: Vec<&'a mut dyn Observer>,
    begun: bool,
    start: Option<Micros>,
    clock: Option<ClockFit>,
    error: Option<io::Error>,
}

impl<'a> EventLog<'a> {
    /// A log into `sink`, flushed after every line.
    pub fn new(sink: impl Write + 'static) -> Self {
        Self {
            sink: Box::new(sink),
            observers: Vec::new(),
            begun: false,
            start: None,
            clock: None,
            error: None,
        }
    }

    /// With somebody more who is told the same.
    #[must_use]
    pub fn observed_by(mut self, observer: &'a mut dyn Observer) -> Self {
        self.observers.push(observer);
        self
    }

    /// From now on, tells host times by this clock.
    pub fn follow(&mut self, clock: Option<ClockFit>) {
        self.clock = clock;
    }

    /// Adds a record.
    pub fn add(&mut self, now: Micros, record: &Record) {
        let start = *self.start.get_or_insert(now);
        let at_host_us = self.clock.zip(record.mcu_us()).map(|(clock, mcu)| since_start(clock, mcu, start));
        let times = Times { host_us: now.since(start), at_host_us };
        if self.error.is_none() {
            self.error = self.write(&Line { times, record }).err();
            self.begun |= self.error.is_none();
        }
        // A run whose log can't be begun isn't started; it leaves no other trace either.
        if self.begun {
            for observer in &mut self.observers {
                observer.observe(times, record);
            }
        }
    }

    fn write(&mut self, line: &Line<'_>) -> io::Result<()> {
        serde_json::to_writer(&mut self.sink, line)?;
        self.sink.write_all(b"\n")?;
        self.sink.flush()
    }

    /// The first error, if the log isn't whole.
    pub fn error(&self) -> Option<&io::Error> {
        self.error.as_ref()
    }

    /// The first error of the first observer that has one.
    pub fn observer_error(&self) -> Option<String> {
        self.observers.iter().find_map(|observer| observer.error())
    }
}
