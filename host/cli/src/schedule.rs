//! `zygote schedule`: a plan and a rig into a schedule, written into the plan or beside it.

use crate::failure::{Failure, OrFail};
use crate::input;
use crate::output::{say, write_file};
use crate::plan::PlatesArgument;
use anyhow::{Context, anyhow};
use clap::Args;
use indicatif::ProgressBar;
use std::path::PathBuf;
use std::time::Duration;
use zygote_deployment::motion::{Certificate, Effort, Ground, Options, Plates, check, search, waits_for};
use zygote_deployment::{Kind, Limits, Millis, Order, Schedule, Tree};
use zygote_stacking::{Plan, fold};

/// More panels than this are scheduled only unchecked: every step of a search looks at all of them.
const MOST_CHECKED: usize = 20_000;
/// Collisions listed.
const SHOWN_COLLISIONS: usize = 20;

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

/// What is checked of the motion.
#[derive(Args)]
struct MotionArguments {
    /// What the motion is checked with
    #[arg(long, value_enum, default_value_t = PlatesArgument::Ideal)]
    panels: PlatesArgument,
    /// A table under the zygote that nothing may pass
    #[arg(long)]
    ground: bool,
    /// Schedule the least bad order where none without a collision is found; the collisions are listed and stored
    #[arg(long)]
    allow_collisions: bool,
    /// Look for no collision: hinges open from the root outwards, one at a time unless --parallel is given
    #[arg(long, conflicts_with_all = ["panels", "ground", "allow_collisions"])]
    unchecked: bool,
}

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
    let by_tree = Order::of_tree(&Tree::new(&plan).context("no order").or_bad_input()?);
    let schedule = if arguments.motion.unchecked {
        schedule_of(&by_tree, &limits)?
    } else {
        // What the rig can't drive is told before a long search.
        schedule_of(&by_tree, &Limits { samples: 0, ..limits })?;
        let (order, certificate) = checked_order(arguments, &plan)?;
        schedule_of(&order, &limits)?.with_certificate(certificate)
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
    Ok(())
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

/// An order without a collision, with what must wait for what, and what was checked.
fn checked_order(arguments: &Arguments, plan: &Plan) -> Result<(Order, Certificate), Failure> {
    let name = arguments.plan.display();
    if plan.panels() > MOST_CHECKED {
        return Err(Failure::BadInput(anyhow!(
            "{name}: motion is checked for up to {MOST_CHECKED} panels, found {}; --unchecked schedules it without",
            plan.panels()
        )));
    }
    let plates = Plates::from(arguments.motion.panels);
    let thickness = plates.thickness(plan);
    let ground = arguments.motion.ground.then_some(Ground::TABLE);
    let bar = progress();
    let found = search(plan, thickness, ground, &Effort::default(), &mut |attempts, blocked| {
        let best = blocked.map_or(String::new(), |blocked| format!(", at best {blocked} hinges blocked"));
        bar.set_message(format!("{attempts} orders tried{best}"));
    });
    bar.finish_and_clear();
    let found = found.with_context(|| format!("{name}: no motion")).or_bad_input()?;
    let report = check(plan, &found.hinges, thickness, &Options { ground })
        .with_context(|| format!("{name}: no motion"))
        .or_bad_input()?;
    for (step, collision) in report.collisions.iter().take(SHOWN_COLLISIONS) {
        say(format_args!("step {step}: {collision}"));
    }
    let meetings = report.collisions.len();
    if meetings > SHOWN_COLLISIONS {
        say(format_args!("... and {} more", meetings - SHOWN_COLLISIONS));
    }
    if meetings > 0 && !arguments.motion.allow_collisions {
        return Err(Failure::Failed(anyhow!(
            "{name}: of {} orders none is free; the best one has {meetings} collisions, listed above; make a plan that opens \
             freely with `zygote plan --free`, or schedule this one with --allow-collisions",
            found.attempts
        )));
    }
    let order = if arguments.sequential || meetings > 0 {
        Order::one_by_one(found.hinges)
    } else {
        waits_for(plan, &found.hinges, thickness)
            .with_context(|| format!("{name}: no motion"))
            .or_bad_input()?
    };
    Ok((order, Certificate::of(&report, thickness, plates == Plates::Ideal, ground)))
}

/// What the search is at, on the error output.
fn progress() -> ProgressBar {
    let bar = ProgressBar::new_spinner();
    bar.enable_steady_tick(Duration::from_millis(200));
    bar
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
