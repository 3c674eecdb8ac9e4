//! `zygote check`: whether a plan file keeps the rules, and with `--motion` whether its schedule moves it without a collision.
//! Exit code 0 it does, 1 it breaks a rule or panels meet, 2 it can't be read.

use crate::failure::{Failure, OrFail};
use crate::output::say;
use crate::plan::summary;
use anyhow::{Context, anyhow, bail};
use clap::Args;
use std::fs;
use std::path::PathBuf;
use zygote_deployment::dense::{Scheduled, Setting, verify_with_jumps};
use zygote_stacking::fold;

/// Places listed for each broken rule.
const SHOWN_PER_RULE: usize = 5;
/// Collisions listed.
const SHOWN_COLLISIONS: usize = 20;

/// Arguments of `zygote check`.
#[derive(Args)]
pub(crate) struct Arguments {
    /// The plan
    #[arg(value_name = "PLAN.fold")]
    plan: PathBuf,
    #[command(flatten)]
    motion: MotionArguments,
}

#[derive(Args)]
struct MotionArguments {
    /// Look for collisions in the motion of its schedule, by sampling, independently of what made the schedule
    #[arg(long)]
    motion: bool,
    /// The schedule, where it stands beside the plan
    #[arg(long, value_name = "SCHEDULE.json", requires = "motion")]
    schedule: Option<PathBuf>,
    /// Degrees that a hinge turns from sample to sample
    #[arg(long, value_name = "DEGREES", default_value_t = 1.0, requires = "motion")]
    step: f64,
    /// Besides one by one, let the hinges move at once as the schedule allows, so many times, at random speeds
    #[arg(long, value_name = "N", default_value_t = 2, requires = "motion")]
    at_once: usize,
    /// Thickness of the panels in panel lengths [default: that of the schedule's certificate]
    #[arg(long, value_name = "T", requires = "motion")]
    thickness: Option<f64>,
    /// Border of every panel that may touch anything [default: that of the certificate, or the thickness given]
    #[arg(long, value_name = "R", requires = "motion")]
    rim: Option<f64>,
}

/// Checks a plan and lists what it breaks.
pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let name = arguments.plan.display();
    let bytes =
        fs::read(&arguments.plan).with_context(|| format!("{name}: cannot be read")).or_bad_input()?;
    let report = fold::check(&bytes).with_context(|| format!("{name}: no plan")).or_bad_input()?;
    if report.is_valid() {
        say(format_args!("{name}: valid: {}", summary(&report.figures)));
        return if arguments.motion.motion { motion(arguments, &bytes) } else { Ok(()) };
    }
    for line in report.lines(SHOWN_PER_RULE) {
        say(line);
    }
    let rules = report.violations().count();
    Err(Failure::Failed(anyhow!("{name}: breaks {rules} of the rules of a plan, listed above")))
}

/// Looks for collisions in the motion of a valid plan's schedule.
fn motion(arguments: &Arguments, bytes: &[u8]) -> Result<(), Failure> {
    let name = arguments.plan.display();
    let plan = fold::read(bytes).with_context(|| format!("{name}: no plan")).or_bad_input()?;
    let value = match (&arguments.motion.schedule, &plan.schedule) {
        (Some(path), _) => {
            let bytes = fs::read(path)
                .with_context(|| format!("{}: cannot be read", path.display()))
                .or_bad_input()?;
            serde_json::from_slice(&bytes)
                .with_context(|| format!("{}: not JSON", path.display()))
                .or_bad_input()?
        }
        (None, Some(value)) => value.clone(),
        (None, None) => {
            let error =
                anyhow!("{name}: has no schedule; make it with `zygote schedule {name} --rig RIG.toml`");
            return Err(Failure::BadInput(error));
        }
    };
    let scheduled = Scheduled::read(&plan, &value).with_context(|| name.to_string()).or_bad_input()?;
    let setting = setting(&arguments.motion, &scheduled).with_context(|| name.to_string()).or_bad_input()?;
    let verdict = verify_with_jumps(&plan, &scheduled.order, &scheduled.springs, &setting)
        .with_context(|| name.to_string())
        .or_bad_input()?;
    for meeting in verdict.meetings.iter().take(SHOWN_COLLISIONS) {
        say(meeting);
    }
    let looked = format!(
        "{} samples of {} degrees or less, one by one and {} times at once, {} pairs of boxes compared",
        verdict.samples, setting.step_deg, setting.at_once, verdict.pairs
    );
    let collisions = verdict.meetings.len();
    if verdict.is_free() {
        let clearance = verdict.clearance;
        say(format_args!(
            "{name}: motion: no collision seen, clearance {clearance:.2e} panel lengths: {looked}"
        ));
        return Ok(());
    }
    if collisions > SHOWN_COLLISIONS {
        say(format_args!("... and {} more", collisions - SHOWN_COLLISIONS));
    }
    Err(Failure::Failed(anyhow!(
        "{name}: {collisions} collisions seen in its motion, listed above: {looked}"
    )))
}

/// What to look at: what the certificate says was proved, unless told otherwise.
fn setting(arguments: &MotionArguments, scheduled: &Scheduled) -> anyhow::Result<Setting> {
    let proved = scheduled.certificate.as_ref();
    let (thickness, rim) = match (arguments.thickness, arguments.rim, proved) {
        (Some(thickness), rim, _) => (thickness, rim.unwrap_or(thickness)),
        (None, rim, Some(proved)) => (proved.thickness, rim.unwrap_or(proved.rim)),
        (None, _, None) => bail!("its schedule has no certificate of its motion; give --thickness T"),
    };
    let ground = proved.and_then(|proved| proved.ground);
    Ok(Setting { thickness, rim, ground, step_deg: arguments.step, at_once: arguments.at_once })
}
