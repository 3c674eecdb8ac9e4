//! The **statics** of a plan that unfolds slowly: what gravity does to every hinge, and whether the whole stands.
//!
//! ```text
//! Plan + Rig + order of hinges -> Walk (one hinge turns, all others stand still)
//!     -> Swing (a torque or a distance by the angle, exactly) -> Load (the worst against the rating), Tipping
//! ```
//!
//! Hinges turn one at a time. A turn moves every panel by a rotation, and where hinges give way by an even shift, so each
//! torque is `k + p cos(angle) + q sin(angle) + l angle`: its greatest values are found in closed form, not sampled.

mod choice;
mod load;
mod loads;
mod swing;
#[cfg(test)]
mod tests;
mod tipping;
mod walk;

pub use choice::lightest_root;
pub use load::{Load, Role};
pub use loads::Loads;
pub use tipping::{Support, Tipping};
pub use walk::{Statics, StaticsError};
