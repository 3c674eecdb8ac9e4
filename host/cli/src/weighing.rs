//! What a weighing means for the user: `zygote torque` and `zygote schedule` stop alike where hinges are overloaded or the
//! whole tips.

use crate::failure::{Failure, OrFail};
use crate::output::say;
use anyhow::{Context, anyhow};
use clap::{Args, ValueEnum};
use std::path::Path;
use zygote_deployment::Rig;
use zygote_deployment::statics::{Load, Role, Statics, Support, lightest_root};
use zygote_stacking::Plan;

/// Overloaded hinges that `zygote schedule` lists.
const SHOWN: usize = 5;

/// What it stands on, and what is put up with.
#[derive(Args)]
pub(crate) struct WeighingArguments {
    /// What the whole stands on
    #[arg(long, value_enum, default_value_t = Stand::Touching)]
    support: Stand,
    /// Go on even if a hinge is overloaded
    #[arg(long)]
    allow_overload: bool,
    /// Go on even if the whole tips, as where its root is held fast
    #[arg(long)]
    allow_tipping: bool,
}

/// What the whole stands on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Stand {
    /// All that touches the plane that the stack lies on
    Touching,
    /// The root alone
    Root,
}

impl WeighingArguments {
    /// What the whole stands on.
    pub(crate) fn support(&self) -> Support {
        match self.support {
            Stand::Touching => Support::Touching,
            Stand::Root => Support::Root,
        }
    }

    /// Exit code 1 for what isn't allowed.
    pub(crate) fn hold(&self, path: &Path, plan: &Plan, statics: &Statics) -> Result<(), Failure> {
        let mut refused = Vec::new();
        let overloaded = statics.overloaded().len();
        if overloaded > 0 && !self.allow_overload {
            refused.push(format!(
                "{overloaded} of {} hinges are overloaded; choose another root, stronger or lighter parts, or give \
                 --allow-overload",
                plan.hinges.len()
            ));
        }
        if statics.tipping.first().is_some() && !self.allow_tipping {
            refused.push(
                "it tips; give it a stand (--support root), or hold its root fast and give --allow-tipping"
                    .to_owned(),
            );
        }
        if refused.is_empty() {
            return Ok(());
        }
        Err(Failure::Failed(anyhow!("{}: {}", path.display(), refused.join("; and "))))
    }
}

/// A plan on a rig that says what its panels weigh.
pub(crate) struct Scale<'a> {
    pub(crate) path: &'a Path,
    pub(crate) plan: &'a Plan,
    pub(crate) rig: &'a Rig,
    pub(crate) support: Support,
}

impl Scale<'_> {
    /// Weighs hinges that open one by one in this order.
    pub(crate) fn weigh(&self, hinges: &[usize]) -> Result<Statics, Failure> {
        Statics::of(self.plan, self.rig, hinges, self.support)
            .with_context(|| format!("{}: its hinges can't be weighed", self.path.display()))
            .or_bad_input()
    }

    /// Says what was found, in a few lines.
    pub(crate) fn tell(&self, statics: &Statics) -> Result<(), Failure> {
        if let Some(load) = statics.worst_first().first() {
            say(format_args!(
                "loads: panels of {}, one hinge after the other: at most {:.2} of a rating ({})",
                statics.panel_mass,
                load.factor(),
                bearing(load)
            ));
        }
        let overloaded = statics.overloaded();
        let mut worst: Vec<Load> = Vec::new();
        for load in statics.overloads() {
            if worst.iter().all(|worse| worse.hinge != load.hinge) {
                worst.push(load);
            }
        }
        for load in worst.iter().take(SHOWN) {
            say(format_args!("overload: {}: {:.2} times", bearing(load), load.factor()));
        }
        if worst.len() > SHOWN {
            say(format_args!("... and {} hinges more, see `zygote torque`", worst.len() - SHOWN));
        }
        let in_shape = statics.overloaded_in_shape().len();
        if in_shape > 0 {
            say(format_args!("{in_shape} of them bear too much in the shape itself, whatever the order"));
        }
        if !overloaded.is_empty()
            && let Some((root, left)) =
                lightest_root(self.plan, self.rig, self.support).context("other roots").or_failed()?
            && left < overloaded.len()
        {
            say(format_args!(
                "with panel {root} as the root {left} hinges would be overloaded, in the order of the tree, whatever \
                 collides: `zygote plan --root {root}`"
            ));
        }
        say(format_args!("tipping: {}", tipping(statics)));
        Ok(())
    }
}

/// Which hinge bears how much when.
fn bearing(load: &Load) -> String {
    let Load { hinge, step, turning, opening, .. } = load;
    let when = match load.role {
        Role::Turning => format!("turning in step {step}, at {:.1} degrees", opening.0),
        Role::Holding => {
            format!("holding in step {step}, when hinge {turning} is at {:.1} degrees", opening.0)
        }
    };
    let [torque, rating] = [load.torque, load.rating].map(millis);
    format!("hinge {hinge} {when}, {:.1} mNm rated for {rating:.1}", torque.abs())
}

/// Millinewton metres.
pub(crate) fn millis(torque: zygote_deployment::NewtonMetres) -> f64 {
    torque.0 * 1e3
}

/// Whether the whole stands, in words.
pub(crate) fn tipping(statics: &Statics) -> String {
    let tipping = &statics.tipping;
    let on = match tipping.support {
        Support::Touching => "what touches the ground",
        Support::Root => "the root",
    };
    let hinge = |step: usize| statics.turning.get(step).map_or(0, |load| load.hinge);
    match (tipping.first(), tipping.least()) {
        (Some(step), _) => match tipping.margins.get(step).copied().flatten() {
            Some(margin) => format!(
                "on {on} it tips in step {step} (hinge {}): the centre of mass gets {:.1} mm outside",
                hinge(step),
                -margin.0
            ),
            None => format!(
                "in step {step} (hinge {}) nothing that stands still touches the ground; for a stand under the root: --support root",
                hinge(step)
            ),
        },
        (None, Some((step, margin))) => format!(
            "on {on} it stands in every step; the centre of mass stays {:.1} mm within (step {step}, hinge {})",
            margin.0,
            hinge(step)
        ),
        (None, None) => "nothing moves".to_owned(),
    }
}
