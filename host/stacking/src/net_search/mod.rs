//! Looks for a strip whose flattened net has no overlapping panels: `zygote plan --net`.
//!
//! The arcs of a strip, stacked upwards and downwards in turn, can be joined where the strip runs on from one to the next: then
//! the tree path is the strip itself, and its net follows from the order of the panels alone.

mod walk;

use crate::net::{Net, Overlaps};
use crate::plan::Plan;
use crate::planner::{self, PlanError, Request};
use crate::random::Random;
use crate::readers::Model;
use crate::strip_changes::{self, Changed, Neighbours, Schedule};
use crate::{hamiltonian, strip_plan};
use walk::Walk;

/// Strips from which the search starts, where panels are few.
const STARTS: u64 = 12;
/// The same, where piles have to find room as well.
const STARTS_OF_PILES: u64 = 256;
/// Plans of the ordinary planner that are compared where no strip's piles find room.
const PLANS: u64 = 16;
/// Most changes for each start.
const CHANGES: u64 = 2_000_000;
/// Most panels on all walks together: with thousands of panels one start is all there is time for.
const STEPS: u64 = 3_000_000_000;
/// So freely does the search begin.
const HOTTEST: u64 = 26_000;

/// A plan, and how far its net is without overlaps.
#[derive(Debug, Clone)]
pub struct NetPlan {
    /// The plan whose net has the fewest overlaps.
    pub plan: Plan,
    /// What overlaps in it.
    pub overlaps: Overlaps,
    /// Strips from which a search started.
    pub starts: u64,
    /// Changes of strips that were tried.
    pub changes: u64,
    /// Strips without overlaps whose piles found no room.
    pub without_room: u64,
}

/// Looks for a plan whose net has no overlapping panels; without one, gives that with the fewest pairs that overlap.
///
/// # Errors
/// As of `plan`.
pub fn plan_with_net(model: &Model, request: &Request) -> Result<NetPlan, PlanError> {
    let panels = model.surface.len();
    planner::check_request(panels, request)?;
    let all: Vec<usize> = (0..panels).collect();
    let neighbours = Neighbours::among(&all, &model.dual);
    let lists = model.dual.neighbours();
    let mut walk = Walk::new(panels, &neighbours);
    let affordable = STEPS / panels.max(1) as u64;
    let schedule = Schedule { rounds: CHANGES.min(affordable), hottest: HOTTEST };
    let most_starts = if request.piles == 1 { STARTS } else { STARTS_OF_PILES };
    let (mut starts, mut changes, mut without_room) = (0, 0, 0);
    let mut best: Option<((usize, i32, i32), Plan)> = None;
    for start in 0..most_starts {
        // A search that finds its net at once leaves time for more starts.
        if start > 0 && changes + schedule.rounds > affordable {
            break;
        }
        let seed = request.seed.wrapping_add(start.wrapping_mul(0x9E37_79B9));
        let strip = match hamiltonian::find(&lists, seed) {
            Ok(strip) => strip,
            Err(reason) if start == 0 => return Err(reason.into()),
            Err(_) => continue,
        };
        starts += 1;
        let mut random = Random::new(request.seed, (1 << 33) + start);
        let pairs = |order: &[usize], limit: usize| walk.pairs(order, limit);
        let Changed { order, cost, rounds } =
            strip_changes::anneal(strip.order, &neighbours, schedule, &mut random, pairs);
        changes += rounds;
        let Some(plan) = strip_plan::of(&order, model, request) else {
            without_room += u64::from(cost == 0);
            continue;
        };
        let [across, along] = plan.grid();
        let score = (cost, across * along, across + along);
        if best.as_ref().is_none_or(|(least, _)| score < *least) {
            best = Some((score, plan));
        }
        // No grid is more compact than a full one that is as long as it is wide, or by one cell longer.
        let (area, is_square) = (across * along, across.abs_diff(along) < 2);
        if cost == 0 && is_square && usize::try_from(area) == Ok(request.piles) {
            break;
        }
    }
    let plan = match best {
        Some((_, plan)) => plan,
        None => with_fewest_pairs(model, request)?,
    };
    let overlaps = Net::of(&plan).overlaps(&plan);
    Ok(NetPlan { plan, overlaps, starts, changes, without_room })
}

/// Of the ordinary planner's plans from some seeds that with the fewest overlaps.
fn with_fewest_pairs(model: &Model, request: &Request) -> Result<Plan, PlanError> {
    let mut best: Option<(usize, Plan)> = None;
    let mut refused = None;
    for number in 0..PLANS {
        match planner::plan(model, &Request { seed: request.seed.wrapping_add(number), ..request.clone() }) {
            Ok(plan) => {
                let pairs = Net::of(&plan).overlaps(&plan).pairs;
                if best.as_ref().is_none_or(|(least, _)| pairs < *least) {
                    best = Some((pairs, plan));
                }
            }
            Err(error) => drop(refused.get_or_insert(error)),
        }
    }
    match (best, refused) {
        (Some((_, plan)), _) => Ok(plan),
        (None, Some(error)) => Err(error),
        // Every seed gave a plan or a refusal.
        (None, None) => planner::plan(model, request),
    }
}
