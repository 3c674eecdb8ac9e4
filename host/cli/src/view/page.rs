//! The page, as `build.rs` found it.

/// One file with everything in it; `None` where it wasn't built before this program.
pub(super) const PAGE: Option<&[u8]> = page();

const fn page() -> Option<&'static [u8]> {
    const FOUND: Option<&'static [u8]> = include!(concat!(env!("OUT_DIR"), "/page.rs"));
    FOUND
}
