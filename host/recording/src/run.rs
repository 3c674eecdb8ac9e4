//! A recorded run made sense of: when what happened by the run's own clock, how it ended, and what became of each hinge.

use crate::reader::Recording;
use std::collections::BTreeMap;
use zygote_controller::{HingeOutcome, HingeReport, Outcome, Record};
use zygote_deployment::{Schedule, Step};
use zygote_protocol::{Explanation, FaultCode};

/// A fault with what it means.
pub(crate) struct Told {
    pub(crate) code: String,
    pub(crate) text: Explanation,
    pub(crate) sentence: String,
    pub(crate) seconds: Option<f64>,
}

/// A run in retrospect.
pub(crate) struct Run<'a> {
    pub(crate) recording: &'a Recording,
    /// What of the schedule this run had to do.
    pub(crate) schedule: Schedule,
    /// MCU time of the start.
    started_us: Option<u64>,
    pub(crate) hinges: BTreeMap<usize, HingeReport>,
}

#[expect(clippy::cast_precision_loss, reason = "a run is far shorter than 2^52 us")]
fn seconds_between(from_us: u64, to_us: u64) -> f64 {
    (to_us as f64 - from_us as f64) / 1e6
}

impl<'a> Run<'a> {
    pub(crate) fn new(recording: &'a Recording) -> Self {
        let schedule = recording.schedule.rest(&recording.open);
        let started_us = recording.events.iter().find_map(|event| match &event.record {
            Record::State { mcu_us, state } if state == "running" => Some(*mcu_us),
            _ => None,
        });
        let mut run = Self { recording, schedule, started_us, hinges: BTreeMap::new() };
        run.hinges = match &recording.report {
            Some(report) => report.hinges.iter().map(|hinge| (hinge.hinge, hinge.clone())).collect(),
            None => run.told_by_events(),
        };
        run
    }

    /// Seconds of the run at an MCU time.
    pub(crate) fn seconds(&self, mcu_us: u64) -> Option<f64> {
        self.started_us.map(|started| seconds_between(started, mcu_us))
    }

    /// Seconds of the run at which a record happened; of what the host did, none.
    pub(crate) fn seconds_of(&self, record: &Record) -> Option<f64> {
        self.seconds(record.mcu_us()?.0)
    }

    /// What became of each hinge as far as the events go: the report was never written.
    fn told_by_events(&self) -> BTreeMap<usize, HingeReport> {
        let whole = &self.recording.schedule;
        let open = |step: &Step| self.recording.open.contains(&step.hinge);
        let mut hinges: BTreeMap<_, _> = whole
            .steps
            .iter()
            .map(|step| {
                let outcome = if open(step) { HingeOutcome::Opened } else { HingeOutcome::NotMoved };
                let (hinge, kind, channel) = (step.hinge, step.motion.kind(), step.channel);
                let (started_s, opened_s, done_s, peak_c) = (None, None, None, None);
                (hinge, HingeReport { hinge, kind, channel, outcome, started_s, opened_s, done_s, peak_c })
            })
            .collect();
        for event in &self.recording.events {
            let at = self.seconds_of(&event.record);
            match &event.record {
                Record::Started { hinge, .. } => {
                    if let Some(hinge) = hinges.get_mut(hinge) {
                        hinge.started_s = at;
                        hinge.outcome = HingeOutcome::Interrupted;
                    }
                }
                Record::Opened { hinge, .. } => {
                    if let Some(hinge) = hinges.get_mut(hinge) {
                        hinge.opened_s = at;
                        hinge.outcome = HingeOutcome::Opened;
                    }
                }
                Record::Done { hinge, peak_c, .. } => {
                    if let Some(hinge) = hinges.get_mut(hinge) {
                        hinge.done_s = at;
                        hinge.peak_c = *peak_c;
                        hinge.outcome = HingeOutcome::Opened;
                    }
                }
                _ => {}
            }
        }
        hinges
    }

    /// How it ended, as far as is known.
    pub(crate) fn outcome(&self) -> Ended {
        match &self.recording.report {
            Some(report) => match &report.outcome {
                Outcome::Deployed => Ended::Well("deployed".to_owned()),
                Outcome::Folded => Ended::Well("folded".to_owned()),
                Outcome::Stopped => Ended::Early("stopped by the user".to_owned()),
                Outcome::Fault(why) => Ended::Badly(why.clone()),
                Outcome::Paused => Ended::Early("paused by the user".to_owned()),
                Outcome::Lost(why) => Ended::Badly(format!("lost: {why}")),
            },
            None => match self.faults().into_iter().next() {
                Some(fault) => Ended::Badly(fault.sentence),
                None => Ended::Unknown,
            },
        }
    }

    /// How many hinges ended so.
    pub(crate) fn count(&self, outcome: HingeOutcome) -> usize {
        self.hinges.values().filter(|hinge| hinge.outcome == outcome).count()
    }

    /// The end of the run by its own clock, s: the last that the MCU told.
    pub(crate) fn end_s(&self) -> f64 {
        let events = self.recording.events.iter().filter_map(|event| self.seconds_of(&event.record));
        let looks = self.recording.telemetry.iter().filter_map(|look| self.seconds(look.mcu_us));
        events.chain(looks).fold(0.0, f64::max)
    }

    /// Every fault, explained.
    pub(crate) fn faults(&self) -> Vec<Told> {
        let faults = self.recording.events.iter().filter_map(|event| {
            let Record::Fault { fault, .. } = &event.record else { return None };
            let (code, _) = fault.split_once(':')?;
            let known = FaultCode::ALL
                .iter()
                .find(|known| format!("{}{:02}", FaultCode::LETTER, known.number()) == code)?;
            let (_, sentence) = crate::told::sentence(&event.record)?;
            Some(Told {
                code: code.to_owned(),
                text: known.explanation(),
                sentence,
                seconds: self.seconds_of(&event.record),
            })
        });
        faults.collect()
    }

    /// What to do now.
    pub(crate) fn next(&self) -> String {
        match &self.recording.report {
            Some(report) => report.next.clone(),
            None => "the recording has no end: look at the rig, and at the event log beside the plan; the MCU turns everything off by itself \
                     when its host is gone"
                .to_owned(),
        }
    }
}

/// How a run ended.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum Ended {
    /// Every hinge is at its angle.
    Well(String),
    /// Somebody wanted it to.
    Early(String),
    /// Something is wrong.
    Badly(String),
    /// The recording ends before the run does.
    Unknown,
}
