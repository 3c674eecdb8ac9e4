//! The order of `zygote schedule`: searched for without a collision, light where the rig says what panels weigh, and with the
//! waits that the user asks for.

use crate::failure::{Failure, OrFail};
use crate::output::say;
use crate::plan::PlatesArgument;
use crate::weighing::Scale;
use anyhow::{Context, anyhow};
use clap::Args;
use indicatif::ProgressBar;
use std::path::Path;
use std::time::Duration;
use zygote_deployment::motion::{
    Certificate, Effort, Found, Ground, MotionError, Options, Plates, check, free_orders, search_after,
    waits_for,
};
use zygote_deployment::{Order, Rig, WaitError};
use zygote_stacking::Plan;

/// More panels than this are scheduled only unchecked: every step of a search looks at all of them.
pub(crate) const MOST_CHECKED: usize = 20_000;
/// Collisions listed.
const SHOWN_COLLISIONS: usize = 20;
/// How long other orders are looked for that load the hinges less.
const LIGHTER: Effort = Effort { other_roots: 0, backward: 2, looks: 5_000 };

/// What is checked of the motion.
#[derive(Args)]
pub(crate) struct MotionArguments {
    /// What the motion is checked with
    #[arg(long, value_enum, default_value_t = PlatesArgument::Ideal)]
    panels: PlatesArgument,
    /// Let nothing pass the plane that the stack lies on, across the rig's gravity
    #[arg(long)]
    ground: bool,
    /// Schedule the least bad order where none without a collision is found; the collisions are listed and stored
    #[arg(long)]
    allow_collisions: bool,
    /// Look for no collision: hinges open from the root outwards, one at a time unless --parallel is given
    #[arg(long, conflicts_with_all = ["panels", "ground", "allow_collisions"])]
    pub(crate) unchecked: bool,
}

/// What an order is looked for with.
pub(crate) struct Wanted<'a> {
    pub(crate) path: &'a Path,
    pub(crate) plan: &'a Plan,
    pub(crate) rig: &'a Rig,
    pub(crate) rig_path: &'a Path,
    pub(crate) motion: &'a MotionArguments,
    /// One hinge after the other.
    pub(crate) sequential: bool,
    /// Of each pair the first hinge waits for the second.
    pub(crate) waits: &'a [(usize, usize)],
    /// Where the rig says what panels weigh.
    pub(crate) scale: Option<&'a Scale<'a>>,
}

/// Reads an `--after`: a hinge, and those that must be open before it.
pub(crate) fn waits_of(text: &str) -> Result<Vec<(usize, usize)>, String> {
    let told = || format!("'{text}', expected a hinge and those that it is to wait for, as in 5:3 or 5:3,4");
    let number = |text: &str| text.trim().parse::<usize>().map_err(|_| told());
    let (hinge, others) = text.split_once(':').ok_or_else(told)?;
    let hinge = number(hinge)?;
    others.split(',').map(|other| Ok((hinge, number(other)?))).collect()
}

/// Refuses waits that no order can keep.
pub(crate) fn hold_waits(path: &Path, plan: &Plan, waits: &[(usize, usize)]) -> Result<(), Failure> {
    let hinges = plan.hinges.len();
    let free = Order { hinges: (0..hinges).collect(), waits_for: vec![Vec::new(); hinges] };
    free.with_waits(waits).with_context(|| format!("{}: --after", path.display())).or_bad_input()?;
    Ok(())
}

impl Wanted<'_> {
    /// An order without a collision, with what must wait for what, and what was checked.
    pub(crate) fn order(&self) -> Result<(Order, Certificate), Failure> {
        let name = self.path.display();
        if self.plan.panels() > MOST_CHECKED {
            return Err(Failure::BadInput(anyhow!(
                "{name}: motion is checked for up to {MOST_CHECKED} panels, found {}; --unchecked schedules it without",
                self.plan.panels()
            )));
        }
        let (found, order) = self.kept()?;
        let (found, order) = self.lighter(found, order)?;
        let report = self.moved(check(self.plan, &order.hinges, self.thickness(), &self.options()))?;
        for (step, collision) in report.collisions.iter().take(SHOWN_COLLISIONS) {
            say(format_args!("step {step}: {collision}"));
        }
        let meetings = report.collisions.len();
        if meetings > SHOWN_COLLISIONS {
            say(format_args!("... and {} more", meetings - SHOWN_COLLISIONS));
        }
        if meetings > 0 && !self.motion.allow_collisions {
            return Err(Failure::Failed(anyhow!(
                "{name}: of {} orders none is free; the best one has {meetings} collisions, listed above; make a plan that \
                 opens freely with `{}`, or schedule this one with --allow-collisions",
                found.attempts,
                self.advice()
            )));
        }
        let order = if self.sequential { Order::one_by_one(order.hinges) } else { order };
        let ideal = self.plates() == Plates::Ideal;
        Ok((order, Certificate::of(&report, self.thickness(), ideal, self.options().ground)))
    }

    /// An order that keeps the user's waits: that which is found without them where they fit it, else one that is sought
    /// with them.
    fn kept(&self) -> Result<(Found, Order), Failure> {
        let found = self.search(&[])?;
        let circle = match self.order_of(&found)? {
            Ok(order) => return Ok((found, order)),
            Err(circle) => circle,
        };
        let again = self.search(&self.after())?;
        if !again.hinges.is_empty()
            && (again.blocked == 0 || found.blocked > 0)
            && let Ok(order) = self.order_of(&again)?
        {
            return Ok((again, order));
        }
        Err(Failure::BadInput(anyhow!(
            "{}: --after: {circle}; the order that is free needs the opposite, and none that keeps to --after was found; \
             leave out a wait, or make another plan",
            self.path.display()
        )))
    }

    /// Of several free orders that in which the fewest hinges are overloaded, where the order can matter.
    fn lighter(&self, found: Found, order: Order) -> Result<(Found, Order), Failure> {
        let Some(scale) = self.scale.filter(|_| found.blocked == 0) else { return Ok((found, order)) };
        let mut best = scale.weigh(&order.hinges)?;
        let in_shape = best.overloaded_in_shape();
        let overloaded = best.overloaded();
        if overloaded.iter().all(|hinge| in_shape.contains(hinge)) {
            return Ok((found, order));
        }
        let (thickness, ground) = (self.thickness(), self.options().ground);
        let others = self.moved(free_orders(self.plan, thickness, ground, &LIGHTER, &self.after()))?;
        let tried = others.len();
        let mut chosen = (found, order);
        for other in others {
            let statics = scale.weigh(&other.hinges)?;
            if statics.is_lighter_than(&best)
                && let Ok(order) = self.order_of(&other)?
            {
                (best, chosen) = (statics, (other, order));
            }
        }
        let left = best.overloaded().len();
        say(format_args!(
            "order: {} hinges overloaded as first found, {left} in the lightest of {tried} free orders",
            overloaded.len()
        ));
        Ok(chosen)
    }

    fn search(&self, after: &[Vec<usize>]) -> Result<Found, Failure> {
        let bar = progress();
        let (thickness, ground) = (self.thickness(), self.options().ground);
        let mut told = |attempts: usize, blocked: Option<usize>| {
            let best = blocked.map_or(String::new(), |blocked| format!(", at best {blocked} hinges blocked"));
            bar.set_message(format!("{attempts} orders tried{best}"));
        };
        let found = search_after(self.plan, thickness, ground, &Effort::default(), after, &mut told);
        bar.finish_and_clear();
        self.moved(found)
    }

    /// What must wait for what in the order that was found, with the user's waits.
    fn order_of(&self, found: &Found) -> Result<Result<Order, WaitError>, Failure> {
        let order = if found.blocked > 0 {
            Order::one_by_one(found.hinges.clone())
        } else {
            self.moved(waits_for(self.plan, &found.hinges, self.thickness()))?
        };
        Ok(order.with_waits(self.waits))
    }

    /// Of every hinge what the user wants it to wait for.
    fn after(&self) -> Vec<Vec<usize>> {
        let mut after = vec![Vec::new(); self.plan.hinges.len()];
        for (hinge, other) in self.waits {
            after[*hinge].push(*other);
        }
        after
    }

    fn plates(&self) -> Plates {
        Plates::from(self.motion.panels)
    }

    fn thickness(&self) -> zygote_deployment::motion::Thickness {
        self.plates().thickness(self.plan)
    }

    fn options(&self) -> Options {
        Options { ground: self.motion.ground.then(|| Ground::under(&self.rig.gravity)) }
    }

    /// The command that makes a plan for this motion.
    fn advice(&self) -> String {
        let panels = match self.plates() {
            Plates::Ideal => "ideal",
            Plates::Thick => "thick",
        };
        let rig = self.rig_path.display();
        match self.options().ground {
            None => format!("zygote plan --free {panels}"),
            Some(ground) if ground == Ground::TABLE => format!("zygote plan --free {panels} --ground"),
            Some(_) => format!("zygote plan --free {panels} --ground --rig {rig}"),
        }
    }

    fn moved<T>(&self, result: Result<T, MotionError>) -> Result<T, Failure> {
        result.with_context(|| format!("{}: no motion", self.path.display())).or_bad_input()
    }
}

/// What the search is at, on the error output.
fn progress() -> ProgressBar {
    let bar = ProgressBar::new_spinner();
    bar.enable_steady_tick(Duration::from_millis(200));
    bar
}
