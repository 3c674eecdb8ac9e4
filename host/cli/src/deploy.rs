//! `zygote deploy`: runs a plan's schedule, or the way back, on a board or on the simulator, and reports.

mod shown;

pub(crate) use shown::{Port, Simulator};

use crate::failure::{Failure, OrFail};
use crate::output::{LateFile, say, write_file};
use crate::recording_file::{self, RecordingFile};
use crate::view::{self, SceneOf};
use crate::{drift, identity, input, interrupt};
use anyhow::{Context, anyhow};
use clap::Args;
use indicatif::{ProgressBar, ProgressStyle};
use std::collections::BTreeSet;
use std::io::BufWriter;
use std::path::{Path, PathBuf};
use std::sync::atomic::Ordering;
use zygote_controller::{
    DeployError, Deployment, DriftError, EarlierRun, EventLog, MotionState, Progress, RunReport,
    SerialTransport, Session, Sightings, Transport, Wish, deploy,
};
use zygote_deployment::{Direction, Kind, Rig, Schedule};
use zygote_live::{Choice, Hub};
use zygote_protocol::Millis;
use zygote_recording::Job as Recorded;
use zygote_rehearsal::scenario::table;
use zygote_rehearsal::{Ending, Scenario, Stage, Trial};
use zygote_stacking::Plan;

/// How long an answer to the hello is waited for.
const HELLO_PATIENCE: Millis = Millis(2_000);
/// Session, run and boot of the simulator, so that every run is the same.
const SIMULATED: u32 = 1;
/// A hinge of the simulator is at its angle within this.
const ANGLE_TOLERANCE_DEG: f64 = 1.0;

/// Arguments of `zygote deploy`.
#[derive(Args)]
#[expect(clippy::struct_excessive_bools, reason = "flags of a command line")]
pub(crate) struct Arguments {
    /// The plan
    #[arg(value_name = "PLAN.fold")]
    plan: PathBuf,
    /// The rig
    #[arg(long, value_name = "RIG.toml")]
    rig: PathBuf,
    #[command(flatten)]
    target: Target,
    /// The schedule, where it doesn't stand in the plan; or the way back, as `zygote fold` writes it
    #[arg(long, value_name = "FILE")]
    schedule: Option<PathBuf>,
    /// Leave the safe state of an earlier fault or stop: you have looked at the rig
    #[arg(long)]
    clear: bool,
    /// Go on from where an earlier run of this schedule broke off
    #[arg(long, value_name = "REPORT.json")]
    resume: Option<PathBuf>,
    /// Servos that were interrupted stand again where they started: you have put them there
    #[arg(long, requires = "resume")]
    interrupted_are_back: bool,
    /// What goes wrong on the simulator, and what must come of it; the exit code is that of the verdict
    #[arg(long, value_name = "FILE", requires = "sim")]
    scenario: Option<PathBuf>,
    /// Event log, one JSON object a line [default: beside plan or schedule, .events.jsonl]
    #[arg(long, value_name = "FILE")]
    log: Option<PathBuf>,
    /// Report as JSON [default: beside plan or schedule, .report.json]
    #[arg(long, value_name = "FILE")]
    report: Option<PathBuf>,
    /// Recording as MCAP, a new file for every run [default: beside plan or schedule, .1.mcap, .2.mcap ...]
    #[arg(long, value_name = "FILE.mcap")]
    record: Option<PathBuf>,
    /// Run it although its hinges were calibrated at another board, whose heaters and thermistors are others
    #[arg(long)]
    calibrated_at_another_board: bool,
    /// Print the report as JSON
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    shown: shown::Shown,
}

/// Where to run.
#[derive(Args)]
#[group(required = true, multiple = false)]
pub(crate) struct Target {
    /// Serial port of the board
    #[arg(long, value_name = "DEV")]
    pub(crate) port: Option<String>,
    /// Simulated board, in virtual time
    #[arg(long)]
    pub(crate) sim: bool,
}

/// A run with its files.
#[expect(clippy::struct_excessive_bools, reason = "each is an option of the command line")]
pub(crate) struct Job {
    plan_path: PathBuf,
    rig_path: PathBuf,
    schedule_path: Option<PathBuf>,
    pub(crate) plan: Plan,
    pub(crate) rig: Rig,
    rig_text: String,
    pub(crate) schedule: Schedule,
    /// Hinges that an earlier run has moved.
    pub(crate) open: BTreeSet<usize>,
    clear: bool,
    scenario: Option<PathBuf>,
    log: Option<PathBuf>,
    report: Option<PathBuf>,
    record: Option<PathBuf>,
    json: bool,
    simulated: bool,
    any_board: bool,
}

impl Job {
    /// A run whose files stand beside it.
    pub(crate) fn new(
        plan_path: &Path,
        rig_path: &Path,
        schedule_path: Option<&Path>,
        simulated: bool,
    ) -> Result<Self, Failure> {
        let plan = input::plan(plan_path)?;
        let (rig, rig_text) = input::rig_with_text(rig_path)?;
        let schedule = input::run(plan_path, &plan, &rig, schedule_path)?;
        Ok(Self {
            plan_path: plan_path.to_owned(),
            rig_path: rig_path.to_owned(),
            schedule_path: schedule_path.map(Path::to_owned),
            plan,
            rig,
            rig_text,
            schedule,
            open: BTreeSet::new(),
            clear: false,
            scenario: None,
            log: None,
            report: None,
            record: None,
            json: false,
            simulated,
            any_board: false,
        })
    }

    fn of(arguments: &Arguments) -> Result<Self, Failure> {
        let Arguments { plan, rig, target, schedule, .. } = arguments;
        let job = Self::new(plan, rig, schedule.as_deref(), target.sim)?;
        let open = opened_before(arguments, &job.schedule)?;
        Ok(Self {
            open,
            clear: arguments.clear,
            scenario: arguments.scenario.clone(),
            log: arguments.log.clone(),
            report: arguments.report.clone(),
            record: arguments.record.clone(),
            json: arguments.json,
            any_board: arguments.calibrated_at_another_board,
            ..job
        })
    }

    /// The file that says what is run.
    fn file(&self) -> &Path {
        self.schedule_path.as_ref().unwrap_or(&self.plan_path)
    }

    /// Its name.
    pub(crate) fn name(&self) -> String {
        name(self.file()).to_owned()
    }

    /// As it stands among others.
    pub(crate) fn choice(&self) -> Choice {
        #[expect(clippy::cast_precision_loss, reason = "a makespan is far below 2^52 ms")]
        let expected_s = self.schedule.makespan.0 as f64 / 1e3;
        let (hinges, direction) = (self.schedule.steps.len(), self.schedule.direction());
        Choice { file: self.name(), hinges, direction, expected_s }
    }

    /// What the page shows of it.
    pub(crate) fn scene(&self, number: usize) -> Result<Vec<u8>, Failure> {
        let (schedule, rig) = (Some(&self.schedule), Some(&self.rig));
        SceneOf { path: &self.plan_path, plan: &self.plan, schedule, rig }.of_run(view::Run::Live { number })
    }

    /// The simulator with this on it, and with what has gone wrong in it.
    pub(crate) fn trial(&self) -> Result<Trial, Failure> {
        let standing = standing(&self.schedule, &self.open);
        match &self.scenario {
            None => Trial::new(self.rig.clone(), standing).or_bad_input(),
            Some(path) => {
                Scenario::open(path).or_bad_input()?.trial_of(self.rig.clone(), standing).or_bad_input()
            }
        }
    }
}

/// A run, or what is left of it.
pub(crate) struct Order<'a> {
    pub(crate) job: &'a Job,
    pub(crate) open: &'a BTreeSet<usize>,
    /// The file that was named for the recording is for the first part of a run.
    pub(crate) first: bool,
}

/// Who watches a run.
pub(crate) struct Attendance<'a> {
    /// Asked often: does the user want to stop?
    pub(crate) interrupted: &'a dyn Fn() -> bool,
    /// People at pages, who arm and start it as well.
    pub(crate) hub: Option<&'a Hub>,
}

/// Runs; succeeds only when every hinge is at its angle.
pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    arguments.shown.check()?;
    let job = Job::of(arguments)?;
    let interrupted = interrupt::flag()?;
    let stops = || interrupted.load(Ordering::Relaxed);
    if arguments.shown.view {
        return shown::run(arguments, job, &stops);
    }
    if let Some(device) = &arguments.target.port {
        let transport = SerialTransport::open(device, job.rig.link.baud).or_bad_input()?;
        return judge(&job.run_on(transport, identity::fresh(), &stops)?);
    }
    let trial = job.trial()?;
    let mut stage = trial.open().or_bad_input()?;
    let user_stops = stage.user_stops();
    let ending = job.run_on(&mut stage, SIMULATED, &|| stops() || user_stops.get());
    let Some(path) = &arguments.scenario else {
        let report = ending?;
        let truth = true_angles(&stage, &job.schedule, arguments.json);
        judge(&report)?;
        return truth;
    };
    let ending = match ending {
        Ok(report) => Ending::Report(Box::new(report)),
        Err(Failure::Failed(error)) => Ending::Refused(format!("{error:#}")),
        Err(bad_input @ Failure::BadInput(_)) => return Err(bad_input),
    };
    judge_scenario(&Scenario::open(path).or_bad_input()?, &trial, stage, ending)
}

/// The verdict on a run in which something went wrong.
fn judge_scenario(scenario: &Scenario, trial: &Trial, stage: Stage, ending: Ending) -> Result<(), Failure> {
    let verdict = scenario.judge(trial, &trial.close(stage, ending).or_failed()?);
    say(table(std::slice::from_ref(&verdict)));
    if verdict.holds() {
        Ok(())
    } else {
        Err(Failure::Failed(anyhow!("{}: the scenario failed", scenario.file)))
    }
}

/// The hinges that need not move again.
fn opened_before(arguments: &Arguments, schedule: &Schedule) -> Result<BTreeSet<usize>, Failure> {
    let Some(path) = &arguments.resume else { return Ok(BTreeSet::new()) };
    let name = path.display().to_string();
    let bytes = std::fs::read(path).with_context(|| format!("{name}: cannot be read")).or_bad_input()?;
    let earlier: EarlierRun = serde_json::from_slice(&bytes)
        .with_context(|| format!("{name}: no report of a run"))
        .or_bad_input()?;
    earlier.open(schedule, arguments.interrupted_are_back).context(name).or_bad_input()
}

/// The schedule with hinges that are open already standing there.
fn standing(schedule: &Schedule, open: &BTreeSet<usize>) -> Schedule {
    let mut standing = schedule.clone();
    for step in standing.steps.iter_mut().filter(|step| open.contains(&step.hinge)) {
        step.from_opening_deg = step.opening_deg;
    }
    standing
}

impl Job {
    /// Runs on a line that is opened for it.
    fn run_on<T: Transport>(
        &self,
        transport: T,
        number: u32,
        interrupted: &dyn Fn() -> bool,
    ) -> Result<RunReport, Failure> {
        let mut session = Session::connect(transport, number, HELLO_PATIENCE).or_failed()?;
        let order = Order { job: self, open: &self.open, first: true };
        let (report, kept) = order.perform(&mut session, number, &Attendance { interrupted, hub: None })?;
        kept.map(|()| report)
    }
}

impl Order<'_> {
    /// Runs in a session and writes log, recording and report; gives the report, and whether all of them are whole.
    pub(crate) fn perform<T: Transport>(
        &self,
        session: &mut Session<T>,
        number: u32,
        attendance: &Attendance<'_>,
    ) -> Result<(RunReport, Result<(), Failure>), Failure> {
        let &Self { job, open, first } = self;
        let (schedule, of) = (&job.schedule, job.file());
        let asked = job.record.as_ref().filter(|_| first);
        let RecordingFile { mut recorder, path: recording_path } =
            RecordingFile::new(&self.recorded(), asked, of)?;
        let log_path = beside(job.log.as_ref(), of, "events.jsonl");
        let mut pages = attendance.hub;
        let mut sightings = Sightings::default();
        let mut log = EventLog::new(BufWriter::new(LateFile::new(log_path.clone())))
            .observed_by(&mut recorder)
            .observed_by(&mut sightings);
        if let Some(hub) = &mut pages {
            log = log.observed_by(hub);
        }
        let wish = |moment| attendance.hub.map_or(Wish::GoOn, |hub| hub.wish(moment));
        let deployment = Deployment {
            schedule,
            rig: &job.rig,
            run: number,
            open,
            clear: job.clear && first,
            // What the simulator heats can't be harmed.
            any_board: job.any_board || job.simulated,
            interrupted: attendance.interrupted,
            steer: attendance.hub.is_some().then_some(&wish),
        };
        let bar = progress_bar(schedule.steps.len() - open.len());
        let outcome = deploy(session, &deployment, &mut log, &mut |progress| {
            show(&bar, progress);
            if let Some(hub) = attendance.hub {
                hub.look(progress);
            }
        });
        bar.finish_and_clear();
        let log_error = log.error().map(ToString::to_string);
        drop(log);
        let rig = &job.rig;
        let outcome = outcome.map(|report| {
            let drift =
                rig.calibrated_by.as_ref().map(|known| sightings.drift(rig, known, schedule.steps.len()));
            match drift {
                Some(Ok(drift)) => (RunReport { drift, ..report }, None),
                Some(Err(error)) => (report, Some(error)),
                None => (report, None),
            }
        });
        let recorded = recorder.finish(outcome.as_ref().ok().map(|(report, _)| report));
        let (report, not_compared) = outcome.map_err(refused)?;
        let kept = self.keep(&report, not_compared, &log_path, &recording_path).and_then(|()| {
            whole(&log_path, "log", log_error)?;
            whole(&recording_path, "recording", recorded.err().map(|error| error.to_string()))
        });
        Ok((report, kept))
    }

    /// Writes the report, and tells it.
    fn keep(
        &self,
        report: &RunReport,
        not_compared: Option<DriftError>,
        log: &Path,
        recording: &Path,
    ) -> Result<(), Failure> {
        let job = self.job;
        let path = beside(job.report.as_ref(), job.file(), "report.json");
        let json = serde_json::to_vec_pretty(report).or_failed()?;
        write_file(&path, &json)?;
        if job.json {
            say(String::from_utf8_lossy(&json));
        } else {
            say(report);
            let again = drift::command(&job.rig_path, &report.drift);
            if !again.is_empty() {
                say(format_args!("to calibrate them: {again}"));
            }
            if let Some(error) = not_compared {
                say(format_args!("the hinges aren't held against their calibration: {error}"));
            }
            let (path, log, recording) = (path.display(), log.display(), recording.display());
            say(format_args!("report: {path}\nevents: {log}\nrecording: {recording}"));
        }
        Ok(())
    }

    /// What the recording tells of it. On the simulator nothing of it depends on the wall clock.
    fn recorded(&self) -> Recorded<'_> {
        let &Self { job, open, .. } = self;
        Recorded {
            plan: &job.plan,
            plan_file: name(&job.plan_path),
            rig: &job.rig_text,
            rig_file: name(&job.rig_path),
            schedule: &job.schedule,
            open,
            scenario: job.scenario.as_deref().map(name),
            started: (!job.simulated).then(recording_file::now),
        }
    }
}

/// Nothing was energised. The wrong board is the user's to change, the rest isn't.
fn refused(error: DeployError) -> Failure {
    match error {
        DeployError::OtherBoard { .. } => Failure::BadInput(
            anyhow!(error).context("not on this board (--calibrated-at-another-board runs it all the same)"),
        ),
        other => Failure::Failed(other.into()),
    }
}

/// A file's name without its folder.
fn name(path: &Path) -> &str {
    path.file_name().and_then(|name| name.to_str()).unwrap_or_default()
}

/// The file asked for, else one beside what is run.
fn beside(asked: Option<&PathBuf>, run: &Path, ending: &str) -> PathBuf {
    asked.cloned().unwrap_or_else(|| run.with_extension(ending))
}

/// A run that is over is told; then that one of its files isn't whole.
fn whole(path: &Path, what: &str, error: Option<String>) -> Result<(), Failure> {
    match error {
        None => Ok(()),
        Some(error) => Err(Failure::Failed(anyhow!(
            "{}: the run is over, but its {what} isn't whole: {error}",
            path.display()
        ))),
    }
}

fn judge(report: &RunReport) -> Result<(), Failure> {
    let what = match report.direction {
        Direction::Deploy => "deployed",
        Direction::Fold => "folded",
    };
    if report.is_complete() { Ok(()) } else { Err(Failure::Failed(anyhow!("the shape is not {what}"))) }
}

/// A bar on the error output, which is nothing where that is no terminal.
fn progress_bar(steps: usize) -> ProgressBar {
    let bar = ProgressBar::new(u64::try_from(steps).unwrap_or(u64::MAX));
    // The template is a constant of ours; if it were wrong, the plain bar would do.
    if let Ok(style) = ProgressStyle::with_template("{bar:30} {pos}/{len} hinges, {elapsed}  {msg}") {
        bar.set_style(style);
    }
    bar
}

fn show(bar: &ProgressBar, progress: &Progress) {
    bar.set_position(u64::try_from(progress.opened).unwrap_or(u64::MAX));
    if let Some(motion) = progress.motions.first() {
        bar.set_message(describe(motion));
    }
}

fn describe(motion: &MotionState) -> String {
    let temperature = motion.temperature_c.map(|celsius| format!(", {celsius:.0} °C")).unwrap_or_default();
    let angle = motion.opening_deg.map(|degrees| format!(", about {degrees:.0}°")).unwrap_or_default();
    format!("hinge {} {}{temperature}{angle}", motion.hinge, motion.phase)
}

/// Holds the true angles of the simulated hinges against those of the plan.
fn true_angles(stage: &Stage, schedule: &Schedule, json: bool) -> Result<(), Failure> {
    let plant = stage.board().plant();
    let angle = |kind, channel: u16| {
        let channel = usize::from(channel);
        match kind {
            Kind::Sma => plant.sma_hinges().get(channel).map(zygote_sim::plant::SmaHinge::angle_deg),
            Kind::Servo => plant.servo_hinges().get(channel).map(zygote_sim::plant::ServoHinge::angle_deg),
            Kind::Spring => plant.spring_hinges().get(channel).map(zygote_sim::plant::SpringHinge::angle_deg),
        }
    };
    let error = |step: &zygote_deployment::Step| {
        let truth = angle(step.motion.kind(), step.channel).unwrap_or(f64::NAN);
        (step.hinge, (truth - f64::from(step.opening_deg)).abs())
    };
    let errors: Vec<_> = schedule.steps.iter().map(error).collect();
    let good = errors.iter().filter(|(_, error)| *error <= ANGLE_TOLERANCE_DEG).count();
    let worst = errors.iter().max_by(|a, b| a.1.total_cmp(&b.1));
    let worst =
        worst.map_or_else(String::new, |(hinge, error)| format!(", worst hinge {hinge}: off by {error:.2}°"));
    let line = format!("true angles: {good} of {} hinges within {ANGLE_TOLERANCE_DEG}°{worst}", errors.len());
    if !json {
        say(&line);
    }
    if good == errors.len() { Ok(()) } else { Err(Failure::Failed(anyhow!("the simulator's {line}"))) }
}
