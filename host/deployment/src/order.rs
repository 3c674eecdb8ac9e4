//! The order in which hinges open, and which of them must wait for which: what the search for a free motion hands to the
//! scheduler.

use crate::tree::Tree;
use std::cmp::Reverse;
use std::collections::BinaryHeap;

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

    /// The same with more waits: of each pair the first hinge starts only when the second is open. Hinges change places only
    /// where that asks for it.
    ///
    /// # Errors
    /// [`WaitError`] for a hinge that there isn't, and for hinges that would wait for each other in a circle.
    pub fn with_waits(&self, waits: &[(usize, usize)]) -> Result<Self, WaitError> {
        let hinges = self.waits_for.len();
        let mut waits_for = self.waits_for.clone();
        for &(hinge, other) in waits {
            for hinge in [hinge, other] {
                if hinge >= hinges {
                    return Err(WaitError::NoHinge { hinge, hinges });
                }
            }
            waits_for[hinge].push(other);
        }
        for others in &mut waits_for {
            others.sort_unstable();
            others.dedup();
        }
        let order = in_order(&self.hinges, &waits_for);
        if order.len() < self.hinges.len() {
            let first = waits.iter().map(|(hinge, _)| *hinge);
            return Err(WaitError::Circle { hinges: circle(&waits_for, &order, first) });
        }
        Ok(Self { hinges: order, waits_for })
    }

    /// The same where some hinges move alone: they wait for all that stand before them, and all behind wait for them.
    #[must_use]
    pub fn with_alone(mut self, alone: &dyn Fn(usize) -> bool) -> Self {
        let mut last = None;
        let mut since = Vec::new();
        for &hinge in &self.hinges {
            let others = &mut self.waits_for[hinge];
            others.extend(last);
            if alone(hinge) {
                others.append(&mut since);
                last = Some(hinge);
            } else {
                since.push(hinge);
            }
            others.sort_unstable();
            others.dedup();
        }
        self
    }
}

/// Waits that can't be kept.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum WaitError {
    /// A hinge that the plan doesn't have.
    #[error(
        "hinge {hinge} is to wait or to be waited for, expected one of the plan's {hinges} hinges, numbered from 0"
    )]
    NoHinge {
        /// What was named.
        hinge: usize,
        /// Hinges of the plan.
        hinges: usize,
    },
    /// Hinges that wait for each other.
    #[error("hinges would wait for each other in a circle: {}", chain(hinges))]
    Circle {
        /// Each waits for the next, the last one for the first.
        hinges: Vec<usize>,
    },
}

/// Hinges that wait for each other, in words.
fn chain(hinges: &[usize]) -> String {
    let names: Vec<_> = hinges.iter().chain(hinges.first()).map(usize::to_string).collect();
    names.join(" for ")
}

/// Hinges, each after all that it waits for, else as they stand; those that wait for each other, and for such, are left out.
fn in_order(hinges: &[usize], waits_for: &[Vec<usize>]) -> Vec<usize> {
    let mut place_of = vec![0; waits_for.len()];
    let mut followers = vec![Vec::new(); waits_for.len()];
    for (place, hinge) in hinges.iter().enumerate() {
        place_of[*hinge] = place;
        for other in &waits_for[*hinge] {
            followers[*other].push(*hinge);
        }
    }
    let mut missing: Vec<_> = waits_for.iter().map(Vec::len).collect();
    let none_missing = hinges.iter().filter(|hinge| missing[**hinge] == 0);
    let mut ready: BinaryHeap<_> = none_missing.map(|hinge| Reverse(place_of[*hinge])).collect();
    let mut order = Vec::with_capacity(hinges.len());
    while let Some(Reverse(place)) = ready.pop() {
        order.push(hinges[place]);
        for &follower in &followers[hinges[place]] {
            missing[follower] -= 1;
            if missing[follower] == 0 {
                ready.push(Reverse(place_of[follower]));
            }
        }
    }
    order
}

/// Hinges that wait for each other in a circle, all of those that `order` leaves out; best one that `first` has a hinge of.
fn circle(waits_for: &[Vec<usize>], order: &[usize], first: impl Iterator<Item = usize>) -> Vec<usize> {
    let mut left = vec![true; waits_for.len()];
    for hinge in order {
        left[*hinge] = false;
    }
    // Whatever is left waits for something that is left, so this walk comes round.
    let mut walk = Vec::new();
    let mut next = first.chain(0..waits_for.len()).find(|hinge| left[*hinge]);
    while let Some(hinge) = next {
        if let Some(start) = walk.iter().position(|other| *other == hinge) {
            return walk.split_off(start);
        }
        walk.push(hinge);
        next = waits_for[hinge].iter().copied().find(|other| left[*other]);
    }
    walk
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
    fn more_waits_move_hinges_only_where_they_must() {
        let order = Order { hinges: vec![0, 1, 2, 3], waits_for: vec![vec![], vec![0], vec![], vec![2]] };
        let more = order.with_waits(&[(1, 3), (1, 2), (1, 3)]).expect("no circle");
        assert_eq!(more.hinges, [0, 2, 3, 1]);
        assert_eq!(more.waits_for, [vec![], vec![0, 2, 3], vec![], vec![2]]);
        assert_eq!(order.with_waits(&[]).expect("the same"), order);
    }

    #[test]
    fn waits_in_a_circle_are_refused_with_its_hinges() {
        let order = Order { hinges: vec![0, 1, 2, 3], waits_for: vec![vec![], vec![0], vec![1], vec![]] };
        let refusal = |waits: &[(usize, usize)]| order.with_waits(waits).expect_err("a circle").to_string();
        assert_eq!(refusal(&[(3, 3)]), "hinges would wait for each other in a circle: 3 for 3");
        assert_eq!(refusal(&[(0, 2)]), "hinges would wait for each other in a circle: 0 for 2 for 1 for 0");
        // Hinge 2 only waits for what is in the circle.
        assert_eq!(
            refusal(&[(2, 3), (0, 3), (3, 1)]),
            "hinges would wait for each other in a circle: 1 for 0 for 3 for 1"
        );
        let none =
            "hinge 4 is to wait or to be waited for, expected one of the plan's 4 hinges, numbered from 0";
        assert_eq!((refusal(&[(4, 0)]), refusal(&[(0, 4)])), (none.to_owned(), none.to_owned()));
    }

    #[test]
    fn what_moves_alone_parts_what_is_before_it_from_what_is_behind() {
        let free = Order { hinges: vec![4, 0, 1, 3, 2], waits_for: vec![vec![]; 5] };
        let order = free.with_alone(&|hinge| hinge == 1 || hinge == 3);
        assert_eq!(order.waits_for, [vec![], vec![0, 4], vec![3], vec![1], vec![]]);
    }

    #[test]
    fn in_the_order_of_the_tree_a_strip_opens_from_end_to_end() {
        let tree = Tree::new(&strip(4)).expect("a tree");
        assert_eq!(Order::of_tree(&tree), Order::one_by_one(vec![0, 1, 2]));
    }
}
