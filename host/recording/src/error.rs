//! Why a run can't be recorded, and why a file is no recording.

use std::io;
use zygote_deployment::TreeError;

/// Why a recording isn't whole. The run goes on without it.
#[derive(Debug, thiserror::Error)]
pub enum RecordError {
    /// The file can't be made.
    #[error("it can't be made: {0}")]
    Open(#[source] io::Error),
    /// The file can't be written: a full disk, most of the time.
    #[error("it can't be written after {seconds:.1} s of the run: {message}")]
    Write {
        /// Host time from the start of the recording, s.
        seconds: f64,
        /// What the system says.
        message: String,
    },
    /// The plan can't be shown in space.
    #[error("the plan's panels have no frames: {0}")]
    Frames(#[from] TreeError),
    /// A part of the job that JSON can't hold.
    #[error("{what} can't be written as JSON: {message}")]
    Json {
        /// Which part.
        what: &'static str,
        /// Why.
        message: String,
    },
}

/// Why a file can't be read as a recording.
#[derive(Debug, thiserror::Error)]
pub enum ReadError {
    /// Nothing in it.
    #[error("the file is empty: nothing was recorded")]
    Empty,
    /// Other bytes than those that every MCAP file begins with.
    #[error("no MCAP file: it begins with {found}, expected 89 4d 43 41 50 30 0d 0a")]
    NotMcap {
        /// Its first bytes.
        found: String,
    },
    /// Somebody else's MCAP file.
    #[error(
        "an MCAP file, but of another program ({program}, profile `{profile}`): expected one that `zygote deploy` recorded, profile `{}`",
        crate::PROFILE
    )]
    OtherProgram {
        /// What it says wrote it.
        program: String,
        /// What it says is in it.
        profile: String,
    },
    /// A layout of another version.
    #[error("a recording of version {found}, this program reads version {}", crate::FORMAT)]
    Version {
        /// What it says.
        found: String,
    },
    /// It breaks off before the first message.
    #[error("the recording breaks off after {bytes} bytes, before {missing}: nothing of the run is in it")]
    Headless {
        /// Its length.
        bytes: usize,
        /// What should come next.
        missing: &'static str,
    },
    /// A part that isn't what its name says.
    #[error("the recording's {what} can't be read: {message}")]
    Part {
        /// Which part.
        what: String,
        /// Why.
        message: String,
    },
}
