//! The search for an order from its end: all hinges are open and close one by one. Thick panels leave little room in the
//! target and in the zygote; an order sought forwards runs into a dead end at its last steps, one sought backwards has the
//! choice where it is needed.
//!
//! What is closed stays closed, so panels that closed hinges join are one rigid cluster from then on. Where an open hinge
//! can't close for its own two clusters alone, it never will: such a closing isn't made. Of a fold that opens by 270
//! degrees, for one, a single panel must be left on one side. At other dead ends some closings are undone, and the hinges that
//! were left are preferred from then on.

use super::state::Motion;
use crate::tree::{Branch, Tree};

/// A search that may go on for so many steps.
pub(super) struct Backward<'a> {
    tree: &'a Tree,
    motion: Motion,
    /// Of some hinges, those that must be open before them.
    after: &'a [Vec<usize>],
    seed: u64,
    /// Hinges that are closed, in the order in which they were.
    closed: Vec<usize>,
    open: Vec<usize>,
    /// Of every hinge how much it is preferred.
    preferred: Vec<f64>,
    dead_ends: u64,
    /// Hinges looked at.
    looks: usize,
}

impl<'a> Backward<'a> {
    /// `motion` has all hinges closed.
    pub(super) fn new(tree: &'a Tree, mut motion: Motion, after: &'a [Vec<usize>], seed: u64) -> Self {
        let open: Vec<usize> = tree.branches().iter().map(|branch| branch.hinge).collect();
        for hinge in &open {
            motion.open(*hinge);
        }
        let preferred = vec![0.0; open.len()];
        Self { tree, motion, after, seed, closed: Vec::new(), open, preferred, dead_ends: 0, looks: 0 }
    }

    /// The order in which hinges open; none when `looks` hinges were looked at without one.
    pub(super) fn run(&mut self, looks: usize) -> Option<Vec<usize>> {
        while !self.open.is_empty() {
            if self.looks > looks {
                return None;
            }
            self.sort();
            if let Some(place) = (0..self.open.len()).rev().find(|place| self.try_close(self.open[*place])) {
                self.closed.push(self.open.remove(place));
            } else {
                self.undo();
            }
        }
        Some(self.closed.iter().rev().copied().collect())
    }

    /// Puts the preferred ones last; chance decides between equals.
    fn sort(&mut self) {
        let worth = |hinge: usize| self.preferred[hinge] + lot(self.seed, self.dead_ends, hinge as u64);
        let worths: Vec<f64> = (0..self.preferred.len()).map(worth).collect();
        self.open.sort_by(|a, b| worths[*a].total_cmp(&worths[*b]));
    }

    /// Closes a hinge if nothing is in its way, and no hinge is shut out by that.
    fn try_close(&mut self, hinge: usize) -> bool {
        self.looks += 1;
        let waits = |other: &usize| self.after.get(*other).is_some_and(|before| before.contains(&hinge));
        if self.open.iter().any(waits) {
            return false;
        }
        self.motion.close(hinge);
        let good = self.motion.blocked(hinge).is_none() && !self.shuts_out(hinge);
        if !good {
            self.motion.open(hinge);
        }
        good
    }

    /// Whether some open hinge can't close any more for the clusters that it joins, one of which a hinge just made.
    fn shuts_out(&mut self, hinge: usize) -> bool {
        let cluster = self.clusters();
        let made = self
            .tree
            .branches()
            .iter()
            .find(|branch| branch.hinge == hinge)
            .map(|branch| cluster[branch.child]);
        let beside: Vec<(usize, [usize; 2])> = self
            .tree
            .branches()
            .iter()
            .map(|branch| (branch.hinge, [cluster[branch.parent], cluster[branch.child]]))
            .filter(|(_, [a, b])| a != b && (Some(*a) == made || Some(*b) == made))
            .collect();
        beside.into_iter().any(|(other, sides)| {
            self.motion.close(other);
            let shut = self.motion.blocked_among(other, &|panel| sides.contains(&cluster[panel]));
            self.motion.open(other);
            shut
        })
    }

    /// For every panel the name of its cluster.
    fn clusters(&self) -> Vec<usize> {
        let mut cluster: Vec<usize> = (0..self.motion.linkage().panels()).collect();
        // Parents come before children.
        for Branch { hinge, parent, child, .. } in self.tree.branches() {
            if !self.motion.is_open(*hinge) {
                cluster[*child] = cluster[*parent];
            }
        }
        cluster
    }

    /// Opens some of the last closed hinges again, more from one dead end to the next, and prefers those that were left.
    fn undo(&mut self) {
        self.dead_ends += 1;
        for hinge in &self.open {
            self.preferred[*hinge] += 1.0;
        }
        let most = 2_u32 << (self.dead_ends % 7);
        let wanted = lot(self.seed, self.dead_ends, u64::MAX) * f64::from(most);
        let kept = (0..self.closed.len()).rev().find(|kept| (self.closed.len() - kept) as f64 > wanted);
        for hinge in self.closed.split_off(kept.unwrap_or(0)).into_iter().rev() {
            self.motion.open(hinge);
            self.open.push(hinge);
        }
    }
}

/// A number from 0 to 1 that looks like chance, the same in every run.
fn lot(seed: u64, round: u64, which: u64) -> f64 {
    let mixed = (which ^ seed.rotate_left(32) ^ round.rotate_left(16)).wrapping_mul(0x9E37_79B9_7F4A_7C15);
    let mixed = (mixed ^ (mixed >> 29)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    (mixed >> 32) as f64 / f64::from(u32::MAX)
}
