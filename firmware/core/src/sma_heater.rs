//! Opens one SMA hinge by heat.
//!
//! ```text
//!   start -> Heat --target reached--> Hold --held long enough--> Cool --cool and rested--> Done
//!              |                       |                           the hinge is open from here on
//!              +-- on for too long, no gain: trip (everything off)
//! ```
//!
//! Too hot, bad sensors and heat without heating are the business of `thermal_guard`, which watches in every state.

use crate::io::Duty;
use crate::trip::Trip;
use zygote_protocol::{CentiCelsius, FaultCode, Heat, Micros, Phase, StepState};

/// Full power up to the target, none from this far above it on, proportionally less in between: so the target is
/// passed by any heater that can reach it at all. Narrower, the lag of the thermistor would make it swing.
const BAND: i16 = 400;

#[derive(Debug, Clone, Copy)]
enum State {
    Heat { on: Micros, cold: CentiCelsius },
    Hold { on: Micros, reached: Micros },
    Cool { off: Micros },
    Done,
}

/// One heater at work.
#[derive(Debug, Clone, Copy)]
pub(crate) struct SmaHeater {
    spec: Heat,
    state: State,
    peak: CentiCelsius,
    duty: Duty,
}

impl SmaHeater {
    pub(crate) fn start(spec: Heat, now: Micros, cold: CentiCelsius) -> Self {
        Self { spec, state: State::Heat { on: now, cold }, peak: cold, duty: Duty::OFF }
    }

    pub(crate) fn channel(&self) -> u16 {
        self.spec.channel
    }

    /// Highest temperature seen.
    pub(crate) fn peak(&self) -> CentiCelsius {
        self.peak
    }

    /// Power to apply now.
    pub(crate) fn duty(&self) -> Duty {
        self.duty
    }

    pub(crate) fn step_state(&self) -> StepState {
        match self.state {
            State::Heat { .. } | State::Hold { .. } => StepState::Moving,
            State::Cool { .. } => StepState::Opened,
            State::Done => StepState::Done,
        }
    }

    pub(crate) fn phase(&self, temperature: CentiCelsius) -> Option<Phase> {
        let duty = self.duty.per_mille();
        match self.state {
            State::Heat { .. } => Some(Phase::Heating { temperature, duty }),
            State::Hold { .. } => Some(Phase::Holding { temperature, duty }),
            State::Cool { .. } => Some(Phase::Cooling { temperature }),
            State::Done => None,
        }
    }

    /// Decides the power for this temperature.
    ///
    /// # Errors
    /// On for too long, or no gain.
    pub(crate) fn advance(&mut self, now: Micros, temperature: CentiCelsius) -> Result<(), Trip> {
        self.peak = self.peak.max(temperature);
        if let State::Heat { on, .. } | State::Hold { on, .. } = self.state {
            self.check_on_time(now, on)?;
        }
        if let State::Heat { on, cold } = self.state {
            if temperature >= self.spec.target {
                self.state = State::Hold { on, reached: now };
            } else {
                self.check_gain(now, on, cold, temperature)?;
            }
        }
        if let State::Hold { reached, .. } = self.state
            && now >= reached.plus(self.spec.hold)
        {
            self.state = State::Cool { off: now };
        }
        if let State::Cool { off } = self.state
            && temperature <= self.spec.cool
            && now >= off.plus(self.spec.rest)
        {
            self.state = State::Done;
        }
        self.duty = match self.state {
            State::Heat { .. } | State::Hold { .. } => thermostat(self.spec.target, temperature),
            State::Cool { .. } | State::Done => Duty::OFF,
        };
        Ok(())
    }

    fn check_on_time(&self, now: Micros, on: Micros) -> Result<(), Trip> {
        let most = self.spec.max_on;
        if now < on.plus(most) {
            return Ok(());
        }
        let milliseconds = i64::try_from(now.since(on) / 1000).unwrap_or(i64::MAX);
        Err(Trip::new(FaultCode::OnTooLong, milliseconds, most.0))
    }

    fn check_gain(
        &self,
        now: Micros,
        on: Micros,
        cold: CentiCelsius,
        warm: CentiCelsius,
    ) -> Result<(), Trip> {
        let gain = warm.0.saturating_sub(cold.0);
        if now < on.plus(self.spec.gain_window) || gain >= self.spec.min_gain.0 {
            return Ok(());
        }
        Err(Trip::new(FaultCode::NoGain, gain, self.spec.min_gain.0))
    }
}

/// Proportional control in a band above the target.
fn thermostat(target: CentiCelsius, temperature: CentiCelsius) -> Duty {
    let below = target.0.saturating_add(BAND).saturating_sub(temperature.0).clamp(0, BAND);
    let per_mille = i32::from(below) * 1000 / i32::from(BAND);
    Duty::new(u16::try_from(per_mille).unwrap_or(0))
}

#[cfg(test)]
mod tests {
    use super::*;
    use zygote_protocol::{Milliamps, Millis};

    const SPEC: Heat = Heat {
        channel: 0,
        target: CentiCelsius(9_000),
        hold: Millis(1_000),
        max_on: Millis(10_000),
        max_temperature: CentiCelsius(12_000),
        cool: CentiCelsius(4_500),
        rest: Millis(500),
        min_gain: CentiCelsius(500),
        gain_window: Millis(2_000),
        current: Milliamps(200),
    };
    const COLD: CentiCelsius = CentiCelsius(2_200);

    fn ms(value: u64) -> Micros {
        Micros(value * 1000)
    }

    #[test]
    fn a_hinge_is_heated_held_cooled_and_done() {
        let mut heater = SmaHeater::start(SPEC, ms(0), COLD);
        heater.advance(ms(0), COLD).unwrap();
        assert_eq!(heater.duty(), Duty::FULL);
        heater.advance(ms(1_000), CentiCelsius(9_000)).unwrap();
        assert_eq!((heater.step_state(), heater.duty()), (StepState::Moving, Duty::FULL));
        heater.advance(ms(1_100), CentiCelsius(9_100)).unwrap();
        assert_eq!((heater.step_state(), heater.duty()), (StepState::Moving, Duty::new(750)));
        heater.advance(ms(2_000), CentiCelsius(9_100)).unwrap();
        assert_eq!((heater.step_state(), heater.duty()), (StepState::Opened, Duty::OFF));
        heater.advance(ms(2_100), CentiCelsius(4_000)).unwrap();
        assert_eq!(heater.step_state(), StepState::Opened, "it has not rested");
        heater.advance(ms(2_500), CentiCelsius(4_600)).unwrap();
        assert_eq!(heater.step_state(), StepState::Opened, "it is still warm");
        heater.advance(ms(2_600), CentiCelsius(4_500)).unwrap();
        assert_eq!((heater.step_state(), heater.peak()), (StepState::Done, CentiCelsius(9_100)));
    }

    #[test]
    fn s4_a_heater_that_never_gets_there_trips_on_time() {
        let mut heater = SmaHeater::start(SPEC, ms(0), COLD);
        heater.advance(ms(9_999), CentiCelsius(8_000)).unwrap();
        let trip = heater.advance(ms(10_000), CentiCelsius(8_000)).unwrap_err();
        assert_eq!(trip, Trip::new(FaultCode::OnTooLong, 10_000, 10_000));
    }

    #[test]
    fn s6_a_heater_without_gain_trips_at_the_end_of_the_window() {
        let mut heater = SmaHeater::start(SPEC, ms(0), COLD);
        heater.advance(ms(1_999), CentiCelsius(2_600)).unwrap();
        let trip = heater.advance(ms(2_000), CentiCelsius(2_600)).unwrap_err();
        assert_eq!(trip, Trip::new(FaultCode::NoGain, 400, 500));
    }

    #[test]
    fn power_falls_to_nothing_above_the_band() {
        assert_eq!(thermostat(SPEC.target, CentiCelsius(9_400)), Duty::OFF);
        assert_eq!(thermostat(SPEC.target, CentiCelsius(i16::MAX)), Duty::OFF);
        assert_eq!(thermostat(SPEC.target, CentiCelsius(i16::MIN)), Duty::FULL);
    }
}
