//! Plans as FOLD files.

mod layout_of_lines;
mod read;
mod write;

pub use read::{FoldError, check, parse, read};
pub use write::write;

/// The key of the schedule, which is kept as it stands.
pub(crate) const SCHEDULE: &str = "zygote:schedule";
