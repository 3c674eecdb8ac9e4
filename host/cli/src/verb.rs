//! The table of verbs.

use crate::failure::Failure;
use clap::Subcommand;

/// A verb and its arguments.
#[derive(Subcommand)]
pub(crate) enum Verb {}

impl Verb {
    /// Does what the user asked for.
    pub(crate) fn run(self) -> Result<(), Failure> {
        match self {}
    }
}
