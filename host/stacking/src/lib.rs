//! From a shape to a **plan**: which panel lies where in the zygote, and which hinges join them.
//!
//! ```text
//! model file -> readers -> Surface (unit squares, dual graph)
//!     -> partition, a cycle in every part -> placement -> matching    \
//!     -> one cycle -> arcs (cuts, layout)                             -> Plan -> plan.fold
//!     -> base: a flat patch, a part with a cycle around each panel    /
//! ```
//!
//! Pure: no clock, no randomness without a seed. Words and signs are those of `docs/src/geometry.md`.

mod adjacency;
mod alternatives;
mod arcs;
mod at_once;
mod base;
mod bridge_bound;
mod by_parts;
mod check;
mod cut_edges;
mod dual;
pub mod fold;
mod folding_map;
mod hamiltonian;
mod hinges;
mod joint;
mod matching;
mod mesh;
mod net;
mod net_search;
mod partition;
mod placement;
mod plan;
mod planner;
mod quality;
mod random;
mod readers;
mod reconfigure;
mod sequence;
mod sets;
mod square;
mod strip_changes;
mod strip_plan;
mod surface;
mod tree_path;
mod voxels;

pub use alternatives::{Alternative, Alternatives, alternatives};
pub use base::NoBase;
pub use by_parts::NoMatch;
pub use check::{Figures, Report, Rule, Violation, check};
pub use cut_edges::CutEdge;
pub use hamiltonian::NoStrip;
pub use mesh::{Distance, Repair};
pub use net::{Net, Overlaps};
pub use net_search::{NetPlan, plan_with_net};
pub use plan::{Hinge, HingeKind, Pile, Plan, Side, Source};
pub use planner::{Bridges, Partition, PlanError, Request, plan};
pub use quality::{Quality, quality};
pub use readers::{Model, ModelError, ModelProblem, Resolution};
pub use reconfigure::{
    Action, Counts, Like, LikeError, Motion, Reconfiguration, ReconfigureError, Slot, SlotKind, plan_like,
};
pub use sequence::{
    Column, Difference, Layer, Mounted, Place, Sequence, SequenceError, SequenceProblem, SequenceText,
};
pub use surface::{Surface, SurfaceError};
