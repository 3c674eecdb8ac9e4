//! `zygote schedule`: a plan and a rig into a schedule, written into the plan or beside it.

use crate::checked_order::{MOST_CHECKED, MotionArguments, Wanted, hold_waits, waits_of};
use crate::failure::{Failure, OrFail};
use crate::input;
use crate::output::{say, write_file};
use crate::weighing::{Scale, WeighingArguments};
use anyhow::Context;
use clap::Args;
use std::path::PathBuf;
use zygote_deployment::motion::Certificate;
use zygote_deployment::statics::Loads;
use zygote_deployment::{Kind, Limits, Millis, Order, Rig, Schedule, Tree};
use zygote_stacking::{Plan, fold};

/// Arguments of `zygote schedule`.
#[derive(Args)]
pub(crate) struct Arguments {
    /// The plan
    #[arg(value_name = "PLAN.fold")]
    plan: PathBuf,
    /// The rig that is to deploy it
    #[arg(long, value_name = "RIG.toml")]
    rig: PathBuf,
    #[command(flatten)]
    motion: MotionArguments,
    #[command(flatten)]
    weighing: WeighingArguments,
    /// Let hinge H start only when A, and B, are open
    #[arg(long, value_name = "H:A[,B]", value_parser = waits_of)]
    after: Vec<Waits>,
    /// One hinge after the other, in the order that was checked
    #[arg(long, conflicts_with = "parallel")]
    sequential: bool,
    /// Most motions at once [default: as many as motion and supply allow]
    #[arg(long, value_name = "M", value_parser = at_least_1)]
    parallel: Option<usize>,
    /// Move one servo of a node at a time
    #[arg(long)]
    one_servo: bool,
    /// Write the schedule here, as JSON, and leave the plan as it is
    #[arg(short, long, value_name = "SCHEDULE.json")]
    output: Option<PathBuf>,
}

/// Of each pair the first hinge waits for the second; a name of its own, as clap takes a list for several arguments.
type Waits = Vec<(usize, usize)>;

fn at_least_1(text: &str) -> Result<usize, String> {
    text.parse()
        .ok()
        .filter(|count| *count >= 1)
        .ok_or_else(|| "expected a whole number, at least 1".to_owned())
}

/// Schedules, verifies what came out, and writes it.
pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let name = arguments.plan.display();
    let rig = input::rig(&arguments.rig)?;
    let mut plan = input::plan(&arguments.plan)?;
    let parallel = arguments.parallel.or(arguments.motion.unchecked.then_some(1));
    let limits = Limits { parallel, one_servo_a_node: arguments.one_servo, ..Limits::default() };
    let schedule_of = |order: &Order, limits: &Limits| {
        Schedule::plan(&plan, &rig, order, limits)
            .with_context(|| format!("{name}: no schedule on this rig"))
            .or_bad_input()
    };
    let tree = Tree::new(&plan).context("no order").or_bad_input()?;
    let by_tree = Order::of_tree(&tree);
    let waits = arguments.after.concat();
    hold_waits(&arguments.plan, &plan, &waits)?;
    let scale = scale(arguments, &plan, &rig);
    let schedule = if arguments.motion.unchecked {
        let order = by_tree
            .with_waits(&waits)
            .with_context(|| format!("{name}: --after, against the order of the tree"))
            .or_bad_input()?;
        let springs = springs(&rig, &tree)?;
        // Whatever is near a spring has to stand still, and nothing has looked what is near.
        let order = if parallel == Some(1) { order } else { order.with_alone(&|hinge| springs[hinge]) };
        schedule_of(&order, &limits)?
    } else {
        // What the rig can't drive is told before a long search.
        schedule_of(&by_tree, &Limits { samples: 0, ..limits })?;
        let (order, certificate) = Wanted {
            path: &arguments.plan,
            plan: &plan,
            rig: &rig,
            rig_path: &arguments.rig,
            motion: &arguments.motion,
            sequential: arguments.sequential,
            waits: &waits,
            scale: scale.as_ref(),
        }
        .order()?;
        schedule_of(&order, &limits)?.with_certificate(certificate)
    };
    let schedule = match &scale {
        Some(scale) => weighed(arguments, scale, schedule)?,
        None => schedule,
    };
    schedule.verify(&plan, &rig).context("a fault of this program: its own schedule is wrong").or_failed()?;
    let written = if let Some(output) = &arguments.output {
        write_file(output, schedule.to_text().or_failed()?.as_bytes())?;
        output
    } else {
        plan.schedule = Some(schedule.to_json().or_failed()?);
        write_file(&arguments.plan, &fold::write(&plan).or_failed()?)?;
        &arguments.plan
    };
    say(format_args!("{}: {}", written.display(), summary(&schedule)));
    if let Some(certificate) = &schedule.certificate {
        say(format_args!("motion: {}", told(certificate)));
    }
    if rig.panel.is_none() {
        say("loads: not weighed: the rig doesn't say what panels weigh (panel.mass or panel.density)");
    } else if schedule.loads.is_none() {
        say(format_args!("loads: not weighed: more than {MOST_CHECKED} panels, see `zygote torque`"));
    }
    Ok(())
}

/// What weighs the plan, where the rig says what panels weigh.
fn scale<'a>(arguments: &'a Arguments, plan: &'a Plan, rig: &'a Rig) -> Option<Scale<'a>> {
    let weighs = rig.panel.is_some() && plan.panels() <= MOST_CHECKED;
    let support = arguments.weighing.support();
    weighs.then_some(Scale { path: &arguments.plan, plan, rig, support })
}

/// The schedule with its loads, if they are allowed.
fn weighed(arguments: &Arguments, scale: &Scale, schedule: Schedule) -> Result<Schedule, Failure> {
    let statics = scale.weigh(&schedule.hinges())?;
    scale.tell(&statics)?;
    arguments.weighing.hold(scale.path, scale.plan, &statics)?;
    Ok(schedule.with_loads(Loads::of(&statics, scale.rig)))
}

/// Of every hinge whether a spring opens it.
fn springs(rig: &Rig, tree: &Tree) -> Result<Vec<bool>, Failure> {
    let fittings = rig.fit_tree(tree).or_bad_input()?;
    Ok(fittings.iter().map(|fitting| fitting.drive.kind() == Kind::Spring).collect())
}

/// What was checked, in one line.
fn told(certificate: &Certificate) -> String {
    let Certificate { panel_pairs, clearance, collisions, ideal, .. } = certificate;
    let panels = if *ideal { "panels without thickness" } else { "panels as thick as the plan's" };
    if collisions.is_empty() {
        format!(
            "free with {panels}: {panel_pairs} pairs proved apart over whole turns, clearance {clearance:.4} panel lengths"
        )
    } else {
        format!("{} collisions with {panels}, allowed", collisions.len())
    }
}

/// What a schedule amounts to, in one line.
fn summary(schedule: &Schedule) -> String {
    let kinds: Vec<_> = Kind::ALL
        .into_iter()
        .map(|kind| (schedule.steps.iter().filter(|step| step.motion.kind() == kind).count(), kind))
        .filter(|(count, _)| *count > 0)
        .map(|(count, kind)| format!("{count} {}", kind.name()))
        .collect();
    format!(
        "{} steps ({}) on rig {} in {} ({:.2} of the lower bound), at most {} at once, drawing at most {} of {}",
        schedule.steps.len(),
        kinds.join(", "),
        schedule.rig,
        clock(schedule.makespan),
        schedule.ratio(),
        schedule.most_at_once(),
        schedule.peak_current,
        schedule.supply_limit,
    )
}

/// A time as people read it.
fn clock(time: Millis) -> String {
    let tenths = time.0.div_ceil(100);
    let minutes = tenths / 600;
    match minutes {
        0 => format!("{}.{} s", tenths / 10, tenths % 10),
        1..60 => format!("{minutes} min {} s", tenths % 600 / 10),
        60.. => format!("{} h {} min", minutes / 60, minutes % 60),
    }
}
