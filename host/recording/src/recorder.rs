//! The recorder: is told every record of a run, and writes the MCAP file.
//!
//! ```text
//!   Waiting --first record--> Writing --error--> Failed: the run goes on, the error is told
//!                                |
//!                              finish: report, index
//! ```
//!
//! A chunk is written in one piece and at least once a second, so that a program that is killed loses a second at most.

use crate::error::RecordError;
use crate::job::{Job, Part};
use crate::message::{Event, Reading, Telemetry};
use crate::primitive::Log;
use crate::scene::Scene;
use crate::stamp::Stamp;
use crate::{LIBRARY, PROFILE, attachment, metadata, schema, told, topic};
use mcap::records::{MessageHeader, Metadata};
use mcap::{Attachment, McapError, WriteOptions, Writer};
use serde::Serialize;
use std::borrow::Cow;
use std::collections::BTreeMap;
use std::io::{self, BufWriter, Seek, Write};
use zygote_controller::{Observer, Record, RunReport, Times};

/// A chunk is written at least so often, ns of host time.
const FLUSH_EVERY_NS: u64 = 1_000_000_000;

type Open<W> = Box<dyn FnOnce() -> io::Result<W>>;

enum State<W: Write + Seek> {
    Waiting(Open<W>),
    Writing(Box<File<W>>),
    /// Nothing more is written.
    Over,
}

/// Records a run into a file that is opened at the first record: a run that was refused leaves none.
pub struct Recorder<W: Write + Seek> {
    state: State<W>,
    scene: Scene,
    about: Metadata,
    parts: Vec<Part>,
    start_ns: u64,
    newest_ns: u64,
    error: Option<RecordError>,
}

impl<W: Write + Seek> Recorder<W> {
    /// A recorder of `job` into what `open` will give.
    ///
    /// # Errors
    /// [`RecordError`] for a job that can't be written down.
    pub fn new(job: &Job<'_>, open: impl FnOnce() -> io::Result<W> + 'static) -> Result<Self, RecordError> {
        Ok(Self {
            state: State::Waiting(Box::new(open)),
            scene: Scene::new(job.plan, job.schedule, job.open)?,
            about: job.metadata(),
            parts: job.parts()?,
            start_ns: job.start_ns(),
            newest_ns: job.start_ns(),
            error: None,
        })
    }

    /// Ends the recording with the run's report, where there is one. Without this the file has no index, but can be read.
    ///
    /// # Errors
    /// The first [`RecordError`], now or earlier: the recording isn't whole.
    pub fn finish(mut self, report: Option<&RunReport>) -> Result<(), RecordError> {
        if let State::Writing(file) = std::mem::replace(&mut self.state, State::Over) {
            let ended = file.end(self.newest_ns, report);
            self.note(ended);
        }
        self.error.take().map_or(Ok(()), Err)
    }

    /// Keeps the first error, and ends the writing.
    fn note(&mut self, result: Result<(), McapError>) {
        if let Err(error) = result {
            let message = match error {
                McapError::Io(error) => error.to_string(),
                other => other.to_string(),
            };
            #[expect(clippy::cast_precision_loss, reason = "a run is far shorter than 2^52 ns")]
            let seconds = (self.newest_ns - self.start_ns) as f64 / 1e9;
            self.error.get_or_insert(RecordError::Write { seconds, message });
            self.state = State::Over;
        }
    }

    fn begin(&mut self) {
        if !matches!(self.state, State::Waiting(_)) {
            return;
        }
        let State::Waiting(open) = std::mem::replace(&mut self.state, State::Over) else { return };
        match open() {
            Err(error) => self.error = Some(RecordError::Open(error)),
            Ok(sink) => match File::begin(sink, self.start_ns, &self.about, &self.parts, &self.scene) {
                Ok(file) => self.state = State::Writing(Box::new(file)),
                Err(error) => self.note(Err(error)),
            },
        }
    }
}

impl<W: Write + Seek> Observer for Recorder<W> {
    fn observe(&mut self, times: Times, record: &Record) {
        self.newest_ns = self.newest_ns.max(self.start_ns + times.host_us * 1_000);
        self.begin();
        let State::Writing(file) = &mut self.state else { return };
        let happened = times.at_host_us.and_then(|at| self.start_ns.checked_add_signed(at * 1_000));
        let moment = Moment { log_ns: self.newest_ns, happened_ns: happened.unwrap_or(self.newest_ns) };
        let written = file.take(moment, times, record, &mut self.scene);
        self.note(written);
    }

    fn error(&self) -> Option<String> {
        self.error.as_ref().map(ToString::to_string)
    }
}

/// When a message was told, and when what it tells happened.
#[derive(Debug, Clone, Copy)]
struct Moment {
    log_ns: u64,
    happened_ns: u64,
}

/// The open file.
struct File<W: Write + Seek> {
    writer: Writer<BufWriter<W>>,
    channels: BTreeMap<&'static str, (u16, u32)>,
    flushed_ns: u64,
}

impl<W: Write + Seek> File<W> {
    fn begin(
        sink: W,
        start_ns: u64,
        about: &Metadata,
        parts: &[Part],
        scene: &Scene,
    ) -> Result<Self, McapError> {
        // Without seeking a chunk stays in memory until it is whole.
        let options =
            WriteOptions::new().compression(None).profile(PROFILE).library(LIBRARY).disable_seeking(true);
        let mut writer = options.create(BufWriter::new(sink))?;
        writer.write_metadata(about)?;
        let mut channels = BTreeMap::new();
        for (topic, schema) in schema::all() {
            let id = writer.add_schema(schema.name, "jsonschema", schema.json.to_string().as_bytes())?;
            let channel = writer.add_channel(id, topic, "json", &BTreeMap::new())?;
            channels.insert(topic, (channel, 0));
        }
        let mut file = Self { writer, channels, flushed_ns: start_ns };
        for part in parts {
            file.attach(start_ns, part.name, part.media_type, &part.bytes)?;
        }
        let (moment, at) = (Moment { log_ns: start_ns, happened_ns: start_ns }, Stamp::from_ns(start_ns));
        file.message(topic::PANELS, moment, &scene.panels(at))?;
        file.message(topic::FRAMES, moment, &scene.frames(at))?;
        file.writer.flush()?;
        Ok(file)
    }

    fn attach(&mut self, at_ns: u64, name: &str, media_type: &str, bytes: &[u8]) -> Result<(), McapError> {
        self.writer.attach(&Attachment {
            log_time: at_ns,
            create_time: at_ns,
            name: name.to_owned(),
            media_type: media_type.to_owned(),
            data: Cow::Borrowed(bytes),
        })
    }

    fn message(
        &mut self,
        topic: &'static str,
        moment: Moment,
        message: &impl Serialize,
    ) -> Result<(), McapError> {
        let data = serde_json::to_vec(message).map_err(io::Error::from)?;
        // Every topic has its channel from the beginning.
        let Some((channel_id, sequence)) = self.channels.get_mut(topic) else { return Ok(()) };
        let header = MessageHeader {
            channel_id: *channel_id,
            sequence: *sequence,
            log_time: moment.log_ns,
            publish_time: moment.happened_ns,
        };
        *sequence += 1;
        self.writer.write_to_known_channel(&header, &data)
    }

    fn take(
        &mut self,
        moment: Moment,
        times: Times,
        record: &Record,
        scene: &mut Scene,
    ) -> Result<(), McapError> {
        if let Record::Connected { line, board, firmware, boot, chip } = record {
            self.identity(line, board, firmware, *boot, chip)?;
        }
        if let Record::Telemetry { mcu_us, supply_mv, current_ma, opened, motions, .. } = record {
            let telemetry = Telemetry {
                times,
                mcu_us: *mcu_us,
                supply_v: f64::from(*supply_mv) / 1e3,
                current_a: f64::from(*current_ma) / 1e3,
                opened: *opened,
                motions: motions.iter().map(Reading::from).collect(),
            };
            self.message(topic::TELEMETRY, moment, &telemetry)?;
        } else {
            self.message(topic::EVENTS, moment, &Event { times, record: record.clone() })?;
        }
        let at = Stamp::from_ns(moment.log_ns);
        if let Some((level, message)) = told::sentence(record) {
            let log = Log {
                timestamp: at,
                level: level as u8,
                message: &message,
                name: "zygote",
                file: "",
                line: 0,
            };
            self.message(topic::LOG, moment, &log)?;
        }
        if let Some(moved) = scene.moved(at, record) {
            self.message(topic::FRAMES, moment, &moved)?;
        }
        if let Some(hinges) = scene.hinges(at, record) {
            self.message(topic::HINGES, moment, &hinges)?;
        }
        let urgent = matches!(record, Record::Uploaded { .. } | Record::Fault { .. } | Record::Lost { .. });
        if urgent || moment.log_ns >= self.flushed_ns + FLUSH_EVERY_NS {
            self.flushed_ns = moment.log_ns;
            self.writer.flush()?;
        }
        Ok(())
    }

    /// Who is at the other end; once more after it was lost and found.
    fn identity(
        &mut self,
        line: &str,
        board: &str,
        firmware: &str,
        boot: u32,
        chip: &str,
    ) -> Result<(), McapError> {
        let boot = &boot.to_string();
        let said = [("line", line), ("board", board), ("firmware", firmware), ("boot", boot), ("chip", chip)];
        let metadata = said.into_iter().map(|(key, value)| (key.to_owned(), value.to_owned())).collect();
        self.writer.write_metadata(&Metadata { name: metadata::IDENTITY.to_owned(), metadata })
    }

    fn end(mut self, at_ns: u64, report: Option<&RunReport>) -> Result<(), McapError> {
        if let Some(report) = report {
            let json = serde_json::to_vec_pretty(report).map_err(io::Error::from)?;
            self.attach(at_ns, attachment::REPORT, "application/json", &json)?;
        }
        self.writer.finish()?;
        // The last bytes may wait in the buffer, which tells nobody when it is dropped with them.
        Ok(self.writer.into_inner().flush()?)
    }
}
