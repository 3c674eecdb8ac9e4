//! What a host asks of an MCU, and what the MCU answers.
//!
//! | command | allowed in | effect |
//! |---|---|---|
//! | `Status` | any | none |
//! | `Progress` | any | none |
//! | `Upload` | Idle, Loaded, Finished | forgets the old program, awaits the steps of a new one |
//! | `Steps` | after `Upload` | stores up to four steps |
//! | `Commit` | after all steps | checks sum, order, channels and limits; Loaded |
//! | `Arm` | Loaded | limits in force, main switch on; Armed until its lifetime ends |
//! | `Start` | Armed | Running |
//! | `Disarm` | Armed, Running | everything off; Loaded |
//! | `Clear` | Safe | a person has looked; Idle |
//! | `LastRun` | any | none |
//! | `Settings` | any | none |
//! | `Configure` | any but Armed, Running | settings are written down for good, then in force |
//! | `Readings` | any | none |
//! | `Memory` | any | none |
//! | `Calibration` | any | none |
//! | `Calibrate` | any but Armed, Running | what was measured is written down for good, then in force |

use crate::{
    Actuator, Calibration, Fault, Limits, MemoryReport, Micros, Millis, Readings, RefusalCode, Settings,
    SettingsReport, Snapshot, Step,
};
use heapless::{String, Vec};
use postcard_schema::Schema;
use serde::{Deserialize, Serialize};

/// Steps in one [`Command::Steps`]: as many as surely fit one frame.
pub const STEPS_PER_COMMAND: usize = 4;
/// Step states in one [`Reply::Progress`].
pub const PROGRESS_PER_REPLY: usize = 128;

/// The name of a rig, as its file and its operator call it.
pub type RigId = String<32>;

/// A command with the number that its response repeats.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, Schema)]
pub struct Request {
    /// Chosen by the host.
    pub id: u16,
    /// What to do.
    pub command: Command,
}

/// The number at the front of a [`Request`], whatever follows.
pub fn peek_request_id(payload: &[u8]) -> Option<u16> {
    postcard::take_from_bytes(payload).ok().map(|(id, _)| id)
}

/// What a host asks.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, Schema)]
pub enum Command {
    /// How are you? Answered by [`Reply::Status`].
    Status,
    /// How far is each step, from this step on? Answered by [`Reply::Progress`].
    Progress {
        /// First step of interest.
        first: u16,
    },
    /// A program of so many steps follows.
    Upload {
        /// The run's number, chosen by the host.
        run: u32,
        /// The rig that the program is for.
        rig: RigId,
        /// Number of steps.
        steps: u16,
        /// [`crate::program_crc`] of all steps.
        crc: u32,
    },
    /// The next steps of the program.
    Steps {
        /// Index of the first of these steps.
        first: u16,
        /// The steps.
        steps: Vec<Step, STEPS_PER_COMMAND>,
    },
    /// The program is complete: check it.
    Commit,
    /// Allow motion.
    Arm {
        /// Must be the program's rig.
        rig: RigId,
        /// Must be within the board's ceilings.
        limits: Limits,
        /// How long a start may be waited for.
        lifetime: Millis,
    },
    /// Execute the program.
    Start {
        /// Must be the program's run.
        run: u32,
    },
    /// Everything off; motion needs a new [`Command::Arm`].
    Disarm,
    /// Leave the safe state after a fault, a stop or a lost link.
    Clear,
    /// What were you doing before you were reset? Answered by [`Reply::LastRun`].
    LastRun,
    /// Which limits are in force, and which are compiled in? Answered by [`Reply::Settings`].
    Settings,
    /// Keep these settings for good. Answered once they are stored.
    Configure(Settings),
    /// What do the heaters' thermistors read, from this channel on? Answered by [`Reply::Readings`].
    Readings {
        /// First channel of interest.
        first: u16,
    },
    /// What became of what you keep over power cycles? Answered by [`Reply::Memory`].
    Memory,
    /// What do you know of this actuator? Answered by [`Reply::Calibration`].
    Calibration(Actuator),
    /// Keep this for good, or forget what you knew. Answered once it is stored.
    Calibrate(Calibration),
}

/// The answer to a [`Request`].
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, Schema)]
pub struct Response {
    /// The request's number.
    pub id: u16,
    /// What came of it.
    pub result: Result<Reply, Refusal>,
}

/// What an accepted command gives back.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, Schema)]
pub enum Reply {
    /// Done.
    Done,
    /// To [`Command::Status`].
    Status(Status),
    /// To [`Command::Progress`].
    Progress {
        /// Index of the first state.
        first: u16,
        /// The states from there on.
        steps: Vec<StepState, PROGRESS_PER_REPLY>,
    },
    /// To [`Command::LastRun`]; `None` after power was off, or where nothing had happened.
    LastRun(Option<Snapshot>),
    /// To [`Command::Settings`].
    Settings(SettingsReport),
    /// To [`Command::Readings`].
    Readings(Readings),
    /// To [`Command::Memory`].
    Memory(MemoryReport),
    /// To [`Command::Calibration`].
    Calibration(Calibration),
}

/// Why a command was refused; it then changed nothing.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, Schema)]
pub struct Refusal {
    /// What is wrong.
    pub code: RefusalCode,
    /// Where: a step, channel or limit, as the code says.
    pub at: u16,
    /// What would have been right, where a number says it.
    pub expected: i64,
    /// What was given.
    pub got: i64,
}

/// The MCU as it stands.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, Schema)]
pub struct Status {
    /// MCU time of this status.
    pub at: Micros,
    /// What the MCU is doing.
    pub state: State,
    /// The program's run, where there is a program.
    pub run: Option<u32>,
    /// Why the MCU is in the safe state.
    pub fault: Option<Fault>,
    /// Steps opened so far.
    pub opened: u16,
    /// Heaters whose output is not off.
    pub heaters_on: u16,
    /// The main switch is closed.
    pub main_switch: bool,
}

/// What an MCU is doing.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, Schema)]
pub enum State {
    /// No program.
    Idle,
    /// A checked program, nothing energised.
    Loaded,
    /// Ready to start.
    Armed,
    /// Executing.
    Running,
    /// Every step is done, nothing energised.
    Finished,
    /// Everything off after a fault, a stop or a lost link, until cleared.
    Safe,
}

/// How far a step is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, Schema)]
pub enum StepState {
    /// Not started.
    Waiting,
    /// The hinge is moving.
    Moving,
    /// The hinge is open; an SMA hinge still cools.
    Opened,
    /// Open and, for an SMA hinge, cooled.
    Done,
    /// Interrupted while moving: the angle isn't known.
    Interrupted,
}
