//! From what a scenario file says to the causes of a trial: hinges become channels, names become states.

use super::error::ScenarioError;
use super::file::{
    CauseTable, ImpairmentTable, LineTable, ResetName, StateName, StepName, WayName, WhatTable, WhenTable,
};
use crate::cause::{Cause, Way, What, When};
use zygote_deployment::{Kind, Schedule, Seconds, Step};
use zygote_protocol::{Micros, Millis, ResetCause, State, StepState};
use zygote_sim::plant::{Fault, Hinge};
use zygote_sim::{Impairment, Stuck};

/// A table of the file with its place.
#[derive(Debug, Clone, Copy)]
pub(super) struct At<'a> {
    pub(super) file: &'a str,
    pub(super) line: usize,
}

impl At<'_> {
    pub(super) fn refuse(
        &self,
        what: &'static str,
        expected: impl Into<String>,
        found: impl Into<String>,
    ) -> ScenarioError {
        let (expected, found) = (expected.into(), found.into());
        ScenarioError::Value { file: self.file.to_owned(), line: self.line, what, expected, found }
    }
}

/// A cause, for the hinges of a schedule.
pub(super) fn cause(at: At<'_>, table: &CauseTable, schedule: &Schedule) -> Result<Cause, ScenarioError> {
    let hinges = Hinges { at, schedule };
    Ok(Cause {
        when: hinges.when(&table.when)?,
        after: millis(at, "after", table.after)?,
        what: hinges.what(&table.what)?,
    })
}

/// What is wrong with the line from the start on.
pub(super) fn line(at: At<'_>, table: &LineTable) -> Result<Vec<(Way, Impairment)>, ScenarioError> {
    let mut line = Vec::new();
    for (way, impairment) in [(Way::ToBoard, table.to_board), (Way::ToHost, table.to_host)] {
        if let Some(impairment) = impairment {
            line.push((way, self::impairment(at, &impairment)?));
        }
    }
    Ok(line)
}

/// A time, in whole milliseconds.
pub(super) fn millis(at: At<'_>, what: &'static str, time: Seconds) -> Result<Millis, ScenarioError> {
    let ms = (time.0 * 1e3).round();
    if !(0.0..=3.6e6).contains(&ms) {
        return Err(at.refuse(what, "0 s to 1 h", time.to_string()));
    }
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to 3,600,000")]
    let ms = ms as u32;
    Ok(Millis(ms))
}

fn impairment(at: At<'_>, table: &ImpairmentTable) -> Result<Impairment, ScenarioError> {
    let ImpairmentTable { delay, loss, flip, duplicate, reorder } = *table;
    for (what, probability) in
        [("loss", loss), ("flip", flip), ("duplicate", duplicate), ("reorder", reorder)]
    {
        if !(0.0..=1.0).contains(&probability) {
            return Err(at.refuse(what, "a probability, 0 to 1", probability.to_string()));
        }
    }
    Ok(Impairment { delay: millis(at, "delay", delay)?, loss, flip, duplicate, reorder })
}

struct Hinges<'a> {
    at: At<'a>,
    schedule: &'a Schedule,
}

impl Hinges<'_> {
    fn when(&self, table: &WhenTable) -> Result<When, ScenarioError> {
        let WhenTable { at, mcu, step, hinge, is, above } = table;
        match (at, mcu, step, hinge, is, above) {
            (None, None, None, None, None, None) => Ok(When::At(Micros(0))),
            (Some(time), None, None, None, None, None) => {
                Ok(When::At(Micros(millis(self.at, "when.at", *time)?.to_micros())))
            }
            (None, Some(state), None, None, None, None) => Ok(When::State(self::state(*state))),
            (None, None, Some(step), None, Some(state), None) => {
                self.schedule.steps.get(*step).ok_or_else(|| {
                    let last = self.schedule.steps.len().saturating_sub(1);
                    self.at.refuse(
                        "when.step",
                        format!("a step of the schedule, 0 to {last}"),
                        step.to_string(),
                    )
                })?;
                Ok(When::Step { step: *step, state: step_state(*state) })
            }
            (None, None, None, Some(hinge), Some(state), None) => {
                Ok(When::Step { step: self.step(*hinge)?.0, state: step_state(*state) })
            }
            (None, None, None, Some(hinge), None, Some(celsius)) => {
                Ok(When::Above { channel: self.channel(*hinge, Kind::Sma)?, celsius: celsius.0 })
            }
            _ => Err(self.at.refuse(
                "when",
                "one of `at`, `mcu`, `step` with `is`, `hinge` with `is`, `hinge` with `above`",
                format!("{table:?}"),
            )),
        }
    }

    fn what(&self, table: &WhatTable) -> Result<What, ScenarioError> {
        let sma = |hinge: usize| self.channel(hinge, Kind::Sma);
        Ok(match table {
            WhatTable::ThermistorOpen { hinge } => What::Break(Fault::ThermistorOpen(sma(*hinge)?)),
            WhatTable::ThermistorShorted { hinge } => What::Break(Fault::ThermistorShorted(sma(*hinge)?)),
            WhatTable::ThermistorFrozen { hinge } => What::Break(Fault::ThermistorFrozen(sma(*hinge)?)),
            WhatTable::ThermistorLoose { hinge } => What::Break(Fault::ThermistorLoose(sma(*hinge)?)),
            WhatTable::ThermistorDrifting { hinge, kelvin_per_second } => {
                let (channel, kelvin_per_s) = (sma(*hinge)?, *kelvin_per_second);
                What::Break(Fault::ThermistorDrifting { channel, kelvin_per_s })
            }
            WhatTable::HeaterOpen { hinge } => What::Break(Fault::HeaterOpen(sma(*hinge)?)),
            WhatTable::HeaterShorted { hinge, left } => {
                What::Break(Fault::HeaterShorted { channel: sma(*hinge)?, ohm: left.0 })
            }
            WhatTable::MosfetStuckOn { hinge } => What::Break(Fault::MosfetStuckOn(sma(*hinge)?)),
            WhatTable::Jammed { hinge } => What::Break(Fault::Jammed(self.hinge(*hinge)?)),
            WhatTable::ServoStalled { hinge } => {
                What::Break(Fault::ServoStalled(self.channel(*hinge, Kind::Servo)?))
            }
            WhatTable::SupplyCut => What::Break(Fault::SupplyCut),
            WhatTable::SupplySag { voltage, resistance } => {
                What::Break(Fault::SupplySag { open_circuit_v: voltage.0, source_ohm: resistance.0 })
            }
            WhatTable::SupplyRestored => What::Break(Fault::SupplyRestored),
            WhatTable::TasksStuck => What::Hang(Stuck::Tasks),
            WhatTable::McuStuck => What::Hang(Stuck::Everything),
            WhatTable::Reset { cause } => What::Reset(reset(*cause)),
            WhatTable::StopPressed => What::StopButton(true),
            WhatTable::StopReleased => What::StopButton(false),
            WhatTable::StopFrame => What::StopFrame,
            WhatTable::LineCut { way, span } => {
                let span = span.map(|span| millis(self.at, "span", span)).transpose()?;
                What::Cut(self::way(*way), span)
            }
            WhatTable::LineBad { way, line } => What::Impair(self::way(*way), impairment(self.at, line)?),
            WhatTable::LineGood => What::Impair(Way::Both, Impairment::NONE),
            WhatTable::HostKilled => What::KillHost,
            WhatTable::UserStops => What::UserStops,
            WhatTable::SecondHost => What::SecondHost,
            WhatTable::FramesReplayed => What::Replay,
            WhatTable::Noise { bytes } => What::Garbage(*bytes),
        })
    }

    fn step(&self, hinge: usize) -> Result<(usize, &Step), ScenarioError> {
        let steps = self.schedule.steps.iter().enumerate();
        steps.into_iter().find(|(_, step)| step.hinge == hinge).ok_or_else(|| {
            let last = self.schedule.steps.len().saturating_sub(1);
            self.at.refuse("hinge", format!("a hinge of the plan, 0 to {last}"), hinge.to_string())
        })
    }

    fn channel(&self, hinge: usize, kind: Kind) -> Result<usize, ScenarioError> {
        let (_, step) = self.step(hinge)?;
        let found = step.motion.kind();
        if found == kind {
            Ok(usize::from(step.channel))
        } else {
            let found = format!("{hinge}, which is {}", found.name());
            Err(self.at.refuse("hinge", format!("a hinge of kind {}", kind.name()), found))
        }
    }

    fn hinge(&self, hinge: usize) -> Result<Hinge, ScenarioError> {
        let (_, step) = self.step(hinge)?;
        let channel = usize::from(step.channel);
        Ok(match step.motion.kind() {
            Kind::Sma => Hinge::Sma(channel),
            Kind::Servo => Hinge::Servo(channel),
            Kind::Spring => Hinge::Spring(channel),
        })
    }
}

fn state(name: StateName) -> State {
    match name {
        StateName::Idle => State::Idle,
        StateName::Loaded => State::Loaded,
        StateName::Armed => State::Armed,
        StateName::Running => State::Running,
        StateName::Finished => State::Finished,
        StateName::Safe => State::Safe,
    }
}

fn step_state(name: StepName) -> StepState {
    match name {
        StepName::Waiting => StepState::Waiting,
        StepName::Moving => StepState::Moving,
        StepName::Opened => StepState::Opened,
        StepName::Done => StepState::Done,
        StepName::Interrupted => StepState::Interrupted,
    }
}

fn reset(name: ResetName) -> ResetCause {
    match name {
        ResetName::Power => ResetCause::Power,
        ResetName::Pin => ResetCause::Pin,
        ResetName::Watchdog => ResetCause::Watchdog,
        ResetName::Software => ResetCause::Software,
    }
}

fn way(name: Option<WayName>) -> Way {
    match name {
        Some(WayName::ToBoard) => Way::ToBoard,
        Some(WayName::ToHost) => Way::ToHost,
        Some(WayName::Both) | None => Way::Both,
    }
}
