//! From a shape to a **plan**: which panel lies where in the zygote, and which hinges join them.
//!
//! ```text
//! model file -> readers -> Surface (unit squares, dual graph) -> Hamiltonian cycle -> arcs -> Plan -> plan.fold
//! ```
//!
//! Pure: no clock, no randomness without a seed. Words and signs are those of `docs/src/geometry.md`.

mod arcs;
mod check;
mod dual;
pub mod fold;
mod folding_map;
mod hamiltonian;
mod hinges;
mod layout;
mod plan;
mod planner;
mod random;
mod readers;
mod square;
mod surface;
mod tree_path;
mod voxels;

pub use check::{Figures, Report, Rule, Violation, check};
pub use hamiltonian::NoStrip;
pub use plan::{Hinge, HingeKind, Pile, Plan, Side, Source};
pub use planner::{PlanError, Request, plan};
pub use readers::{Model, ModelError, ModelProblem};
pub use surface::{Surface, SurfaceError};
