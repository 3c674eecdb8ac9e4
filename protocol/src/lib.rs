//! The wire between a host and an MCU: messages, units, frames and the reliable link.
//!
//! `no_std`, no allocation, no I/O and no clock: both ends run the same state machine on bytes and times that
//! are handed in. The bytes are described for people in `docs/src/protocol.md`.
//!
//! | frame | from | carries | delivered |
//! |---|---|---|---|
//! | Hello, HelloReply | host, MCU | [`Hello`], [`HelloReply`] | repeated by the host until answered |
//! | Data | host | [`Request`] | in order, exactly once |
//! | Data | MCU | [`Report`]: [`Response`] or [`Event`] | in order, exactly once |
//! | Urgent | host, MCU | [`Urgent`], [`Fault`] | ahead of everything, at least until acknowledged |
//! | Telemetry | MCU | [`Telemetry`] | perhaps; the newest wins |
//! | Ack, Nack | both | nothing | also the keep-alive |
//! | Reset | MCU | nothing | "I know no such session" |
#![no_std]
#![warn(clippy::indexing_slicing, clippy::as_conversions)]

mod calibration;
mod codes;
mod command;
mod crc;
mod frame;
mod hello;
mod kept;
mod limits;
mod link;
mod memory;
mod readings;
mod report;
pub mod schema;
mod settings;
mod snapshot;
mod step;
mod units;

pub use calibration::{Actuator, Calibration, HeaterCalibration, ServoCalibration};
pub use codes::{Explanation, FaultCode, RefusalCode};
pub use command::{
    Command, PROGRESS_PER_REPLY, Refusal, Reply, Request, Response, RigId, STEPS_PER_COMMAND, State, Status,
    StepState, peek_request_id,
};
pub use frame::{Decoder, FrameError, FrameKind, Header, MAX_ENCODED, MAX_PAYLOAD, decode_payload, encode};
pub use hello::{
    Buffers, Channels, Hello, HelloReply, Identity, ResetCause, VERSION, VERSION_MIN, granted_session,
    peek_versions,
};
pub use kept::Kept;
pub use limits::{LimitName, Limits};
pub use link::{Link, LinkCounters, NO_SESSION, Received, SendError, WINDOW};
pub use memory::{MemoryReport, MemoryState};
pub use readings::{READINGS_PER_REPLY, Reading, Readings};
pub use report::{Event, EventKind, Fault, Motion, Phase, Report, TELEMETRY_MOTIONS, Telemetry, Urgent};
pub use settings::{Settings, SettingsReport, TooLax};
pub use snapshot::{RETAINED_WORDS, Retained, SNAPSHOT_STEPS, Snapshot};
pub use step::{Action, Heat, MAX_AFTER, Pulse, Release, Step, Turn, program_crc};
pub use units::{CentiCelsius, Micros, Milliamps, Millis, Millivolts};
