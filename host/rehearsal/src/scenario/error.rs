//! Why a scenario file can't be used.

use crate::board::BoardError;
use std::io;

/// A refusal that names the file and, where there is one, the line.
#[derive(Debug, thiserror::Error)]
pub enum ScenarioError {
    /// The file, or one that it names, can't be read.
    #[error("{file}: cannot be read")]
    Read {
        /// Its name.
        file: String,
        /// What the system says.
        #[source]
        source: io::Error,
    },
    /// No TOML, or a key that is unknown, missing or of the wrong kind.
    #[error("{file}:{line}: {message}")]
    Parse {
        /// Its name.
        file: String,
        /// The line, from 1.
        line: usize,
        /// What is wrong.
        message: String,
    },
    /// A value that can't be.
    #[error("{file}:{line}: {what}: expected {expected}, found {found}")]
    Value {
        /// Its name.
        file: String,
        /// The line of the table that it stands in.
        line: usize,
        /// The key.
        what: &'static str,
        /// What would have been right.
        expected: String,
        /// What stands there.
        found: String,
    },
    /// The rig, the model or the plan that the scenario is about can't be used.
    #[error("{file}: {what}")]
    Job {
        /// Its name.
        file: String,
        /// Which of them.
        what: &'static str,
        /// Why.
        #[source]
        source: Box<dyn std::error::Error + Send + Sync>,
    },
    /// A scenario without a job of its own was asked to run by itself.
    #[error(
        "{file}: has no [job], so it can only be used with a plan: `zygote deploy PLAN --sim --scenario {file}`"
    )]
    NoJob {
        /// Its name.
        file: String,
    },
    /// The rig can't be simulated, or doesn't have what is to break.
    #[error("{file}: the simulated rig")]
    Board {
        /// Its name.
        file: String,
        /// Why.
        #[source]
        source: Box<BoardError>,
    },
}
