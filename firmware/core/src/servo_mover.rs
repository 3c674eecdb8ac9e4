//! Turns one servo hinge at constant speed, and holds it at the end.

use crate::io::PulseMicros;
use zygote_protocol::{Micros, Phase, StepState, Turn};

/// One servo at work.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ServoMover {
    spec: Turn,
    since: Micros,
    pulse: PulseMicros,
    arrived: bool,
}

impl ServoMover {
    pub(crate) fn start(spec: Turn, now: Micros) -> Self {
        Self { spec, since: now, pulse: PulseMicros(spec.from_us), arrived: false }
    }

    pub(crate) fn spec(&self) -> &Turn {
        &self.spec
    }

    /// Pulse to send now.
    pub(crate) fn pulse(&self) -> PulseMicros {
        self.pulse
    }

    pub(crate) fn step_state(&self) -> StepState {
        if self.arrived { StepState::Done } else { StepState::Moving }
    }

    pub(crate) fn phase(&self) -> Option<Phase> {
        (!self.arrived).then_some(Phase::Turning { pulse_us: self.pulse.0 })
    }

    pub(crate) fn advance(&mut self, now: Micros) {
        let (elapsed, whole) = (now.since(self.since), self.spec.duration.to_micros());
        self.arrived = elapsed >= whole.saturating_add(self.spec.settle.to_micros());
        self.pulse = PulseMicros(if elapsed >= whole {
            self.spec.to_us
        } else {
            between(self.spec.from_us, self.spec.to_us, elapsed, whole)
        });
    }
}

/// The point after `part` of `whole` on the way from `a` to `b`; `part` is below `whole`.
fn between(a: u16, b: u16, part: u64, whole: u64) -> u16 {
    let sum = u64::from(a) * (whole - part) + u64::from(b) * part;
    u16::try_from(sum / whole).unwrap_or(b)
}

#[cfg(test)]
mod tests {
    use super::*;
    use zygote_protocol::{Milliamps, Millis};

    fn mover(from_us: u16, to_us: u16) -> ServoMover {
        let spec = Turn {
            channel: 0,
            from_us,
            to_us,
            duration: Millis(1_000),
            settle: Millis(100),
            current: Milliamps(1),
            hold_current: Milliamps(1),
        };
        ServoMover::start(spec, Micros(0))
    }

    #[test]
    fn a_servo_goes_evenly_both_ways_and_stays() {
        for (from, middle, to) in [(500, 1_000, 1_500), (1_500, 1_000, 500)] {
            let mut servo = mover(from, to);
            servo.advance(Micros(500_000));
            assert_eq!((servo.pulse(), servo.step_state()), (PulseMicros(middle), StepState::Moving));
            assert_eq!(servo.phase(), Some(Phase::Turning { pulse_us: middle }));
            servo.advance(Micros(1_000_000));
            assert_eq!(
                (servo.pulse(), servo.step_state()),
                (PulseMicros(to), StepState::Moving),
                "it settles"
            );
            servo.advance(Micros(1_100_000));
            assert_eq!((servo.pulse(), servo.step_state()), (PulseMicros(to), StepState::Done));
            servo.advance(Micros(9_000_000));
            assert_eq!((servo.pulse(), servo.phase()), (PulseMicros(to), None));
        }
    }

    #[test]
    fn a_motion_without_duration_is_over_at_once() {
        let mut servo = mover(500, 1_500);
        (servo.spec.duration, servo.spec.settle) = (Millis(0), Millis(0));
        servo.advance(Micros(0));
        assert_eq!((servo.pulse(), servo.step_state()), (PulseMicros(1_500), StepState::Done));
    }
}
