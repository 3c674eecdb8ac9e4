//! The **motion** of a plan's panels as plates, checked for collisions over the whole of every turn, not at samples.
//!
//! ```text
//! Plan + Thickness -> Linkage (joints: closed pose, axis, turn, stretch)
//!     -> Motion (what is open, where every panel is) --open a hinge--> blocks that turn, blocks that stand still
//!     -> near (pairs that could meet) -> apart (extents over angle intervals) -> Collision
//! check: all steps of an order -> Report
//! search: a free order, one hinge at a time -> waits_for: which hinges must wait for which, whatever their speeds
//! ```
//!
//! A panel is a plate: its outer face is a unit square, its thickness goes to the inner side. A border (the *rim*) of
//! every plate may touch anything; what must not meet is the *cores*: the squares less the border, times the thickness.
//! Two cores collide where their interiors do; touching is none.

mod apart;
mod backward;
mod block;
mod certificate;
mod check;
mod collision;
mod cuboid;
mod forward;
mod free_plan;
mod ground;
mod linkage;
mod near;
mod search;
mod state;
#[cfg(test)]
mod tests;
mod thickness;
mod turning;
mod waits;

pub use apart::{Conflict, FINEST, apart};
pub use certificate::Certificate;
pub use check::{Options, OrderError, Report, check};
pub use collision::{Collision, Obstacle};
pub use cuboid::Cuboid;
pub use free_plan::{FreePlan, FreePlanError, Plates, free_plan};
pub use ground::Ground;
pub(crate) use ground::Plane;
pub use linkage::Linkage;
pub use near::LOOKED_FOR;
pub use search::{Effort, Found, Scope, free_orders, search, search_after};
pub use state::Motion;
pub use thickness::{MotionError, Thickness};
pub use turning::{Body, Interval, Turn};
pub use waits::waits_for;

/// So much of overlap, in panel lengths, is rounding, not a collision: far above the error of poses along thousands of
/// joints, far below any thickness. See also [`Thickness::touching`].
pub const TOUCHING: f64 = 1e-9;
