//! A plan that opens without a collision: where the motion of one plan isn't free, stacking is asked for another.

use super::ground::Ground;
use super::search::{Effort, Found, search};
use super::thickness::{MotionError, Thickness};
use zygote_stacking::{Model, Plan, PlanError, Request, plan};

/// What a motion is checked with.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Plates {
    /// Panels without thickness.
    Ideal,
    /// Panels as thick as the plan says; their edges may touch.
    Thick,
}

impl Plates {
    /// The plates for a plan.
    pub fn thickness(self, plan: &Plan) -> Thickness {
        match self {
            Self::Ideal => Thickness::ideal(plan),
            Self::Thick => Thickness::of(plan),
        }
    }
}

/// Roots tried on a ground beside the first.
const ROOTS_ON_GROUND: usize = 11;

/// A plan, and how it opens.
#[derive(Debug, Clone, PartialEq)]
pub struct FreePlan {
    /// The plan, with the root that the order goes out from.
    pub plan: Plan,
    /// Its order; `blocked` is 0 where it is free.
    pub found: Found,
    /// Plans tried.
    pub tried: u64,
}

/// Why there is none.
#[derive(Debug, thiserror::Error)]
pub enum FreePlanError {
    /// No plan at all.
    #[error(transparent)]
    Plan(#[from] PlanError),
    /// Nothing was to be tried.
    #[error("no plan tried, expected at least 1 try")]
    NoTries,
    /// A ground that no plan opens above.
    #[error(
        "of {tried} plans none has a panel that could stay fixed on the ground: whichever does, something of the target lies \
         below it, or layers of its pile lie under it"
    )]
    NoRoot {
        /// Plans tried.
        tried: u64,
    },
    /// Plates that can't be.
    #[error(transparent)]
    Motion(#[from] MotionError),
}

/// Plans with one seed after the other, from the request's on, until one opens freely; where none of `tries` does, gives the
/// one with the fewest hinges that something blocks. `told` hears before every try how many there were, and how many hinges
/// the best plan leaves blocked. On a ground the root is one of the panels that can stay fixed on it.
///
/// # Errors
/// Where no seed gives a plan, why the last one didn't; on a ground also if no plan has a panel that can be the root.
pub fn free_plan(
    model: &Model,
    request: &Request,
    plates: Plates,
    ground: Option<Ground>,
    tries: u64,
    told: &mut dyn FnMut(u64, Option<usize>),
) -> Result<FreePlan, FreePlanError> {
    // Many plans, each for a short time, find one sooner than one for a long time.
    // On a ground little but the root decides.
    let other_roots = if ground.is_some() { ROOTS_ON_GROUND } else { 2 };
    let effort = Effort { other_roots, ..Effort::default() };
    let mut best: Option<FreePlan> = None;
    let mut failed = None;
    let mut rootless = 0;
    for tried in 1..=tries {
        told(tried - 1, best.as_ref().map(|best| best.found.blocked));
        let seed = request.seed.wrapping_add(tried - 1);
        let plan = match plan(model, &Request { seed, ..request.clone() }) {
            Ok(plan) => plan,
            Err(error) => {
                failed = Some(error);
                continue;
            }
        };
        let thickness = plates.thickness(&plan);
        if let Some(ground) = ground
            && ground.roots(&plan, thickness)?.is_empty()
        {
            rootless += 1;
            continue;
        }
        let found = search(&plan, thickness, ground, &effort, &mut |_, _| {})?;
        if best.as_ref().is_none_or(|best| found.blocked < best.found.blocked) {
            let done = found.blocked == 0;
            best = Some(FreePlan { plan: Plan { root: found.root, ..plan }, found, tried });
            if done {
                break;
            }
        }
    }
    match (best, failed) {
        (Some(best), _) => Ok(best),
        (None, _) if rootless > 0 => Err(FreePlanError::NoRoot { tried: rootless }),
        (None, Some(error)) => Err(error.into()),
        (None, None) => Err(FreePlanError::NoTries),
    }
}
