//! The search for an order in which all hinges open without a collision: from the root outwards first, then from the end.

use super::backward::Backward;
use super::forward::{Forward, PREFERENCES};
use super::ground::Ground;
use super::state::Motion;
use super::thickness::{MotionError, Thickness};
use crate::tree::Tree;
use std::collections::BTreeSet;
use zygote_stacking::{HingeKind, Plan};

/// With more panels than this only orders from the root outwards are tried: a search from the end looks at all panels again
/// and again.
const MOST_BACKWARD: usize = 1_000;

/// How long is searched.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Effort {
    /// Roots tried beside the plan's own.
    pub other_roots: usize,
    /// Searches from the end, each with another seed.
    pub backward: u64,
    /// Hinges looked at in each of them.
    pub looks: usize,
}

impl Default for Effort {
    /// The plan's root alone, and some seconds for a hundred panels.
    fn default() -> Self {
        Self { other_roots: 0, backward: 4, looks: 15_000 }
    }
}

/// Which orders a search found its own among.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Scope {
    /// From the root outwards: each hinge after the one before it.
    FromRoot,
    /// Any: hinges farther out may open first.
    Any,
}

/// The best order that was found.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Found {
    /// The panel that stays fixed.
    pub root: usize,
    /// The hinges.
    pub hinges: Vec<usize>,
    /// Which orders it is one of.
    pub scope: Scope,
    /// How many hinges something blocks all the same.
    pub blocked: usize,
    /// Orders begun.
    pub attempts: usize,
}

/// Searches for an order without a collision; where none is found, gives the one with the fewest hinges that something
/// blocks. `told` hears before every attempt how many were made, and how many hinges the best one leaves blocked.
///
/// # Errors
/// See [`Motion::new`].
pub fn search(
    plan: &Plan,
    thickness: Thickness,
    ground: Option<Ground>,
    effort: &Effort,
    told: &mut dyn FnMut(usize, Option<usize>),
) -> Result<Found, MotionError> {
    search_after(plan, thickness, ground, effort, &[], told)
}

/// The same, where some hinges must wait for others: `after` has of every hinge those that must be open before it; a hinge
/// that is missing there waits for none. Without an order that keeps to that, free or not, the one found has no hinges.
///
/// # Errors
/// See [`Motion::new`].
pub fn search_after(
    plan: &Plan,
    thickness: Thickness,
    ground: Option<Ground>,
    effort: &Effort,
    after: &[Vec<usize>],
    told: &mut dyn FnMut(usize, Option<usize>),
) -> Result<Found, MotionError> {
    let mut best: Option<Found> = None;
    let mut attempts = 0;
    let roots = roots(plan, thickness, ground, effort.other_roots)?;
    for &root in &roots {
        let rooted = Plan { root, ..plan.clone() };
        let tree = Tree::new(&rooted)?;
        let motion = Motion::new(&rooted, thickness, ground)?;
        let forward = Forward::new(&rooted, &tree);
        for preference in PREFERENCES {
            let most = best.as_ref().map(|found| found.blocked);
            told(attempts, most);
            attempts += 1;
            if let Some((hinges, blocked)) = forward.run(motion.clone(), preference, most, after) {
                let found = Found { root, hinges, scope: Scope::FromRoot, blocked, attempts };
                if blocked == 0 {
                    return Ok(found);
                }
                best = Some(found);
            }
        }
    }
    let root = roots.first().copied().unwrap_or(plan.root);
    if plan.panels() <= MOST_BACKWARD {
        let rooted = Plan { root, ..plan.clone() };
        let tree = Tree::new(&rooted)?;
        let motion = Motion::new(&rooted, thickness, ground)?;
        for seed in 0..effort.backward {
            told(attempts, best.as_ref().map(|found| found.blocked));
            attempts += 1;
            if let Some(hinges) = Backward::new(&tree, motion.clone(), after, seed).run(effort.looks) {
                return Ok(Found { root, hinges, scope: Scope::Any, blocked: 0, attempts });
            }
        }
    }
    let none = Found { root, hinges: Vec::new(), scope: Scope::FromRoot, blocked: 0, attempts };
    Ok(Found { attempts, ..best.unwrap_or(none) })
}

/// Several orders without a collision, all with the plan's root: by every preference from the root outwards, and by every
/// search from the end. What the search for one gives up on is left out.
///
/// # Errors
/// See [`Motion::new`].
pub fn free_orders(
    plan: &Plan,
    thickness: Thickness,
    ground: Option<Ground>,
    effort: &Effort,
    after: &[Vec<usize>],
) -> Result<Vec<Found>, MotionError> {
    let tree = Tree::new(plan)?;
    let motion = Motion::new(plan, thickness, ground)?;
    let forward = Forward::new(plan, &tree);
    let outwards = PREFERENCES
        .into_iter()
        .filter_map(|preference| forward.run(motion.clone(), preference, Some(1), after))
        .map(|(hinges, _)| (Scope::FromRoot, hinges));
    let seeds = if plan.panels() <= MOST_BACKWARD { effort.backward } else { 0 };
    let from_the_end = (0..seeds)
        .filter_map(|seed| Backward::new(&tree, motion.clone(), after, seed).run(effort.looks))
        .map(|hinges| (Scope::Any, hinges));
    let mut all: Vec<Found> = Vec::new();
    for (scope, hinges) in outwards.chain(from_the_end) {
        if all.iter().all(|found| found.hinges != hinges) {
            all.push(Found { root: plan.root, hinges, scope, blocked: 0, attempts: all.len() + 1 });
        }
    }
    Ok(all)
}

/// The plan's root, and some of the panels from which other orders go out. Without a ground ends of bridges, and middles of
/// piles; on a ground those that can stay fixed on it, the plan's own root only if it is one of them, or if none is.
fn roots(
    plan: &Plan,
    thickness: Thickness,
    ground: Option<Ground>,
    others: usize,
) -> Result<Vec<usize>, MotionError> {
    if others == 0 {
        return Ok(vec![plan.root]);
    }
    if let Some(ground) = ground {
        let mut standing = ground.roots(plan, thickness)?;
        if standing.is_empty() {
            return Ok(vec![plan.root]);
        }
        // Stable: behind the plan's own root those nearest to the ground.
        standing.sort_by_key(|root| *root != plan.root);
        let step = standing.len().div_ceil(others + 1).max(1);
        return Ok(standing.into_iter().step_by(step).collect());
    }
    let bridges = plan.hinges.iter().filter(|hinge| hinge.kind == HingeKind::Bridge);
    let middles = plan.piles.iter().filter_map(|pile| pile.panels.get(pile.panels.len() / 2).copied());
    let all: BTreeSet<usize> =
        bridges.flat_map(|hinge| hinge.panels).chain(middles).filter(|panel| *panel != plan.root).collect();
    let step = all.len().div_ceil(others).max(1);
    Ok([plan.root].into_iter().chain(all.into_iter().step_by(step).take(others)).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::motion::{Options, check};
    use std::path::Path;
    use zygote_stacking::{Bridges, Model, Request, plan};

    fn planned(name: &str, request: &Request) -> Plan {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("../../models/{name}.txt"));
        plan(&Model::read(&path, None).expect("a model"), request).expect("a plan")
    }

    fn assert_free(plan: &Plan, thickness: Thickness, effort: &Effort) -> Found {
        let found = search(plan, thickness, None, effort, &mut |_, _| {}).expect("plates");
        assert_eq!(found.blocked, 0, "{}", plan.source.model);
        let plan = Plan { root: found.root, ..plan.clone() };
        let report = check(&plan, &found.hinges, thickness, &Options::default()).expect("plates");
        assert!(report.is_free(), "{}: {:?}", plan.source.model, report.collisions.first());
        found
    }

    #[test]
    fn without_thickness_piles_around_a_base_open_freely_from_the_root() {
        for name in ["i14", "l14", "fish92", "vehicle92", "airplane92", "fish144"] {
            for piles in [1, 2, 4] {
                let request = Request { piles, bridges: Bridges::Base, ..Request::default() };
                if name.ends_with("14") && piles == 4 {
                    continue;
                }
                let plan = planned(name, &request);
                let found = assert_free(&plan, Thickness::ideal(&plan), &Effort::default());
                assert_eq!((found.scope, found.root), (Scope::FromRoot, plan.root), "{name} K={piles}");
            }
        }
    }

    #[test]
    fn small_shapes_open_freely_with_panels_a_twentieth_thick() {
        for (name, seed) in [("i14", 1), ("l14", 1)] {
            let request =
                Request { piles: 2, thickness: 0.05, seed, bridges: Bridges::Least, ..Request::default() };
            let plan = planned(name, &request);
            assert_free(&plan, Thickness::of(&plan), &Effort { backward: 8, ..Effort::default() });
        }
    }

    #[test]
    fn the_same_search_finds_the_same_order() {
        let plan = planned("l14", &Request { piles: 2, thickness: 0.05, ..Request::default() });
        let run = || search(&plan, Thickness::of(&plan), None, &Effort::default(), &mut |_, _| {});
        assert_eq!(run(), run());
    }

    #[test]
    fn where_no_order_is_free_the_least_bad_one_opens_every_hinge() {
        // A table under a shape that grows downwards.
        let plan = planned("i14", &Request::default());
        let effort = Effort { backward: 1, looks: 200, ..Effort::default() };
        let ground = Some(Ground { normal: glam::DVec3::X });
        let found = search(&plan, Thickness::ideal(&plan), ground, &effort, &mut |_, _| {}).expect("plates");
        assert!(found.blocked > 0);
        let mut hinges = found.hinges;
        hinges.sort_unstable();
        assert_eq!(hinges, (0..plan.hinges.len()).collect::<Vec<_>>());
    }

    #[test]
    fn an_order_is_found_with_the_waits_that_are_asked_for() {
        let plan = planned("l14", &Request { piles: 2, ..Request::default() });
        let thickness = Thickness::ideal(&plan);
        let found = assert_free(&plan, thickness, &Effort::default());
        let place = |hinges: &[usize], hinge| hinges.iter().position(|other| *other == hinge);
        // Any two neighbours the other way round, from the root or from the end.
        for pair in found.hinges.windows(2) {
            let mut after = vec![Vec::new(); plan.hinges.len()];
            after[pair[0]].push(pair[1]);
            let other = search_after(&plan, thickness, None, &Effort::default(), &after, &mut |_, _| {})
                .expect("plates");
            assert!(place(&other.hinges, pair[1]) < place(&other.hinges, pair[0]), "{pair:?} {other:?}");
            let report = check(&plan, &other.hinges, thickness, &Options::default()).expect("plates");
            assert!(report.is_free(), "{pair:?}: {:?}", report.collisions.first());
        }
        // All of them the other way round is no order that is free.
        let mut after = vec![Vec::new(); plan.hinges.len()];
        found.hinges.windows(2).for_each(|pair| after[pair[0]].push(pair[1]));
        let none = search_after(&plan, thickness, None, &Effort::default(), &after, &mut |_, _| {});
        assert!(none.expect("plates").hinges.is_empty());
    }

    #[test]
    fn several_free_orders_are_all_free_and_none_is_told_twice() {
        let plan = planned("l14", &Request { piles: 2, bridges: Bridges::Base, ..Request::default() });
        let thickness = Thickness::ideal(&plan);
        let all = free_orders(&plan, thickness, None, &Effort::default(), &[]).expect("plates");
        assert!(all.len() > 2, "{}", all.len());
        for (number, found) in all.iter().enumerate() {
            let report = check(&plan, &found.hinges, thickness, &Options::default()).expect("plates");
            assert!(report.is_free(), "{found:?}");
            assert!(all[..number].iter().all(|other| other.hinges != found.hinges));
        }
    }
}
