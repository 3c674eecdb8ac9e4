//! Opens the rings of placed parts so that neighbours come to equal heights with their common edge on the sides that face
//! each other: there a bridge is possible. A cycle can be opened anywhere, so a bridge is arranged and not waited for.
//!
//! ```text
//! border:   the cut edges between piles on neighbouring cells
//! opening:  what a ring can become
//! opener:   pile after pile, the opening that joins most groups and matches most
//! groups:   which piles hang together
//! align:    more neighbours at equal heights by small changes of the strips
//! bridges:  a spanning tree of them, or as many as can be, a fold broken for each one too many
//! ```

mod align;
mod border;
mod bridges;
mod groups;
mod opener;
mod opening;
mod turning;

pub(crate) use bridges::{Bridged, bridge};
pub(crate) use opener::Opener;

use crate::folding_map::Facing;
use crate::plan::Side;

/// The piles, each opened.
#[derive(Debug, Clone)]
pub(crate) struct Matched {
    /// Panels of every pile from the bottom up.
    pub(crate) piles: Vec<Vec<usize>>,
    /// Of every panel how it lies before its pile is turned.
    pub(crate) facing: Vec<Facing>,
    /// Of every pile its quarter turns.
    pub(crate) turns: Vec<usize>,
    /// The cells, as they were given.
    pub(crate) cells: Vec<[i32; 2]>,
}

/// The side of a cell beyond which another one is, if they are neighbours.
fn beyond(here: [i32; 2], there: [i32; 2]) -> Option<Side> {
    Side::ALL.into_iter().find(|side| {
        let [dx, dy] = side.step();
        there == [here[0] + dx, here[1] + dy]
    })
}
