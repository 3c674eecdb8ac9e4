//! What goes wrong in a random trial: nothing, one thing or several, by the clock or in the middle of a motion.

use crate::cause::{Cause, Way, What, When};
use zygote_deployment::{Kind, Schedule};
use zygote_protocol::{Micros, Millis, ResetCause, StepState};
use zygote_sim::plant::{Config, Fault, Hinge};
use zygote_sim::{Chance, Impairment, Stuck};

/// The clock's mishaps happen within this, ms: most runs are under way then.
const WITHIN_MS: usize = 25_000;
/// How long after its beginning a motion is struck, ms.
const INTO_MOTION_MS: usize = 6_000;

/// Nothing in a quarter of the trials, several things in another quarter.
pub(super) fn causes(chance: &mut Chance, schedule: &Schedule, plant: &Config) -> Vec<Cause> {
    let count = match chance.below(8) {
        0 | 1 => 0,
        6 => 2,
        7 => 3,
        _ => 1,
    };
    (0..count).flat_map(|_| cause(chance, schedule, plant)).collect()
}

/// One mishap, with its end where it has one.
fn cause(chance: &mut Chance, schedule: &Schedule, plant: &Config) -> Vec<Cause> {
    let (step, kind, channel) = some_hinge(chance, schedule);
    let (when, into) = if chance.happens(0.5) {
        (When::At(Micros(0)), WITHIN_MS)
    } else {
        (When::Step { step, state: StepState::Moving }, INTO_MOTION_MS)
    };
    let after = millis(chance.below(into));
    let what =
        if chance.happens(0.6) { on_the_rig(chance, kind, channel, plant) } else { on_the_line(chance) };
    let restored = match what {
        What::Break(Fault::SupplyCut | Fault::SupplySag { .. }) => Some(What::Break(Fault::SupplyRestored)),
        What::StopButton(true) => Some(What::StopButton(false)),
        What::Impair(..) => Some(What::Impair(Way::Both, Impairment::NONE)),
        _ => None,
    };
    let mut causes = vec![Cause { when, after, what }];
    if let Some(what) = restored.filter(|_| chance.happens(0.5)) {
        let span = 100 + u32::try_from(chance.below(5_000)).unwrap_or(0);
        causes.push(Cause { when, after: Millis(after.0 + span), what });
    }
    causes
}

/// A step, with its hinge's kind and channel.
fn some_hinge(chance: &mut Chance, schedule: &Schedule) -> (usize, Kind, usize) {
    let step = chance.below(schedule.steps.len());
    schedule
        .steps
        .get(step)
        .map_or((0, Kind::Sma, 0), |found| (step, found.motion.kind(), usize::from(found.channel)))
}

fn on_the_rig(chance: &mut Chance, kind: Kind, channel: usize, plant: &Config) -> What {
    let hinge = match kind {
        Kind::Sma => Hinge::Sma(channel),
        Kind::Servo => Hinge::Servo(channel),
        Kind::Spring => Hinge::Spring(channel),
    };
    let of_all = |chance: &mut Chance| match chance.below(6) {
        4 => What::Hang(if chance.happens(0.5) { Stuck::Tasks } else { Stuck::Everything }),
        0 => What::Break(Fault::SupplyCut),
        1 => What::Break(Fault::SupplySag {
            open_circuit_v: chance.between(2.0, plant.supply.open_circuit_v),
            source_ohm: chance.between(0.05, 1.0),
        }),
        2 => What::StopButton(true),
        3 => What::Reset([ResetCause::Watchdog, ResetCause::Pin, ResetCause::Power][chance.below(3)]),
        _ => What::Break(Fault::Jammed(hinge)),
    };
    if chance.happens(0.4) {
        return of_all(chance);
    }
    match kind {
        Kind::Spring => of_all(chance),
        Kind::Servo => What::Break(Fault::ServoStalled(channel)),
        Kind::Sma => What::Break(match chance.below(8) {
            0 => Fault::ThermistorOpen(channel),
            1 => Fault::ThermistorShorted(channel),
            2 => Fault::ThermistorFrozen(channel),
            3 => Fault::ThermistorLoose(channel),
            4 => Fault::ThermistorDrifting { channel, kelvin_per_s: chance.between(-1.0, 3.0) },
            5 => Fault::HeaterOpen(channel),
            6 => Fault::HeaterShorted { channel, ohm: chance.between(0.5, 4.0) },
            _ => Fault::MosfetStuckOn(channel),
        }),
    }
}

fn on_the_line(chance: &mut Chance) -> What {
    let way = [Way::ToBoard, Way::ToHost, Way::Both][chance.below(3)];
    match chance.below(9) {
        0 => What::Cut(way, None),
        1 => What::Cut(way, Some(millis(100 + chance.below(3_000)))),
        2 => What::Impair(way, impairment(chance, 20.0)),
        3 => What::KillHost,
        4 => What::UserStops,
        5 => What::SecondHost,
        6 => What::Replay,
        7 => What::Garbage(1 + chance.below(5_000)),
        _ => What::StopFrame,
    }
}

/// A line that is bad from the start on, in a quarter of the trials.
pub(super) fn line(chance: &mut Chance) -> Vec<(Way, Impairment)> {
    if !chance.happens(0.25) {
        return Vec::new();
    }
    [Way::ToBoard, Way::ToHost].into_iter().map(|way| (way, impairment(chance, 1.0))).collect()
}

/// Bytes lost and turned up to one in 1,000, times `worse`; chunks late by up to 50 ms, twice or out of turn.
fn impairment(chance: &mut Chance, worse: f64) -> Impairment {
    Impairment {
        delay: millis(chance.below(50)),
        loss: chance.between(0.0, 0.001) * worse,
        flip: chance.between(0.0, 0.001) * worse,
        duplicate: chance.between(0.0, 0.2),
        reorder: chance.between(0.0, 0.2),
    }
}

fn millis(ms: usize) -> Millis {
    Millis(u32::try_from(ms).unwrap_or(u32::MAX))
}
