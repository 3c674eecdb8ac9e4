//! Two things at once. What they give does not depend on which is done first.

/// Does two things on two threads.
pub(crate) fn at_once<A, B: Send>(one: impl FnOnce() -> A, other: impl FnOnce() -> B + Send) -> (A, B) {
    std::thread::scope(|scope| {
        let other = scope.spawn(other);
        // A fault there is a fault here.
        (one(), other.join().unwrap_or_else(|fault| std::panic::resume_unwind(fault)))
    })
}
