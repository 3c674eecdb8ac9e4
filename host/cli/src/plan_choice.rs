//! Plans chosen among many: `zygote plan --net` and `zygote plan --like`. The verb writes what comes of it.

use crate::failure::Failure;
use crate::input;
use crate::plan::refused;
use anyhow::anyhow;
use indicatif::{ProgressBar, ProgressStyle};
use std::path::Path;
use zygote_deployment::motion::{FreePlan, FreePlanError, Ground, Plates, Scope, free_plan};
use zygote_stacking::{Counts, LikeError, Model, NetPlan, Plan, Request, plan_like, plan_with_net};

/// A plan, and what to tell of the choice.
type Choice = (Plan, Vec<String>);

/// A plan whose net has few overlaps, at best none.
pub(crate) fn with_net(path: &Path, model: &Model, request: &Request) -> Result<Choice, Failure> {
    let NetPlan { plan, overlaps, starts, changes, without_room } =
        plan_with_net(model, request).map_err(refused(path))?;
    let tried = format!("{starts} strips and {changes} changes of them tried");
    let mut told = Vec::new();
    if overlaps.pairs == 0 {
        told.push(format!("net: no two panels overlap ({tried})"));
    } else {
        told.push(format!(
            "net: none without overlaps was found ({tried}), which doesn't prove that there is none"
        ));
        told.push(format!(
            "the net of this plan has the fewest overlaps of those tried: {} pairs of panels",
            overlaps.pairs
        ));
        if without_room > 0 {
            let piles = request.piles;
            told.push(format!(
                "{without_room} strips had a net without overlaps, but {piles} piles of one found no room side by side"
            ));
        }
    }
    Ok((plan, told))
}

/// How a plan is to open.
#[derive(Clone, Copy)]
pub(crate) struct Free {
    /// What its motion is checked with.
    pub(crate) plates: Plates,
    /// What nothing may pass.
    pub(crate) ground: Option<Ground>,
    /// Most plans tried.
    pub(crate) tries: u64,
}

/// A plan that opens without a collision.
pub(crate) fn that_opens_freely(
    path: &Path,
    model: &Model,
    request: &Request,
    free: Free,
) -> Result<Choice, Failure> {
    let Free { plates, ground, tries } = free;
    let bar = progress(tries);
    let made = free_plan(model, request, plates, ground, tries, &mut |tried, blocked| {
        bar.set_position(tried);
        if let Some(blocked) = blocked {
            bar.set_message(format!("at best {blocked} hinges blocked"));
        }
    });
    bar.finish_and_clear();
    let FreePlan { plan, found, tried } = made.map_err(|error| match error {
        FreePlanError::Plan(error) => refused(path)(error),
        FreePlanError::NoRoot { .. } => Failure::Failed(anyhow!(
            "{}: {error}; try a gravity along x or y (--rig), or leave out --ground",
            path.display()
        )),
        other => Failure::BadInput(anyhow!("{}: {other}", path.display())),
    })?;
    let panels = match plates {
        Plates::Ideal => "panels without thickness",
        Plates::Thick => "panels as thick as the plan's",
    };
    let panels = if ground.is_some() { format!("{panels}, above the ground") } else { panels.to_owned() };
    if found.blocked > 0 {
        return Err(Failure::Failed(anyhow!(
            "{}: of {tries} plans none opens freely with {panels}; the best one has {} hinges that something blocks (seed \
             {}); try more with --tries, another --bridges, another number of piles, or thinner panels",
            path.display(),
            found.blocked,
            plan.source.seed
        )));
    }
    let order = match found.scope {
        Scope::FromRoot => "from the root outwards",
        Scope::Any => "in an order of its own",
    };
    let told = format!(
        "motion: free, {order}, with {panels}; plan {tried} of at most {tries}, seed {}",
        plan.source.seed
    );
    Ok((plan, vec![told]))
}

/// The plan that another one is to be like.
pub(crate) struct Like<'a> {
    path: &'a Path,
    plan: Plan,
}

impl<'a> Like<'a> {
    /// Reads it.
    pub(crate) fn read(path: &'a Path) -> Result<Self, Failure> {
        Ok(Self { path, plan: input::plan(path)? })
    }

    /// Its number of piles.
    pub(crate) fn piles(&self) -> usize {
        self.plan.piles.len()
    }

    /// A plan that moves few of its hinges.
    pub(crate) fn plan(&self, path: &Path, model: &Model, request: &Request) -> Result<Choice, Failure> {
        let name = self.path.display();
        let like = plan_like(model, request, &self.plan).map_err(|error| match error {
            LikeError::Plan(error) => refused(path)(error),
            LikeError::Stack(error) => {
                Failure::BadInput(anyhow!("{} can't be like {name}: {error}", path.display()))
            }
            LikeError::Cells { .. } => Failure::Failed(anyhow!("{} like {name}: {error}", path.display())),
        })?;
        let Counts { kept, turned, moved, removed, added } = like.way.counts;
        let told = vec![
            format!(
                "like {name}: {} plans tried, {} on its cells; hinges that move or come off: {} at best, {} in the \
                 median, {} after {} changes of the best few",
                like.tried,
                like.moved.len(),
                like.moved.first().copied().unwrap_or(0),
                like.median(),
                moved + removed,
                like.changes
            ),
            format!("turn the stack of {name}: {}", like.way.motion),
            format!(
                "{} hinges: keep {kept}, turn {turned}, move {moved}, remove {removed}, add {added}",
                self.plan.hinges.len()
            ),
        ];
        Ok((like.plan, told))
    }
}

/// Plans tried, and the best of them.
fn progress(tries: u64) -> ProgressBar {
    let style = ProgressStyle::with_template("{bar:30} {pos} of at most {len} plans tried, {elapsed} {msg}");
    let bar = ProgressBar::new(tries);
    bar.with_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()))
}
