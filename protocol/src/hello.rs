//! The first exchange: who is there, which versions it speaks, and what it can do.
//!
//! The first three fields of [`Hello`] and of [`HelloReply`] keep their place in every version, so that two ends
//! that don't understand each other can at least say so.

use crate::{Limits, NO_SESSION, schema};
use heapless::String;
use postcard_schema::Schema;
use serde::{Deserialize, Serialize};

/// The protocol version that this crate speaks.
pub const VERSION: u16 = 5;
/// The oldest protocol version that this crate still understands.
pub const VERSION_MIN: u16 = 5;

/// Host to MCU: opens the session whose number stands in the frame.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, Schema)]
pub struct Hello {
    /// Oldest version understood.
    pub min: u16,
    /// Newest version understood.
    pub current: u16,
    /// [`schema::hash`] of the sender.
    pub schema: u32,
}

impl Hello {
    /// The hello of this crate.
    pub fn ours() -> Self {
        Self { min: VERSION_MIN, current: VERSION, schema: schema::hash() }
    }
}

/// The versions and the schema hash at the front of a [`Hello`] or [`HelloReply`] of any version.
pub fn peek_versions(payload: &[u8]) -> Option<Hello> {
    postcard::take_from_bytes(payload).ok().map(|(hello, _)| hello)
}

/// MCU to host: the answer, given also to a host of another version.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, Schema)]
pub struct HelloReply {
    /// Oldest version understood.
    pub min: u16,
    /// Newest version understood.
    pub current: u16,
    /// [`schema::hash`] of the sender.
    pub schema: u32,
    /// Who the MCU is and what it can do.
    pub identity: Identity,
    /// The board's ceilings, which no host can raise (S13).
    pub ceiling: Limits,
    /// How many actuators the board drives.
    pub channels: Channels,
    /// How much the MCU can take in.
    pub buffers: Buffers,
}

/// The session that an MCU of this boot opens for a hello of this number. A whole session that is said again after a reset
/// so opens another one, and what it says belongs to none (S11).
pub const fn granted_session(asked: u32, boot: u32) -> u32 {
    /// Odd, so that no two boots grant the same; far from 1, so that neighbours of one boot and the next differ.
    const SPREAD: u32 = 0x9e37_79b9;
    match asked ^ boot.wrapping_mul(SPREAD) {
        NO_SESSION => asked,
        granted => granted,
    }
}

/// Who an MCU is.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, Schema)]
pub struct Identity {
    /// Another number after every reset, and after every time that power was off.
    pub boot: u32,
    /// Firmware version.
    pub firmware: String<16>,
    /// Commit that the firmware was built from, abbreviated.
    pub git: String<12>,
    /// Board name, as its folder is called.
    pub board: String<24>,
    /// The chip's unique id.
    pub unique_id: [u8; 12],
    /// Why the MCU last started.
    pub reset: ResetCause,
}

/// Why the MCU last started.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, Schema)]
pub enum ResetCause {
    /// Power was switched on, or failed.
    Power,
    /// The reset pin or button.
    Pin,
    /// A watchdog expired.
    Watchdog,
    /// The firmware asked for it, after a panic for example.
    Software,
    /// The chip doesn't say.
    Unknown,
    /// The dead man's switch turned everything off: the control loop stood still, or the host was silent and nobody acted.
    DeadMan,
}

/// How many actuators of each kind a board drives; channels are numbered from 0.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, Schema)]
pub struct Channels {
    /// SMA heaters, each with its thermistor.
    pub heaters: u16,
    /// Servos.
    pub servos: u16,
    /// Spring releases.
    pub springs: u16,
}

/// How much an MCU can take in.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, Schema)]
pub struct Buffers {
    /// Steps of one program.
    pub steps: u16,
    /// Reliable frames under way at once.
    pub window: u8,
    /// Bytes of payload in one frame.
    pub payload: u16,
}
