//! Deploys a schedule: upload, check, arm, start, watch, and report whatever happens.

mod steering;

use crate::calibrate::chip_id;
use crate::event_log::{EventLog, Record};
use crate::inbox::Notice;
use crate::program::{self, ProgramError};
use crate::report::{Outcome, RunReport, complete};
use crate::session::{RequestError, Session, SessionError};
use crate::{MotionState, Transport};
use std::collections::BTreeSet;
pub use steering::{Moment, Wish};
use zygote_deployment::{CalibratedAt, Fitting, Rig, RigError, Schedule};
use zygote_protocol::{
    CentiCelsius, Command, Event, EventKind, Fault, FaultCode, Limits, Micros, Milliamps, Millis, Millivolts,
    Reply, RigId, State, Step, Telemetry, program_crc,
};

/// An MCU that was lost is waited for so long: a reset takes less.
const RECONNECT_PATIENCE: Millis = Millis(3_000);
/// The user's wish to stop is looked at so often.
const WATCH: Millis = Millis(50);
/// An arming is followed by its start at once; this is for a slow line.
const ARM_LIFETIME: Millis = Millis(10_000);

/// Why a run didn't even start. Nothing was energised.
#[derive(Debug, thiserror::Error)]
pub enum DeployError {
    /// The schedule doesn't fit the MCU.
    #[error(transparent)]
    Program(#[from] ProgramError),
    /// The rig doesn't fit the schedule.
    #[error(transparent)]
    Rig(#[from] RigError),
    /// The schedule goes by what was measured at another board.
    #[error(
        "the schedule goes by a calibration at board {expected}, this is board {found}: connect that board, or calibrate this one \
         and make the schedule anew"
    )]
    OtherBoard {
        /// Where the hinges were measured.
        expected: CalibratedAt,
        /// What answers.
        found: CalibratedAt,
    },
    /// The rig's name is longer than the wire allows.
    #[error("rig id {id:?}: expected at most 32 bytes, found {}", .id.len())]
    RigId {
        /// The name.
        id: String,
    },
    /// The MCU is in its safe state.
    #[error("the MCU is in its safe state ({}): look at the rig, then deploy with --clear", reason(.fault.as_ref()))]
    Safe {
        /// Why.
        fault: Option<Fault>,
    },
    /// The MCU is armed or running.
    #[error("the MCU is busy ({state:?}): another program uses it")]
    Busy {
        /// What it is doing.
        state: State,
    },
    /// The event log can't be begun; once a run is under way, it isn't stopped for that.
    #[error("the event log can't be written: {message}")]
    Log {
        /// What the system says.
        message: String,
    },
    /// So for whoever is told the same.
    #[error("the run can't be recorded: {message}")]
    Recording {
        /// What the observer says.
        message: String,
    },
    /// A command was refused, or the session ended.
    #[error(transparent)]
    Request(#[from] RequestError),
}

impl From<SessionError> for DeployError {
    fn from(error: SessionError) -> Self {
        Self::Request(error.into())
    }
}

fn reason(fault: Option<&Fault>) -> String {
    fault.map_or_else(|| "no fault known".to_owned(), |fault| fault.code.to_string())
}

/// How far a run is, for a display.
#[derive(Debug, Clone, PartialEq)]
pub struct Progress {
    /// Hinges that are open.
    pub opened: usize,
    /// All hinges.
    pub total: usize,
    /// Hinges on their way, those that move before those that cool.
    pub motions: Vec<MotionState>,
    /// MCU time of the look at the rig.
    pub at: Micros,
    /// Supply voltage.
    pub supply: Millivolts,
    /// Measured sum of currents.
    pub current: Milliamps,
}

/// What to deploy, and how.
pub struct Deployment<'a> {
    /// The schedule, verified against its plan and rig.
    pub schedule: &'a Schedule,
    /// Its rig.
    pub rig: &'a Rig,
    /// Number of the run.
    pub run: u32,
    /// Hinges that an earlier run has moved; see [`crate::EarlierRun`].
    pub open: &'a BTreeSet<usize>,
    /// Leave the safe state first: a person has looked at the rig.
    pub clear: bool,
    /// Run it although its hinges were calibrated at another board.
    pub any_board: bool,
    /// Asked often: does the user want to stop?
    pub interrupted: &'a dyn Fn() -> bool,
    /// Asked often as well: what whoever attends the run wants. Without it, it is armed and started at once.
    pub steer: Option<&'a dyn Fn(Moment) -> Wish>,
}

/// Runs a deployment to its end, whatever that is.
///
/// # Errors
/// [`DeployError`], when it didn't start.
pub fn deploy<T: Transport>(
    session: &mut Session<T>,
    deployment: &Deployment<'_>,
    log: &mut EventLog<'_>,
    show: &mut dyn FnMut(&Progress),
) -> Result<RunReport, DeployError> {
    let Deployment { schedule: whole, rig, run, .. } = *deployment;
    let schedule = &whole.rest(deployment.open);
    let info = session.info().clone();
    let (board, firmware) = (info.identity.board.to_string(), info.identity.firmware.to_string());
    let found = CalibratedAt { board: board.clone(), unique_id: chip_id(&info) };
    if let Some(expected) = schedule.calibrated_at.clone().filter(|at| *at != found && !deployment.any_board)
    {
        return Err(DeployError::OtherBoard { expected, found });
    }
    let fittings = rig.fit(whole.steps.len())?;
    let steps = program::program(schedule, &info)?;
    let limits = program::limits(schedule, &steps, rig, &info)?;
    let rig_id = RigId::try_from(rig.id.as_str()).map_err(|_| DeployError::RigId { id: rig.id.clone() })?;
    make_ready(session, deployment.clear)?;
    upload(session, run, &rig_id, &steps)?;
    log.add(
        session.now(),
        &Record::Connected {
            line: session.transport().name(),
            board: board.clone(),
            firmware: firmware.clone(),
            boot: info.identity.boot,
            chip: chip_id(&info),
        },
    );
    log.add(session.now(), &Record::Uploaded { run, steps: steps.len() });
    if let Some(error) = log.error() {
        return Err(DeployError::Log { message: error.to_string() });
    }
    if let Some(message) = log.observer_error() {
        return Err(DeployError::Recording { message });
    }
    let report = RunReport::new(run, schedule, &board, &firmware);
    let (started, ended, finished, quiet) = (None, None, false, false);
    let attended = deployment.steer.is_some();
    let mut watch = Watch { schedule, fittings, report, started, ended, finished, attended, quiet, log };
    let begun = match deployment.steer {
        None => start(session, run, rig_id, limits).map(|()| None),
        Some(steer) => watch.until_started(session, deployment, steer, &(rig_id, limits), show),
    };
    let outcome = match begun {
        Ok(None) => watch.until_the_end(session, deployment, show),
        Ok(Some(early)) => early,
        Err(error) => {
            // Perhaps it is armed; the error is what the user must know, not whether this last word got through.
            session.stop().ok();
            return Err(error.into());
        }
    };
    let mut report = watch.settle(session, outcome);
    let moved: BTreeSet<_> = schedule.steps.iter().map(|step| step.hinge).collect();
    report.precede(RunReport::new(run, &whole.rest(&moved), &board, &firmware));
    Ok(report)
}

pub(crate) fn make_ready<T: Transport>(session: &mut Session<T>, clear: bool) -> Result<(), DeployError> {
    let status = session.status()?;
    match status.state {
        State::Idle | State::Loaded | State::Finished => Ok(()),
        State::Armed | State::Running => Err(DeployError::Busy { state: status.state }),
        State::Safe if clear => Ok(session.request(Command::Clear).map(|_| ())?),
        State::Safe => Err(DeployError::Safe { fault: status.fault }),
    }
}

/// Sends the steps without waiting for each answer, then looks at the answers.
pub(crate) fn upload<T: Transport>(
    session: &mut Session<T>,
    run: u32,
    rig: &RigId,
    steps: &[Step],
) -> Result<(), RequestError> {
    // The program fits the MCU's buffer, which counts its steps in 16 bits.
    let count = u16::try_from(steps.len()).unwrap_or(u16::MAX);
    session.request(Command::Upload { run, rig: rig.clone(), steps: count, crc: program_crc(steps) })?;
    let mut pending = Vec::new();
    for (first, chunk) in (0..)
        .step_by(zygote_protocol::STEPS_PER_COMMAND)
        .zip(steps.chunks(zygote_protocol::STEPS_PER_COMMAND))
    {
        let steps = chunk.iter().cloned().collect();
        pending.push(session.submit(Command::Steps { first, steps })?);
    }
    for id in pending {
        session.response(id)?.map_err(|refusal| RequestError::Refused { command: "steps", refusal })?;
    }
    session.request(Command::Commit).map(|_| ())
}

pub(crate) fn start<T: Transport>(
    session: &mut Session<T>,
    run: u32,
    rig: RigId,
    limits: Limits,
) -> Result<(), RequestError> {
    session.request(Command::Arm { rig, limits, lifetime: ARM_LIFETIME })?;
    start_only(session, run)
}

/// Starts what is armed.
fn start_only<T: Transport>(session: &mut Session<T>, run: u32) -> Result<(), RequestError> {
    session.request(Command::Start { run }).map(|_| ())
}

/// A run being watched.
struct Watch<'a, 'o> {
    schedule: &'a Schedule,
    fittings: Vec<Fitting>,
    report: RunReport,
    /// MCU time of the start and of the end.
    started: Option<Micros>,
    ended: Option<Micros>,
    /// The MCU says that every step is done.
    finished: bool,
    /// A person starts it.
    attended: bool,
    /// There were no news the last time.
    quiet: bool,
    log: &'a mut EventLog<'o>,
}

impl Watch<'_, '_> {
    /// Watches until every hinge is at its angle, something fails, or the user wants to stop.
    fn until_the_end<T: Transport>(
        &mut self,
        session: &mut Session<T>,
        deployment: &Deployment<'_>,
        show: &mut dyn FnMut(&Progress),
    ) -> Outcome {
        loop {
            if (deployment.interrupted)() {
                return self.stop(session);
            }
            if let Some(outcome) = deployment.steer.and_then(|steer| self.steered(session, steer)) {
                return outcome;
            }
            if let Some(outcome) = self.listen(session, deployment.patience(), show) {
                return outcome;
            }
            if self.finished {
                return complete(self.report.direction);
            }
        }
    }

    /// Takes the next piece of news, waiting for it a while; gives how the run ended, where it did.
    fn listen<T: Transport>(
        &mut self,
        session: &mut Session<T>,
        patience: Millis,
        show: &mut dyn FnMut(&Progress),
    ) -> Option<Outcome> {
        let notice = match session.notice(session.now().plus(patience)) {
            Ok(notice) => notice,
            Err(error) => return Some(self.lost(session.now(), &error)),
        };
        let now = session.now();
        self.log.follow(session.clock().fit());
        self.quiet = notice.is_none();
        match notice {
            None => None,
            Some(Notice::Event(event)) => {
                self.take_event(now, &event);
                None
            }
            Some(Notice::Fault(fault)) => Some(self.take_fault(now, &fault)),
            Some(Notice::Telemetry(telemetry)) => {
                show(&self.take_telemetry(now, &telemetry));
                None
            }
        }
    }

    fn stop<T: Transport>(&mut self, session: &mut Session<T>) -> Outcome {
        self.log.add(session.now(), &Record::StopRequested);
        match session.stop() {
            Ok(after) => {
                self.log.add(session.now(), &Record::StopConfirmed { after_us: after.0 });
                if self.attended {
                    self.hear_the_rest(session);
                }
                Outcome::Stopped
            }
            Err(error) => self.lost(session.now(), &error),
        }
    }

    fn lost(&mut self, now: Micros, error: &SessionError) -> Outcome {
        let message = error.to_string();
        self.log.add(now, &Record::Lost { message: message.clone() });
        Outcome::Lost(message)
    }

    fn hinge(&self, step: u16) -> usize {
        self.schedule.steps.get(usize::from(step)).map_or(usize::MAX, |step| step.hinge)
    }

    /// Seconds of the run at an MCU time.
    fn seconds(&self, at: Micros) -> Option<f64> {
        self.started.map(|started| seconds(at.since(started)))
    }

    fn take_event(&mut self, now: Micros, event: &Event) {
        let mcu_us = event.at.0;
        let at = self.seconds(event.at);
        let record = match event.kind {
            EventKind::State(state) => {
                match state {
                    State::Running => self.started = Some(event.at),
                    State::Finished | State::Safe => self.ended = Some(event.at),
                    // Disarmed in the middle.
                    State::Loaded if self.started.is_some() => self.ended = Some(event.at),
                    State::Idle | State::Loaded | State::Armed => {}
                }
                Record::State { mcu_us, state: format!("{state:?}").to_lowercase() }
            }
            EventKind::StepStarted { step } => {
                self.book(step, zygote_protocol::StepState::Moving, |hinge| hinge.started_s = at);
                Record::Started { mcu_us, step, hinge: self.hinge(step) }
            }
            EventKind::StepOpened { step } => {
                self.book(step, zygote_protocol::StepState::Opened, |hinge| hinge.opened_s = at);
                Record::Opened { mcu_us, step, hinge: self.hinge(step) }
            }
            EventKind::StepDone { step, peak } => {
                let peak_c = peak.map(celsius);
                self.book(step, zygote_protocol::StepState::Done, |hinge| {
                    hinge.done_s = at;
                    hinge.peak_c = peak_c;
                });
                Record::Done { mcu_us, step, hinge: self.hinge(step), peak_c }
            }
        };
        self.log.add(now, &record);
        self.finished |= event.kind == EventKind::State(State::Finished);
    }

    fn book(
        &mut self,
        step: u16,
        state: zygote_protocol::StepState,
        set: impl FnOnce(&mut crate::report::HingeReport),
    ) {
        let step = usize::from(step);
        self.report.settle(step, state);
        if let Some(hinge) = self.report.hinges.get_mut(step) {
            set(hinge);
        }
    }

    fn take_fault(&mut self, now: Micros, fault: &Fault) -> Outcome {
        let hinge = fault.step.map(|step| self.hinge(step));
        self.ended = Some(fault.at);
        let Fault { value, limit, .. } = *fault;
        let code = fault.code.to_string();
        self.log.add(now, &Record::Fault { mcu_us: fault.at.0, fault: code.clone(), value, limit, hinge });
        if fault.code == FaultCode::Stopped {
            return Outcome::Stopped;
        }
        let place = hinge.map_or_else(String::new, |hinge| format!(" at hinge {hinge}"));
        Outcome::Fault(format!("{code}{place}: measured {value}, limit {limit}"))
    }

    fn take_telemetry(&mut self, now: Micros, telemetry: &Telemetry) -> Progress {
        let motions: Vec<_> = telemetry
            .motions
            .iter()
            .filter_map(|motion| {
                let step = self.schedule.steps.get(usize::from(motion.step))?;
                Some(MotionState::new(*motion, step, &self.fittings.get(step.hinge)?.drive))
            })
            .collect();
        let temperatures =
            motions.iter().filter_map(|motion| Some((motion.hinge, motion.temperature_c?))).collect();
        let progress = Progress {
            opened: usize::from(telemetry.opened),
            total: self.schedule.steps.len(),
            motions: motions.clone(),
            at: telemetry.at,
            supply: telemetry.supply,
            current: telemetry.current,
        };
        if self.attended && self.started.is_none() {
            // A person may take long to arm and start it; nothing of that is the run's.
            return progress;
        }
        self.log.add(
            now,
            &Record::Telemetry {
                mcu_us: telemetry.at.0,
                supply_mv: telemetry.supply.0,
                current_ma: telemetry.current.0,
                opened: telemetry.opened,
                temperatures,
                motions,
            },
        );
        progress
    }

    /// Asks the MCU for the last word on every step, and closes the report.
    fn settle<T: Transport>(mut self, session: &mut Session<T>, outcome: Outcome) -> RunReport {
        let outcome = match outcome {
            Outcome::Lost(why) => Outcome::Lost(self.after_loss(session, why)),
            ended => match self.ask_states(session) {
                Ok(()) => ended,
                Err(error) => match ended {
                    Outcome::Fault(why) => {
                        Outcome::Fault(format!("{why}; how far each hinge is it didn't say: {error}"))
                    }
                    _ => Outcome::Lost(error.to_string()),
                },
            },
        };
        if let (Some(started), Some(ended)) = (self.started, self.ended) {
            self.report.duration_s = seconds(ended.since(started));
        }
        self.report.finish(outcome, session.link_counters(), session.clock().fit());
        self.report
    }

    /// Asks an MCU that was lost once more, and gives what is known of it then; what can't be learned stays as it was seen last.
    fn after_loss<T: Transport>(&mut self, session: &mut Session<T>, why: String) -> String {
        if session.reconnect(RECONNECT_PATIENCE).is_err() {
            return why;
        }
        let run = self.report.run;
        let identity = session.info().identity.clone();
        self.log.add(
            session.now(),
            &Record::Connected {
                line: session.transport().name(),
                board: identity.board.to_string(),
                firmware: identity.firmware.to_string(),
                boot: identity.boot,
                chip: chip_id(session.info()),
            },
        );
        match session.status() {
            Ok(status) if status.run == Some(run) => {
                let fault = status.fault.map_or_else(String::new, |fault| format!(": {}", fault.code));
                match self.ask_states(session) {
                    Ok(()) => format!("{why}; it is there again, {:?}{fault}", status.state),
                    Err(_) => why,
                }
            }
            Ok(_) => match session.last_run() {
                Ok(Some(before)) if before.run == Some(run) => {
                    for step in 0..before.steps {
                        self.report.settle(usize::from(step), before.step(step));
                    }
                    format!("{why}; it was reset ({:?}) and kept what it knew of the run", identity.reset)
                }
                _ => format!("{why}; it was reset ({:?})", identity.reset),
            },
            Err(_) => why,
        }
    }

    fn ask_states<T: Transport>(&mut self, session: &mut Session<T>) -> Result<(), RequestError> {
        let total = self.report.hinges.len();
        let mut next = 0;
        while next < total {
            let first = u16::try_from(next).unwrap_or(u16::MAX);
            let Reply::Progress { steps, .. } = session.request(Command::Progress { first })? else {
                return Err(RequestError::WrongReply { command: "progress" });
            };
            if steps.is_empty() {
                return Err(RequestError::WrongReply { command: "progress" });
            }
            for state in steps {
                self.report.settle(next, state);
                next += 1;
            }
        }
        // The state's event may still be under way behind the fault that caused it.
        let until = session.now().plus(WATCH);
        while let Some(notice) = session.notice(until)? {
            if let Notice::Event(event) = notice {
                self.take_event(session.now(), &event);
            }
        }
        Ok(())
    }
}

#[expect(clippy::cast_precision_loss, reason = "a run is far shorter than 2^52 us")]
fn seconds(us: u64) -> f64 {
    us as f64 / 1e6
}

fn celsius(temperature: CentiCelsius) -> f64 {
    f64::from(temperature.0) / 100.0
}
