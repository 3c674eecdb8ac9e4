//! From a shape to a **plan**: which panel lies where in the zygote, and which hinges join them.
//!
//! ```text
//! model file -> readers -> Surface (unit squares, dual graph) -> Hamiltonian cycle -> arcs -> Plan -> plan.fold
//! ```
//!
//! Pure: no clock, no randomness without a seed. Words and signs are those of `docs/src/geometry.md`.

mod plan;

pub use plan::{Hinge, HingeKind, Pile, Plan, Side, Source};
