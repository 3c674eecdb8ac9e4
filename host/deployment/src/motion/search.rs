//! The search for an order in which all hinges open without a collision.
//!
//! Orders are built step by step: of the hinges that may open, the first by some preference that nothing blocks. What
//! opens is never closed again, so an attempt may come to a dead end; then another preference, another root or chance
//! tries anew. With one hinge at a time it doesn't matter which side of it stands still, so a root only says which
//! orders are tried: those from it outwards, and at last any.

use super::state::{Ground, Motion};
use super::thickness::{MotionError, Thickness};
use crate::tree::Tree;
use std::cmp::Reverse;
use std::collections::BTreeSet;
use zygote_stacking::{HingeKind, Plan};

/// Attempts by chance from each root, and in any order.
const BY_CHANCE: u64 = 6;
/// Roots tried beside the plan's own.
const ROOTS: usize = 6;

/// Which orders are tried.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Scope {
    /// From the root outwards: each hinge after the one before it.
    FromRoot,
    /// Any order: hinges farther out may open first.
    Any,
}

/// What is preferred among hinges that may open.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Preference {
    /// Strip by strip, the last one reached first.
    Deep,
    /// What carries other piles first, so that wide rests move while little is open.
    BridgesFirst,
    /// What carries least first.
    LeastFirst,
    /// What carries most first.
    MostFirst,
    /// By chance.
    Chance(u64),
}

/// The best order that was found.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Found {
    /// The panel that it goes out from.
    pub root: usize,
    /// The hinges.
    pub hinges: Vec<usize>,
    /// Whether it goes from the root outwards.
    pub scope: Scope,
    /// How many hinges something blocks all the same.
    pub blocked: usize,
    /// Orders begun.
    pub attempts: usize,
}

/// Searches for an order without a collision; where none is found, the one with the fewest hinges that something blocks.
/// `told` hears of every attempt: how many were made, and how many hinges the best one leaves blocked.
///
/// # Errors
/// See [`Motion::new`].
pub fn search(
    plan: &Plan,
    thickness: Thickness,
    ground: Option<Ground>,
    told: &mut dyn FnMut(usize, usize),
) -> Result<Found, MotionError> {
    let mut best: Option<Found> = None;
    let mut attempts = 0;
    for (root, scope) in
        roots(plan).into_iter().map(|root| (root, Scope::FromRoot)).chain([(plan.root, Scope::Any)])
    {
        let rooted = Plan { root, ..plan.clone() };
        let tree = Tree::new(&rooted)?;
        let start = Motion::new(&rooted, thickness, ground)?;
        let weights = Weights::of(&rooted, &tree);
        for preference in preferences(scope) {
            attempts += 1;
            let most = best.as_ref().map_or(usize::MAX, |found| found.blocked);
            let attempt = Attempt { tree: &tree, weights: &weights, scope, preference };
            if let Some((hinges, blocked)) = attempt.run(start.clone(), most) {
                best = Some(Found { root, hinges, scope, blocked, attempts });
            }
            told(attempts, best.as_ref().map_or(0, |found| found.blocked));
            if let Some(found) = best.as_mut().filter(|found| found.blocked == 0) {
                found.attempts = attempts;
                return Ok(found.clone());
            }
        }
    }
    let mut found = best.unwrap_or(Found {
        root: plan.root,
        hinges: Vec::new(),
        scope: Scope::FromRoot,
        blocked: 0,
        attempts,
    });
    found.attempts = attempts;
    Ok(found)
}

/// The plan's root, and panels from which other orders go out: ends of bridges, and middles of piles.
fn roots(plan: &Plan) -> Vec<usize> {
    let bridged =
        plan.hinges.iter().filter(|hinge| hinge.kind == HingeKind::Bridge).flat_map(|hinge| hinge.panels);
    let middles = plan.piles.iter().filter_map(|pile| pile.panels.get(pile.panels.len() / 2).copied());
    let others: BTreeSet<usize> = bridged.chain(middles).filter(|panel| *panel != plan.root).collect();
    // Some of them, evenly.
    let step = others.len().div_ceil(ROOTS).max(1);
    [plan.root].into_iter().chain(others.into_iter().step_by(step)).collect()
}

fn preferences(scope: Scope) -> Vec<Preference> {
    let fixed = match scope {
        Scope::FromRoot => vec![Preference::BridgesFirst, Preference::Deep, Preference::LeastFirst],
        Scope::Any => vec![Preference::LeastFirst, Preference::MostFirst, Preference::BridgesFirst],
    };
    fixed.into_iter().chain((0..BY_CHANCE).map(Preference::Chance)).collect()
}

/// Of every hinge what it carries, seen from the root.
struct Weights {
    panels: Vec<usize>,
    bridges: Vec<usize>,
    /// The hinges that come after each; those after none at the end.
    next: Vec<Vec<usize>>,
}

impl Weights {
    fn of(plan: &Plan, tree: &Tree) -> Self {
        let hinges = plan.hinges.len();
        let mut weights =
            Self { panels: vec![1; hinges], bridges: vec![0; hinges], next: vec![Vec::new(); hinges + 1] };
        for branch in tree.branches().iter().rev() {
            let own = usize::from(plan.hinges[branch.hinge].kind == HingeKind::Bridge);
            weights.bridges[branch.hinge] += own;
            if let Some(before) = branch.before {
                weights.panels[before] += weights.panels[branch.hinge];
                weights.bridges[before] += weights.bridges[branch.hinge];
            }
        }
        for branch in tree.branches() {
            weights.next[branch.before.unwrap_or(hinges)].push(branch.hinge);
        }
        weights
    }
}

struct Attempt<'a> {
    tree: &'a Tree,
    weights: &'a Weights,
    scope: Scope,
    preference: Preference,
}

impl Attempt<'_> {
    /// The order, and how many hinges in it are blocked; none where that are as many as `most` or more.
    fn run(&self, mut motion: Motion, most: usize) -> Option<(Vec<usize>, usize)> {
        let hinges = motion.linkage().hinges();
        let mut ready: Vec<usize> = match self.scope {
            Scope::FromRoot => self.weights.next[hinges].clone(),
            Scope::Any => self.tree.branches().iter().map(|branch| branch.hinge).collect(),
        };
        let mut order = Vec::with_capacity(hinges);
        let mut blocked = 0;
        while !ready.is_empty() {
            self.sort(&mut ready, order.len());
            let free = ready.iter().rposition(|hinge| motion.blocked(*hinge).is_none());
            let chosen = free.unwrap_or_else(|| {
                blocked += 1;
                let depth = |hinge: usize| motion.blocked(hinge).map_or(0.0, |collision| collision.depth);
                let depths: Vec<f64> = ready.iter().map(|hinge| depth(*hinge)).collect();
                (0..ready.len()).min_by(|a, b| depths[*a].total_cmp(&depths[*b])).unwrap_or(0)
            });
            if blocked >= most {
                return None;
            }
            let hinge = ready.remove(chosen);
            motion.open(hinge);
            order.push(hinge);
            if self.scope == Scope::FromRoot {
                ready.extend(self.weights.next[hinge].iter().rev());
            }
        }
        Some((order, blocked))
    }

    /// Puts the preferred ones last.
    fn sort(&self, ready: &mut [usize], step: usize) {
        let Weights { panels, bridges, .. } = self.weights;
        match self.preference {
            Preference::Deep => {}
            Preference::BridgesFirst => {
                ready.sort_by_key(|hinge| (bridges[*hinge], Reverse(panels[*hinge]), *hinge));
            }
            Preference::LeastFirst => ready.sort_by_key(|hinge| (Reverse(panels[*hinge]), *hinge)),
            Preference::MostFirst => ready.sort_by_key(|hinge| (panels[*hinge], *hinge)),
            Preference::Chance(seed) => {
                // A number that looks like chance, the same in every run.
                let lot = |hinge: usize| {
                    let mixed = (hinge as u64 ^ seed.rotate_left(32) ^ (step as u64).rotate_left(48))
                        .wrapping_mul(0x9E37_79B9_7F4A_7C15);
                    (mixed ^ (mixed >> 29)).wrapping_mul(0xBF58_476D_1CE4_E5B9) >> 16
                };
                ready.sort_by_key(|hinge| (lot(*hinge), *hinge));
            }
        }
    }
}
