//! Steps against a temperature that the test says: order, currents, events, and what is told of them.

use super::*;
use crate::io::{Duty, PulseMicros};
use zygote_protocol::{Heat, Millis, Release, Turn};

/// Every output is the last of three, so that one on another channel is seen.
const CHANNEL: u16 = 2;
const COLD: CentiCelsius = CentiCelsius(2_200);
const PLENTY: Milliamps = Milliamps(10_000);

/// Opens after 1 s at 95 °C, done at 45 °C and after 500 ms.
const HEAT: Heat = Heat {
    channel: CHANNEL,
    target: CentiCelsius(9_500),
    hold: Millis(1_000),
    max_on: Millis(15_000),
    max_temperature: CentiCelsius(12_000),
    cool: CentiCelsius(4_500),
    rest: Millis(500),
    min_gain: CentiCelsius(500),
    gain_window: Millis(3_000),
    current: Milliamps(200),
};

fn heat(after: &[u16]) -> Step {
    Step { hinge: 0, after: after.iter().copied().collect(), action: Action::Heat(HEAT) }
}

/// 1 s and 100 ms to settle.
fn turn(after: &[u16], hold_current: Milliamps) -> Step {
    let turn = Turn {
        channel: CHANNEL,
        from_us: 500,
        to_us: 1_500,
        duration: Millis(1_000),
        settle: Millis(100),
        current: Milliamps(300),
        hold_current,
    };
    Step { hinge: 1, after: after.iter().copied().collect(), action: Action::Turn(turn) }
}

/// A pulse of 200 ms and 300 ms to open.
fn release(after: &[u16]) -> Step {
    let release =
        Release { channel: CHANNEL, pulse: Millis(200), settle: Millis(300), current: Milliamps(1_000) };
    Step { hinge: 2, after: after.iter().copied().collect(), action: Action::Release(release) }
}

struct Bench<'a> {
    sequencer: Sequencer<4>,
    steps: &'a [Step],
    supply: Milliamps,
    events: EventQueue,
    outputs: Outputs<3, 3, 3>,
}

impl<'a> Bench<'a> {
    fn new(steps: &'a [Step], supply: Milliamps) -> Self {
        let mut sequencer = Sequencer::new();
        sequencer.load(steps);
        Self { sequencer, steps, supply, events: EventQueue::new(), outputs: Outputs::OFF }
    }

    /// One tick, at this time and temperature.
    fn tick(&mut self, ms: u64, celsius: CentiCelsius) {
        self.outputs = Outputs::OFF;
        let instant =
            Instant { now: Micros(ms * 1000), supply: self.supply, temperature: &|_| Some(celsius) };
        self.sequencer.advance(self.steps, &instant, &mut self.events, &mut self.outputs).unwrap();
    }

    fn states(&self) -> Vec<StepState, 4> {
        self.sequencer.states().collect()
    }

    fn motions(&self, celsius: CentiCelsius) -> Vec<MotionReport, TELEMETRY_MOTIONS> {
        let instant = Instant { now: Micros(0), supply: self.supply, temperature: &|_| Some(celsius) };
        self.sequencer.motions(&instant)
    }

    fn told(&mut self) -> Vec<(u64, EventKind), 16> {
        core::iter::from_fn(|| self.events.pop()).map(|event| (event.at.0 / 1000, event.kind)).collect()
    }
}

#[test]
fn a_hinge_that_is_heated_starts_opens_and_is_done_once_each_with_its_peak() {
    let steps = [heat(&[])];
    let mut bench = Bench::new(&steps, PLENTY);
    for (ms, celsius) in [
        (0, 2_200),
        (5, 2_300),
        (1_000, 9_500),
        (1_500, 9_600),
        (2_000, 9_550),
        (2_400, 5_000),
        (2_500, 4_500),
    ] {
        bench.tick(ms, CentiCelsius(celsius));
    }
    bench.tick(2_505, COLD);
    let peak = Some(CentiCelsius(9_600));
    assert_eq!(
        bench.told(),
        [
            (0, EventKind::StepStarted { step: 0 }),
            (2_000, EventKind::StepOpened { step: 0 }),
            (2_500, EventKind::StepDone { step: 0, peak })
        ]
    );
    assert_eq!((bench.sequencer.opened(), bench.sequencer.is_finished()), (1, true));
    assert!(matches!(bench.sequencer.slots.first(), Some(Slot::Ended(StepState::Done))));
}

#[test]
fn a_servo_holds_its_end_once_it_is_done_and_a_spring_is_off_after_its_pulse() {
    let steps = [turn(&[], Milliamps(10)), release(&[])];
    let mut bench = Bench::new(&steps, PLENTY);
    bench.tick(0, COLD);
    let first = (bench.outputs.servos, bench.outputs.springs);
    assert_eq!(first, ([None, None, Some(PulseMicros(500))], [false, false, true]));
    bench.tick(500, COLD);
    let middle = (bench.outputs.servos, bench.outputs.springs);
    assert_eq!(middle, ([None, None, Some(PulseMicros(1_000))], [false; 3]));
    bench.tick(1_100, COLD);
    bench.tick(9_000, COLD);
    assert_eq!(bench.outputs.servos, [None, None, Some(PulseMicros(1_500))]);
    assert_eq!(bench.outputs.heaters, [Duty::OFF; 3]);
    assert_eq!(
        bench.told(),
        [
            (0, EventKind::StepStarted { step: 0 }),
            (0, EventKind::StepStarted { step: 1 }),
            (500, EventKind::StepOpened { step: 1 }),
            (500, EventKind::StepDone { step: 1, peak: None }),
            (1_100, EventKind::StepOpened { step: 0 }),
            (1_100, EventKind::StepDone { step: 0, peak: None })
        ]
    );
}

#[test]
fn steps_under_way_are_told_those_that_move_before_those_that_cool() {
    let steps = [heat(&[]), turn(&[0], Milliamps(10)), release(&[0]), heat(&[1, 2])];
    let mut bench = Bench::new(&steps, PLENTY);
    let heating = |ms: u64| CentiCelsius(i16::try_from(2_200 + ms).unwrap());
    bench.tick(0, COLD);
    bench.tick(5, heating(5));
    let temperature = heating(5);
    let told = [MotionReport { step: 0, phase: Phase::Heating { temperature, duty: 1_000 } }];
    assert_eq!(bench.motions(temperature), told);
    assert_eq!(bench.outputs.heaters, [Duty::OFF, Duty::OFF, Duty::FULL]);
    bench.tick(1_000, CentiCelsius(9_500));
    bench.tick(2_000, CentiCelsius(9_600));
    let temperature = CentiCelsius(9_600);
    assert_eq!(
        bench.motions(temperature),
        [
            MotionReport { step: 1, phase: Phase::Turning { pulse_us: 500 } },
            MotionReport { step: 2, phase: Phase::Releasing },
            MotionReport { step: 0, phase: Phase::Cooling { temperature } }
        ]
    );
    assert_eq!(bench.states(), [StepState::Opened, StepState::Moving, StepState::Moving, StepState::Waiting]);
    assert_eq!((bench.sequencer.opened(), bench.sequencer.is_finished()), (1, false));
}

#[test]
fn s7_a_spring_counts_against_the_supply_while_it_is_pulsed_and_not_while_it_opens() {
    let steps = [release(&[]), heat(&[])];
    let mut bench = Bench::new(&steps, Milliamps(1_199));
    bench.tick(0, COLD);
    bench.tick(199, COLD);
    assert_eq!(bench.states(), [StepState::Moving, StepState::Waiting]);
    bench.tick(200, COLD);
    assert_eq!(bench.states(), [StepState::Moving, StepState::Moving]);
    let mut bench = Bench::new(&steps, Milliamps(1_200));
    bench.tick(0, COLD);
    assert_eq!(bench.states(), [StepState::Moving, StepState::Moving], "both together fit to the milliamp");
}

#[test]
fn s7_a_servo_that_holds_counts_against_the_supply_with_its_holding_current() {
    for (hold, second) in [(801, StepState::Waiting), (800, StepState::Moving)] {
        let steps = [turn(&[], Milliamps(hold)), heat(&[0])];
        let mut bench = Bench::new(&steps, Milliamps(1_000));
        bench.tick(0, COLD);
        bench.tick(1_100, COLD);
        assert_eq!(bench.states(), [StepState::Done, second], "{hold} mA");
    }
}

#[test]
fn a_motion_starts_only_when_the_events_of_all_that_are_under_way_still_fit() {
    let steps = [heat(&[]), heat(&[]), heat(&[])];
    // Three for each motion; one is gone once the first has started.
    for (room, moving) in [(2, 0), (3, 1), (6, 1), (7, 2), (10, 2), (11, 3)] {
        let mut bench = Bench::new(&steps, PLENTY);
        while bench.events.room() > room {
            bench.events.push(Event { at: Micros(0), kind: EventKind::StepStarted { step: 9 } });
        }
        bench.tick(0, COLD);
        let started = bench.states().iter().filter(|state| **state == StepState::Moving).count();
        assert_eq!(started, moving, "room for {room} events");
    }
}

#[test]
fn a_servo_that_holds_needs_no_room_for_events() {
    let steps = [turn(&[], Milliamps(10)), heat(&[0])];
    let mut bench = Bench::new(&steps, PLENTY);
    bench.tick(0, COLD);
    bench.tick(1_000, COLD);
    while bench.events.room() > 5 {
        bench.events.push(Event { at: Micros(0), kind: EventKind::StepStarted { step: 9 } });
    }
    // Two of the five go to the servo, which opens and is done: three are left for the heater.
    bench.tick(1_100, COLD);
    assert_eq!(bench.states(), [StepState::Done, StepState::Moving]);
}
