//! Opens one SMA hinge by heat, or heats it for a while.
//!
//! ```text
//!   start -> Heat --target reached--> Hold --held long enough--> Cool --cool and rested--> Done
//!              |                       |                          ^ the hinge is open from here on
//!              |                       |                          |
//!              +--- a pulse: target reached, or its time over ----+
//!              +-- on for too long, gain or sensor lost: trip (everything off)
//! ```
//!
//! A pulse is heat of constant power that isn't held and that ends with its time; all else that guards heat guards it as well.
//!
//! A reading is believed only as long as it follows the power (S5, S6). One that stands still is put to the test: the heater goes off,
//! and a live thermistor must show it. One that doesn't rise, or falls, while the heater is on has lost the hinge.
//!
//! Too hot, open, shorted and jumping sensors, and heat without heating are the business of `thermal_guard`, which watches in every
//! state.

use crate::io::Duty;
use crate::trip::Trip;
use zygote_protocol::{CentiCelsius, FaultCode, Heat, Micros, Millis, Phase, Pulse, StepState};

/// Full power up to the target, none from this far above it on, proportionally less in between: so the target is
/// passed by any heater that can reach it at all. Narrower, the lag of the thermistor would make it swing.
const BAND: i16 = 400;
/// A reading that is the same to the bit for so long while the heater is on is put to the test. The fastest of our hinges
/// warms by some 10 K in that time.
const STILL: Millis = Millis(500);
/// A hinge that was above ambient cools by more than a count of the converter in so long, seen through the slowest thermistor.
const TEST: Millis = Millis(1_000);
/// After the first gain window the foil may be transforming, which takes up heat: a quarter of the first gain will do.
const LATER_SHARE: i16 = 4;
/// While the heater is on, a reading so far below its highest has come off the hinge.
const FALL: i16 = 500;
/// While it holds, a reading so far below the target.
const SAG: i16 = 1_000;
/// In so long an opened hinge cools by at least so much, until it is cool. The slowest of our hinges does that as long as the air is
/// 2 K below the temperature at which it counts as cool.
const COOLING: (Millis, i16) = (Millis(10_000), 100);

#[derive(Debug, Clone, Copy)]
enum State {
    Heat { on: Micros, window: Window },
    Hold { on: Micros, reached: Micros },
    Cool { off: Micros, window: Window },
    Done,
}

/// A time in which heating must raise the temperature by this much, or cooling lower it.
#[derive(Debug, Clone, Copy)]
struct Window {
    since: Micros,
    from: CentiCelsius,
    gain: i16,
    /// Highest reading since heating began, or since the latest test of a still one.
    top: CentiCelsius,
}

/// A reading that stands still.
#[derive(Debug, Clone, Copy)]
struct Still {
    reading: CentiCelsius,
    /// For as long as the heater was on.
    since: Micros,
    /// The heater was turned off for the sake of it.
    tested: Option<Micros>,
}

/// What decides the power.
#[derive(Debug, Clone, Copy)]
enum Power {
    /// The distance to the target.
    Thermostat,
    /// The host: a pulse.
    Constant(Duty),
}

/// One heater at work.
#[derive(Debug, Clone, Copy)]
pub(crate) struct SmaHeater {
    spec: Heat,
    power: Power,
    state: State,
    still: Still,
    peak: CentiCelsius,
    duty: Duty,
}

impl SmaHeater {
    pub(crate) fn start(spec: Heat, now: Micros, cold: CentiCelsius) -> Self {
        let window = Window { since: now, from: cold, gain: spec.min_gain.0, top: cold };
        let still = Still { reading: cold, since: now, tested: None };
        let state = State::Heat { on: now, window };
        Self { spec, power: Power::Thermostat, state, still, peak: cold, duty: Duty::OFF }
    }

    pub(crate) fn pulse(pulse: Pulse, now: Micros, cold: CentiCelsius) -> Self {
        Self { power: Power::Constant(Duty::new(pulse.duty)), ..Self::start(pulse.heat(), now, cold) }
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
    /// On for too long, no gain, no cooling, or a reading that doesn't follow the power.
    pub(crate) fn advance(&mut self, now: Micros, temperature: CentiCelsius) -> Result<(), Trip> {
        self.peak = self.peak.max(temperature);
        if let State::Heat { on, .. } | State::Hold { on, .. } = self.state {
            self.check_on_time(now, on)?;
            self.check_still(now, temperature)?;
        }
        if let State::Heat { on, window } = self.state {
            let reached = temperature >= self.spec.target;
            let window = if reached { window } else { self.check_gain(now, window, temperature)? };
            self.state = match self.power {
                Power::Thermostat if reached => State::Hold { on, reached: now },
                Power::Constant(_) if reached || now >= on.plus(self.spec.max_on) => {
                    cooling(now, temperature)
                }
                Power::Thermostat | Power::Constant(_) => State::Heat { on, window },
            };
        }
        if let State::Hold { .. } = self.state {
            self.check_sag(temperature)?;
        }
        if let State::Hold { reached, .. } = self.state
            && now >= reached.plus(self.spec.hold)
        {
            self.state = cooling(now, temperature);
        }
        if let State::Cool { off, window } = self.state {
            self.state = if temperature > self.spec.cool {
                State::Cool { off, window: check_cooling(now, window, temperature)? }
            } else if now >= off.plus(self.spec.rest) {
                State::Done
            } else {
                self.state
            };
        }
        self.duty = match self.state {
            State::Heat { .. } | State::Hold { .. } if self.still.tested.is_some() => Duty::OFF,
            State::Heat { .. } | State::Hold { .. } => match self.power {
                Power::Thermostat => thermostat(self.spec.target, temperature),
                Power::Constant(duty) => duty,
            },
            State::Cool { .. } | State::Done => Duty::OFF,
        };
        Ok(())
    }

    /// A pulse ends with its time instead.
    fn check_on_time(&self, now: Micros, on: Micros) -> Result<(), Trip> {
        let most = self.spec.max_on;
        match self.power {
            Power::Thermostat if now >= on.plus(most) => {
                let milliseconds = i64::try_from(now.since(on) / 1000).unwrap_or(i64::MAX);
                Err(Trip::new(FaultCode::OnTooLong, milliseconds, most.0))
            }
            Power::Thermostat | Power::Constant(_) => Ok(()),
        }
    }

    /// Puts a reading that stands still to the test, and ends the test once it moves.
    fn check_still(&mut self, now: Micros, temperature: CentiCelsius) -> Result<(), Trip> {
        if temperature != self.still.reading {
            self.still = Still { reading: temperature, since: now, tested: None };
        } else if let Some(off) = self.still.tested {
            if now >= off.plus(TEST) {
                return Err(Trip::new(
                    FaultCode::SensorFrozen,
                    temperature.0,
                    STILL.0.saturating_add(TEST.0),
                ));
            }
        } else if self.duty == Duty::OFF {
            self.still.since = now;
        } else if now >= self.still.since.plus(STILL) {
            self.still.tested = Some(now);
        }
        Ok(())
    }

    /// Holds the reading against what heating must have done to it, and opens the next window when this one is over. A test of a still
    /// reading opens a new window: the heater was off.
    fn check_gain(&self, now: Micros, window: Window, warm: CentiCelsius) -> Result<Window, Trip> {
        let next = |gain, top| Window { since: now, from: warm, gain, top };
        if self.still.tested.is_some() {
            return Ok(next(window.gain, warm));
        }
        let top = window.top.max(warm);
        let fall = top.0.saturating_sub(warm.0);
        if fall > FALL {
            return Err(Trip::new(FaultCode::NoGain, fall.saturating_neg(), window.gain));
        }
        if now < window.since.plus(self.spec.gain_window) {
            return Ok(Window { top, ..window });
        }
        let gain = warm.0.saturating_sub(window.from.0);
        if gain < window.gain {
            return Err(Trip::new(FaultCode::NoGain, gain, window.gain));
        }
        let left = self.spec.target.0.saturating_sub(warm.0);
        Ok(next((self.spec.min_gain.0 / LATER_SHARE).min(left), top))
    }

    /// A hinge that is held doesn't get cold.
    fn check_sag(&self, temperature: CentiCelsius) -> Result<(), Trip> {
        let sag = self.spec.target.0.saturating_sub(temperature.0);
        if sag > SAG { Err(Trip::new(FaultCode::NoGain, sag.saturating_neg(), 0)) } else { Ok(()) }
    }
}

/// The heater goes off.
fn cooling(now: Micros, temperature: CentiCelsius) -> State {
    State::Cool {
        off: now,
        window: Window { since: now, from: temperature, gain: COOLING.1, top: temperature },
    }
}

/// Holds an opened hinge against how it must cool, and opens the next window when this one is over.
fn check_cooling(now: Micros, window: Window, temperature: CentiCelsius) -> Result<Window, Trip> {
    if now < window.since.plus(COOLING.0) {
        return Ok(window);
    }
    let fall = window.from.0.saturating_sub(temperature.0);
    if fall < window.gain {
        return Err(Trip::new(FaultCode::NoCooling, fall, window.gain));
    }
    Ok(Window { since: now, from: temperature, ..window })
}

/// Proportional control in a band above the target.
fn thermostat(target: CentiCelsius, temperature: CentiCelsius) -> Duty {
    let below = target.0.saturating_add(BAND).saturating_sub(temperature.0).clamp(0, BAND);
    let per_mille = i32::from(below) * 1000 / i32::from(BAND);
    Duty::new(u16::try_from(per_mille).unwrap_or(0))
}

#[cfg(test)]
mod pulses;

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
        for at in 0..100 {
            heater.advance(ms(100 * at), CentiCelsius(2_200 + 60 * i16::try_from(at).unwrap())).unwrap();
        }
        let trip = heater.advance(ms(10_000), CentiCelsius(8_200)).unwrap_err();
        assert_eq!(trip, Trip::new(FaultCode::OnTooLong, 10_000, 10_000));
    }

    #[test]
    fn s6_a_heater_without_gain_trips_at_the_end_of_the_window() {
        let mut heater = SmaHeater::start(SPEC, ms(0), COLD);
        heater.advance(ms(1_999), CentiCelsius(2_600)).unwrap();
        let trip = heater.advance(ms(2_000), CentiCelsius(2_600)).unwrap_err();
        assert_eq!(trip, Trip::new(FaultCode::NoGain, 400, 500));
    }

    /// Feeds readings 100 ms apart until one trips.
    fn feed(
        heater: &mut SmaHeater,
        from_ms: u64,
        readings: &mut dyn Iterator<Item = i16>,
    ) -> Option<(u64, Trip)> {
        (0..).zip(readings).find_map(|(at, reading)| {
            let at = from_ms + 100 * at;
            heater.advance(ms(at), CentiCelsius(reading)).err().map(|trip| (at, trip))
        })
    }

    /// A heater whose readings rise by 10 °C a second from 22 °C up to `to`.
    fn heated(to: i16) -> (SmaHeater, u64) {
        let mut heater = SmaHeater::start(SPEC, ms(0), COLD);
        let steps = (to - COLD.0) / 100;
        assert_eq!(feed(&mut heater, 0, &mut (0..=steps).map(|step| COLD.0 + 100 * step)), None);
        (heater, 100 * u64::try_from(steps + 1).unwrap())
    }

    #[test]
    fn s5_a_reading_that_stands_still_turns_the_heater_off_and_trips_if_it_goes_on() {
        // While heating, and while holding.
        for frozen in [6_000, 9_100] {
            let (mut heater, now) = heated(frozen);
            assert_ne!(heater.duty(), Duty::OFF);
            assert_eq!(feed(&mut heater, now, &mut [frozen; 4].into_iter()), None);
            assert_ne!(heater.duty(), Duty::OFF, "400 ms are no reason");
            assert_eq!(feed(&mut heater, now + 400, &mut [frozen; 1].into_iter()), None);
            assert_eq!(heater.duty(), Duty::OFF, "it is put to the test");
            // A hold would end before the test does.
            if frozen == 6_000 {
                let trip = feed(&mut heater, now + 500, &mut [frozen; 20].into_iter());
                assert_eq!(trip, Some((now + 1_400, Trip::new(FaultCode::SensorFrozen, frozen, 1_500))));
            }
        }
    }

    #[test]
    fn s5_a_live_sensor_passes_the_test_and_heating_goes_on() {
        let (mut heater, now) = heated(6_000);
        assert_eq!(feed(&mut heater, now, &mut [6_000; 8].into_iter()), None);
        assert_eq!(heater.duty(), Duty::OFF);
        assert_eq!(feed(&mut heater, now + 800, &mut [5_980].into_iter()), None);
        assert_eq!(heater.duty(), Duty::FULL);
    }

    #[test]
    fn s6_the_gain_goes_on_being_watched_after_the_first_window() {
        let (mut heater, now) = heated(6_000);
        // Too slow, but no two readings alike: 1 °C in two seconds, in noise.
        let trip = feed(&mut heater, now, &mut (0..100).map(|at| 6_000 + at * 5 + at % 2 * 20));
        let (at, trip) = trip.expect("no gain");
        assert_eq!((trip.code, trip.limit), (FaultCode::NoGain, 125));
        assert!(at <= now + 4_100, "at most what is left of one window, and one more: {at} ms, {now} ms");
    }

    #[test]
    fn s6_a_reading_that_falls_while_heating_trips_at_once() {
        let (mut heater, now) = heated(6_000);
        let trip = feed(&mut heater, now, &mut (1..20).map(|at| 6_000 - 200 * at));
        assert_eq!(trip, Some((now + 200, Trip::new(FaultCode::NoGain, -600, 125))));
    }

    #[test]
    fn s6_a_reading_that_sags_while_holding_trips() {
        let (mut heater, now) = heated(9_000);
        let trip = feed(&mut heater, now, &mut (1..8).map(|at| 9_000 - 400 * at));
        assert_eq!(trip, Some((now + 200, Trip::new(FaultCode::NoGain, -1_200, 0))));
    }

    #[test]
    fn s6_an_opened_hinge_that_does_not_cool_trips() {
        let (mut heater, now) = heated(9_000);
        // Held for a second.
        assert_eq!(feed(&mut heater, now, &mut [9_050, 9_060].into_iter().cycle().take(11)), None);
        assert_eq!(heater.step_state(), StepState::Opened);
        let trip = feed(&mut heater, now + 1_100, &mut [9_050, 9_060].into_iter().cycle().take(200));
        let (at, trip) = trip.expect("no cooling");
        assert_eq!((trip.code, trip.limit), (FaultCode::NoCooling, 100));
        assert!((now + 10_000..=now + 11_100).contains(&at), "{at} ms, {now} ms");
    }

    #[test]
    fn s6_what_is_just_enough_trips_nothing() {
        // The least gain, at the end of the window.
        let mut heater = SmaHeater::start(SPEC, ms(0), COLD);
        let mut warming = (0..20).map(|at| 2_200 + at).chain([2_700]);
        assert_eq!(feed(&mut heater, 0, &mut warming), None);
        // The largest fall, and the largest sag.
        let (mut heater, now) = heated(6_000);
        assert_eq!(feed(&mut heater, now, &mut [6_010, 5_510, 5_520].into_iter()), None);
        let (mut heater, now) = heated(9_000);
        assert_eq!(feed(&mut heater, now, &mut [8_400, 8_000, 8_010].into_iter()), None);
        assert_eq!(heater.step_state(), StepState::Moving);
    }

    #[test]
    fn s6_cooling_is_watched_window_by_window_and_a_kelvin_will_do() {
        let (mut heater, now) = heated(9_000);
        assert_eq!(feed(&mut heater, now, &mut [9_050, 9_060].into_iter().cycle().take(11)), None);
        // Reached with the last reading of heating, and held for a second.
        let off = now + 900;
        let at = |heater: &mut SmaHeater, after: u64, reading| {
            heater.advance(ms(off + after), CentiCelsius(reading))
        };
        assert_eq!(at(&mut heater, 9_990, 9_050), Ok(()), "the first window isn't over");
        assert_eq!(at(&mut heater, 10_000, 8_960), Ok(()), "a kelvin below where it was when it opened");
        assert_eq!(at(&mut heater, 19_990, 8_960), Ok(()));
        let trip = at(&mut heater, 20_000, 8_910).unwrap_err();
        assert_eq!(
            (trip.code, trip.value),
            (FaultCode::NoCooling, 50),
            "half a kelvin since the window before"
        );
    }

    #[test]
    fn the_phases_are_told_with_temperature_and_power() {
        let warm = CentiCelsius(9_100);
        let mut heater = SmaHeater::start(SPEC, ms(0), COLD);
        heater.advance(ms(0), COLD).unwrap();
        assert_eq!(heater.phase(COLD), Some(Phase::Heating { temperature: COLD, duty: 1000 }));
        heater.advance(ms(1_000), warm).unwrap();
        assert_eq!(heater.phase(warm), Some(Phase::Holding { temperature: warm, duty: 750 }));
        heater.advance(ms(2_000), warm).unwrap();
        assert_eq!(heater.phase(warm), Some(Phase::Cooling { temperature: warm }));
        heater.advance(ms(3_000), COLD).unwrap();
        assert_eq!(heater.phase(COLD), None);
    }

    #[test]
    fn power_falls_to_nothing_above_the_band() {
        assert_eq!(thermostat(SPEC.target, CentiCelsius(9_400)), Duty::OFF);
        assert_eq!(thermostat(SPEC.target, CentiCelsius(i16::MAX)), Duty::OFF);
        assert_eq!(thermostat(SPEC.target, CentiCelsius(i16::MIN)), Duty::FULL);
    }
}
