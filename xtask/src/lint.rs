//! `cargo xtask lint`: formatting of everything, clippy of the host workspace. Every warning is an error.

use crate::{
    firmware,
    tools::{self, cargo},
};
use anyhow::Result;

/// Checks formatting, then lints.
pub(crate) fn run() -> Result<()> {
    tools::run(cargo().args(["fmt", "--all", "--check"]))?;
    for folder in firmware::outside()? {
        tools::run(cargo().args(["fmt", "--check", "--manifest-path"]).arg(folder.join("Cargo.toml")))?;
    }
    tools::run(cargo().args(["clippy", "--workspace", "--all-targets", "--quiet", "--", "-D", "warnings"]))
}
