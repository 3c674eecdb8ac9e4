//! Runs one after the other, as whoever has control in the page wants them; what a run does, `deploy::Order` does.

use crate::deploy::{self, Attendance, Job};
use crate::failure::Failure;
use crate::identity;
use std::collections::BTreeSet;
use std::thread;
use std::time::Duration;
use zygote_controller::{
    DeployError, EarlierRun, HingeOutcome, Notice, Outcome, Progress, Record, RequestError, RunReport,
    Session, Transport,
};
use zygote_deployment::Kind;
use zygote_live::{Begin, Choice, Hub, Order, Server, Stage, Told, expected};
use zygote_protocol::{Command, EventKind, Millis, State};

/// Wishes are looked at so often while nothing runs.
const MOMENT: Millis = Millis(10);
/// How long an MCU that was lost is waited for.
const PATIENCE: Millis = Millis(2_000);
/// Pages hear the last word before the program ends.
const GOODBYE: Duration = Duration::from_millis(300);

/// Where runs are done.
pub(crate) trait Bench {
    /// Its line.
    type Line: Transport;

    /// The session for a run that begins anew, in place of the one so far: a board is the same, a simulator has another plant.
    fn session(
        &mut self,
        run: usize,
        so_far: Option<Session<Self::Line>>,
    ) -> Result<Session<Self::Line>, Failure>;
}

/// Runs on offer, and how far the last of them came.
pub(crate) struct Attended<'a> {
    pub(crate) hub: &'a Hub,
    pub(crate) server: &'a Server,
    pub(crate) jobs: &'a [Job],
    /// What the page shows of each.
    pub(crate) scenes: Vec<Vec<u8>>,
    pub(crate) interrupted: &'a dyn Fn() -> bool,
    pub(crate) pace: f64,
    /// The first run is loaded at once, and is the only one.
    pub(crate) only: bool,
    /// It is armed and started at once, too.
    pub(crate) at_once: bool,
    /// The run that was loaded last, and what came of it.
    pub(crate) last: Option<(usize, RunReport)>,
}

/// What is to be loaded.
struct Load {
    run: usize,
    open: BTreeSet<usize>,
    at_once: bool,
    /// What is left of the last one.
    rest: bool,
}

/// What comes next.
enum Next {
    Load(Load),
    End,
}

impl Attended<'_> {
    /// Goes on until somebody ends it; gives the line back.
    pub(crate) fn until_the_end<B: Bench>(&mut self, bench: &mut B) -> Result<Option<B::Line>, Failure> {
        let choices: Vec<Choice> = self.jobs.iter().map(Job::choice).collect();
        self.hub.offer(&choices);
        let mut session = None;
        let mut next = None;
        if self.only {
            let open = self.jobs.first().map(|job| job.open.clone()).unwrap_or_default();
            next = Some(Load { run: 0, open, at_once: self.at_once, rest: false });
        } else {
            self.show(0);
            self.rest(Stage::new("idle", "Nothing is loaded.", &["choose", "end"]));
        }
        loop {
            let load = match next.take() {
                Some(load) => load,
                None => match self.idle(&mut session) {
                    Next::Load(load) => load,
                    Next::End => break,
                },
            };
            let outcome = self.run(bench, &mut session, load);
            match outcome {
                // It can't be run at all: that is told where the program was started.
                Err(failure) if self.only && self.last.is_none() && !is_safe(&failure) => {
                    return Err(failure);
                }
                Err(failure) => self.trouble(&failure),
                Ok(()) => {}
            }
            if (self.interrupted)() {
                break;
            }
        }
        self.hub.enter(Stage::new("gone", "The program has ended.", &[]));
        thread::sleep(GOODBYE);
        Ok(session.map(Session::into_transport))
    }

    /// What the page shows of a run.
    fn show(&self, run: usize) {
        if let Some(scene) = self.scenes.get(run) {
            self.server.put("/scene.json", scene.clone());
        }
    }

    fn rest(&self, stage: Stage) {
        self.hub.enter(stage);
    }

    fn tell(&self, failure: &Failure) {
        let (Failure::BadInput(error) | Failure::Failed(error)) = failure;
        self.hub.tell(&Told::Trouble { told: &format!("{error:#}") });
    }

    fn trouble(&self, failure: &Failure) {
        self.tell(failure);
        // What the MCU is in then, somebody has to look at.
        self.rest(self.stage("safe", "The run wasn't started.", &["clear"]));
    }

    /// Loads a run, and sees it through.
    fn run<B: Bench>(
        &mut self,
        bench: &mut B,
        session: &mut Option<Session<B::Line>>,
        load: Load,
    ) -> Result<(), Failure> {
        let Some(job) = self.jobs.get(load.run) else { return Ok(()) };
        self.hub.enter(Stage::busy("Loading."));
        let mut ours = match session.take() {
            Some(ours) if load.rest => ours,
            so_far => bench.session(load.run, so_far)?,
        };
        self.show(load.run);
        let rest = job.schedule.rest(&load.open);
        let begin = Begin {
            version: zygote_live::VERSION,
            run: load.run,
            file: job.name(),
            rig: job.rig.id.clone(),
            line: ours.transport().name(),
            direction: job.schedule.direction(),
            pace: self.pace,
            current_limit_a: job.rig.supply.limit.0,
            steps: expected(&rest),
            open: load.open.iter().copied().collect(),
        };
        self.hub.begin(&begin, load.at_once);
        let attendance = Attendance { interrupted: self.interrupted, hub: Some(self.hub) };
        let order = deploy::Order { job, open: &load.open, first: self.last.is_none() };
        let ended = order.perform(&mut ours, identity::fresh(), &attendance);
        *session = Some(ours);
        let (report, kept) = ended?;
        if let Err(failure) = kept {
            // The run is over all the same.
            self.tell(&failure);
        }
        self.hub.report(&report);
        self.last = Some((load.run, report));
        if let Some((_, report)) = &self.last {
            self.rest(self.after(report));
        }
        Ok(())
    }

    /// What may be asked for where nothing runs, besides these.
    fn stage(&self, name: &'static str, told: &str, more: &[&'static str]) -> Stage {
        let mut stage = Stage::new(name, told, more);
        // Of one that was begun, what is left can be resumed.
        if (!self.only || self.last.is_none()) && name != "safe" {
            stage.can.push("choose");
        }
        stage.can.push("end");
        stage
    }

    fn after(&self, report: &RunReport) -> Stage {
        let mut stage = match &report.outcome {
            Outcome::Deployed | Outcome::Folded => {
                self.stage("over", "Every hinge is at its angle, and everything is off.", &[])
            }
            Outcome::Paused => {
                self.stage("paused", "Everything is off. What is left can be resumed.", &["resume"])
            }
            Outcome::Stopped => {
                self.stage("safe", "Stopped: everything is off. Look at the rig, then clear.", &["clear"])
            }
            Outcome::Fault(why) => self.stage("safe", &format!("{why}. Everything is off."), &["clear"]),
            Outcome::Lost(why) => self.stage(
                "safe",
                &format!("The MCU was lost: {why}. It turns everything off by itself."),
                &["clear"],
            ),
        };
        stage.interrupted = interrupted_servos(report);
        stage
    }

    /// Waits for what is wanted next.
    fn idle<T: Transport>(&mut self, session: &mut Option<Session<T>>) -> Next {
        let mut silent = false;
        loop {
            if (self.interrupted)() {
                return Next::End;
            }
            if self.hub.stop_asked() {
                self.stop(session.as_mut());
            }
            if let Some(order) = self.hub.order() {
                silent = false;
                if let Some(next) = self.take(order, session.as_mut()) {
                    return next;
                }
            }
            match session {
                Some(session) if !silent => silent = self.listen(session),
                _ => thread::sleep(Duration::from_millis(u64::from(MOMENT.0))),
            }
        }
    }

    /// Hears what the MCU has to say; whether it has gone.
    fn listen<T: Transport>(&self, session: &mut Session<T>) -> bool {
        match session.notice(session.now().plus(MOMENT)) {
            Ok(None) => {}
            Ok(Some(Notice::Telemetry(look))) => self.hub.look(&Progress {
                opened: usize::from(look.opened),
                total: 0,
                motions: Vec::new(),
                at: look.at,
                supply: look.supply,
                current: look.current,
            }),
            Ok(Some(Notice::Event(event))) => {
                if let EventKind::State(state) = event.kind {
                    let state = format!("{state:?}").to_lowercase();
                    self.hub.tell(&Told::Event(&Record::State { mcu_us: event.at.0, state }));
                }
            }
            Ok(Some(Notice::Fault(fault))) => {
                let (mcu_us, value, limit) = (fault.at.0, fault.value, fault.limit);
                let fault = fault.code.to_string();
                self.hub.tell(&Told::Event(&Record::Fault { mcu_us, fault, value, limit, hinge: None }));
            }
            Err(error) => {
                self.hub.tell(&Told::Event(&Record::Lost { message: error.to_string() }));
                return true;
            }
        }
        false
    }

    /// Does what is wanted; gives what comes next where that is more than this.
    fn take<T: Transport>(&mut self, order: Order, session: Option<&mut Session<T>>) -> Option<Next> {
        match order {
            Order::End => return Some(Next::End),
            Order::Choose { run } => match self.jobs.get(run) {
                Some(job) => {
                    return Some(Next::Load(Load {
                        run,
                        open: job.open.clone(),
                        at_once: false,
                        rest: false,
                    }));
                }
                None => self.hub.tell(&Told::Trouble { told: &format!("there is no run {run}") }),
            },
            Order::Resume { back } => return self.resume(back),
            Order::Clear => match session.map(clear) {
                None | Some(Ok(())) => self.cleared(),
                Some(Err(why)) => self.hub.tell(&Told::Trouble { told: &why }),
            },
            // None of them is taken where nothing is loaded.
            Order::Arm | Order::Disarm | Order::Start | Order::Pause | Order::GoOn | Order::Unload => {}
        }
        None
    }

    fn resume(&self, back: bool) -> Option<Next> {
        let (run, report) = self.last.as_ref()?;
        let job = self.jobs.get(*run)?;
        match EarlierRun::from(report).open(&job.schedule, back) {
            // Who paused it wants it to go on; what was stopped, or failed, is armed and started by hand.
            Ok(open) => {
                let at_once = report.outcome == Outcome::Paused;
                Some(Next::Load(Load { run: *run, open, at_once, rest: true }))
            }
            Err(error) => {
                self.hub.tell(&Told::Trouble { told: &error.to_string() });
                None
            }
        }
    }

    fn cleared(&self) {
        let resumable = self.last.as_ref().filter(|(_, report)| !report.is_complete());
        let (told, more): (_, &[_]) = match resumable {
            Some(_) => ("Nothing is energised. What is left can be loaded.", &["resume"]),
            None => ("Nothing is loaded.", &[]),
        };
        let mut stage = self.stage("cleared", told, more);
        stage.interrupted = resumable.map(|(_, report)| interrupted_servos(report)).unwrap_or_default();
        self.rest(stage);
    }

    /// Stops an MCU on which nothing runs.
    fn stop<T: Transport>(&self, session: Option<&mut Session<T>>) {
        self.hub.tell(&Told::Event(&Record::StopRequested));
        match session.map(Session::stop) {
            None => self.hub.tell(&Told::Unconfirmed { why: "no MCU is connected" }),
            Some(Err(error)) => self.hub.tell(&Told::Unconfirmed { why: &error.to_string() }),
            Some(Ok(after)) => {
                self.hub.tell(&Told::Event(&Record::StopConfirmed { after_us: after.0 }));
                self.rest(self.stage(
                    "safe",
                    "Stopped: everything is off. Look at the rig, then clear.",
                    &["clear"],
                ));
            }
        }
    }
}

/// The MCU is in its safe state, from before: somebody has to look at the rig, and may say so in the page.
fn is_safe(failure: &Failure) -> bool {
    let (Failure::BadInput(error) | Failure::Failed(error)) = failure;
    matches!(error.downcast_ref(), Some(DeployError::Safe { .. }))
}

fn interrupted_servos(report: &RunReport) -> Vec<usize> {
    let interrupted = report.hinges.iter().filter(|hinge| hinge.outcome == HingeOutcome::Interrupted);
    interrupted.filter(|hinge| hinge.kind == Kind::Servo).map(|hinge| hinge.hinge).collect()
}

/// Leaves the safe state, of an MCU that may have to be found again first.
fn clear<T: Transport>(session: &mut Session<T>) -> Result<(), String> {
    let status = match session.status() {
        Err(RequestError::Session(_)) => {
            session.reconnect(PATIENCE).map_err(|error| error.to_string())?;
            session.status()
        }
        status => status,
    };
    match status.map_err(|error| error.to_string())?.state {
        State::Safe => session.request(Command::Clear).map(drop).map_err(|error| error.to_string()),
        State::Idle | State::Loaded | State::Finished => Ok(()),
        State::Armed | State::Running => Err("the MCU is busy: another program uses it".to_owned()),
    }
}
