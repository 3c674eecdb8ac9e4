//! A run that a person attends: armed, started, paused and stopped when they say so, while the MCU goes on by itself.
//!
//! ```text
//!            GoOn: Arm             GoOn: Start
//!   Loaded ------------->  Armed  -------------> Running --Pause, once no servo is on its way: Disarm--> Paused
//!     ^                      |
//!     +---Pause, or nobody --+                        Stop, from each of them: everything off, Safe
//!         starts it: Disarm
//! ```
//!
//! An MCU knows no pause: it goes through its program, or it is disarmed, which turns everything off. What was heated then is heated
//! anew by the run that goes on from there. A servo that was on its way may stand anywhere, so a pause waits until none is.

use super::{Deployment, Progress, WATCH, Watch, start_only};
use crate::Transport;
use crate::event_log::Record;
use crate::inbox::Notice;
use crate::report::{HingeOutcome, Outcome};
use crate::session::{RequestError, Session};
use zygote_deployment::Kind;
use zygote_protocol::{Command, Limits, Millis, RigId};

/// How long an arming waits for the person who starts the run; the MCU turns one that is older into a fault.
const ARM_LIFETIME: Millis = Millis(60_000);
/// This much earlier it is taken back, which is no fault.
const BEFORE_IT_EXPIRES: u64 = 5_000_000;
/// Somebody may want to stop at any moment.
const WATCH_ATTENDED: Millis = Millis(10);

/// Where an attended run is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Moment {
    /// Its program is stored and checked; nothing is energised.
    Loaded,
    /// Armed: the main switch is closed.
    Armed,
    /// It goes on by itself.
    Running,
}

/// What whoever attends a run wants now.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Wish {
    /// To leave things as they are.
    Wait,
    /// To arm what is loaded, and start what is armed.
    GoOn,
    /// To give up what is loaded, disarm what is armed, and pause what runs; asked again until it is done.
    Pause,
    /// To turn everything off, now.
    Stop,
}

impl Deployment<'_> {
    /// How long news are waited for before anybody's wish is asked again.
    pub(super) fn patience(&self) -> Millis {
        if self.steer.is_some() { WATCH_ATTENDED } else { WATCH }
    }
}

impl Watch<'_, '_> {
    /// Waits until the run is armed and started; gives how it ended where it did before.
    pub(super) fn until_started<T: Transport>(
        &mut self,
        session: &mut Session<T>,
        deployment: &Deployment<'_>,
        steer: &dyn Fn(Moment) -> Wish,
        (rig, limits): &(RigId, Limits),
        show: &mut dyn FnMut(&Progress),
    ) -> Result<Option<Outcome>, RequestError> {
        let mut armed_until = None;
        loop {
            let moment = if armed_until.is_some() { Moment::Armed } else { Moment::Loaded };
            let wish = if (deployment.interrupted)() { Wish::Stop } else { steer(moment) };
            let expires = armed_until.is_some_and(|until| session.now() >= until);
            match (moment, wish) {
                (_, Wish::Stop) => return Ok(Some(self.stop(session))),
                (Moment::Loaded, Wish::GoOn) => {
                    let (rig, limits) = (rig.clone(), *limits);
                    session.request(Command::Arm { rig, limits, lifetime: ARM_LIFETIME })?;
                    let until = session.now().plus(ARM_LIFETIME).0.saturating_sub(BEFORE_IT_EXPIRES);
                    armed_until = Some(zygote_protocol::Micros(until));
                }
                (Moment::Loaded, Wish::Pause) => return Ok(Some(Outcome::Paused)),
                (Moment::Armed, Wish::GoOn) => return start_only(session, deployment.run).map(|()| None),
                (Moment::Armed, wish) if wish == Wish::Pause || expires => {
                    session.request(Command::Disarm)?;
                    armed_until = None;
                }
                (Moment::Loaded | Moment::Armed | Moment::Running, Wish::Wait | Wish::GoOn | Wish::Pause) => {
                }
            }
            if let Some(outcome) = self.listen(session, WATCH_ATTENDED, show) {
                return Ok(Some(outcome));
            }
        }
    }

    /// Does what is wanted of a run that goes on; gives how that ended it.
    pub(super) fn steered<T: Transport>(
        &mut self,
        session: &mut Session<T>,
        steer: &dyn Fn(Moment) -> Wish,
    ) -> Option<Outcome> {
        match steer(Moment::Running) {
            Wish::Stop => Some(self.stop(session)),
            // A servo that opens is followed by the next one at once: its news have to be in.
            Wish::Pause if self.quiet && !self.a_servo_is_under_way() && !self.all_are_open() => {
                self.pause(session)
            }
            Wish::Wait | Wish::GoOn | Wish::Pause => None,
        }
    }

    /// What came along with a stop's confirmation: that the MCU is in its safe state. Somebody waits for it.
    pub(super) fn hear_the_rest<T: Transport>(&mut self, session: &mut Session<T>) {
        // A session that breaks now is asked for its states once more, and tells it then.
        while let Ok(Some(notice)) = session.notice(session.now()) {
            if let Notice::Event(event) = notice {
                self.take_event(session.now(), &event);
            }
        }
    }

    /// What is left is to cool: that is no motion to pause.
    fn all_are_open(&self) -> bool {
        self.report.count(HingeOutcome::Opened) == self.report.hinges.len()
    }

    fn a_servo_is_under_way(&self) -> bool {
        let is_under_way = |hinge: &crate::HingeReport| hinge.outcome == HingeOutcome::Interrupted;
        self.report.hinges.iter().any(|hinge| hinge.kind == Kind::Servo && is_under_way(hinge))
    }

    fn pause<T: Transport>(&mut self, session: &mut Session<T>) -> Option<Outcome> {
        match session.request(Command::Disarm) {
            Ok(_) => {
                self.log.add(session.now(), &Record::Paused);
                Some(Outcome::Paused)
            }
            // It has just ended, well or with a fault: that news is on its way.
            Err(RequestError::Refused { .. } | RequestError::WrongReply { .. }) => None,
            Err(RequestError::Session(error)) => Some(self.lost(session.now(), &error)),
        }
    }
}
