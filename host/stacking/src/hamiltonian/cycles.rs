//! The cycles of a cover: which one a node is in, and where in it. Tells what an exchange would do to their number.
//!
//! A cycle is a list of segments, a segment a short row of nodes that may be read backwards. So joining, cutting and turning
//! a cycle of a million nodes touches some thousand entries, and not every node of it.

use super::cover::Cover;
use super::segments::Segments;
use std::collections::{BTreeMap, BTreeSet};

type Edge = (usize, usize);

/// The cycles, kept up to date with the cover.
pub(super) struct Cycles {
    segments: Segments,
    /// Of every cycle its length and its segments in order.
    known: BTreeMap<usize, (usize, Vec<usize>)>,
    /// The cycles by length.
    by_length: BTreeSet<(usize, usize)>,
    next_name: usize,
}

impl Cycles {
    pub(super) fn of(cover: &Cover) -> Self {
        let mut segments = Segments::new(cover.nodes());
        let (known, by_length) = (BTreeMap::new(), BTreeSet::new());
        let mut rows: Vec<Vec<usize>> = Vec::new();
        for node in 0..cover.nodes() {
            if !segments.holds(node) {
                rows.push(segments.cut_up(cover.walk(node)));
            }
        }
        let mut cycles = Self { segments, known, by_length, next_name: 0 };
        for row in rows {
            cycles.name(row);
        }
        cycles
    }

    /// The number of cycles.
    pub(super) fn count(&self) -> usize {
        self.known.len()
    }

    /// Length and name of every cycle, the shortest first.
    pub(super) fn by_length(&self) -> impl DoubleEndedIterator<Item = (usize, usize)> {
        self.by_length.iter().copied()
    }

    /// Length of a cycle and one of its nodes; none when there is no cycle of that name (any more).
    pub(super) fn length_and_member(&self, name: usize) -> Option<(usize, usize)> {
        let (length, row) = self.known.get(&name)?;
        Some((*length, self.segments.first(row[0])))
    }

    /// The name of a node's cycle.
    pub(super) fn cycle_of(&self, node: usize) -> usize {
        self.segments.of(node).cycle
    }

    fn name(&mut self, row: Vec<usize>) -> usize {
        let name = self.next_name;
        self.next_name += 1;
        let mut length = 0;
        for (rank, segment) in row.iter().enumerate() {
            length += self.segments.place(*segment, name, rank);
        }
        self.by_length.insert((length, name));
        self.known.insert(name, (length, row));
        name
    }

    /// After an exchange: cuts the cycles that it touched where edges went, and joins the pieces where edges came. Gives
    /// the names of the cycles that come of it.
    pub(super) fn renew(&mut self, removed: &[Edge], added: &[Edge]) -> Vec<usize> {
        let mut cuts: Vec<(usize, u64, usize)> =
            removed.iter().map(|(u, v)| self.cut_after(*u, *v)).collect();
        cuts.sort_unstable();
        let mut pieces: Vec<Vec<usize>> = Vec::with_capacity(cuts.len());
        for cuts in cuts.chunk_by(|a, b| a.0 == b.0) {
            let name = cuts[0].0;
            let Some((length, mut row)) = self.known.remove(&name) else { continue };
            self.by_length.remove(&(length, name));
            // From the last cut to the first, so that ranks before a cut hold.
            let mut tail = Vec::new();
            for (number, (_, _, last)) in cuts.iter().enumerate().rev() {
                let rank = self.segments.of(*last).rank;
                let after = row.split_off(rank + 1);
                let beyond = self.segments.split_after(*last);
                let piece = beyond.into_iter().chain(after).collect();
                if number + 1 == cuts.len() { tail = piece } else { pieces.push(piece) }
            }
            // The piece after the last cut goes on with the nodes before the first.
            tail.extend(row);
            pieces.push(tail);
        }
        let rows = self.joined(pieces, added);
        rows.into_iter()
            .map(|row| {
                let row = self.segments.merge_small(row);
                self.name(row)
            })
            .collect()
    }

    /// Strings pieces together along the added edges, into a row of segments for each cycle.
    fn joined(&mut self, pieces: Vec<Vec<usize>>, added: &[Edge]) -> Vec<Vec<usize>> {
        let ends = |segments: &Segments, piece: &[usize]| {
            (segments.first(piece[0]), segments.last(piece[piece.len() - 1]))
        };
        let mut left: Vec<Option<Vec<usize>>> = pieces.into_iter().map(Some).collect();
        let mut free: Vec<Edge> = added.to_vec();
        let mut rows = Vec::new();
        while let Some(mut row) = left.iter_mut().find_map(Option::take) {
            loop {
                let (_, last) = ends(&self.segments, &row);
                let Some(way) = free.iter().position(|(u, v)| *u == last || *v == last) else { break };
                let (u, v) = free.swap_remove(way);
                let next = if u == last { v } else { u };
                let found = left.iter_mut().find_map(|place| {
                    let (first, last) = ends(&self.segments, place.as_ref()?);
                    (first == next || last == next)
                        .then(|| place.take().map(|piece| (piece, first == next)))?
                });
                // No piece is left there: the edge closes the cycle.
                let Some((mut piece, forwards)) = found else { break };
                if !forwards {
                    piece.reverse();
                    for segment in &piece {
                        self.segments.turn(*segment);
                    }
                }
                row.extend(piece);
            }
            rows.push(row);
        }
        rows
    }

    /// By how much an exchange would change the number of cycles. Removing edges cuts the cycles into pieces; what is
    /// joined by the added edges is one cycle each.
    pub(super) fn change(&self, removed: &[Edge], added: &[Edge]) -> isize {
        let mut cuts: Vec<(usize, u64)> = removed
            .iter()
            .map(|(u, v)| {
                let (name, position, _) = self.cut_after(*u, *v);
                (name, position)
            })
            .collect();
        cuts.sort_unstable();
        // A piece is named by the cut after which it ends.
        let piece = |node: usize| {
            let (name, position) = self.segments.position(node);
            let first = cuts.partition_point(|cut| cut.0 < name);
            let last = cuts.partition_point(|cut| cut.0 <= name);
            let index = cuts.partition_point(|cut| *cut < (name, position));
            if index == last { first } else { index }
        };
        let mut group: Vec<usize> = (0..cuts.len()).collect();
        let mut after = cuts.len();
        for (u, v) in added {
            let (a, b) = (group[piece(*u)], group[piece(*v)]);
            if a != b {
                after -= 1;
                for member in &mut group {
                    if *member == a {
                        *member = b;
                    }
                }
            }
        }
        let before = cuts.chunk_by(|a, b| a.0 == b.0).count();
        after.cast_signed() - before.cast_signed()
    }

    /// The cycle of an edge, and position and name of the node after which the edge lies.
    fn cut_after(&self, u: usize, v: usize) -> (usize, u64, usize) {
        let ((name, at_u), (_, at_v)) = (self.segments.position(u), self.segments.position(v));
        let (low, high) = if at_u < at_v { ((at_u, u), (at_v, v)) } else { ((at_v, v), (at_u, u)) };
        let row = &self.known[&name].1;
        let wraps = low.1 == self.segments.first(row[0]) && high.1 == self.segments.last(row[row.len() - 1]);
        let (position, node) = if wraps { high } else { low };
        (name, position, node)
    }
}

#[cfg(test)]
mod tests {
    use super::super::segments::Segment;
    use super::*;

    #[test]
    fn cycles_follow_exchanges_of_any_kind() {
        use crate::random::Random;
        let nodes = 4 * Segment::LONGEST;
        let mut random = Random::new(1, 1);
        let mut cover = Cover::new(nodes);
        let mut ring: Vec<usize> = (0..nodes).collect();
        random.shuffle(&mut ring);
        for pair in ring.windows(2) {
            cover.link(pair[0], pair[1]);
        }
        cover.link(ring[0], ring[nodes - 1]);
        let mut cycles = Cycles::of(&cover);
        for _ in 0..300 {
            let mut random_edge = || {
                let u = random.below(nodes);
                let v = cover.mates(u).nth(random.below(2)).unwrap();
                (u, v)
            };
            let ((a, b), (c, d)) = (random_edge(), random_edge());
            if [a, b].contains(&c) || [a, b].contains(&d) || cover.has(b, c) || cover.has(d, a) {
                continue;
            }
            let (removed, added) = ([(a, b), (c, d)], [(b, c), (d, a)]);
            let expected = cycles.count().cast_signed() + cycles.change(&removed, &added);
            cover.exchange(&removed, &added);
            cycles.renew(&removed, &added);
            let fresh = Cycles::of(&cover);
            assert_eq!(cycles.count(), fresh.count());
            assert_eq!(cycles.count().cast_signed(), expected);
            for node in 0..nodes {
                let beside = cover.mates(node).all(|mate| cycles.cycle_of(mate) == cycles.cycle_of(node));
                assert!(beside, "a node and its mates are in one cycle");
            }
            let total: usize = cycles.by_length.iter().map(|(length, _)| length).sum();
            assert_eq!(total, nodes);
        }
    }
}
