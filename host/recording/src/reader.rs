//! Reads a recording: whole, or as far as it goes when the program that wrote it was killed, or the disk was full.

use crate::error::ReadError;
use crate::message::{Event, Telemetry};
use crate::{FORMAT, PROFILE, attachment, metadata, topic};
use mcap::read::{ChunkReader, LinearReader, Options};
use mcap::records::Record as Entry;
use mcap::{MAGIC, McapError};
use serde::de::DeserializeOwned;
use std::collections::{BTreeMap, BTreeSet};
use zygote_controller::RunReport;
use zygote_deployment::{Rig, Schedule};
use zygote_stacking::{Plan, fold};

/// How a recording ends.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum End {
    /// With its index.
    Whole,
    /// In the middle: what comes after the last whole chunk is lost.
    Cut {
        /// Why nothing more can be read.
        why: String,
    },
}

/// A run, as it was recorded.
#[derive(Debug, Clone)]
pub struct Recording {
    /// What ran, for people: file names, program, time, scenario.
    pub job: BTreeMap<String, String>,
    /// Who was at the other end last: line, board, firmware, boot.
    pub identity: BTreeMap<String, String>,
    /// The plan.
    pub plan: Plan,
    /// The rig.
    pub rig: Rig,
    /// The whole schedule.
    pub schedule: Schedule,
    /// Hinges that an earlier run had moved.
    pub open: BTreeSet<usize>,
    /// What happened, in the order of arrival.
    pub events: Vec<Event>,
    /// What was measured.
    pub telemetry: Vec<Telemetry>,
    /// The report, if the recorder lived to write it.
    pub report: Option<RunReport>,
    /// How it ends.
    pub end: End,
}

/// Everything that was found, before it is made sense of.
#[derive(Default)]
struct Found {
    profile: Option<(String, String)>,
    metadata: BTreeMap<String, BTreeMap<String, String>>,
    attachments: BTreeMap<String, Vec<u8>>,
    topics: BTreeMap<u16, String>,
    events: Vec<Event>,
    telemetry: Vec<Telemetry>,
    whole: bool,
}

impl Recording {
    /// Reads a recording from the bytes of its file.
    ///
    /// # Errors
    /// [`ReadError`] for what is no recording, or breaks off before it says what ran.
    pub fn read(bytes: &[u8]) -> Result<Self, ReadError> {
        if bytes.is_empty() {
            return Err(ReadError::Empty);
        }
        let begin = &bytes[..bytes.len().min(MAGIC.len())];
        if !MAGIC.starts_with(begin) {
            let found: Vec<_> = begin.iter().map(|byte| format!("{byte:02x}")).collect();
            return Err(ReadError::NotMcap { found: found.join(" ") });
        }
        let mut found = Found::default();
        let why = found.take_all(bytes)?;
        let end = match why {
            None if found.whole => End::Whole,
            None => End::Cut { why: "its index is missing".to_owned() },
            Some(why) => End::Cut { why },
        };
        found.make_sense(bytes.len(), end)
    }
}

impl Found {
    /// Takes every record that can be read; gives why it ended early.
    fn take_all(&mut self, bytes: &[u8]) -> Result<Option<String>, ReadError> {
        let entries = match LinearReader::new_with_options(bytes, Options::IgnoreEndMagic.into()) {
            Ok(entries) => entries,
            Err(error) => return Ok(Some(error.to_string())),
        };
        for entry in entries {
            let entry = match entry {
                Ok(entry) => entry,
                // A length beyond the end of the file is a cut as well.
                Err(McapError::UnexpectedEof | McapError::RecordTooLarge { .. }) => {
                    return Ok(Some("it breaks off".to_owned()));
                }
                Err(error) => return Ok(Some(error.to_string())),
            };
            if let Entry::Chunk { header, data } = entry {
                // All of it or nothing: its checksum is known at its end.
                let inner = ChunkReader::new(header, &data).and_then(Iterator::collect);
                match inner {
                    Ok(inner) => self.take_each(inner)?,
                    Err(error) => return Ok(Some(error.to_string())),
                }
            } else {
                self.take(entry)?;
            }
            self.belongs_to_us()?;
        }
        Ok(None)
    }

    fn take_each(&mut self, entries: Vec<Entry<'_>>) -> Result<(), ReadError> {
        entries.into_iter().try_for_each(|entry| self.take(entry))
    }

    fn take(&mut self, entry: Entry<'_>) -> Result<(), ReadError> {
        match entry {
            Entry::Header(header) => self.profile = Some((header.profile, header.library)),
            Entry::Metadata(metadata) => {
                self.metadata.insert(metadata.name, metadata.metadata);
            }
            Entry::Attachment { header, data, .. } => {
                self.attachments.insert(header.name, data.into_owned());
            }
            Entry::Channel(channel) => {
                self.topics.insert(channel.id, channel.topic);
            }
            Entry::Message { header, data } => {
                match self.topics.get(&header.channel_id).map(String::as_str) {
                    Some(topic::EVENTS) => self.events.push(json(topic::EVENTS, header.sequence, &data)?),
                    Some(topic::TELEMETRY) => {
                        self.telemetry.push(json(topic::TELEMETRY, header.sequence, &data)?);
                    }
                    _ => {}
                }
            }
            Entry::Footer(_) => self.whole = true,
            _ => {}
        }
        Ok(())
    }

    /// Before anything is made of what another program wrote.
    fn belongs_to_us(&self) -> Result<(), ReadError> {
        match &self.profile {
            Some((profile, library)) if profile != PROFILE => {
                Err(ReadError::OtherProgram { program: library.clone(), profile: profile.clone() })
            }
            _ => Ok(()),
        }
    }

    fn make_sense(mut self, bytes: usize, end: End) -> Result<Recording, ReadError> {
        let job = self
            .metadata
            .remove(metadata::JOB)
            .ok_or(ReadError::Headless { bytes, missing: "it says what ran" })?;
        match job.get("format").map(String::as_str) {
            Some(FORMAT) => {}
            found => return Err(ReadError::Version { found: found.unwrap_or("none").to_owned() }),
        }
        let plan = self.part(bytes, attachment::PLAN)?;
        let plan = fold::read(&plan).map_err(|error| part(attachment::PLAN, error))?;
        let rig = self.part(bytes, attachment::RIG)?;
        let rig = std::str::from_utf8(&rig).map_err(|error| part(attachment::RIG, error))?;
        let rig = Rig::read(attachment::RIG, rig).map_err(|error| part(attachment::RIG, error))?;
        let schedule = self.part(bytes, attachment::SCHEDULE)?;
        let schedule = std::str::from_utf8(&schedule)
            .map_err(|error| part(attachment::SCHEDULE, error))
            .and_then(|text| Schedule::from_text(text).map_err(|error| part(attachment::SCHEDULE, error)))?;
        let report = self.attachments.remove(attachment::REPORT);
        let report = report
            .map(|report| serde_json::from_slice(&report).map_err(|error| part(attachment::REPORT, error)))
            .transpose()?;
        let open = job.get("already_open").map(String::as_str).unwrap_or_default();
        let open = open
            .split_whitespace()
            .map(|hinge| hinge.parse().map_err(|error| part("list of open hinges", error)))
            .collect::<Result<_, _>>()?;
        let identity = self.metadata.remove(metadata::IDENTITY).unwrap_or_default();
        let Self { events, telemetry, .. } = self;
        Ok(Recording { job, identity, plan, rig, schedule, open, events, telemetry, report, end })
    }

    fn part(&mut self, bytes: usize, name: &'static str) -> Result<Vec<u8>, ReadError> {
        self.attachments.remove(name).ok_or(ReadError::Headless { bytes, missing: name })
    }
}

fn part(what: &str, error: impl std::fmt::Display) -> ReadError {
    ReadError::Part { what: what.to_owned(), message: error.to_string() }
}

fn json<T: DeserializeOwned>(topic: &str, sequence: u32, data: &[u8]) -> Result<T, ReadError> {
    serde_json::from_slice(data).map_err(|error| part(&format!("message {sequence} on {topic}"), error))
}
