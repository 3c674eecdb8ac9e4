//! Numbers that tell runs, sessions and boots apart.

use std::process;
use std::time::{SystemTime, UNIX_EPOCH};

/// Another number at every call of the program; never 0, which is the session of nobody.
pub(crate) fn fresh() -> u32 {
    // A clock before 1970 costs nothing but a chance of repetition.
    let now = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default();
    let mixed = now.as_nanos() ^ (u128::from(process::id()) << 16);
    u32::try_from(mixed & u128::from(u32::MAX)).unwrap_or(1).max(1)
}
