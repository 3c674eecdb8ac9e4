//! Releases one spring hinge: a pulse through its burn wire or latch, then time to open.

use zygote_protocol::{Micros, Phase, Release, StepState};

/// One release at work.
#[derive(Debug, Clone, Copy)]
pub(crate) struct SpringRelease {
    spec: Release,
    since: Micros,
    now: Micros,
}

impl SpringRelease {
    pub(crate) fn start(spec: Release, now: Micros) -> Self {
        Self { spec, since: now, now }
    }

    pub(crate) fn channel(&self) -> u16 {
        self.spec.channel
    }

    /// The burn wire or latch is to be energised now.
    pub(crate) fn energised(&self) -> bool {
        self.now < self.since.plus(self.spec.pulse)
    }

    pub(crate) fn step_state(&self) -> StepState {
        let end = self.since.plus(self.spec.pulse).plus(self.spec.settle);
        if self.now < end { StepState::Moving } else { StepState::Done }
    }

    pub(crate) fn phase(&self) -> Option<Phase> {
        (self.step_state() == StepState::Moving).then_some(Phase::Releasing)
    }

    pub(crate) fn advance(&mut self, now: Micros) {
        self.now = now;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use zygote_protocol::{Milliamps, Millis};

    #[test]
    fn a_spring_is_pulsed_then_given_time() {
        let spec = Release { channel: 0, pulse: Millis(200), settle: Millis(300), current: Milliamps(1) };
        let mut spring = SpringRelease::start(spec, Micros(0));
        assert!(spring.energised());
        spring.advance(Micros(199_999));
        assert!(spring.energised());
        assert_eq!(spring.phase(), Some(Phase::Releasing));
        spring.advance(Micros(200_000));
        assert_eq!((spring.energised(), spring.step_state()), (false, StepState::Moving));
        assert_eq!(spring.phase(), Some(Phase::Releasing), "it opens");
        spring.advance(Micros(500_000));
        assert_eq!((spring.energised(), spring.step_state()), (false, StepState::Done));
        assert_eq!(spring.phase(), None);
    }
}
