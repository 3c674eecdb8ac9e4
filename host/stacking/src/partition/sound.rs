//! Cheap proofs that a part has no Hamiltonian cycle, before any search for one.

use super::pieces;
use crate::adjacency::Adjacency;

/// Some nodes of a graph: those that bear the name of one part.
#[derive(Clone, Copy)]
pub(super) struct Part<'a> {
    pub(super) graph: &'a Adjacency,
    /// Of every node the name of its part.
    pub(super) name_of: &'a [usize],
    pub(super) name: usize,
}

impl<'a> Part<'a> {
    fn has(self, node: usize) -> bool {
        self.name_of[node] == self.name
    }

    fn nodes(self) -> impl Iterator<Item = usize> + 'a {
        (0..self.graph.len()).filter(move |node| self.has(*node))
    }

    fn near(self, node: usize) -> impl Iterator<Item = usize> + 'a {
        self.graph[node].iter().copied().filter(move |near| self.has(*near))
    }

    /// What keeps the part from having a Hamiltonian cycle as far as cheap tests can tell, as a number that falls as it gets
    /// nearer to having one: further pieces, panels with less than two neighbours, a surplus of one colour where it can be
    /// coloured like a chess board, panels that hold it together.
    pub(super) fn defects(self) -> usize {
        let pieces = pieces(self.graph, |node| self.has(node)).len();
        let ends = self.nodes().filter(|node| self.near(*node).nth(1).is_none()).count();
        let defects = 4 * pieces.saturating_sub(1) + 2 * ends;
        if defects > 0 {
            return defects + self.surplus();
        }
        self.surplus() + self.articulations().len()
    }

    /// The panels at which the part is weak: ends, and panels that hold it together.
    pub(super) fn weak_spots(self) -> Vec<usize> {
        let mut spots = self.articulations();
        spots.extend(self.nodes().filter(|node| self.near(*node).nth(1).is_none()));
        spots
    }

    /// By how much one colour outnumbers the other; 0 where the part can't be coloured.
    fn surplus(self) -> usize {
        let Some(start) = self.nodes().next() else { return 0 };
        let mut dark: Vec<Option<bool>> = vec![None; self.graph.len()];
        dark[start] = Some(true);
        let mut reached = vec![start];
        let (mut count, mut of_dark) = (0, 0usize);
        while let Some(node) = reached.pop() {
            count += 1;
            of_dark += usize::from(dark[node] == Some(true));
            let other = dark[node].map(|dark| !dark);
            for next in self.near(node) {
                if dark[next].is_none() {
                    dark[next] = other;
                    reached.push(next);
                } else if dark[next] != other {
                    return 0;
                }
            }
        }
        (2 * of_dark).abs_diff(count)
    }

    /// The nodes that the part falls apart without (Hopcroft and Tarjan 1973), without recursion.
    fn articulations(self) -> Vec<usize> {
        let Some(start) = self.nodes().next() else { return Vec::new() };
        let mut found = vec![usize::MAX; self.graph.len()];
        let mut low = vec![usize::MAX; self.graph.len()];
        let mut parts_off = vec![false; self.graph.len()];
        (found[start], low[start]) = (0, 0);
        let mut time = 1;
        let mut children_of_start = 0;
        let mut way = vec![(start, usize::MAX, 0)];
        while let Some((node, parent, next)) = way.last_mut() {
            let (node, parent) = (*node, *parent);
            if let Some(&other) = self.graph[node].get(*next) {
                *next += 1;
                if !self.has(other) {
                    continue;
                }
                if found[other] == usize::MAX {
                    children_of_start += usize::from(node == start);
                    (found[other], low[other]) = (time, time);
                    time += 1;
                    way.push((other, node, 0));
                } else if other != parent {
                    low[node] = low[node].min(found[other]);
                }
            } else {
                way.pop();
                if parent != usize::MAX {
                    low[parent] = low[parent].min(low[node]);
                    parts_off[parent] |= parent != start && low[node] >= found[parent];
                }
            }
        }
        parts_off[start] = children_of_start > 1;
        (0..parts_off.len()).filter(|node| parts_off[*node]).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn defects(graph: &Adjacency) -> usize {
        Part { graph, name_of: &vec![0; graph.len()], name: 0 }.defects()
    }

    fn graph(nodes: usize, edges: &[(usize, usize)]) -> Adjacency {
        let mut graph = Adjacency::without_edges(nodes);
        for (a, b) in edges {
            graph.join(*a, *b);
        }
        graph
    }

    #[test]
    fn a_ring_may_have_a_cycle() {
        assert_eq!(0, defects(&graph(4, &[(0, 1), (1, 2), (2, 3), (3, 0)])));
        assert_eq!(0, defects(&graph(3, &[(0, 1), (1, 2), (2, 0)])));
    }

    #[test]
    fn two_rings_that_share_a_panel_have_none() {
        let bow = [(0, 1), (1, 2), (2, 0), (2, 3), (3, 4), (4, 2)];
        assert_ne!(0, defects(&graph(5, &bow)));
        // The same with the shared panel first, where the search begins.
        let turned = [(0, 1), (1, 2), (2, 0), (0, 3), (3, 4), (4, 0)];
        assert_ne!(0, defects(&graph(5, &turned)));
    }

    #[test]
    fn a_dead_end_two_pieces_and_unequal_colours_have_none() {
        assert_ne!(0, defects(&graph(4, &[(0, 1), (1, 2), (2, 0), (2, 3)])));
        assert_ne!(0, defects(&graph(6, &[(0, 1), (1, 2), (2, 0), (3, 4), (4, 5), (5, 3)])));
        let two_and_three = [(0, 2), (0, 3), (0, 4), (1, 2), (1, 3), (1, 4)];
        assert_ne!(0, defects(&graph(5, &two_and_three)));
    }
}
