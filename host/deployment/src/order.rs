//! The order in which hinges open, and which of them must wait for which: what the search for a free motion hands to the
//! scheduler.

use crate::tree::Tree;

/// An order of all hinges of a plan.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Order {
    /// All hinges, each after all that it waits for.
    pub hinges: Vec<usize>,
    /// Of every hinge, those that must be open before it starts, rising. Hinges that neither wait for the other, directly or
    /// through others, may move at once.
    pub waits_for: Vec<Vec<usize>>,
}

impl Order {
    /// One hinge after the other.
    pub fn one_by_one(hinges: Vec<usize>) -> Self {
        let mut waits_for = vec![Vec::new(); hinges.len()];
        for pair in hinges.windows(2) {
            waits_for[pair[1]].push(pair[0]);
        }
        Self { hinges, waits_for }
    }

    /// The order of the tree from the root out; every hinge waits for the one before it alone. Nothing has looked for
    /// collisions.
    pub fn of_tree(tree: &Tree) -> Self {
        let mut waits_for = vec![Vec::new(); tree.branches().len()];
        for branch in tree.branches() {
            waits_for[branch.hinge].extend(branch.before);
        }
        Self { hinges: tree.branches().iter().map(|branch| branch.hinge).collect(), waits_for }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::strip;

    #[test]
    fn one_by_one_every_hinge_waits_for_the_last() {
        let order = Order::one_by_one(vec![2, 0, 1]);
        assert_eq!(order.waits_for, [vec![2], vec![0], vec![]]);
    }

    #[test]
    fn in_the_order_of_the_tree_a_strip_opens_from_end_to_end() {
        let tree = Tree::new(&strip(4)).expect("a tree");
        assert_eq!(Order::of_tree(&tree), Order::one_by_one(vec![0, 1, 2]));
    }
}
