//! Why a rig file is refused, by itself or for a plan.

use super::places::Place;
use super::settings::Kind;

/// A rig file that can't be used.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum RigError {
    /// No TOML, a key that doesn't exist or is missing, a wrong unit.
    #[error("{place}: {message}")]
    Parse {
        /// Where.
        place: Place,
        /// What the reader of TOML says: what it found and what it expected.
        message: String,
    },
    /// A value that breaks a rule of the rig file.
    #[error("{place}: expected {expected}, found {found}")]
    Value {
        /// Where.
        place: Place,
        /// The rule.
        expected: String,
        /// The value.
        found: String,
    },
    /// A hinge number that the plan doesn't have.
    #[error("{place}: expected a hinge of the plan, 0 to {last}, found {hinge}")]
    NoSuchHinge {
        /// Where.
        place: Place,
        /// The number in the rig file.
        hinge: usize,
        /// The plan's last hinge.
        last: usize,
    },
    /// The plan has more hinges of a kind than the nodes can drive.
    #[error(
        "{place}: too few {}: the plan needs {needed} for its {} hinges, {} {available}",
        kind.channel_key(), kind.name(), if *nodes == 1 { "the node has".to_owned() } else { format!("the {nodes} nodes have") }
    )]
    TooFewChannels {
        /// Where.
        place: Place,
        /// Kind of hinge.
        kind: Kind,
        /// Hinges of the kind.
        needed: usize,
        /// Nodes that have channels for them.
        nodes: usize,
        /// Channels of the kind, of all these nodes.
        available: usize,
    },
}
