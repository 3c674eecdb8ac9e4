//! Recordings: a run as an MCAP file, which Foxglove shows as it is, and which this crate reads again, cut off or whole.
//!
//! ```text
//!   deploy --records--> Recorder --messages--> RUN.mcap --Recording::read--> timeline, report page
//!             (Observer)    |
//!                           Scene: panels and hinges in space
//! ```
//!
//! `docs/src/recordings.md` is the page for the file.

mod error;
mod job;
mod message;
mod page;
mod primitive;
mod reader;
mod recorder;
mod run;
mod scene;
mod schema;
mod sightings;
mod stamp;
mod timeline;
mod told;

pub use error::{ReadError, RecordError};
pub use job::Job;
pub use message::{Event, Reading, Telemetry};
pub use page::page;
pub use reader::{End, Recording};
pub use recorder::Recorder;
pub use timeline::timeline;

/// The MCAP profile that tells our recordings from other programs'.
const PROFILE: &str = "x-zygote";
/// What the file says wrote it.
const LIBRARY: &str = concat!("zygote ", env!("CARGO_PKG_VERSION"));
/// The one version of the layout of topics, metadata and attachments.
const FORMAT: &str = "1";

/// Names of attachments.
mod attachment {
    pub(crate) const PLAN: &str = "plan.fold";
    pub(crate) const RIG: &str = "rig.toml";
    pub(crate) const SCHEDULE: &str = "schedule.json";
    pub(crate) const REPORT: &str = "report.json";
}

/// Names of metadata records.
mod metadata {
    pub(crate) const JOB: &str = "zygote.job";
    pub(crate) const IDENTITY: &str = "zygote.identity";
}

/// Topics.
mod topic {
    pub(crate) const EVENTS: &str = "/events";
    pub(crate) const TELEMETRY: &str = "/telemetry";
    pub(crate) const LOG: &str = "/log";
    pub(crate) const PANELS: &str = "/panels";
    pub(crate) const HINGES: &str = "/hinges";
    pub(crate) const FRAMES: &str = "/frames";
}

#[cfg(test)]
mod checks;
