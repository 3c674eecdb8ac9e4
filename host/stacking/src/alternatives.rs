//! Several plans for one shape, no two of which are one stack turned: `zygote alternatives`.

use crate::net::{Net, Overlaps};
use crate::plan::Plan;
use crate::planner::{self, PlanError, Request};
use crate::readers::Model;
use crate::reconfigure;
use crate::tree_path;
use std::collections::BTreeSet;

/// Seeds tried for each plan that is asked for.
const SEEDS_EACH: usize = 20;

/// One of the plans.
#[derive(Debug, Clone)]
pub struct Alternative {
    /// The plan.
    pub plan: Plan,
    /// Most hinges from the middle of the tree path to any panel.
    pub depth: usize,
    /// What overlaps in its net.
    pub overlaps: Overlaps,
}

/// Plans with sequences of their own.
#[derive(Debug, Clone)]
pub struct Alternatives {
    /// The plans, in the order of their seeds.
    pub found: Vec<Alternative>,
    /// Seeds tried.
    pub tried: usize,
}

/// Looks for `count` plans from one seed after another. Two plans are alike when a quarter turn of the whole stack, or where
/// piles have an even number of panels turning it over, makes the hinges of one those of the other.
///
/// # Errors
/// A request that can't be met, or no plan from any seed.
pub fn alternatives(model: &Model, request: &Request, count: usize) -> Result<Alternatives, PlanError> {
    let mut seen = BTreeSet::new();
    let mut found = Vec::new();
    let mut refused = None;
    let mut tried = 0;
    while found.len() < count && tried < count.saturating_mul(SEEDS_EACH) {
        let seed = request.seed.wrapping_add(tried as u64);
        tried += 1;
        match planner::plan(model, &Request { seed, ..request.clone() }) {
            Ok(plan) => {
                if seen.insert(reconfigure::regardless_of_turns(&plan)) {
                    let depth = tree_path::centre(&tree_path::joined(plan.panels(), &plan.hinges)).1;
                    let overlaps = Net::of(&plan).overlaps(&plan);
                    found.push(Alternative { plan, depth, overlaps });
                }
            }
            Err(error) if error.is_luck() => {
                refused.get_or_insert(error);
            }
            Err(error) => return Err(error),
        }
    }
    match refused {
        Some(error) if found.is_empty() => Err(error),
        _ => Ok(Alternatives { found, tried }),
    }
}
