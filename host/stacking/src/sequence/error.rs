//! What can be wrong with the text of a coded sequence, and where.

use std::fmt;

/// A place in a text; both count from 1, columns in characters.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct Place {
    /// The line.
    pub line: usize,
    /// The column.
    pub column: usize,
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "line {}, column {}", self.line, self.column)
    }
}

/// A text that is no coded sequence.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{place}: {problem}")]
pub struct SequenceError {
    /// Where.
    pub place: Place,
    /// What.
    pub problem: SequenceProblem,
}

/// What is wrong.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum SequenceProblem {
    /// Characters that are none of the grammar's.
    #[error("expected {expected}, found {found}")]
    Syntax {
        /// What stands there in a good text.
        expected: &'static str,
        /// What stands there.
        found: String,
    },
    /// No line with a pile.
    #[error("no pile: expected a line such as `(0,0): E270 N90 .`")]
    Empty,
    /// Two piles on one cell.
    #[error("a second pile on cell ({i},{j}); the first is on line {first}")]
    CellTwice {
        /// Cell along x.
        i: i32,
        /// Cell along y.
        j: i32,
        /// Line of the first pile.
        first: usize,
    },
    /// Piles of unequal height.
    #[error("a pile of {found} panels, expected {expected} as in the first pile")]
    Height {
        /// As in the first pile.
        expected: usize,
        /// Here.
        found: usize,
    },
    /// A top panel below others, or a last panel that goes on.
    #[error("the last panel of a pile, and no other, ends with `.`")]
    Top,
    /// Two hinges on one side of a panel.
    #[error("two hinges on side {side} of the panel at height {height}")]
    SideTwice {
        /// The side.
        side: &'static str,
        /// Height of the panel.
        height: usize,
    },
    /// A bridge to a cell without a pile.
    #[error("a bridge to cell ({i},{j}), where no pile stands")]
    NoPile {
        /// Cell along x.
        i: i32,
        /// Cell along y.
        j: i32,
    },
    /// A bridge that the other pile doesn't have.
    #[error(
        "a bridge {mounted} to cell ({i},{j}), which has none such at height {height}: expected [{expected}] there"
    )]
    OneSided {
        /// The bridge here.
        mounted: String,
        /// The other cell along x.
        i: i32,
        /// The other cell along y.
        j: i32,
        /// Height of the bridge.
        height: usize,
        /// What should stand there.
        expected: String,
    },
    /// Two fixed panels.
    #[error("a second panel that stays fixed (`*`); the first is at {first}")]
    RootTwice {
        /// The first.
        first: Place,
    },
    /// A hinge between panels that hang together already.
    #[error("a hinge closes a loop: the panel hangs on the one before it by other hinges already")]
    Loop,
    /// A panel that no hinge joins to the first.
    #[error("no way over hinges from this panel to the first: a bridge is missing")]
    Apart,
}
