//! `zygote deploy --view`: the run in the page, where it is armed, started, paused, resumed and stopped.

use super::{Arguments, HELLO_PATIENCE, Job, judge, judge_scenario, true_angles};
use crate::failure::{Failure, OrFail};
use crate::identity;
use crate::live::{Attended, Bench, RealTime, Screen};
use anyhow::anyhow;
use clap::Args;
use std::sync::Arc;
use zygote_controller::{RunReport, SerialTransport, Session};
use zygote_live::Hub;
use zygote_rehearsal::{Ending, Scenario, Stage};

/// Whether the run is shown, and how.
#[derive(Args)]
pub(super) struct Shown {
    /// Show the run in the browser; nothing moves before it is armed and started there
    #[arg(long)]
    pub(super) view: bool,
    /// Arm and start at once
    #[arg(long, requires = "view")]
    yes: bool,
    #[command(flatten)]
    screen: Screen,
}

impl Shown {
    /// What says how a page is to be served is no good without one.
    pub(super) fn check(&self) -> Result<(), Failure> {
        let Screen { view_port, no_open, pace } = self.screen;
        let said = [(view_port != 0, "--view-port"), (no_open, "--no-open"), (pace.is_some(), "--pace")];
        match said.iter().find(|(said, _)| *said && !self.view) {
            Some((_, option)) => Err(Failure::BadInput(anyhow!("{option} needs --view"))),
            None => Ok(()),
        }
    }
}

/// Runs until somebody ends it; succeeds only when every hinge is at its angle.
pub(super) fn run(arguments: &Arguments, job: Job, interrupted: &dyn Fn() -> bool) -> Result<(), Failure> {
    let Shown { yes, screen, .. } = &arguments.shown;
    let (hub, name) = (Arc::new(Hub::new()), job.name());
    let scenes = vec![job.scene(0)?];
    let jobs = [job];
    let [job] = &jobs;
    // Whether the line can be had is known before a page is shown.
    let port = arguments.target.port.as_deref();
    let line =
        port.map(|device| SerialTransport::open(device, job.rig.link.baud)).transpose().or_bad_input()?;
    let server = screen.open(&name, &hub)?;
    let mut attended = Attended {
        hub: &hub,
        server: &server,
        jobs: &jobs,
        scenes,
        interrupted,
        pace: screen.pace(),
        only: true,
        at_once: *yes,
        last: None,
    };
    if let Some(line) = line {
        attended.until_the_end(&mut Port { line: Some(line) })?;
        return judge(&report_of(attended)?);
    }
    let line = attended.until_the_end(&mut Simulator { jobs: &jobs, pace: screen.pace() })?;
    let report = report_of(attended)?;
    let Some(stage) = line.map(RealTime::into_inner) else { return judge(&report) };
    if let Some(path) = &job.scenario {
        let ending = Ending::Report(Box::new(report));
        return judge_scenario(&Scenario::open(path).or_bad_input()?, &job.trial()?, stage, ending);
    }
    judge(&report)?;
    true_angles(&stage, &job.schedule, job.json)
}

fn report_of(attended: Attended<'_>) -> Result<RunReport, Failure> {
    let nothing = || Failure::Failed(anyhow!("nothing was run"));
    attended.last.map(|(_, report)| report).ok_or_else(nothing)
}

/// A board, the same for every run.
pub(crate) struct Port {
    pub(crate) line: Option<SerialTransport>,
}

impl Bench for Port {
    type Line = SerialTransport;

    fn session(
        &mut self,
        _run: usize,
        so_far: Option<Session<SerialTransport>>,
    ) -> Result<Session<SerialTransport>, Failure> {
        match (so_far, self.line.take()) {
            (Some(session), _) => Ok(session),
            (None, Some(line)) => Session::connect(line, identity::fresh(), HELLO_PATIENCE).or_failed(),
            (None, None) => Err(Failure::Failed(anyhow!("the board was lost: start this program again"))),
        }
    }
}

/// A simulator, with another plant for every run.
pub(crate) struct Simulator<'a> {
    pub(crate) jobs: &'a [Job],
    pub(crate) pace: f64,
}

impl Bench for Simulator<'_> {
    type Line = RealTime<Stage>;

    fn session(
        &mut self,
        run: usize,
        _so_far: Option<Session<Self::Line>>,
    ) -> Result<Session<Self::Line>, Failure> {
        let job = self.jobs.get(run).ok_or_else(|| Failure::Failed(anyhow!("there is no run {run}")))?;
        let stage = job.trial()?.open().or_bad_input()?;
        let line = RealTime::new(stage, self.pace);
        Session::connect(line, identity::fresh(), HELLO_PATIENCE).or_failed()
    }
}
