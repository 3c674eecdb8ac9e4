//! `zygote deploy`: runs a plan's schedule, or the way back, on a board or on the simulator, and reports.

use crate::failure::{Failure, OrFail};
use crate::output::{LateFile, say, write_file};
use crate::recording_file::{self, RecordingFile};
use crate::{drift, identity, input, interrupt};
use anyhow::{Context, anyhow};
use clap::Args;
use indicatif::{ProgressBar, ProgressStyle};
use std::collections::BTreeSet;
use std::io::BufWriter;
use std::path::{Path, PathBuf};
use std::sync::atomic::Ordering;
use zygote_controller::{
    DeployError, Deployment, EarlierRun, EventLog, MotionState, Progress, RunReport, SerialTransport,
    Session, Sightings, Transport, deploy,
};
use zygote_deployment::{Direction, Kind, Rig, Schedule};
use zygote_protocol::Millis;
use zygote_recording::Job;
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
}

/// Where to run.
#[derive(Args)]
#[group(required = true, multiple = false)]
struct Target {
    /// Serial port of the board
    #[arg(long, value_name = "DEV")]
    port: Option<String>,
    /// Simulated board, in virtual time
    #[arg(long)]
    sim: bool,
}

/// What is to be run.
struct Order<'a> {
    arguments: &'a Arguments,
    plan: &'a Plan,
    rig: &'a Rig,
    rig_text: &'a str,
    schedule: &'a Schedule,
    open: &'a BTreeSet<usize>,
}

/// Runs; succeeds only when every hinge is at its angle.
pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let plan = &input::plan(&arguments.plan)?;
    let (rig, rig_text) = &input::rig_with_text(&arguments.rig)?;
    let schedule = &input::run(&arguments.plan, plan, rig, arguments.schedule.as_deref())?;
    let open = &opened_before(arguments, schedule)?;
    let order = Order { arguments, plan, rig, rig_text, schedule, open };
    if let Some(device) = &arguments.target.port {
        let transport = SerialTransport::open(device, rig.link.baud).or_bad_input()?;
        let (report, _) = order.run_on(transport, identity::fresh(), &|| false)?;
        return judge(&report);
    }
    let standing = standing(schedule, open);
    let Some(path) = &arguments.scenario else {
        let trial = Trial::new(rig.clone(), standing).or_bad_input()?;
        let mut stage = trial.open().or_bad_input()?;
        let (report, _) = order.run_on(&mut stage, SIMULATED, &|| false)?;
        let truth = true_angles(&stage, schedule, arguments.json);
        judge(&report)?;
        return truth;
    };
    let scenario = Scenario::open(path).or_bad_input()?;
    let trial = scenario.trial_of(rig.clone(), standing).or_bad_input()?;
    let mut stage = trial.open().or_bad_input()?;
    let stops = stage.user_stops();
    let ending = match order.run_on(&mut stage, SIMULATED, &|| stops.get()) {
        Ok((report, _)) => Ending::Report(Box::new(report)),
        Err(Failure::Failed(error)) => Ending::Refused(format!("{error:#}")),
        Err(bad_input @ Failure::BadInput(_)) => return Err(bad_input),
    };
    let verdict = scenario.judge(&trial, &trial.close(stage, ending).or_failed()?);
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

impl Order<'_> {
    /// Runs on a line and writes log, recording and report; gives the line back.
    fn run_on<T: Transport>(
        &self,
        transport: T,
        number: u32,
        stops: &dyn Fn() -> bool,
    ) -> Result<(RunReport, T), Failure> {
        let &Self { arguments, rig, schedule, open, .. } = self;
        let of = arguments.schedule.as_ref().unwrap_or(&arguments.plan);
        let RecordingFile { mut recorder, path: recording_path } =
            RecordingFile::new(&self.recorded(), arguments.record.as_ref(), of)?;
        let interrupted = interrupt::flag()?;
        let mut session = Session::connect(transport, number, HELLO_PATIENCE).or_failed()?;
        let log_path = beside(arguments.log.as_ref(), of, "events.jsonl");
        let mut sightings = Sightings::default();
        let mut log = EventLog::new(BufWriter::new(LateFile::new(log_path.clone())))
            .observed_by(&mut recorder)
            .observed_by(&mut sightings);
        let deployment = Deployment {
            schedule,
            rig,
            run: number,
            open,
            clear: arguments.clear,
            // What the simulator heats can't be harmed.
            any_board: arguments.calibrated_at_another_board || arguments.target.sim,
            interrupted: &|| interrupted.load(Ordering::Relaxed) || stops(),
        };
        let bar = progress_bar(schedule.steps.len() - open.len());
        let outcome = deploy(&mut session, &deployment, &mut log, &mut |progress| show(&bar, progress));
        bar.finish_and_clear();
        let log_error = log.error().map(ToString::to_string);
        drop(log);
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
        let report_path = beside(arguments.report.as_ref(), of, "report.json");
        let json = serde_json::to_vec_pretty(&report).or_failed()?;
        write_file(&report_path, &json)?;
        if arguments.json {
            say(String::from_utf8_lossy(&json));
        } else {
            say(&report);
            let again = drift::command(&arguments.rig, &report.drift);
            if !again.is_empty() {
                say(format_args!("to calibrate them: {again}"));
            }
            if let Some(error) = not_compared {
                say(format_args!("the hinges aren't held against their calibration: {error}"));
            }
            say(format_args!(
                "report: {}\nevents: {}\nrecording: {}",
                report_path.display(),
                log_path.display(),
                recording_path.display()
            ));
        }
        whole(&log_path, "log", log_error)?;
        whole(&recording_path, "recording", recorded.err().map(|error| error.to_string()))?;
        Ok((report, session.into_transport()))
    }

    /// What the recording tells of it. On the simulator nothing of it depends on the wall clock.
    fn recorded(&self) -> Job<'_> {
        let &Self { arguments, plan, rig_text, schedule, open, .. } = self;
        Job {
            plan,
            plan_file: name(&arguments.plan),
            rig: rig_text,
            rig_file: name(&arguments.rig),
            schedule,
            open,
            scenario: arguments.scenario.as_deref().map(name),
            started: (!arguments.target.sim).then(recording_file::now),
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
