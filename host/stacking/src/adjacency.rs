//! A graph of panels as lists of neighbours. A square has four edges, so a list has four places, all in one row of memory:
//! at a million panels that is half the memory and time of lists of their own.

use std::ops::Index;

/// The most neighbours that a panel has.
const MOST: usize = 4;
/// What stands in an empty place.
const NONE: usize = usize::MAX;

/// For every node its neighbours.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Adjacency {
    rows: Vec<[usize; MOST]>,
}

impl Adjacency {
    /// So many nodes without neighbours.
    pub(crate) fn without_edges(nodes: usize) -> Self {
        Self { rows: vec![[NONE; MOST]; nodes] }
    }

    /// How many nodes there are.
    pub(crate) fn len(&self) -> usize {
        self.rows.len()
    }

    /// Adds a node.
    #[cfg(test)]
    pub(crate) fn add(&mut self, near: [usize; MOST]) {
        self.rows.push(near);
    }

    /// Adds a neighbour to a node's list, which must have room.
    pub(crate) fn push(&mut self, node: usize, other: usize) {
        let place = self.rows[node].iter_mut().find(|place| **place == NONE);
        debug_assert!(place.is_some(), "node {node} has {MOST} neighbours already");
        if let Some(place) = place {
            *place = other;
        }
    }

    /// Joins two nodes.
    pub(crate) fn join(&mut self, a: usize, b: usize) {
        self.push(a, b);
        self.push(b, a);
    }

    /// Empties a node's list.
    pub(crate) fn clear(&mut self, node: usize) {
        self.rows[node] = [NONE; MOST];
    }

    /// Puts another neighbour in a neighbour's place, wherever it stands.
    pub(crate) fn replace(&mut self, node: usize, old: usize, new: usize) {
        for place in self.rows[node].iter_mut().filter(|place| **place == old) {
            *place = new;
        }
    }
}

/// The places in use.
fn filled(row: &[usize; MOST]) -> &[usize] {
    let count = row.iter().position(|place| *place == NONE).unwrap_or(MOST);
    &row[..count]
}

fn row_of(near: impl IntoIterator<Item = usize>) -> [usize; MOST] {
    let mut row = [NONE; MOST];
    for (place, other) in row.iter_mut().zip(near) {
        *place = other;
    }
    row
}

impl Index<usize> for Adjacency {
    type Output = [usize];

    fn index(&self, node: usize) -> &[usize] {
        filled(&self.rows[node])
    }
}

/// From lists of four neighbours at most.
impl<Near: IntoIterator<Item = usize>> FromIterator<Near> for Adjacency {
    fn from_iter<Lists: IntoIterator<Item = Near>>(lists: Lists) -> Self {
        Self { rows: lists.into_iter().map(row_of).collect() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_list_has_room_for_four() {
        let mut graph = Adjacency::without_edges(6);
        for other in 1..=4 {
            graph.push(0, other);
        }
        assert_eq!(&graph[0], [1, 2, 3, 4]);
        graph.replace(0, 2, 5);
        assert_eq!(&graph[0], [1, 5, 3, 4]);
        graph.clear(0);
        graph.join(0, 5);
        assert_eq!((&graph[0], &graph[5]), ([5].as_slice(), [0].as_slice()));
    }
}
