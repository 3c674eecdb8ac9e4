//! Deployments over a line that damages, loses or ends: the real host and the real core with something in between.
#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]

use std::cell::{Cell, RefCell};
use std::collections::BTreeSet;
use std::io;
use std::path::Path;
use std::rc::Rc;
use zygote_controller::{
    ConnectError, DeployError, Deployment, EventLog, HingeOutcome, Outcome, RequestError, RunReport, Session,
    SessionError, Transport, deploy,
};
use zygote_deployment::{Limits, Order, Rig, Schedule, Tree};
use zygote_protocol::{Micros, Millis, State};
use zygote_rehearsal::{Stage, Trial};
use zygote_stacking::{Model, Request};

/// A simulated board behind a line that flips a bit in one byte of so many, and is dead from some time on.
struct BadLine {
    sim: Stage,
    one_in: u64,
    dead_from: Micros,
    random: u64,
}

impl BadLine {
    fn damage(&mut self, bytes: &[u8]) -> Vec<u8> {
        let mut next = || {
            self.random ^= self.random << 13;
            self.random ^= self.random >> 7;
            self.random ^= self.random << 17;
            self.random
        };
        bytes
            .iter()
            .map(|byte| if next() % self.one_in == 0 { byte ^ 1 << (next() % 8) } else { *byte })
            .collect()
    }

    fn is_dead(&self) -> bool {
        self.now() >= self.dead_from
    }
}

impl Transport for BadLine {
    fn now(&self) -> Micros {
        self.sim.now()
    }

    fn send(&mut self, bytes: &[u8]) -> io::Result<()> {
        let damaged = self.damage(bytes);
        if self.is_dead() { Ok(()) } else { self.sim.send(&damaged) }
    }

    fn receive(&mut self, buffer: &mut [u8], deadline: Micros) -> io::Result<usize> {
        let count = self.sim.receive(buffer, deadline)?;
        if self.is_dead() {
            return Ok(0);
        }
        let damaged = self.damage(&buffer[..count]);
        buffer[..count].copy_from_slice(&damaged);
        Ok(count)
    }

    fn name(&self) -> String {
        "bad line".to_owned()
    }
}

fn repository() -> std::path::PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// Fourteen panels on the mixed rig.
fn job() -> (Rig, Schedule) {
    let model = Model::read(&repository().join("models/i14.txt"), None).unwrap();
    let request = Request { piles: 2, ..Request::default() };
    let plan = zygote_stacking::plan(&model, &request).unwrap();
    let text = std::fs::read_to_string(repository().join("models/rigs/mixed.toml")).unwrap();
    let rig = Rig::read("mixed.toml", &text).unwrap();
    let order = Order::of_tree(&Tree::new(&plan).unwrap());
    let schedule = Schedule::plan(&plan, &rig, &order, &Limits::at_most(1)).unwrap();
    (rig, schedule)
}

fn line(rig: &Rig, schedule: &Schedule, one_in: u64, dead_from: Micros) -> BadLine {
    let trial = Trial::new(rig.clone(), schedule.clone()).unwrap();
    BadLine { sim: trial.open().unwrap(), one_in, dead_from, random: 0x1234_5678_9abc_def1 }
}

/// Deploys; `interrupted` is asked with the number of times it was asked before.
fn run(
    line: BadLine,
    rig: &Rig,
    schedule: &Schedule,
    interrupted: impl Fn(u32) -> bool,
) -> (Result<RunReport, DeployError>, BadLine) {
    let mut session = Session::connect(line, 9, Millis(5_000)).unwrap();
    let asked = Cell::new(0);
    let deployment = Deployment {
        schedule,
        rig,
        run: 1,
        open: &BTreeSet::new(),
        clear: false,
        any_board: false,
        interrupted: &|| interrupted(asked.replace(asked.get() + 1)),
        steer: None,
    };
    let report = deploy(&mut session, &deployment, &mut EventLog::new(io::sink()), &mut |_| {});
    (report, session.into_transport())
}

const NEVER: Micros = Micros(u64::MAX);
const CLEAN: u64 = u64::MAX;

#[test]
fn a_deployment_survives_a_line_that_damages_one_byte_in_300() {
    let (rig, schedule) = job();
    let (report, _) = run(line(&rig, &schedule, 300, NEVER), &rig, &schedule, |_| false);
    let report = report.unwrap();
    assert!(report.is_complete(), "{report}");
    assert!(report.damaged_frames > 10, "{} damaged frames are no bad line", report.damaged_frames);
}

#[test]
fn s3_a_line_that_dies_ends_in_a_lost_run_and_a_board_with_everything_off() {
    let (rig, schedule) = job();
    let (report, line) = run(line(&rig, &schedule, CLEAN, Micros(8_000_000)), &rig, &schedule, |_| false);
    let report = report.unwrap();
    assert!(matches!(report.outcome, Outcome::Lost(_)), "{report}");
    assert!(report.count(HingeOutcome::Opened) > 0 && report.count(HingeOutcome::NotMoved) > 0, "{report}");
    let board = line.sim.board();
    assert_eq!(board.core().state(), State::Safe);
    assert!(!board.core().outputs().main_switch);
}

#[test]
fn s8_a_user_who_stops_gets_a_confirmed_stop_and_a_report() {
    let (rig, schedule) = job();
    let (report, line) = run(line(&rig, &schedule, CLEAN, NEVER), &rig, &schedule, |asked| asked > 100);
    let report = report.unwrap();
    assert_eq!(report.outcome, Outcome::Stopped);
    assert!(report.count(HingeOutcome::NotMoved) > 0, "{report}");
    assert_eq!(line.sim.board().core().state(), State::Safe);
}

#[test]
fn a_stopped_board_wants_a_person_before_the_next_run() {
    let (rig, schedule) = job();
    let (_, mut line) = run(line(&rig, &schedule, CLEAN, NEVER), &rig, &schedule, |asked| asked > 100);
    line.random = 1;
    let mut session = Session::connect(line, 10, Millis(5_000)).unwrap();
    let deployment = Deployment {
        schedule: &schedule,
        rig: &rig,
        run: 2,
        open: &BTreeSet::new(),
        clear: false,
        any_board: false,
        interrupted: &|| false,
        steer: None,
    };
    let mut log = EventLog::new(io::sink());
    let refused = deploy(&mut session, &deployment, &mut log, &mut |_| {});
    assert!(matches!(refused, Err(DeployError::Safe { fault: Some(_) })), "{refused:?}");
    let cleared = Deployment { clear: true, ..deployment };
    assert!(deploy(&mut session, &cleared, &mut log, &mut |_| {}).unwrap().is_complete());
}

#[test]
fn nobody_at_the_other_end_is_told_by_name_after_the_time_given() {
    let (rig, schedule) = job();
    let dead = line(&rig, &schedule, CLEAN, Micros(0));
    let error = Session::connect(dead, 9, Millis(2_000)).err().unwrap();
    assert!(matches!(error, ConnectError::NoAnswer { waited_ms: 2_000, heard: 0, .. }), "{error}");
}

#[test]
fn a_schedule_on_several_nodes_is_refused_before_anything_is_sent() {
    let (rig, schedule) = job();
    let text = std::fs::read_to_string(repository().join("models/rigs/servo-160.toml")).unwrap();
    let second = "[[node]]\nname = \"second\"\nservos = 16\n\n[hinges]";
    let text = text.replace("servos = 160", "servos = 4").replacen("[hinges]", second, 1);
    let model = Model::read(&repository().join("models/i14.txt"), None).unwrap();
    let plan = zygote_stacking::plan(&model, &Request { piles: 2, ..Request::default() }).unwrap();
    let two_nodes = Rig::read("two.toml", &text).unwrap();
    let order = Order::of_tree(&Tree::new(&plan).unwrap());
    let split = Schedule::plan(&plan, &two_nodes, &order, &Limits::at_most(1)).unwrap();
    assert!(!split.crossings().is_empty());
    let (refused, line) = run(line(&rig, &schedule, CLEAN, NEVER), &two_nodes, &split, |_| false);
    let said = refused.unwrap_err().to_string();
    assert!(said.contains("the schedule is for 2 nodes (numbers [0, 1] of the rig file)"), "{said}");
    assert_eq!(line.sim.board().core().state(), State::Idle);
}

/// One port that two programs have opened.
#[derive(Clone)]
struct SharedPort(Rc<RefCell<Stage>>);

impl Transport for SharedPort {
    fn now(&self) -> Micros {
        self.0.borrow().now()
    }

    fn send(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.0.borrow_mut().send(bytes)
    }

    fn receive(&mut self, buffer: &mut [u8], deadline: Micros) -> io::Result<usize> {
        self.0.borrow_mut().receive(buffer, deadline)
    }

    fn name(&self) -> String {
        "shared port".to_owned()
    }
}

#[test]
fn of_two_hosts_on_one_port_the_first_is_told_that_another_took_over() {
    let (rig, schedule) = job();
    let port = SharedPort(Rc::new(RefCell::new(line(&rig, &schedule, CLEAN, NEVER).sim)));
    let mut first = Session::connect(port.clone(), 9, Millis(5_000)).unwrap();
    first.status().unwrap();
    let mut second = Session::connect(port, 10, Millis(5_000)).unwrap();
    assert!(matches!(first.status(), Err(RequestError::Session(SessionError::Forgotten { .. }))));
    assert_eq!(second.status().unwrap().state, State::Idle);
}

/// A host whose clock runs faster than the simulated board's.
struct FastClock {
    sim: Stage,
    ppm: u64,
}

impl Transport for FastClock {
    fn now(&self) -> Micros {
        let board = self.sim.now().0;
        Micros(7_000_000 + board + board * self.ppm / 1_000_000)
    }

    fn send(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.sim.send(bytes)
    }

    fn receive(&mut self, buffer: &mut [u8], deadline: Micros) -> io::Result<usize> {
        let left = Micros(deadline.since(self.now()));
        let until = Micros(self.sim.now().0 + left.0.max(1));
        self.sim.receive(buffer, until)
    }

    fn name(&self) -> String {
        "fast clock".to_owned()
    }
}

#[test]
fn the_log_tells_events_in_host_time_and_the_report_the_rate_of_the_clock() {
    let (rig, schedule) = job();
    let host = FastClock { sim: line(&rig, &schedule, CLEAN, NEVER).sim, ppm: 200 };
    let mut session = Session::connect(host, 9, Millis(5_000)).unwrap();
    let log = Rc::new(RefCell::new(Vec::new()));
    let mut event_log = EventLog::new(SharedSink(Rc::clone(&log)));
    let deployment = Deployment {
        schedule: &schedule,
        rig: &rig,
        run: 1,
        clear: false,
        any_board: false,
        open: &BTreeSet::new(),
        interrupted: &|| false,
        steer: None,
    };
    let report = deploy(&mut session, &deployment, &mut event_log, &mut |_| {}).unwrap();
    let clock = report.clock.unwrap();
    assert!((clock.rate_ppm + 200.0).abs() < 2.0 && clock.residual_us < 100.0, "{clock:?}");
    let lines = String::from_utf8(log.borrow().clone()).unwrap();
    let events: Vec<serde_json::Value> = lines
        .lines()
        .map(|line| serde_json::from_str(line).unwrap())
        .filter(|line: &serde_json::Value| line["kind"] == "opened")
        .collect();
    assert_eq!(events.len(), schedule.steps.len());
    for event in events {
        // The simulated line takes no time: an event is heard within the board's tick of its happening.
        let late = event["host_us"].as_i64().unwrap() - event["at_host_us"].as_i64().unwrap();
        assert!((-100..=6_000).contains(&late), "{late} us: {event}");
    }
}

/// A log that can be read afterwards.
struct SharedSink(Rc<RefCell<Vec<u8>>>);

impl io::Write for SharedSink {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.0.borrow_mut().write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}
