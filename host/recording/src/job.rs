//! What is about to run, as it is written before the first message.

use crate::error::RecordError;
use crate::{FORMAT, attachment, metadata, stamp};
use mcap::records::Metadata;
use std::collections::{BTreeMap, BTreeSet};
use std::time::Duration;
use zygote_deployment::Schedule;
use zygote_stacking::{Plan, fold};

/// What is about to run.
pub struct Job<'a> {
    /// The plan.
    pub plan: &'a Plan,
    /// Its file, for people.
    pub plan_file: &'a str,
    /// The text of the rig file.
    pub rig: &'a str,
    /// The rig file, for people.
    pub rig_file: &'a str,
    /// The whole schedule.
    pub schedule: &'a Schedule,
    /// Hinges that an earlier run has moved.
    pub open: &'a BTreeSet<usize>,
    /// The scenario file that makes things go wrong, for people.
    pub scenario: Option<&'a str>,
    /// Wall clock at the start, from 1970; none in virtual time, so that the same run gives the same bytes.
    pub started: Option<Duration>,
}

/// A named file inside the recording.
pub(crate) struct Part {
    pub(crate) name: &'static str,
    pub(crate) media_type: &'static str,
    pub(crate) bytes: Vec<u8>,
}

impl Job<'_> {
    /// Time of the recording's start, ns.
    pub(crate) fn start_ns(&self) -> u64 {
        self.started.and_then(|started| u64::try_from(started.as_nanos()).ok()).unwrap_or(0)
    }

    pub(crate) fn metadata(&self) -> Metadata {
        let open: Vec<_> = self.open.iter().map(usize::to_string).collect();
        let mut about = BTreeMap::from([
            ("format", FORMAT.to_owned()),
            ("program", crate::LIBRARY.to_owned()),
            ("plan", self.plan_file.to_owned()),
            ("rig", self.rig_file.to_owned()),
            ("already_open", open.join(" ")),
            (
                "started",
                self.started
                    .map_or_else(|| "virtual time".to_owned(), |started| stamp::utc(started.as_secs())),
            ),
        ]);
        if let Some(scenario) = self.scenario {
            about.insert("scenario", scenario.to_owned());
        }
        let metadata = about.into_iter().map(|(key, value)| (key.to_owned(), value)).collect();
        Metadata { name: metadata::JOB.to_owned(), metadata }
    }

    pub(crate) fn parts(&self) -> Result<Vec<Part>, RecordError> {
        let plan = fold::write(self.plan)
            .map_err(|error| RecordError::Json { what: "the plan", message: error.to_string() })?;
        let schedule = self
            .schedule
            .to_text()
            .map_err(|error| RecordError::Json { what: "the schedule", message: error.to_string() })?;
        Ok(vec![
            Part { name: attachment::PLAN, media_type: "application/json", bytes: plan },
            Part {
                name: attachment::RIG,
                media_type: "application/toml",
                bytes: self.rig.as_bytes().to_vec(),
            },
            Part { name: attachment::SCHEDULE, media_type: "application/json", bytes: schedule.into_bytes() },
        ])
    }
}
