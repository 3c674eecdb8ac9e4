//! The search for an order from the root outwards: of the hinges whose panel is reached, the first by some preference that
//! nothing blocks. What opens stays open, so an attempt may come to a dead end; then the hinge that something blocks least
//! opens all the same, so that the least bad order can be told.

use super::state::Motion;
use crate::tree::Tree;
use std::cmp::Reverse;
use zygote_stacking::{HingeKind, Plan};

/// What is preferred among hinges that may open.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Preference {
    /// What carries other piles, and of those what carries most: wide rests move while little is open.
    Wide,
    /// Strip by strip, the last one reached first.
    Deep,
    /// What carries least.
    Light,
}

/// All of them, the most promising first.
pub(super) const PREFERENCES: [Preference; 3] = [Preference::Wide, Preference::Deep, Preference::Light];

/// Of every hinge what it carries, seen from the root.
pub(super) struct Forward {
    panels: Vec<usize>,
    bridges: Vec<usize>,
    /// The hinges that come after each; those at the root at the end.
    next: Vec<Vec<usize>>,
}

impl Forward {
    pub(super) fn new(plan: &Plan, tree: &Tree) -> Self {
        let hinges = plan.hinges.len();
        let mut new =
            Self { panels: vec![1; hinges], bridges: vec![0; hinges], next: vec![Vec::new(); hinges + 1] };
        for branch in tree.branches().iter().rev() {
            new.bridges[branch.hinge] += usize::from(plan.hinges[branch.hinge].kind == HingeKind::Bridge);
            if let Some(before) = branch.before {
                new.panels[before] += new.panels[branch.hinge];
                new.bridges[before] += new.bridges[branch.hinge];
            }
        }
        for branch in tree.branches().iter().rev() {
            new.next[branch.before.unwrap_or(hinges)].push(branch.hinge);
        }
        new
    }

    /// The order, and how many hinges in it are blocked; none where that are not less than `most`. `after` has of some
    /// hinges those that must be open before them; where that leads to a dead end, there is none either.
    pub(super) fn run(
        &self,
        mut motion: Motion,
        preference: Preference,
        most: Option<usize>,
        after: &[Vec<usize>],
    ) -> Option<(Vec<usize>, usize)> {
        let hinges = motion.linkage().hinges();
        let mut ready = self.next[hinges].clone();
        let mut order = Vec::with_capacity(hinges);
        let mut blocked = 0;
        while !ready.is_empty() {
            self.sort(&mut ready, preference);
            let mut depths = vec![0.0; ready.len()];
            let may = |hinge: usize| {
                after.get(hinge).is_none_or(|others| others.iter().all(|other| motion.is_open(*other)))
            };
            let mut ready_now = (0..ready.len()).rev().filter(|place| may(ready[*place]));
            let free = ready_now.find(|place| match motion.blocked(ready[*place]) {
                None => true,
                Some(collision) => {
                    depths[*place] = collision.depth;
                    false
                }
            });
            let place = if let Some(place) = free {
                place
            } else {
                blocked += 1;
                if most.is_some_and(|most| blocked >= most) {
                    return None;
                }
                (0..ready.len())
                    .filter(|place| may(ready[*place]))
                    .min_by(|a, b| depths[*a].total_cmp(&depths[*b]))?
            };
            let hinge = ready.remove(place);
            motion.open(hinge);
            order.push(hinge);
            ready.extend(&self.next[hinge]);
        }
        Some((order, blocked))
    }

    /// Puts the preferred ones last.
    fn sort(&self, ready: &mut [usize], preference: Preference) {
        let Self { panels, bridges, .. } = self;
        match preference {
            Preference::Wide => ready.sort_by_key(|hinge| (bridges[*hinge], panels[*hinge], Reverse(*hinge))),
            Preference::Deep => {}
            Preference::Light => ready.sort_by_key(|hinge| Reverse((panels[*hinge], *hinge))),
        }
    }
}
