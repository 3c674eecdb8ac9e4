//! `zygote serve`: a page from which runs are chosen, armed, started, paused and stopped, one after the other.

use crate::deploy::{Job, Port, Simulator, Target};
use crate::failure::{Failure, OrFail};
use crate::live::{Attended, Screen};
use crate::{input, interrupt};
use anyhow::{Context, anyhow};
use clap::Args;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::Ordering;
use zygote_controller::SerialTransport;
use zygote_deployment::{Fingerprint, Schedule};
use zygote_live::Hub;

/// Arguments of `zygote serve`.
#[derive(Args)]
#[command(
    after_help = "A plan that holds its schedule is a run, and so is every schedule, or way back, of a plan that is named too. The page \
    is served to this computer alone, and to those who know its address with the secret in it."
)]
pub(crate) struct Arguments {
    /// Plans, and schedules of them
    #[arg(value_name = "FILE", required = true)]
    files: Vec<PathBuf>,
    /// The rig
    #[arg(long, value_name = "RIG.toml")]
    rig: PathBuf,
    #[command(flatten)]
    target: Target,
    #[command(flatten)]
    screen: Screen,
}

/// Serves until Ctrl-C, or until the page ends it.
pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let jobs = jobs(arguments)?;
    let scenes = jobs.iter().enumerate().map(|(number, job)| job.scene(number)).collect::<Result<_, _>>()?;
    let stop = interrupt::flag()?;
    let hub = Arc::new(Hub::new());
    let port = arguments.target.port.as_deref();
    let baud = jobs.first().map_or(0, |job| job.rig.link.baud);
    let line = port.map(|device| SerialTransport::open(device, baud)).transpose().or_bad_input()?;
    let server = arguments.screen.open(&arguments.rig.display(), &hub)?;
    let mut attended = Attended {
        hub: &hub,
        server: &server,
        jobs: &jobs,
        scenes,
        interrupted: &|| stop.load(Ordering::Relaxed),
        pace: arguments.screen.pace(),
        only: false,
        at_once: false,
        last: None,
    };
    match line {
        Some(line) => attended.until_the_end(&mut Port { line: Some(line) }).map(drop),
        None => {
            attended.until_the_end(&mut Simulator { jobs: &jobs, pace: arguments.screen.pace() }).map(drop)
        }
    }
}

fn jobs(arguments: &Arguments) -> Result<Vec<Job>, Failure> {
    let is_plan = |path: &&PathBuf| path.extension().is_some_and(|ending| ending == "fold");
    let (plans, schedules): (Vec<_>, Vec<_>) = arguments.files.iter().partition(is_plan);
    let job = |plan: &Path, schedule| Job::new(plan, &arguments.rig, schedule, arguments.target.sim);
    let mut jobs = Vec::new();
    let mut known = Vec::new();
    for path in plans {
        let plan = input::plan(path)?;
        if plan.schedule.is_some() {
            jobs.push(job(path, None)?);
        }
        known.push((path, Fingerprint::of(&plan)));
    }
    for path in schedules {
        let name = path.display();
        let text =
            fs::read_to_string(path).with_context(|| format!("{name}: cannot be read")).or_bad_input()?;
        let schedule =
            Schedule::from_text(&text).with_context(|| format!("{name}: no schedule")).or_bad_input()?;
        let of = schedule.plan_crc64;
        let plan = known.iter().find(|(_, plan)| *plan == of).with_context(|| {
            format!("{name}: is for plan {of}, which none of the plans named is; name its plan too")
        });
        jobs.push(job(plan.or_bad_input()?.0, Some(path))?);
    }
    if jobs.is_empty() {
        let error =
            anyhow!("there is nothing to run: none of the plans has a schedule; `zygote schedule` makes one");
        return Err(Failure::BadInput(error));
    }
    Ok(jobs)
}
