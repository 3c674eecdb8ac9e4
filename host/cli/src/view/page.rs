//! The page, as `build.rs` found it.

use crate::failure::Failure;
use anyhow::anyhow;

/// One file with everything in it; `None` where it wasn't built before this program.
const PAGE: Option<&[u8]> = include!(concat!(env!("OUT_DIR"), "/page.rs"));

/// The page.
pub(crate) fn page() -> Result<&'static [u8], Failure> {
    PAGE.ok_or_else(|| {
        Failure::Failed(anyhow!(
            "this program was built without the viewer's page; make it with `cargo xtask viewer`, then build this program again"
        ))
    })
}

/// Whether this program has the page.
pub(crate) const fn has_page() -> bool {
    PAGE.is_some()
}
