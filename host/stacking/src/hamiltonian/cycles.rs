//! The cycles of a cover: which one a node is in, and where in it. Tells what an exchange would do to their number.

use super::cover::Cover;
use std::collections::{BTreeMap, BTreeSet};

/// The cycles, kept up to date with the cover.
pub(super) struct Cycles {
    /// Of every node its cycle, and its position in it.
    place: Vec<(usize, usize)>,
    /// Of every cycle its length and one of its nodes.
    known: BTreeMap<usize, (usize, usize)>,
    /// The cycles by length.
    by_length: BTreeSet<(usize, usize)>,
    next_name: usize,
}

impl Cycles {
    pub(super) fn of(cover: &Cover) -> Self {
        let place = vec![(usize::MAX, 0); cover.nodes()];
        let mut cycles = Self { place, known: BTreeMap::new(), by_length: BTreeSet::new(), next_name: 0 };
        for node in 0..cover.nodes() {
            if cycles.place[node].0 == usize::MAX {
                cycles.name(cover, node);
            }
        }
        cycles
    }

    /// The number of cycles.
    pub(super) fn count(&self) -> usize {
        self.known.len()
    }

    /// One node of each of the shortest cycles, with the length of the cycle.
    pub(super) fn shortest(&self, how_many: usize) -> Vec<(usize, usize)> {
        self.by_length.iter().take(how_many).map(|(length, name)| (*length, self.known[name].1)).collect()
    }

    fn name(&mut self, cover: &Cover, start: usize) {
        let name = self.next_name;
        self.next_name += 1;
        let mut length = 0;
        for node in cover.walk(start) {
            self.place[node] = (name, length);
            length += 1;
        }
        self.known.insert(name, (length, start));
        self.by_length.insert((length, name));
    }

    /// After an exchange: names the cycles anew that it touched.
    pub(super) fn renew(&mut self, cover: &Cover, removed: &[(usize, usize)]) {
        let touched = || removed.iter().flat_map(|(u, v)| [*u, *v]);
        let old: BTreeSet<usize> = touched().map(|node| self.place[node].0).collect();
        for name in &old {
            if let Some((length, _)) = self.known.remove(name) {
                self.by_length.remove(&(length, *name));
            }
        }
        for node in touched() {
            if old.contains(&self.place[node].0) {
                self.name(cover, node);
            }
        }
    }

    /// By how much an exchange would change the number of cycles. Removing edges cuts the cycles into pieces; what is
    /// joined by the added edges is one cycle each.
    pub(super) fn change(&self, removed: &[(usize, usize)], added: &[(usize, usize)]) -> isize {
        let mut cuts: Vec<(usize, usize)> = removed.iter().map(|(u, v)| self.cut_after(*u, *v)).collect();
        cuts.sort_unstable();
        // A piece is named by the cut after which it ends.
        let piece = |node: usize| {
            let (name, position) = self.place[node];
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

    /// The cycle of an edge and the position after which the edge lies.
    fn cut_after(&self, u: usize, v: usize) -> (usize, usize) {
        let ((name, at_u), (_, at_v)) = (self.place[u], self.place[v]);
        let (low, high) = (at_u.min(at_v), at_u.max(at_v));
        (name, if high == low + 1 { low } else { high })
    }
}
