//! Recordings of real runs on the simulator: read by this crate and by the format's own reader, cut, damaged, on full disks.

use crate::{End, Job, ReadError, RecordError, Recorder, Recording, page, timeline};
use mcap::records::MessageHeader;
use mcap::{MessageStream, Summary, WriteOptions};
use serde_json::Value;
use std::cell::RefCell;
use std::collections::{BTreeMap, BTreeSet};
use std::io::{self, Cursor, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::rc::Rc;
use zygote_controller::{DeployError, Deployment, EventLog, Outcome, Record, RunReport, Session, deploy};
use zygote_deployment::scene::Frames;
use zygote_deployment::{Limits, Order, Rig, Schedule, Tree};
use zygote_protocol::Millis;
use zygote_rehearsal::{Scenario, Trial};
use zygote_stacking::{Model, Plan, Request};

/// A disk with so much room; what was written stays when the writer is gone.
#[derive(Clone)]
struct Disk {
    bytes: Rc<RefCell<Vec<u8>>>,
    room: usize,
}

impl Disk {
    fn with_room(room: usize) -> Self {
        Self { bytes: Rc::default(), room }
    }

    fn content(&self) -> Vec<u8> {
        self.bytes.borrow().clone()
    }
}

impl Write for Disk {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let left = self.room - self.bytes.borrow().len();
        if left == 0 {
            return Err(io::Error::from(io::ErrorKind::StorageFull));
        }
        let taken = &bytes[..bytes.len().min(left)];
        self.bytes.borrow_mut().extend_from_slice(taken);
        Ok(taken.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

impl Seek for Disk {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        assert_eq!(to, SeekFrom::Current(0), "a recording is written from front to back");
        Ok(self.bytes.borrow().len() as u64)
    }
}

/// Six panels, five hinges, on the rig of the scenarios.
struct Rehearsal {
    plan: Plan,
    rig: Rig,
    rig_text: String,
    schedule: Schedule,
    trial: Trial,
}

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

impl Rehearsal {
    /// A run in which nothing goes wrong, or what a scenario says.
    fn new(scenario: Option<&str>) -> Self {
        let rig_text = std::fs::read_to_string(root().join("sim/scenarios/rigs/sma.toml")).unwrap();
        let rig = Rig::read("sma.toml", &rig_text).unwrap();
        let model = Model::read(&root().join("models/cube6.txt"), None).unwrap();
        let plan = zygote_stacking::plan(&model, &Request { piles: 1, ..Request::default() }).unwrap();
        let order = Order::of_tree(&Tree::new(&plan).unwrap());
        let schedule = Schedule::plan(&plan, &rig, &order, &Limits::at_most(1)).unwrap();
        let trial = match scenario {
            None => Trial::new(rig.clone(), schedule.clone()).unwrap(),
            Some(name) => Scenario::open(&root().join("sim/scenarios").join(name))
                .unwrap()
                .trial_of(rig.clone(), schedule.clone())
                .unwrap(),
        };
        Self { plan, rig, rig_text, schedule, trial }
    }

    /// Deploys while it is recorded onto `disk`.
    fn record(&self, disk: &Disk) -> (Result<RunReport, DeployError>, Recorder<Disk>) {
        let open = BTreeSet::new();
        let job = Job {
            plan: &self.plan,
            plan_file: "cube.fold",
            rig: &self.rig_text,
            rig_file: "sma.toml",
            schedule: &self.schedule,
            open: &open,
            scenario: None,
            started: None,
        };
        let sink = disk.clone();
        let mut recorder = Recorder::new(&job, move || Ok(sink)).unwrap();
        let mut log = EventLog::new(io::sink()).observed_by(&mut recorder);
        let mut stage = self.trial.open().unwrap();
        let mut session = Session::connect(&mut stage, 1, Millis(2_000)).unwrap();
        let deployment = Deployment {
            schedule: &self.schedule,
            rig: &self.rig,
            run: 1,
            open: &open,
            clear: false,
            any_board: false,
            interrupted: &|| false,
            steer: None,
        };
        let ended = deploy(&mut session, &deployment, &mut log, &mut |_| {});
        drop(log);
        (ended, recorder)
    }

    fn whole(&self) -> Vec<u8> {
        let disk = Disk::with_room(usize::MAX);
        let (ended, recorder) = self.record(&disk);
        recorder.finish(ended.as_ref().ok()).unwrap();
        disk.content()
    }
}

#[test]
fn the_format_s_own_reader_finds_messages_schemas_and_files() {
    let bytes = Rehearsal::new(None).whole();
    let summary = Summary::read(&bytes).unwrap().unwrap();
    let topics: BTreeMap<_, _> = summary
        .channels
        .values()
        .map(|channel| (channel.topic.as_str(), channel.schema.as_ref().unwrap().name.as_str()))
        .collect();
    let expected = [
        ("/events", "zygote.Event"),
        ("/frames", "foxglove.FrameTransforms"),
        ("/hinges", "foxglove.SceneUpdate"),
        ("/log", "foxglove.Log"),
        ("/panels", "foxglove.SceneUpdate"),
        ("/telemetry", "zygote.Telemetry"),
    ];
    assert_eq!(topics, BTreeMap::from(expected));
    let files: Vec<_> = summary.attachment_indexes.iter().map(|index| index.name.as_str()).collect();
    assert_eq!(files, ["plan.fold", "rig.toml", "schedule.json", "report.json"]);
    let mut last = 0;
    let mut counts = BTreeMap::new();
    for message in MessageStream::new(&bytes).unwrap() {
        let message = message.unwrap();
        assert!(message.log_time >= last, "time goes on");
        last = message.log_time;
        // Every message has at least one of the keys that its schema promises.
        let value: Value = serde_json::from_slice(&message.data).unwrap();
        let schema: Value = serde_json::from_slice(&message.channel.schema.as_ref().unwrap().data).unwrap();
        for key in value.as_object().unwrap().keys() {
            let known = schema["properties"].get(key).is_some();
            assert!(known || message.channel.topic == "/events", "{}: {key}", message.channel.topic);
        }
        *counts.entry(message.channel.topic.clone()).or_insert(0) += 1;
    }
    assert_eq!(counts["/panels"], 1);
    assert!(counts["/telemetry"] > 100 && counts["/frames"] > 50 && counts["/hinges"] > 20, "{counts:?}");
    assert_eq!(counts["/events"], counts["/log"]);
}

#[test]
fn what_was_recorded_is_read_again() {
    let rehearsal = Rehearsal::new(None);
    let recording = Recording::read(&rehearsal.whole()).unwrap();
    assert_eq!(recording.end, End::Whole);
    assert_eq!(recording.plan, rehearsal.plan);
    assert_eq!(recording.rig, Rig::read("rig.toml", &rehearsal.rig_text).unwrap());
    assert_eq!(recording.schedule, rehearsal.schedule);
    assert_eq!(recording.report.as_ref().unwrap().outcome, Outcome::Deployed);
    let opened = recording.events.iter().filter(|event| matches!(event.record, Record::Opened { .. }));
    assert_eq!(opened.count(), rehearsal.plan.hinges.len());
    let heated = recording.telemetry.iter().flat_map(|look| &look.motions);
    assert!(heated.clone().any(|motion| motion.duty.is_some_and(|duty| duty > 0.5)));
    assert!(heated.clone().any(|motion| motion.opening_deg.is_some_and(|degrees| degrees > 10.0)));
    assert!(heated.clone().all(|motion| motion.temperature_c.is_some()));
}

#[test]
fn the_same_run_gives_the_same_bytes() {
    assert!(Rehearsal::new(None).whole() == Rehearsal::new(None).whole());
}

#[test]
fn the_frames_end_where_the_target_is() {
    let rehearsal = Rehearsal::new(None);
    let bytes = rehearsal.whole();
    let mut newest = BTreeMap::new();
    for message in MessageStream::new(&bytes).unwrap().map(Result::unwrap) {
        if message.channel.topic != "/frames" {
            continue;
        }
        let update: Value = serde_json::from_slice(&message.data).unwrap();
        for transform in update["transforms"].as_array().unwrap() {
            newest.insert(transform["child_frame_id"].as_str().unwrap().to_owned(), transform.clone());
        }
    }
    assert_eq!(newest.len(), rehearsal.plan.panels());
    let frames = Frames::new(&rehearsal.plan).unwrap();
    for hinge in 0..rehearsal.plan.hinges.len() {
        let link = frames.link(hinge, 1.0).unwrap();
        let found = &newest[&format!("panel {}", link.child)];
        assert_eq!(found["parent_frame_id"], format!("panel {}", link.parent));
        for (key, expected) in ["x", "y", "z"].iter().zip(link.pose.translation) {
            assert!((found["translation"][key].as_f64().unwrap() - expected).abs() < 1e-4, "hinge {hinge}");
        }
        for (key, expected) in ["x", "y", "z", "w"].iter().zip(link.pose.rotation) {
            assert!((found["rotation"][key].as_f64().unwrap() - expected).abs() < 1e-4, "hinge {hinge}");
        }
    }
}

#[test]
fn a_recording_that_breaks_off_anywhere_is_read_as_far_as_it_goes() {
    let bytes = Rehearsal::new(None).whole();
    let whole = Recording::read(&bytes).unwrap();
    let mut known = 0;
    for length in (1..bytes.len()).step_by(613).chain([bytes.len() - 1]) {
        match Recording::read(&bytes[..length]) {
            Ok(cut) => {
                let now = cut.events.len() + cut.telemetry.len();
                assert!(now >= known, "{length} bytes tell less than fewer did");
                known = now;
                assert!(whole.events.starts_with(&cut.events) && whole.telemetry.starts_with(&cut.telemetry));
                assert!(length > bytes.len() - 8 || matches!(cut.end, End::Cut { .. }), "{length}");
                assert!(timeline(&cut).contains("next: ") && page(&cut).ends_with("</html>\n"));
            }
            Err(ReadError::Headless { .. }) => assert_eq!(known, 0, "{length}"),
            Err(other) => panic!("{length} bytes: {other}"),
        }
    }
    assert_eq!(known, whole.events.len() + whole.telemetry.len());
}

#[test]
fn a_recorder_that_is_killed_loses_a_second_at_most() {
    let disk = Disk::with_room(usize::MAX);
    let (_, recorder) = Rehearsal::new(None).record(&disk);
    // Nothing of it runs any more, as when the process is killed.
    std::mem::forget(recorder);
    let recording = Recording::read(&disk.content()).unwrap();
    assert!(matches!(recording.end, End::Cut { .. }) && recording.report.is_none());
    let whole = Recording::read(&Rehearsal::new(None).whole()).unwrap();
    let last = |recording: &Recording| recording.telemetry.last().unwrap().times.host_us;
    assert!(last(&whole) - last(&recording) <= 1_100_000, "{} of {}", last(&recording), last(&whole));
    let text = timeline(&recording);
    assert!(text.contains("the recording isn't whole (its index is missing)"), "{text}");
    assert!(text.contains("unknown: the recording ends before the run does"), "{text}");
}

#[test]
fn a_disk_that_is_full_ends_the_recording_and_not_the_run() {
    let rehearsal = Rehearsal::new(None);
    let size = rehearsal.whole().len();
    for room in [size / 3, size / 2, size - 100] {
        let disk = Disk::with_room(room);
        let (ended, recorder) = rehearsal.record(&disk);
        let report = ended.unwrap();
        assert_eq!(report.outcome, Outcome::Deployed, "{room} bytes");
        let error = recorder.finish(Some(&report)).unwrap_err();
        assert!(matches!(&error, RecordError::Write { seconds, .. } if *seconds > 1.0), "{room}: {error}");
        let saved = Recording::read(&disk.content()).unwrap();
        assert!(matches!(saved.end, End::Cut { .. }) && saved.events.len() > 3, "{room} bytes");
    }
}

#[test]
fn a_disk_that_is_full_from_the_beginning_is_told_before_anything_moves() {
    let rehearsal = Rehearsal::new(None);
    let (ended, _) = rehearsal.record(&Disk::with_room(100));
    assert!(matches!(&ended, Err(DeployError::Recording { .. })), "{ended:?}");
    assert!(ended.unwrap_err().to_string().starts_with("the run can't be recorded: it can't be written"));
}

#[test]
fn a_fault_is_in_the_recording_with_what_it_means() {
    let recording = Recording::read(&Rehearsal::new(Some("s12-report-of-a-fault.toml")).whole()).unwrap();
    assert!(matches!(recording.report.as_ref().unwrap().outcome, Outcome::Fault(_)));
    let text = timeline(&recording);
    assert!(text.contains("F08") && text.contains("at hinge 4"), "{text}");
    assert!(text.contains("not deployed") && text.contains("2 of 5 hinges"), "{text}");
    let page = page(&recording);
    let remedy = zygote_protocol::FaultCode::ALL.iter().find(|code| code.number() == 8).unwrap();
    let remedy = remedy.explanation().remedy.replace('"', "&quot;");
    for part in ["F08", "not deployed", "interrupted", "not moved", &remedy] {
        assert!(page.contains(part), "{part}");
    }
}

#[test]
fn the_page_needs_nothing_else_and_closes_what_it_opens() {
    let page = page(&Recording::read(&Rehearsal::new(None).whole()).unwrap());
    for other in ["http", "<script", "src=", "href=", "url(", "@import"] {
        assert!(!page.contains(other), "{other}");
    }
    for tag in ["section", "svg", "table", "div", "details", "g", "tr", "td", "p"] {
        let opened = page.matches(&format!("<{tag}>")).count() + page.matches(&format!("<{tag} ")).count();
        assert_eq!(opened, page.matches(&format!("</{tag}>")).count(), "{tag}");
    }
    assert!(!page.contains("NaN") && !page.contains("inf"), "a number that is none");
}

/// Why bytes are no recording.
fn refused(bytes: &[u8]) -> String {
    Recording::read(bytes).unwrap_err().to_string()
}

#[test]
fn what_is_no_recording_is_refused_with_the_reason() {
    assert!(refused(b"").contains("empty"));
    assert!(refused(b"{\"events\":[]}").contains("begins with 7b 22"));
    assert!(refused(b"\x89MCAP").contains("breaks off after 5 bytes"));
    let mut other = Cursor::new(Vec::new());
    let mut writer = WriteOptions::new().profile("ros2").library("a robot").create(&mut other).unwrap();
    let channel = writer.add_channel(0, "/events", "json", &BTreeMap::new()).unwrap();
    let header = MessageHeader { channel_id: channel, sequence: 0, log_time: 0, publish_time: 0 };
    writer.write_to_known_channel(&header, b"not ours").unwrap();
    writer.finish().unwrap();
    drop(writer);
    let refusal = refused(&other.into_inner());
    assert!(refusal.contains("of another program (a robot, profile `ros2`)"), "{refusal}");
}

#[test]
fn a_byte_that_flipped_ends_the_reading_and_invents_nothing() {
    let bytes = Rehearsal::new(None).whole();
    let whole = Recording::read(&bytes).unwrap();
    let (mut cut, mut refused) = (0, 0);
    // The index at the end isn't read, so nothing there can be missed.
    for place in (40..bytes.len() * 9 / 10).step_by(2_311) {
        let mut damaged = bytes.clone();
        damaged[place] ^= 0x10;
        match Recording::read(&damaged) {
            Ok(recording) => {
                assert!(whole.events.starts_with(&recording.events), "byte {place}");
                assert!(whole.telemetry.starts_with(&recording.telemetry), "byte {place}");
                cut += usize::from(recording.end != End::Whole);
            }
            Err(_) => refused += 1,
        }
    }
    assert!(cut > 10 && refused > 0, "{cut} cut, {refused} refused");
}
