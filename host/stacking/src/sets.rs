//! Disjoint sets that only ever join: near linear, since every search halves the way it went.

/// Members 0 to n - 1, at first each in a set of its own.
#[derive(Debug, Clone)]
pub(crate) struct Sets {
    parent: Vec<usize>,
}

impl Sets {
    /// So many sets of one member.
    pub(crate) fn new(members: usize) -> Self {
        Self { parent: (0..members).collect() }
    }

    /// The name of the set that a member is in: one of its members.
    pub(crate) fn find(&mut self, mut member: usize) -> usize {
        while self.parent[member] != member {
            self.parent[member] = self.parent[self.parent[member]];
            member = self.parent[member];
        }
        member
    }

    /// Makes one set of two members' sets, by the name of the second; says whether they were two.
    pub(crate) fn join(&mut self, a: usize, b: usize) -> bool {
        let (a, b) = (self.find(a), self.find(b));
        self.parent[a] = b;
        a != b
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Random;

    #[test]
    fn members_share_a_name_just_when_joins_lead_from_one_to_the_other() {
        let mut random = Random::new(3, 1);
        for _ in 0..50 {
            let mut sets = Sets::new(20);
            // The same by relabelling everything at every join.
            let mut label: Vec<usize> = (0..20).collect();
            for _ in 0..18 {
                let (a, b) = (random.below(20), random.below(20));
                let (from, to) = (label[a], label[b]);
                assert_eq!(sets.join(a, b), from != to);
                label.iter_mut().filter(|label| **label == from).for_each(|label| *label = to);
                for (one, other) in (0..20).flat_map(|one| (0..one).map(move |other| (one, other))) {
                    assert_eq!(sets.find(one) == sets.find(other), label[one] == label[other]);
                }
            }
        }
    }
}
