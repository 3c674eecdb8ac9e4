//! The program store: steps as they are uploaded, and the checks before they may be armed (S10, S13).
//!
//! ```text
//!   Empty --Upload--> Receiving --all Steps, Commit--> Checked
//!     ^                   |  refused steps change nothing
//!     +------ Upload starts over from any state
//! ```

use crate::calibration;
use crate::config::Config;
use crate::io::Duty;
use heapless::{String, Vec};
use zygote_protocol::{
    Action, CentiCelsius, Channels, Heat, Kept, Limits, Pulse, Refusal, RefusalCode, Step, Turn, program_crc,
};

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum State {
    Empty,
    Receiving,
    Checked,
}

/// At most `STEPS` steps with what was declared about them.
#[derive(Debug)]
pub(crate) struct Program<const STEPS: usize> {
    state: State,
    run: u32,
    rig: String<32>,
    declared: u16,
    crc: u32,
    steps: Vec<Step, STEPS>,
}

/// A refusal in short.
pub(crate) fn refuse(code: RefusalCode, at: u16, expected: impl Into<i64>, got: impl Into<i64>) -> Refusal {
    Refusal { code, at, expected: expected.into(), got: got.into() }
}

/// An index as it goes over the wire; programs have fewer than 65,536 steps.
pub(crate) fn index(value: usize) -> u16 {
    u16::try_from(value).unwrap_or(u16::MAX)
}

impl<const STEPS: usize> Program<STEPS> {
    pub(crate) const fn new() -> Self {
        Self { state: State::Empty, run: 0, rig: String::new(), declared: 0, crc: 0, steps: Vec::new() }
    }

    /// The steps, once they are checked.
    pub(crate) fn steps(&self) -> &[Step] {
        if self.state == State::Checked { &self.steps } else { &[] }
    }

    /// The run, where there is a program or one under way.
    pub(crate) fn run(&self) -> Option<u32> {
        (self.state != State::Empty).then_some(self.run)
    }

    pub(crate) fn rig(&self) -> &str {
        &self.rig
    }

    /// Forgets everything and awaits steps.
    pub(crate) fn upload(&mut self, run: u32, rig: String<32>, steps: u16, crc: u32) -> Result<(), Refusal> {
        if steps == 0 {
            return Err(refuse(RefusalCode::ProgramEmpty, 0, 1, 0));
        }
        if usize::from(steps) > STEPS {
            return Err(refuse(RefusalCode::TooManySteps, 0, index(STEPS), steps));
        }
        // In place: a second program would lie on the stack for a moment.
        let Self { state, run: our_run, rig: our_rig, declared, crc: our_crc, steps: stored } = self;
        (*state, *our_run, *our_rig, *declared, *our_crc) = (State::Receiving, run, rig, steps, crc);
        stored.clear();
        Ok(())
    }

    /// Stores the next steps.
    pub(crate) fn store(&mut self, first: u16, steps: &[Step]) -> Result<(), Refusal> {
        if self.state != State::Receiving {
            return Err(refuse(RefusalCode::NoUpload, first, 0, 0));
        }
        let next = index(self.steps.len());
        if first != next {
            return Err(refuse(RefusalCode::StepsOutOfSequence, first, next, first));
        }
        let total = self.steps.len() + steps.len();
        if total > usize::from(self.declared) {
            return Err(refuse(RefusalCode::TooManySteps, first, self.declared, index(total)));
        }
        self.steps
            .extend_from_slice(steps)
            .map_err(|_| refuse(RefusalCode::TooManySteps, first, index(STEPS), index(total)))
    }

    /// Checks the whole program against the board and what was measured at it.
    pub(crate) fn commit<const H: usize, const S: usize>(
        &mut self,
        config: &Config,
        channels: Channels,
        known: &Kept<H, S>,
    ) -> Result<(), Refusal> {
        if self.state != State::Receiving {
            return Err(refuse(RefusalCode::NoUpload, 0, 0, 0));
        }
        let stored = index(self.steps.len());
        if stored != self.declared {
            return Err(refuse(RefusalCode::ProgramIncomplete, stored, self.declared, stored));
        }
        let crc = program_crc(&self.steps);
        if crc != self.crc {
            return Err(refuse(RefusalCode::ProgramChecksum, 0, self.crc, crc));
        }
        for (at, step) in (0..).zip(&self.steps) {
            check_order(at, step)?;
            self.check_unique(at, step)?;
            check_channel(at, step, channels)?;
            check_motion(at, step, &config.ceiling, config)?;
            calibration::check(known, at, step)?;
        }
        self.state = State::Checked;
        Ok(())
    }

    /// Checks the steps against the limits that a session asks for.
    pub(crate) fn check_limits(&self, limits: &Limits, config: &Config) -> Result<(), Refusal> {
        (0..).zip(&self.steps).try_for_each(|(at, step)| check_motion(at, step, limits, config))
    }

    /// No other step before this one moves the same hinge or drives the same channel.
    fn check_unique(&self, at: u16, step: &Step) -> Result<(), Refusal> {
        for earlier in self.steps.iter().take(usize::from(at)) {
            if earlier.hinge == step.hinge {
                return Err(refuse(RefusalCode::HingeTaken, at, step.hinge, step.hinge));
            }
            if output(&earlier.action) == output(&step.action) {
                return Err(refuse(
                    RefusalCode::ChannelTaken,
                    at,
                    output(&step.action).1,
                    output(&step.action).1,
                ));
            }
        }
        Ok(())
    }
}

/// Kind and channel: what two steps can't share.
fn output(action: &Action) -> (u8, u16) {
    match action {
        Action::Heat(Heat { channel, .. }) | Action::Pulse(Pulse { channel, .. }) => (0, *channel),
        Action::Turn(turn) => (1, turn.channel),
        Action::Release(release) => (2, release.channel),
    }
}

fn check_order(at: u16, step: &Step) -> Result<(), Refusal> {
    match step.after.iter().find(|before| **before >= at) {
        Some(&late) => Err(refuse(RefusalCode::OrderViolated, at, i64::from(at) - 1, late)),
        None => Ok(()),
    }
}

fn check_channel(at: u16, step: &Step, channels: Channels) -> Result<(), Refusal> {
    let (count, channel) = match step.action {
        Action::Heat(Heat { channel, .. }) | Action::Pulse(Pulse { channel, .. }) => {
            (channels.heaters, channel)
        }
        Action::Turn(turn) => (channels.servos, turn.channel),
        Action::Release(release) => (channels.springs, release.channel),
    };
    if channel < count {
        Ok(())
    } else {
        Err(refuse(RefusalCode::UnknownChannel, at, i64::from(count) - 1, channel))
    }
}

fn check_motion(at: u16, step: &Step, limits: &Limits, config: &Config) -> Result<(), Refusal> {
    let current = step.action.current();
    if current > limits.supply {
        return Err(refuse(RefusalCode::StepOverCurrent, at, limits.supply.0, current.0));
    }
    match &step.action {
        Action::Heat(heat) => check_heat(at, heat, limits),
        Action::Pulse(pulse) => check_pulse(at, pulse, limits),
        Action::Turn(turn) => check_turn(at, turn, config),
        Action::Release(release) if release.pulse > limits.max_on => {
            Err(refuse(RefusalCode::StepOverOnTime, at, limits.max_on.0, release.pulse.0))
        }
        Action::Release(_) => Ok(()),
    }
}

fn check_heat(at: u16, heat: &Heat, limits: &Limits) -> Result<(), Refusal> {
    let over =
        |most: CentiCelsius, got: CentiCelsius| refuse(RefusalCode::StepOverTemperature, at, most.0, got.0);
    if heat.max_temperature > limits.max_temperature {
        return Err(over(limits.max_temperature, heat.max_temperature));
    }
    if heat.target >= heat.max_temperature {
        return Err(over(heat.max_temperature, heat.target));
    }
    if heat.cool >= heat.target {
        return Err(over(heat.target, heat.cool));
    }
    if heat.max_on > limits.max_on {
        return Err(refuse(RefusalCode::StepOverOnTime, at, limits.max_on.0, heat.max_on.0));
    }
    if heat.hold >= heat.max_on {
        return Err(refuse(RefusalCode::StepOverOnTime, at, heat.max_on.0, heat.hold.0));
    }
    if heat.gain_window > heat.max_on {
        return Err(refuse(RefusalCode::StepOverOnTime, at, heat.max_on.0, heat.gain_window.0));
    }
    if heat.rest < limits.min_rest {
        return Err(refuse(RefusalCode::StepOverOnTime, at, limits.min_rest.0, heat.rest.0));
    }
    // A gain of nothing would switch the watch off.
    if heat.min_gain.0 <= 0 {
        return Err(refuse(RefusalCode::StepOverTemperature, at, 1, heat.min_gain.0));
    }
    Ok(())
}

fn check_pulse(at: u16, pulse: &Pulse, limits: &Limits) -> Result<(), Refusal> {
    let nearest = pulse.duty.clamp(1, Duty::FULL.per_mille());
    if pulse.duty != nearest {
        return Err(refuse(RefusalCode::PulseDuty, at, nearest, pulse.duty));
    }
    check_heat(at, &pulse.heat(), limits)
}

fn check_turn(at: u16, turn: &Turn, config: &Config) -> Result<(), Refusal> {
    let (least, most) = (*config.servo_pulse_us.start(), *config.servo_pulse_us.end());
    for pulse in [turn.from_us, turn.to_us] {
        let nearest = pulse.min(most).max(least);
        if pulse != nearest {
            return Err(refuse(RefusalCode::ServoRange, at, nearest, pulse));
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use zygote_protocol::{Milliamps, Millis, Release};

    const LIMITS: Limits = Limits {
        max_temperature: CentiCelsius(12_000),
        max_on: Millis(20_000),
        min_rest: Millis(500),
        supply: Milliamps(1_000),
        link_timeout: Millis(1_000),
    };
    const GOOD: Heat = Heat {
        channel: 0,
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

    #[test]
    fn a_refused_time_is_told_with_what_it_was_held_against() {
        assert_eq!(check_heat(3, &GOOD, &LIMITS), Ok(()));
        let cases = [
            (Heat { max_on: Millis(20_001), ..GOOD }, 20_000, 20_001),
            (Heat { hold: Millis(15_000), ..GOOD }, 15_000, 15_000),
            (Heat { gain_window: Millis(15_001), ..GOOD }, 15_000, 15_001),
            (Heat { rest: Millis(499), ..GOOD }, 500, 499),
        ];
        for (heat, expected, got) in cases {
            let refusal = refuse(RefusalCode::StepOverOnTime, 3, expected, got);
            assert_eq!(check_heat(3, &heat, &LIMITS), Err(refusal));
        }
    }

    const CHANNELS: Channels = Channels { heaters: 4, servos: 3, springs: 2 };

    fn config() -> Config {
        let identity = zygote_protocol::Identity {
            boot: 0,
            firmware: String::new(),
            git: String::new(),
            board: String::new(),
            unique_id: [0; 12],
            reset: zygote_protocol::ResetCause::Power,
        };
        let (channels, thermistor) = (CHANNELS, crate::NTC_10K);
        Config { identity, ceiling: LIMITS, channels, thermistor, servo_pulse_us: 500..=2_500 }
    }

    fn turn(channel: u16, from_us: u16, to_us: u16) -> Turn {
        let (duration, settle) = (Millis(1_000), Millis(100));
        Turn {
            channel,
            from_us,
            to_us,
            duration,
            settle,
            current: Milliamps(300),
            hold_current: Milliamps(10),
        }
    }

    fn release(channel: u16, pulse: Millis) -> Release {
        Release { channel, pulse, settle: Millis(100), current: Milliamps(1_000) }
    }

    fn step(after: &[u16], action: Action) -> Step {
        Step { hinge: 0, after: after.iter().copied().collect(), action }
    }

    #[test]
    fn a_program_that_fills_the_store_is_taken_and_one_step_more_is_refused() {
        let mut program = Program::<4>::new();
        assert_eq!(program.upload(1, String::new(), 4, 0), Ok(()));
        assert_eq!(program.upload(1, String::new(), 5, 0), Err(refuse(RefusalCode::TooManySteps, 0, 4, 5)));
    }

    #[test]
    fn s4_the_largest_values_that_a_limit_allows_are_allowed() {
        let edges = [
            Heat { max_on: LIMITS.max_on, ..GOOD },
            Heat { gain_window: GOOD.max_on, ..GOOD },
            Heat { max_temperature: LIMITS.max_temperature, ..GOOD },
            Heat { rest: LIMITS.min_rest, ..GOOD },
        ];
        for heat in edges {
            assert_eq!(check_heat(0, &heat, &LIMITS), Ok(()), "{heat:?}");
        }
    }

    #[test]
    fn s7_a_step_may_draw_all_that_the_supply_gives_and_no_more() {
        let draws =
            |current| check_motion(2, &step(&[], Action::Heat(Heat { current, ..GOOD })), &LIMITS, &config());
        assert_eq!(draws(Milliamps(1_000)), Ok(()));
        assert_eq!(draws(Milliamps(1_001)), Err(refuse(RefusalCode::StepOverCurrent, 2, 1_000, 1_001)));
    }

    #[test]
    fn s4_a_spring_is_pulsed_for_as_long_as_a_heater_may_be_on_and_no_longer() {
        let pulsed =
            |pulse| check_motion(2, &step(&[], Action::Release(release(0, pulse))), &LIMITS, &config());
        assert_eq!(pulsed(Millis(20_000)), Ok(()));
        assert_eq!(pulsed(Millis(20_001)), Err(refuse(RefusalCode::StepOverOnTime, 2, 20_000, 20_001)));
    }

    #[test]
    fn s13_a_servo_pulse_outside_what_the_board_sends_is_refused_with_the_nearest_inside() {
        let check = |from_us, to_us| {
            check_motion(2, &step(&[], Action::Turn(turn(0, from_us, to_us))), &LIMITS, &config())
        };
        assert_eq!((check(500, 2_500), check(2_500, 500)), (Ok(()), Ok(())));
        for (pulse, nearest) in [(499, 500), (0, 500), (2_501, 2_500), (u16::MAX, 2_500)] {
            let refusal = Err(refuse(RefusalCode::ServoRange, 2, nearest, pulse));
            assert_eq!((check(pulse, 1_000), check(1_000, pulse)), (refusal, refusal), "{pulse}");
        }
    }

    #[test]
    fn s10_a_step_waits_for_earlier_ones_only_and_is_told_the_latest_that_it_may_wait_for() {
        let check = |after: &[u16]| check_order(3, &step(after, Action::Heat(GOOD)));
        assert_eq!(check(&[0, 2]), Ok(()));
        assert_eq!(check(&[0, 3]), Err(refuse(RefusalCode::OrderViolated, 3, 2, 3)));
        assert_eq!(check(&[9, 0]), Err(refuse(RefusalCode::OrderViolated, 3, 2, 9)));
    }

    #[test]
    fn s13_a_channel_past_the_last_one_fitted_is_refused_with_the_last_one() {
        type Make = fn(u16) -> Action;
        let kinds: [(Make, u16); 3] = [
            (|channel| Action::Heat(Heat { channel, ..GOOD }), CHANNELS.heaters),
            (|channel| Action::Turn(turn(channel, 500, 500)), CHANNELS.servos),
            (|channel| Action::Release(release(channel, Millis(1))), CHANNELS.springs),
        ];
        for (action, count) in kinds {
            assert_eq!(check_channel(1, &step(&[], action(count - 1)), CHANNELS), Ok(()));
            let refusal = refuse(RefusalCode::UnknownChannel, 1, count - 1, count);
            assert_eq!(check_channel(1, &step(&[], action(count)), CHANNELS), Err(refusal));
        }
    }
}
