//! Leads one servo to a pulse, slowly, and holds it there: a program of one step, which rests for as long as somebody reads. It is
//! relaxed as soon as it pushes, which its current tells, or the MCU's fault for too much of it.

use super::hinge::ServoHinge;
use super::protractor::{Answer, Protractor, Question};
use super::{Reading, ServoCalibration, ServoError};
use crate::calibrate::limits;
use crate::deploy::{start, upload};
use crate::inbox::Notice;
use crate::session::{RequestError, Session};
use crate::{DeployError, Transport};
use zygote_calibration::servo::Look;
use zygote_protocol::{
    Action, Command, EventKind, FaultCode, Micros, Milliamps, Millis, Phase, RefusalCode, RigId, State, Step,
    Telemetry, Turn,
};

/// What nobody knows is approached at this.
const SPEED_DEG_PER_S: f64 = 30.0;
/// A servo that is led slowly has arrived, and what swings has come to rest, so long after its pulse.
const ARRIVE: Millis = Millis(600);
/// A servo is held for so long at the most, then led to its pulse anew: a person reads a protractor in less.
const HOLD: Millis = Millis(600_000);
/// A servo draws up to so many times its rated current when it starts to move ..
const PUSHES: u32 = 2;
/// .. but not in so many messages of telemetry one after the other, a tenth of a second each.
const PUSHES_FOR: u32 = 4;
/// So many at the beginning of a way may tell of the time before it.
const UNSURE: u32 = 2;
/// The line is looked at so often.
const WATCH: Millis = Millis(50);

/// How a way ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Arrival {
    /// It stands at its pulse.
    Free,
    /// It pushed against something, and is relaxed.
    Pushes {
        /// The pulse by then.
        pulse_us: u16,
    },
}

/// What happened while the line was watched.
enum Seen {
    Nothing,
    Pushes(u16),
    /// It was held for as long as a program lasts.
    Over,
}

/// Leads servos one after the other.
pub(super) struct Approach<'a> {
    calibration: &'a ServoCalibration<'a>,
    run: u32,
    /// The hinge that was led last, and its pulse.
    stands: Option<(usize, u16)>,
    /// The least current seen while a servo was led or held: of what is always on.
    least: Option<Milliamps>,
    /// Messages of telemetry since this way began.
    heard: u32,
    /// Of them the last, in which the current was high.
    high: u32,
}

impl<'a> Approach<'a> {
    pub(super) fn new(calibration: &'a ServoCalibration<'a>) -> Self {
        Self { calibration, run: calibration.run, stands: None, least: None, heard: 0, high: 0 }
    }

    /// The pulse that a hinge was led to last.
    pub(super) fn stands_at(&self, hinge: usize) -> Option<u16> {
        self.stands.filter(|(last, _)| *last == hinge).map(|(_, pulse_us)| pulse_us)
    }

    /// Leads it, and waits until it is there.
    pub(super) fn lead<T: Transport>(
        &mut self,
        session: &mut Session<T>,
        hinge: &ServoHinge,
        (from_us, to_us): (u16, u16),
    ) -> Result<Arrival, ServoError> {
        let way_deg = f64::from(from_us.abs_diff(to_us)) * hinge.nominal.deg_per_us();
        let speed = SPEED_DEG_PER_S.min(hinge.settings.speed.0);
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "some seconds")]
        let duration = Millis((way_deg / speed * 1e3).ceil() as u32);
        let amps = |amps: f64| {
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "it saturates")]
            let milliamps = (amps * 1e3).ceil() as u32;
            Milliamps(milliamps)
        };
        let turn = Turn {
            channel: hinge.channel,
            from_us,
            to_us,
            duration,
            settle: HOLD,
            current: amps(hinge.settings.current.0),
            hold_current: amps(hinge.settings.hold_current.0),
        };
        // A rig has fewer hinges than the wire has numbers.
        let number = u16::try_from(hinge.number).unwrap_or(u16::MAX);
        let step = Step { hinge: number, after: heapless::Vec::new(), action: Action::Turn(turn) };
        let rig = self.calibration.rig;
        let id = RigId::try_from(rig.id.as_str()).map_err(|_| DeployError::RigId { id: rig.id.clone() })?;
        self.run = self.run.wrapping_add(1);
        (self.heard, self.high, self.stands) = (0, 0, None);
        upload(session, self.run, &id, &[step])?;
        start(session, self.run, id, limits(rig, session.info().ceiling))?;
        let there = session.now().plus(duration).plus(ARRIVE);
        while session.now() < there {
            if let Seen::Pushes(pulse_us) = self.watch(session, hinge, to_us, there)? {
                return Ok(Arrival::Pushes { pulse_us });
            }
        }
        Ok(Arrival::Free)
    }

    /// Leads it, has its angle read, and relaxes it.
    pub(super) fn read<T: Transport>(
        &mut self,
        session: &mut Session<T>,
        hinge: &ServoHinge,
        way: (u16, u16),
        question: Question,
        protractor: &mut dyn Protractor<T>,
    ) -> Result<Reading, ServoError> {
        let pulse_us = way.1;
        if let Arrival::Pushes { pulse_us } = self.lead(session, hinge, way)? {
            return self.read_relaxed(session, hinge, pulse_us, question, protractor);
        }
        let unread = |source| ServoError::Reading { hinge: hinge.number, source };
        protractor.ask(&question).map_err(unread)?;
        loop {
            match protractor.answer(session.transport()).map_err(unread)? {
                None => {}
                Some(Answer::Angle(angle_deg)) => {
                    self.relax(session, hinge.number, pulse_us)?;
                    return Ok(Reading::At(Look { pulse_us, angle_deg, pushes: false }));
                }
                Some(Answer::Nudge(by_us)) => {
                    let bounds = hinge.bounds;
                    let to_us = pulse_us.saturating_add_signed(by_us);
                    if (bounds.shortest_us..=bounds.longest_us).contains(&to_us) {
                        self.relax(session, hinge.number, pulse_us)?;
                        return Ok(Reading::Nudged(to_us));
                    }
                    let why = format!(
                        "expected pulses of {} to {} us, found {to_us} us",
                        bounds.shortest_us, bounds.longest_us
                    );
                    protractor.ask(&Question { again: Some(why), ..question.clone() }).map_err(unread)?;
                }
                Some(Answer::End) => {
                    disarm(session)?;
                    return self.read_relaxed(session, hinge, pulse_us, question, protractor);
                }
                Some(Answer::Stop) => return Err(ServoError::Interrupted),
            }
            let soon = session.now().plus(WATCH);
            match self.watch(session, hinge, pulse_us, soon)? {
                Seen::Nothing => {}
                Seen::Pushes(pulse_us) => {
                    return self.read_relaxed(session, hinge, pulse_us, question, protractor);
                }
                Seen::Over => {
                    if let Arrival::Pushes { pulse_us } = self.lead(session, hinge, (pulse_us, pulse_us))? {
                        return self.read_relaxed(session, hinge, pulse_us, question, protractor);
                    }
                }
            }
        }
    }

    /// Asks for the angle of a servo that pushed, and now is limp.
    fn read_relaxed<T: Transport>(
        &mut self,
        session: &mut Session<T>,
        hinge: &ServoHinge,
        pulse_us: u16,
        question: Question,
        protractor: &mut dyn Protractor<T>,
    ) -> Result<Reading, ServoError> {
        let unread = |source| ServoError::Reading { hinge: hinge.number, source };
        let question = Question { pulse_us, relaxed: true, ..question };
        protractor.ask(&question).map_err(unread)?;
        loop {
            match protractor.answer(session.transport()).map_err(unread)? {
                Some(Answer::Angle(angle_deg)) => {
                    return Ok(Reading::At(Look { pulse_us, angle_deg, pushes: true }));
                }
                Some(Answer::Stop) => return Err(ServoError::Interrupted),
                Some(Answer::Nudge(_) | Answer::End) => {
                    let why = Some("it is relaxed: expected an angle, or stop".to_owned());
                    protractor.ask(&Question { again: why, ..question.clone() }).map_err(unread)?;
                }
                None => {}
            }
            let soon = session.now().plus(WATCH);
            self.watch(session, hinge, pulse_us, soon)?;
        }
    }

    /// Lets it go limp where it stands.
    pub(super) fn relax<T: Transport>(
        &mut self,
        session: &mut Session<T>,
        hinge: usize,
        pulse_us: u16,
    ) -> Result<(), ServoError> {
        disarm(session)?;
        self.stands = Some((hinge, pulse_us));
        Ok(())
    }

    /// Takes the news until `until`, or until something happens. What pushes is relaxed.
    fn watch<T: Transport>(
        &mut self,
        session: &mut Session<T>,
        hinge: &ServoHinge,
        pulse_us: u16,
        until: Micros,
    ) -> Result<Seen, ServoError> {
        let until = until.min(session.now().plus(WATCH));
        loop {
            if (self.calibration.interrupted)() {
                return Err(ServoError::Interrupted);
            }
            let notice = session.notice(until).map_err(RequestError::from)?;
            match notice {
                None => return Ok(Seen::Nothing),
                Some(Notice::Fault(fault)) if fault.code == FaultCode::OverCurrent => {
                    session.request(Command::Clear)?;
                    return Ok(Seen::Pushes(pulse_us));
                }
                Some(Notice::Fault(fault)) => return Err(ServoError::Fault { fault, hinge: hinge.number }),
                Some(Notice::Event(event)) => {
                    if event.kind == EventKind::State(State::Finished) {
                        return Ok(Seen::Over);
                    }
                }
                Some(Notice::Telemetry(telemetry)) => {
                    if let Some(pulse_us) = self.pushes(hinge, pulse_us, &telemetry) {
                        disarm(session)?;
                        return Ok(Seen::Pushes(pulse_us));
                    }
                }
            }
        }
    }

    /// The pulse at which it pushes, once that is sure.
    fn pushes(&mut self, hinge: &ServoHinge, pulse_us: u16, telemetry: &Telemetry) -> Option<u16> {
        self.heard += 1;
        // The current is that of a moment before: of nothing yet, at first.
        if telemetry.state != State::Running || self.heard <= UNSURE {
            return None;
        }
        let least = self.least.map_or(telemetry.current, |least| least.min(telemetry.current));
        self.least = Some(least);
        let above_a = f64::from(telemetry.current.0.saturating_sub(least.0)) / 1e3;
        let is_high = above_a > f64::from(PUSHES) * hinge.settings.current.0;
        self.high = if is_high { self.high + 1 } else { 0 };
        let by_then = telemetry.motions.iter().find_map(|motion| match motion.phase {
            Phase::Turning { pulse_us } => Some(pulse_us),
            Phase::Heating { .. } | Phase::Holding { .. } | Phase::Cooling { .. } | Phase::Releasing => None,
        });
        (self.high >= PUSHES_FOR).then(|| by_then.unwrap_or(pulse_us))
    }
}

/// Everything off.
fn disarm<T: Transport>(session: &mut Session<T>) -> Result<(), ServoError> {
    match session.request(Command::Disarm) {
        Ok(_) => Ok(()),
        // The program has just ended by itself.
        Err(RequestError::Refused { refusal, .. }) if refusal.code == RefusalCode::WrongState => Ok(()),
        Err(error) => Err(error.into()),
    }
}
