//! Settings that a board keeps: lowered by the host, never raised above what is compiled in (S13), in force once stored.

use crate::a_bench::{Answer, Bench};
use zygote_protocol::{
    Action, CentiCelsius, Command, FaultCode, Kept, Limits, MemoryReport, MemoryState, Milliamps, Millis,
    Refusal, RefusalCode, Reply, Response, RigId, Settings, SettingsReport, State, Step, Turn, program_crc,
};

/// Half of full scale: some 25 °C.
const COUNTS: u16 = 2_048;

impl Bench {
    fn report(&mut self) -> SettingsReport {
        let Ok(Reply::Settings(report)) = self.ask(Command::Settings) else { panic!("no settings") };
        report
    }
}

fn compiled() -> Settings {
    let config = crate::a_board::config(1, 1, 1);
    Settings { ceiling: config.ceiling, shortest_pulse_us: 500, longest_pulse_us: 2_500 }
}

fn lowered() -> Settings {
    Settings {
        ceiling: Limits { max_temperature: CentiCelsius(8_000), ..compiled().ceiling },
        shortest_pulse_us: 1_000,
        longest_pulse_us: 2_000,
    }
}

fn kept(settings: Settings) -> Kept<1, 1> {
    let mut kept = Kept::NOTHING;
    kept.settings = Some(settings);
    kept
}

fn refused(code: RefusalCode, at: u16, expected: i64, got: i64) -> Answer {
    Err(Refusal { code, at, expected, got })
}

/// A program of one servo, uploaded and committed.
fn with_a_servo(bench: &mut Bench) -> Answer {
    let turn = Turn {
        channel: 0,
        from_us: 700,
        to_us: 1_500,
        duration: Millis(900),
        settle: Millis(0),
        current: Milliamps(10),
        hold_current: Milliamps(10),
    };
    let step = Step { hinge: 1, after: heapless::Vec::new(), action: Action::Turn(turn) };
    let steps: heapless::Vec<Step, 4> = std::iter::once(step).collect();
    let crc = program_crc(&steps);
    let rig = RigId::try_from("r").unwrap();
    bench.ask(Command::Upload { run: 1, rig, steps: 1, crc })?;
    bench.ask(Command::Steps { first: 0, steps })?;
    bench.ask(Command::Commit)
}

fn arm(bench: &mut Bench, limits: Limits) -> Answer {
    bench.ask(Command::Arm { rig: RigId::try_from("r").unwrap(), limits, lifetime: Millis(10_000) })
}

#[test]
fn settings_are_in_force_and_answered_only_once_they_are_stored() {
    let mut bench = Bench::new();
    assert_eq!((bench.report().in_force, bench.report().compiled), (compiled(), compiled()));
    let id = bench.send(Command::Configure(lowered()));
    assert!(bench.carry().is_empty(), "not yet");
    assert_eq!(bench.core.to_store(), Some(&kept(lowered())));
    assert_eq!(bench.report().in_force, compiled());
    bench.core.stored(true);
    assert_eq!(bench.core.to_store(), None);
    assert_eq!(bench.carry(), [Response { id, result: Ok(Reply::Done) }]);
    assert_eq!((bench.report().in_force, bench.report().compiled), (lowered(), compiled()));
}

#[test]
fn what_the_board_found_in_its_memory_is_told_and_follows_what_is_stored() {
    let mut bench = Bench::new();
    let told = |bench: &mut Bench| bench.ask(Command::Memory);
    assert_eq!(told(&mut bench), Ok(Reply::Memory(MemoryReport::BLANK)));
    let found = MemoryReport { state: MemoryState::OtherVersion, damaged: 3 };
    bench.core.remember(found);
    assert_eq!(told(&mut bench), Ok(Reply::Memory(found)));
    for (is_stored, state) in [(true, MemoryState::Kept), (false, MemoryState::Unusable)] {
        bench.send(Command::Configure(lowered()));
        bench.carry();
        bench.core.stored(is_stored);
        bench.carry();
        assert_eq!(told(&mut bench), Ok(Reply::Memory(MemoryReport { state, ..found })));
    }
}

#[test]
fn settings_that_cannot_be_stored_change_nothing() {
    let mut bench = Bench::new();
    let id = bench.send(Command::Configure(lowered()));
    bench.carry();
    bench.core.stored(false);
    assert_eq!(bench.carry(), [Response { id, result: refused(RefusalCode::NotStored, 0, 0, 0) }]);
    assert_eq!(bench.report().in_force, compiled());
}

#[test]
fn s13_no_setting_goes_beyond_the_board() {
    let mut bench = Bench::new();
    let hot = Limits { max_temperature: CentiCelsius(12_001), ..compiled().ceiling };
    assert_eq!(
        bench.ask(Command::Configure(Settings { ceiling: hot, ..compiled() })),
        refused(RefusalCode::LimitAboveCeiling, 0, 12_000, 12_001)
    );
    let strong = Limits { supply: Milliamps(1_001), ..compiled().ceiling };
    assert_eq!(
        bench.ask(Command::Configure(Settings { ceiling: strong, ..compiled() })),
        refused(RefusalCode::LimitAboveCeiling, 3, 1_000, 1_001)
    );
    assert_eq!(
        bench.ask(Command::Configure(Settings { longest_pulse_us: 2_501, ..compiled() })),
        refused(RefusalCode::ServoRange, 0, 2_500, 2_501)
    );
    assert_eq!(bench.core.to_store(), None);
    // Once lowered they may be raised again, as far as the board goes.
    for settings in [lowered(), compiled()] {
        bench.send(Command::Configure(settings));
        bench.carry();
        bench.core.stored(true);
        bench.carry();
        assert_eq!(bench.report().in_force, settings);
    }
}

#[test]
fn s13_what_was_stored_by_a_laxer_firmware_is_held_to_this_one() {
    let mut bench = Bench::new();
    let hot = Limits { max_temperature: CentiCelsius(20_000), max_on: Millis(1), ..compiled().ceiling };
    bench.core.restore(kept(Settings { ceiling: hot, ..lowered() }));
    let in_force = bench.report().in_force;
    assert_eq!(in_force.ceiling, Limits { max_on: Millis(1), ..compiled().ceiling });
    assert_eq!((in_force.shortest_pulse_us, in_force.longest_pulse_us), (1_000, 2_000));
}

#[test]
fn s13_lowered_settings_bind_programs_and_arming() {
    let mut bench = Bench::new();
    bench.core.restore(kept(lowered()));
    assert_eq!(with_a_servo(&mut bench), refused(RefusalCode::ServoRange, 0, 1_000, 700));
    bench.core.restore(kept(compiled()));
    assert_eq!(bench.ask(Command::Commit), Ok(Reply::Done));
    bench.core.restore(kept(Settings { shortest_pulse_us: 500, ..lowered() }));
    assert_eq!(
        arm(&mut bench, compiled().ceiling),
        refused(RefusalCode::LimitAboveCeiling, 0, 8_000, 12_000)
    );
    assert_eq!(arm(&mut bench, lowered().ceiling), Ok(Reply::Done));
}

#[test]
fn nothing_is_stored_while_something_is_energised_nor_armed_while_something_is_stored() {
    let mut bench = Bench::new();
    assert_eq!(with_a_servo(&mut bench), Ok(Reply::Done));
    bench.send(Command::Configure(compiled()));
    bench.carry();
    assert_eq!(arm(&mut bench, compiled().ceiling), refused(RefusalCode::Storing, 0, 0, 0));
    assert_eq!(bench.ask(Command::Configure(lowered())), refused(RefusalCode::Storing, 0, 0, 0));
    bench.core.stored(true);
    bench.carry();
    assert_eq!(arm(&mut bench, compiled().ceiling), Ok(Reply::Done));
    assert_eq!(bench.ask(Command::Configure(lowered())), refused(RefusalCode::WrongState, 0, 0, 2));
    assert_eq!(bench.core.to_store(), None);
}

#[test]
fn the_answer_belongs_to_the_session_that_asked() {
    let mut bench = Bench::new();
    bench.send(Command::Configure(lowered()));
    bench.carry();
    bench.open(6);
    bench.core.stored(true);
    assert_eq!(bench.carry(), []);
    assert_eq!(bench.report().in_force, lowered(), "stored all the same");
}

#[test]
fn a_lost_servo_driver_ends_a_run_with_servos_and_no_other() {
    let mut bench = Bench::new();
    bench.tick(COUNTS, true);
    assert_eq!(bench.core.state(), State::Idle, "a rig without servos has no driver");
    with_a_servo(&mut bench).unwrap();
    arm(&mut bench, compiled().ceiling).unwrap();
    bench.ask(Command::Start { run: 1 }).unwrap();
    bench.tick(COUNTS, false);
    assert_eq!(bench.core.state(), State::Running);
    assert!(bench.core.outputs().servos[0].is_some());
    bench.tick(COUNTS, true);
    assert_eq!(bench.core.fault().map(|fault| fault.code), Some(FaultCode::ServosLost));
    assert_eq!(*bench.core.outputs(), zygote_core::Outputs::OFF);
}
