//! What became of what a board keeps over power cycles: told, so that nobody takes compiled-in limits for those he had set.

use postcard_schema::Schema;
use serde::{Deserialize, Serialize};

/// The memory that outlives power.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, Schema)]
pub struct MemoryReport {
    /// Whether settings were found, or have been stored since.
    pub state: MemoryState,
    /// Records that the start passed over because their checksum was wrong: power failed while they were written, or the
    /// memory wears out. What they held is lost; the record before them counts.
    pub damaged: u16,
}

impl MemoryReport {
    /// Where nothing was ever kept.
    pub const BLANK: Self = Self { state: MemoryState::Blank, damaged: 0 };
}

/// Whether settings are kept.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, Schema)]
pub enum MemoryState {
    /// They are.
    Kept,
    /// None have been: what is compiled in holds.
    Blank,
    /// They are of another firmware and can't be read: what is compiled in holds.
    OtherVersion,
    /// The memory can't be used: what is compiled in holds, and nothing can be kept.
    Unusable,
}
