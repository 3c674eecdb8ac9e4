//! Programs without a board, counted. A [`Bare`] processor calls one function at a time and counts what it takes; [`Calls`] follows
//! every call that its instructions make.

mod bare;
mod calls;
mod cycles;
mod linked;

pub use bare::{Bare, BareError, Taken};
pub use calls::{Calls, CallsError, Deepest};
pub use linked::{Linked, LinkedError};
