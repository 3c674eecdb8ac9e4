//! A part with its lanes shortened to three panels each: both ends, and one between them that neighbours the ends alone. A
//! cycle must run through that one, so lengthened again it runs along the whole lane.

use crate::adjacency::Adjacency;
use crate::hamiltonian::Strip;

/// A shortened part.
pub(super) struct Shortened<'a> {
    /// Its graph.
    pub(super) graph: Adjacency,
    /// Of every node its number in the part.
    nodes: Vec<usize>,
    /// Of every node of the part the lane that it stands for.
    lane: Vec<Option<&'a [usize]>>,
}

impl<'a> Shortened<'a> {
    /// Shortens lanes of three panels at least that have no panel in common.
    pub(super) fn of(part: &Adjacency, lanes: &'a [Vec<usize>]) -> Self {
        let mut lane = vec![None; part.len()];
        let mut kept = vec![true; part.len()];
        for row in lanes {
            for panel in &row[1..row.len() - 1] {
                kept[*panel] = false;
            }
            kept[row[1]] = true;
            lane[row[1]] = Some(row.as_slice());
        }
        let nodes: Vec<usize> = (0..part.len()).filter(|node| kept[*node]).collect();
        let mut number = vec![0; part.len()];
        for (short, node) in nodes.iter().enumerate() {
            number[*node] = short;
        }
        let mut graph: Adjacency = nodes
            .iter()
            .map(|node| {
                let near = part[*node].iter().filter(|near| kept[**near] && lane[**near].is_none());
                near.map(|near| number[*near])
            })
            .collect();
        for row in lanes {
            let (first, middle, last) = (number[row[0]], number[row[1]], number[row[row.len() - 1]]);
            graph.clear(middle);
            graph.join(middle, first);
            graph.join(middle, last);
        }
        Self { graph, nodes, lane }
    }

    /// The strip through the whole part.
    pub(super) fn lengthened(&self, strip: &Strip) -> Strip {
        let count = strip.order.len();
        let mut order = Vec::with_capacity(self.lane.len());
        for (place, node) in strip.order.iter().enumerate() {
            let node = self.nodes[*node];
            match self.lane[node] {
                None => order.push(node),
                Some(row) => {
                    let between = &row[1..row.len() - 1];
                    let before = self.nodes[strip.order[(place + count - 1) % count]];
                    if before == row[0] {
                        order.extend(between);
                    } else {
                        order.extend(between.iter().rev());
                    }
                }
            }
        }
        Strip { order, closed: strip.closed }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cycle_through_a_shortened_part_runs_along_the_whole_lane() {
        // Two rows of five panels, the lower one a lane.
        let near = |node: usize| {
            let (x, y) = (node % 5, node / 5);
            let mut near = vec![(1 - y) * 5 + x];
            near.extend((x > 0).then(|| node - 1));
            near.extend((x < 4).then_some(node + 1));
            near
        };
        let part: Adjacency = (0..10).map(near).collect();
        let lanes = [vec![0, 1, 2, 3, 4]];
        let shortened = Shortened::of(&part, &lanes);
        assert_eq!(shortened.graph.len(), 8);
        let names = |order: &[usize]| -> Vec<usize> {
            order.iter().map(|name| shortened.nodes.iter().position(|node| node == name).unwrap()).collect()
        };
        for ring in [[0, 1, 4, 9, 8, 7, 6, 5], [4, 1, 0, 5, 6, 7, 8, 9]] {
            let strip = shortened.lengthened(&Strip { order: names(&ring), closed: true });
            assert_eq!(strip.order.len(), 10);
            let next = |at: usize| strip.order[(at + 1) % 10];
            assert!((0..10).all(|at| part[strip.order[at]].contains(&next(at))));
        }
    }
}
