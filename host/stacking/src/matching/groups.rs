//! Which piles hang together by matches.

use crate::random::Random;
use crate::sets::Sets;
use std::collections::BTreeSet;

/// The groups of piles.
pub(crate) struct Groups {
    /// Of every pile a name of its group.
    pub(super) of: Vec<usize>,
    /// Piles that are neighbours on the grid and share cut edges.
    pairs: BTreeSet<(usize, usize)>,
}

impl Groups {
    /// The groups of so many piles: of neighbours on the grid it is told whether they match.
    pub(super) fn new(piles: usize, pairs: impl Iterator<Item = ((usize, usize), bool)>) -> Self {
        let mut sets = Sets::new(piles);
        let mut all = BTreeSet::new();
        // Borders tell of the same two piles many times in a row.
        let mut last = None;
        for ((a, b), matches) in pairs {
            if last.replace((a, b)) != Some((a, b)) {
                all.insert((a, b));
            }
            if matches {
                sets.join(a, b);
            }
        }
        Self { of: (0..piles).map(|pile| sets.find(pile)).collect(), pairs: all }
    }

    /// How many groups there are.
    pub(super) fn count(&self) -> usize {
        self.of.iter().collect::<BTreeSet<_>>().len()
    }

    /// Two piles side by side, of different groups; none where all hang together.
    pub(crate) fn border(&self, random: &mut Random) -> Option<(usize, usize)> {
        let apart: Vec<(usize, usize)> =
            self.pairs.iter().filter(|(a, b)| self.of[*a] != self.of[*b]).copied().collect();
        if apart.is_empty() {
            return None;
        }
        let (a, b) = apart[random.below(apart.len())];
        Some(if random.below(2) == 0 { (a, b) } else { (b, a) })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn piles_hang_together_along_matches_and_borders_lie_between_groups() {
        let pairs = [((0, 1), true), ((1, 2), false), ((1, 2), true), ((2, 3), false), ((3, 4), true)];
        let groups = Groups::new(5, pairs.into_iter());
        assert_eq!(groups.count(), 2);
        let mut random = Random::new(1, 1);
        let found: BTreeSet<_> = (0..50).filter_map(|_| groups.border(&mut random)).collect();
        assert_eq!(found, BTreeSet::from([(2, 3), (3, 2)]));
    }

    #[test]
    fn piles_of_one_group_have_no_border() {
        let groups = Groups::new(3, [((0, 1), true), ((0, 2), true), ((1, 2), false)].into_iter());
        assert_eq!(groups.border(&mut Random::new(1, 1)), None);
    }
}
