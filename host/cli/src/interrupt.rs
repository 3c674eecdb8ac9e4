//! Ctrl-C as a wish that long work looks at, so that a rig is stopped before the program ends.

use crate::failure::{Failure, OrFail};
use anyhow::Context;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// Takes over Ctrl-C, and termination, for the rest of the program; the flag says that it came.
pub(crate) fn flag() -> Result<Arc<AtomicBool>, Failure> {
    let flag = Arc::new(AtomicBool::new(false));
    let set = Arc::clone(&flag);
    ctrlc::set_handler(move || set.store(true, Ordering::Relaxed))
        .context("Ctrl-C can't be caught, so a run couldn't be stopped")
        .or_failed()?;
    Ok(flag)
}
