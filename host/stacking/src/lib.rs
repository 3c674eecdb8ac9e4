//! From a shape to a **plan**: which panel lies where in the zygote, and which hinges join them.
//!
//! ```text
//! model file -> readers -> Surface (unit squares, dual graph)
//!     -> Hamiltonian cycle -> arcs -> layout                   \
//!     -> partition, a cycle a part -> placement -> matching    -> Plan -> plan.fold
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
mod matching;
mod mincut;
mod partition;
mod placement;
mod plan;
mod planner;
mod quality;
mod random;
mod readers;
mod square;
mod strip_cuts;
mod surface;
mod tree_path;
mod voxels;

pub use check::{Figures, Report, Rule, Violation, check};
pub use hamiltonian::NoStrip;
pub use mincut::NoMatch;
pub use plan::{Hinge, HingeKind, Pile, Plan, Side, Source};
pub use planner::{Bridges, Options, Partition, PlanError, Request, plan, plan_with};
pub use quality::{Quality, quality};
pub use readers::{Model, ModelError, ModelProblem};
pub use surface::{Surface, SurfaceError};
