//! A plan that is as much as can be like another one: `zygote plan --like`. Of the plans of many seeds those on the other's
//! cells are compared with it, and the best few are changed piece by piece until more of their hinges are in place.

use super::pieces;
use super::{Reconfiguration, ReconfigureError, cells, slots};
use crate::plan::Plan;
use crate::planner::{self, Bridges, Partition, PlanError, Request};
use crate::readers::Model;

/// Most plans compared, where panels are few.
const MOST_PLANS: usize = 64;
/// Fewest plans compared.
const FEWEST_PLANS: usize = 8;
/// Panels of all plans together, between these limits.
const PANELS: usize = 60_000;
/// Plans that are changed; of large ones only the best, for longer.
const FINALISTS: usize = 3;
/// Panels of a large plan.
const LARGE: usize = 1000;

/// Why there is no plan like another.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum LikeError {
    /// There is no plan at all.
    #[error(transparent)]
    Plan(#[from] PlanError),
    /// Another number of panels or piles.
    #[error(transparent)]
    Stack(#[from] ReconfigureError),
    /// No plan on these cells.
    #[error(
        "none of {tried} plans has its piles on the cells {wanted} or can be turned there; the first has {found}"
    )]
    Cells {
        /// Plans tried.
        tried: usize,
        /// Cells of the plan that is to be met.
        wanted: String,
        /// Cells of the first plan tried.
        found: String,
    },
}

/// A plan that is like another.
#[derive(Debug, Clone)]
pub struct Like {
    /// The plan.
    pub plan: Plan,
    /// The way from the other plan to this one.
    pub way: Reconfiguration,
    /// Plans made, each from another seed.
    pub tried: usize,
    /// Hinges that change place for each of those on the same cells, least first.
    pub moved: Vec<usize>,
    /// Changes tried on the best few.
    pub changes: u64,
}

impl Like {
    /// Hinges that change place for the middle one of the plans compared.
    pub fn median(&self) -> usize {
        self.moved.get(self.moved.len() / 2).copied().unwrap_or(0)
    }
}

/// Plans a model so that few hinges of another plan have to move.
///
/// # Errors
/// No plan, another number of panels or piles, or none on the same cells.
pub fn plan_like(model: &Model, request: &Request, other: &Plan) -> Result<Like, LikeError> {
    let panels = model.surface.len();
    if panels != other.panels() {
        return Err(ReconfigureError::Panels { first: other.panels(), second: panels }.into());
    }
    if request.piles != other.piles.len() {
        return Err(ReconfigureError::Piles { first: other.piles.len(), second: request.piles }.into());
    }
    let sides = other.grid().map(|side| usize::try_from(side).unwrap_or(1));
    let grid = request.grid.or(Some(sides));
    let mut candidates: Vec<(Reconfiguration, Plan)> = Vec::new();
    let (mut tried, mut found, mut refused) = (0, None, None);
    for number in 0..(PANELS / panels.max(1)).clamp(FEWEST_PLANS, MOST_PLANS) as u64 {
        let mut request = Request { seed: request.seed.wrapping_add(number), grid, ..request.clone() };
        // Few bridges leave most room to be alike: every other plan has as few as can be.
        if number % 2 == 1 {
            (request.partition, request.bridges) = (Partition::Arcs, Bridges::Least);
        }
        let plan = match planner::plan(model, &request) {
            Ok(plan) => plan,
            // Another seed may do, but no request becomes possible by another seed.
            Err(error) if error.is_luck() => {
                refused.get_or_insert(error);
                continue;
            }
            Err(error) => return Err(error.into()),
        };
        tried += 1;
        match Reconfiguration::between(other, &plan) {
            Ok(way) => candidates.push((way, plan)),
            Err(ReconfigureError::Cells { second, .. }) => drop(found.get_or_insert(second)),
            Err(error) => return Err(error.into()),
        }
    }
    candidates.sort_by_key(|(way, _)| way.counts.effort());
    let mut moved: Vec<usize> = candidates.iter().map(|(way, _)| way.counts.effort().0).collect();
    moved.sort_unstable();
    let mut changes = 0;
    let mut best: Option<(Reconfiguration, Plan)> = None;
    let finalists = if panels < LARGE { FINALISTS } else { 1 };
    for (way, plan) in candidates.into_iter().take(finalists) {
        let improved = pieces::improve(&plan, model, request, &slots(other, &way.motion), finalists);
        changes += improved.changes;
        let now = Reconfiguration::between(other, &improved.plan)?;
        for (way, plan) in [(way, plan), (now, improved.plan)] {
            if best.as_ref().is_none_or(|(least, _)| way.counts.effort() < least.counts.effort()) {
                best = Some((way, plan));
            }
        }
    }
    match (best, found, refused) {
        (Some((way, plan)), _, _) => Ok(Like { plan, way, tried, moved, changes }),
        (None, Some(found), _) => Err(LikeError::Cells { tried, wanted: cells(other), found }),
        (None, None, Some(refused)) => Err(refused.into()),
        // Every seed gave a plan or a refusal.
        (None, None, None) => Err(LikeError::Cells { tried, wanted: cells(other), found: "none".into() }),
    }
}
