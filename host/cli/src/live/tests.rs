//! Attended runs on the simulator, in virtual time: armed, started, paused and stopped as somebody wishes.
#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]

use std::cell::Cell;
use std::collections::BTreeSet;
use std::io;
use std::path::Path;
use zygote_controller::{
    Deployment, EarlierRun, EventLog, HingeOutcome, Moment, Observer, Outcome, Record, RunReport, Session,
    Times, Wish, deploy,
};
use zygote_deployment::{Kind, Limits, Order, Rig, Schedule, Tree};
use zygote_protocol::{Millis, State};
use zygote_rehearsal::{Stage, Trial};
use zygote_stacking::{Model, Request};

/// Fourteen panels on shape-memory hinges, servos and springs, several at once.
fn job() -> (Rig, Schedule) {
    on("mixed.toml", 3)
}

fn on(rig: &str, parallel: usize) -> (Rig, Schedule) {
    let repository = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let model = Model::read(&repository.join("models/i14.txt"), None).unwrap();
    let plan = zygote_stacking::plan(&model, &Request { piles: 2, ..Request::default() }).unwrap();
    let text = std::fs::read_to_string(repository.join("models/rigs").join(rig)).unwrap();
    let rig = Rig::read(rig, &text).unwrap();
    let order = Order::of_tree(&Tree::new(&plan).unwrap());
    let schedule = Schedule::plan(&plan, &rig, &order, &Limits::at_most(parallel)).unwrap();
    (rig, schedule)
}

fn session(rig: &Rig, schedule: &Schedule) -> Session<Stage> {
    let stage = Trial::new(rig.clone(), schedule.clone()).unwrap().open().unwrap();
    Session::connect(stage, 1, Millis(2_000)).unwrap()
}

/// When the MCU went into which state, s.
#[derive(Default)]
struct States(Vec<(f64, String)>);

impl Observer for States {
    fn observe(&mut self, _: Times, record: &Record) {
        if let Record::State { mcu_us, state } = record {
            self.0.push((std::time::Duration::from_micros(*mcu_us).as_secs_f64(), state.clone()));
        }
    }

    fn error(&self) -> Option<String> {
        None
    }
}

fn run(
    session: &mut Session<Stage>,
    (rig, schedule): (&Rig, &Schedule),
    open: &BTreeSet<usize>,
    steer: &dyn Fn(Moment) -> Wish,
) -> (RunReport, States) {
    let mut states = States::default();
    let mut log = EventLog::new(io::sink()).observed_by(&mut states);
    let (run, clear, any_board, interrupted, steer) = (1, false, false, &|| false, Some(steer));
    let deployment = Deployment { schedule, rig, run, open, clear, any_board, interrupted, steer };
    let report = deploy(session, &deployment, &mut log, &mut |_| {}).unwrap();
    drop(log);
    (report, states)
}

/// Goes on once it was asked so often at each moment.
fn after(asks: u32, then: impl Fn(u32) -> Wish) -> impl Fn(Moment) -> Wish {
    let [loaded, armed, running] = [Cell::new(0), Cell::new(0), Cell::new(0)];
    move |moment| {
        let count = match moment {
            Moment::Loaded => &loaded,
            Moment::Armed => &armed,
            Moment::Running => &running,
        };
        count.set(count.get() + 1);
        match moment {
            Moment::Running => then(count.get()),
            Moment::Loaded | Moment::Armed if count.get() > asks => Wish::GoOn,
            Moment::Loaded | Moment::Armed => Wish::Wait,
        }
    }
}

#[test]
fn s2_nothing_is_armed_and_nothing_moves_before_somebody_says_so() {
    let (rig, schedule) = job();
    let mut session = session(&rig, &schedule);
    let (report, states) =
        run(&mut session, (&rig, &schedule), &BTreeSet::new(), &after(200, |_| Wish::GoOn));
    assert!(report.is_complete(), "{report}");
    let at = |name: &str| states.0.iter().find(|(_, state)| state == name).unwrap().0;
    // Two hundred times ten milliseconds, less those in which there were news.
    assert!(at("armed") - at("loaded") > 0.5, "{:?}", states.0);
    assert!(at("running") - at("armed") > 0.5, "{:?}", states.0);
}

/// Pauses once it was asked so often, and then goes on from there; gives the report of the first part, if it was paused before its end.
fn paused(rig: &Rig, schedule: &Schedule, asks: u32) -> Option<RunReport> {
    let mut session = session(rig, schedule);
    let pausing = after(0, |count| if count > asks { Wish::Pause } else { Wish::GoOn });
    let (report, states) = run(&mut session, (rig, schedule), &BTreeSet::new(), &pausing);
    if report.is_complete() {
        return None;
    }
    assert_eq!(report.outcome, Outcome::Paused, "{report}");
    assert_eq!(states.0.last().unwrap().1, "loaded");
    let core = session.transport().board().core();
    assert_eq!(core.state(), State::Loaded);
    assert!(!core.outputs().main_switch, "a pause turns everything off");
    let open = EarlierRun::from(&report).open(schedule, false).unwrap();
    let (rest, _) = run(&mut session, (rig, schedule), &open, &after(0, |_| Wish::GoOn));
    assert!(rest.is_complete(), "{rest}");
    Some(report)
}

#[test]
fn a_pause_cuts_heaters_off_and_what_is_left_completes_the_shape() {
    let (rig, schedule) = on("sma-160.toml", 3);
    let report = paused(&rig, &schedule, 200).unwrap();
    assert!(report.count(HingeOutcome::Interrupted) > 0, "{report}");
    assert!(report.count(HingeOutcome::NotMoved) > 0, "{report}");
}

#[test]
fn a_pause_leaves_no_servo_on_its_way() {
    let (rig, schedule) = job();
    let reports: Vec<_> = (0..12).filter_map(|nth| paused(&rig, &schedule, 100 * nth)).collect();
    assert!(!reports.is_empty(), "there is a moment at which no servo moves");
    for report in reports {
        let servos = report.hinges.iter().filter(|hinge| hinge.kind == Kind::Servo);
        let cut = servos.filter(|hinge| hinge.outcome == HingeOutcome::Interrupted).count();
        assert_eq!(cut, 0, "{report}");
    }
}

#[test]
fn s2_an_arming_that_nobody_starts_is_taken_back_and_is_no_fault() {
    let (rig, schedule) = job();
    let mut session = session(&rig, &schedule);
    let armed = Cell::new(false);
    let nobody = |moment| match moment {
        Moment::Loaded if armed.get() => Wish::Pause,
        Moment::Loaded => Wish::GoOn,
        Moment::Armed | Moment::Running => {
            armed.set(true);
            Wish::Wait
        }
    };
    let (report, states) = run(&mut session, (&rig, &schedule), &BTreeSet::new(), &nobody);
    assert_eq!(report.outcome, Outcome::Paused, "{report}");
    assert_eq!(report.count(HingeOutcome::NotMoved), schedule.steps.len());
    assert_eq!(
        states.0.iter().map(|(_, state)| state.as_str()).next_back(),
        Some("loaded"),
        "{:?}",
        states.0
    );
    assert!(session.now().0 > 50_000_000, "it was waited for somebody");
    assert!(!session.transport().board().core().outputs().main_switch);
}

#[test]
fn s8_who_attends_can_stop_at_every_moment() {
    let (rig, schedule) = job();
    for last in [Moment::Loaded, Moment::Armed, Moment::Running] {
        let mut session = session(&rig, &schedule);
        let stopping = |moment| if moment == last { Wish::Stop } else { Wish::GoOn };
        let (report, states) = run(&mut session, (&rig, &schedule), &BTreeSet::new(), &stopping);
        assert_eq!(report.outcome, Outcome::Stopped, "{report}");
        assert_eq!(states.0.last().map(|(_, state)| state.as_str()), Some("safe"), "{:?}", states.0);
        assert_eq!(session.transport().board().core().state(), State::Safe);
    }
}
