//! One handler a command: the mirror of the table in `zygote_protocol::Command`.

use crate::calibration;
use crate::core::Core;
use crate::io::{Duty, Outputs};
use crate::mode::Mode;
use crate::program::refuse;
use crate::settings::limit_number;
use crate::thermal_guard::ThermalGuard;
use zygote_protocol::{
    Actuator, Calibration, Command, Limits, Micros, Millis, READINGS_PER_REPLY, Reading, Readings, Refusal,
    RefusalCode, Reply, RigId, Settings, State, Status,
};

/// Longest time that an arming may wait for its start.
const MAX_LIFETIME: Millis = Millis(600_000);

type Answer = Result<Reply, Refusal>;

/// Does what a command asks, or refuses it and changes nothing. `None` if the answer has to wait.
pub(crate) fn handle<const H: usize, const S: usize, const R: usize, const STEPS: usize>(
    core: &mut Core<H, S, R, STEPS>,
    now: Micros,
    id: u16,
    command: Command,
) -> Option<Answer> {
    Some(match command {
        Command::Status => Ok(Reply::Status(status(core, now))),
        Command::Progress { first } => Ok(progress(core, first)),
        Command::Upload { run, rig, steps, crc } => upload(core, now, run, rig, steps, crc),
        Command::Steps { first, steps } => core.program.store(first, &steps).map(|()| Reply::Done),
        Command::Commit => commit(core, now),
        Command::Arm { rig, limits, lifetime } => arm(core, now, &rig, limits, lifetime),
        Command::Start { run } => start(core, now, run),
        Command::Disarm => disarm(core, now),
        Command::Clear => clear(core, now),
        Command::LastRun => Ok(Reply::LastRun(core.before.clone())),
        Command::Settings => Ok(core.keeper.report(now, &core.config)),
        Command::Memory => Ok(Reply::Memory(core.keeper.memory())),
        Command::Readings { first } => Ok(readings(core, first)),
        Command::Calibration(actuator) => calibration_of(core, actuator),
        Command::Configure(settings) => return configure(core, id, settings).err().map(Err),
        Command::Calibrate(calibration) => return calibrate(core, id, calibration).err().map(Err),
    })
}

fn wrong_state(expected: State, got: State) -> Refusal {
    refuse(RefusalCode::WrongState, 0, number(expected), number(got))
}

/// The place of a state in [`State`], as it goes over the wire.
fn number(state: State) -> u16 {
    match state {
        State::Idle => 0,
        State::Loaded => 1,
        State::Armed => 2,
        State::Running => 3,
        State::Finished => 4,
        State::Safe => 5,
    }
}

fn status<const H: usize, const S: usize, const R: usize, const STEPS: usize>(
    core: &Core<H, S, R, STEPS>,
    now: Micros,
) -> Status {
    let heaters_on = core.outputs.heaters.iter().filter(|duty| **duty != Duty::OFF).count();
    Status {
        at: now,
        state: core.state(),
        run: core.program.run(),
        fault: core.fault(),
        opened: core.sequencer.opened(),
        heaters_on: crate::program::index(heaters_on),
        main_switch: core.outputs.main_switch,
    }
}

fn progress<const H: usize, const S: usize, const R: usize, const STEPS: usize>(
    core: &Core<H, S, R, STEPS>,
    first: u16,
) -> Reply {
    let states = core.sequencer.states().skip(usize::from(first));
    Reply::Progress { first, steps: states.take(zygote_protocol::PROGRESS_PER_REPLY).collect() }
}

/// As of the latest tick: when the thermistors were read and the power was set. By itself, so that no other command's stack holds it.
#[inline(never)]
fn readings<const H: usize, const S: usize, const R: usize, const STEPS: usize>(
    core: &Core<H, S, R, STEPS>,
    first: u16,
) -> Reply {
    let fitted = usize::from(core.channels().heaters);
    let reading = |(guard, duty): (&ThermalGuard, &Duty)| Reading {
        temperature: guard.believed(),
        duty: duty.per_mille(),
    };
    let channels = core.guards.iter().zip(&core.outputs.heaters).take(fitted).skip(usize::from(first));
    Reply::Readings(Readings {
        at: core.ticked,
        supply: core.supply,
        current: core.current,
        first,
        channels: channels.map(reading).take(READINGS_PER_REPLY).collect(),
    })
}

fn upload<const H: usize, const S: usize, const R: usize, const STEPS: usize>(
    core: &mut Core<H, S, R, STEPS>,
    now: Micros,
    run: u32,
    rig: RigId,
    steps: u16,
    crc: u32,
) -> Answer {
    match core.mode {
        Mode::Idle | Mode::Loaded | Mode::Finished => {}
        Mode::Armed { .. } | Mode::Running(_) | Mode::Safe(_) => {
            return Err(wrong_state(State::Idle, core.state()));
        }
    }
    core.program.upload(run, rig, steps, crc)?;
    core.sequencer.load(&[]);
    core.enter(now, Mode::Idle);
    Ok(Reply::Done)
}

fn commit<const H: usize, const S: usize, const R: usize, const STEPS: usize>(
    core: &mut Core<H, S, R, STEPS>,
    now: Micros,
) -> Answer {
    if !matches!(core.mode, Mode::Idle) {
        return Err(wrong_state(State::Idle, core.state()));
    }
    let channels = core.channels();
    core.program.commit(&core.config, channels, core.keeper.known())?;
    core.sequencer.load(core.program.steps());
    core.enter(now, Mode::Loaded);
    Ok(Reply::Done)
}

fn arm<const H: usize, const S: usize, const R: usize, const STEPS: usize>(
    core: &mut Core<H, S, R, STEPS>,
    now: Micros,
    rig: &RigId,
    limits: Limits,
    lifetime: Millis,
) -> Answer {
    if !matches!(core.mode, Mode::Loaded | Mode::Finished) {
        return Err(wrong_state(State::Loaded, core.state()));
    }
    if core.stop_pressed {
        return Err(refuse(RefusalCode::StopPressed, 0, 0, 1));
    }
    // Writing may halt the processor for a second.
    if core.keeper.is_storing() {
        return Err(refuse(RefusalCode::Storing, 0, 0, 0));
    }
    if rig.as_str() != core.program.rig() {
        return Err(refuse(RefusalCode::RigMismatch, 0, 0, 0));
    }
    if let Some((name, ceiling, got)) = limits.laxer_than(&core.config.ceiling) {
        return Err(refuse(RefusalCode::LimitAboveCeiling, limit_number(name), ceiling, got));
    }
    if lifetime > MAX_LIFETIME {
        return Err(refuse(RefusalCode::LifetimeTooLong, 0, MAX_LIFETIME.0, lifetime.0));
    }
    core.program.check_limits(&limits, &core.config)?;
    calibration::check_all(core.keeper.known(), core.program.steps())?;
    core.restart_guards();
    core.sequencer.load(core.program.steps());
    core.outputs = Outputs { main_switch: true, ..Outputs::OFF };
    core.enter(now, Mode::Armed { until: now.plus(lifetime), lifetime, limits });
    Ok(Reply::Done)
}

fn start<const H: usize, const S: usize, const R: usize, const STEPS: usize>(
    core: &mut Core<H, S, R, STEPS>,
    now: Micros,
    run: u32,
) -> Answer {
    let Mode::Armed { limits, .. } = core.mode else { return Err(wrong_state(State::Armed, core.state())) };
    match core.program.run() {
        Some(ours) if ours == run => {
            core.enter(now, Mode::Running(limits));
            Ok(Reply::Done)
        }
        ours => Err(refuse(RefusalCode::RunMismatch, 0, ours.unwrap_or_default(), run)),
    }
}

fn disarm<const H: usize, const S: usize, const R: usize, const STEPS: usize>(
    core: &mut Core<H, S, R, STEPS>,
    now: Micros,
) -> Answer {
    match core.mode {
        Mode::Armed { .. } | Mode::Running(_) => {
            core.enter(now, Mode::Loaded);
            Ok(Reply::Done)
        }
        Mode::Idle | Mode::Loaded | Mode::Finished | Mode::Safe(_) => {
            Err(wrong_state(State::Armed, core.state()))
        }
    }
}

fn clear<const H: usize, const S: usize, const R: usize, const STEPS: usize>(
    core: &mut Core<H, S, R, STEPS>,
    now: Micros,
) -> Answer {
    if !matches!(core.mode, Mode::Safe(_)) {
        return Err(wrong_state(State::Safe, core.state()));
    }
    if core.stop_pressed {
        return Err(refuse(RefusalCode::StopPressed, 0, 0, 1));
    }
    core.enter(now, Mode::Idle);
    Ok(Reply::Done)
}

/// Nothing may be energised: writing to flash may halt the processor for a second. By itself, as [`readings`].
#[inline(never)]
fn configure<const H: usize, const S: usize, const R: usize, const STEPS: usize>(
    core: &mut Core<H, S, R, STEPS>,
    id: u16,
    settings: Settings,
) -> Result<(), Refusal> {
    if core.mode.is_energised() {
        return Err(wrong_state(State::Idle, core.state()));
    }
    core.keeper.configure(id, settings)
}

#[inline(never)]
fn calibration_of<const H: usize, const S: usize, const R: usize, const STEPS: usize>(
    core: &Core<H, S, R, STEPS>,
    actuator: Actuator,
) -> Answer {
    calibration::check_actuator(actuator, core.channels())?;
    Ok(Reply::Calibration(core.keeper.known().of(actuator)))
}

/// As [`configure`]. By itself, as [`readings`].
#[inline(never)]
fn calibrate<const H: usize, const S: usize, const R: usize, const STEPS: usize>(
    core: &mut Core<H, S, R, STEPS>,
    id: u16,
    calibration: Calibration,
) -> Result<(), Refusal> {
    if core.mode.is_energised() {
        return Err(wrong_state(State::Idle, core.state()));
    }
    let channels = core.channels();
    core.keeper.calibrate(id, calibration, channels)
}
