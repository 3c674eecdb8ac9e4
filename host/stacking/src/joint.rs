//! A bridge that is possible.

use crate::plan::Side;

/// Two neighbours at one height of two piles.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Joint {
    pub(crate) panels: [usize; 2],
    pub(crate) edges: [usize; 2],
    pub(crate) piles: [usize; 2],
    /// The sides that the common edge is on, each in its own pile's frame.
    pub(crate) sides: [Side; 2],
}
