//! `cargo xtask unit` and `cargo xtask doctest`: the Rust tests of the host workspace.

use crate::tools::{self, cargo};
use anyhow::Result;

/// Unit and integration tests.
pub(crate) fn unit() -> Result<()> {
    let nextest = tools::from_crates_io("cargo-nextest", "^0.9", &[])?;
    tools::run(tools::command(nextest).args(["nextest", "run", "--workspace", "--no-fail-fast"]))
}

/// Examples in the documentation.
pub(crate) fn doc() -> Result<()> {
    tools::run(cargo().args(["test", "--doc", "--workspace", "--quiet"]))
}
