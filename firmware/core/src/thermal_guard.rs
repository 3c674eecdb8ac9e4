//! Watches one heater's thermistor, whether the heater is on or off: is the reading believable (S5), is the
//! hinge too hot (S4), does it get warm without being heated (S6)?

use crate::io::ADC_FULL_SCALE;
use crate::thermistor::Thermistor;
use crate::trip::Trip;
use zygote_protocol::{CentiCelsius, FaultCode};

/// Bad samples in a row that make a fault; fewer are noise and the last good value stands.
const FILTER: u8 = 3;
/// Counts this close to full scale mean an open thermistor: below -45 °C for the usual part.
const OPEN_ABOVE: u16 = ADC_FULL_SCALE - 35;
/// Counts this close to zero mean a short: above 250 °C for the usual part.
const SHORTED_BELOW: u16 = 40;
/// No hinge changes so much from one sample to the next.
const JUMP: CentiCelsius = CentiCelsius(2_000);
/// A heater that is off may warm so much over its coldest since: by the thermistor's lag after switching off, and
/// by warm neighbours. More means that its MOSFET conducts.
const UNHEATED_RISE: CentiCelsius = CentiCelsius(1_500);

/// One heater's guard.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ThermalGuard {
    /// Last believable reading.
    last: Option<CentiCelsius>,
    /// How many readings in a row weren't, and what was wrong with the latest.
    bad: u8,
    why: Option<Trip>,
    /// Coldest reading since the heater went off; `None` while it is on.
    floor: Option<CentiCelsius>,
}

impl ThermalGuard {
    pub(crate) const NEW: Self = Self { last: None, bad: 0, why: None, floor: None };

    /// The last believable temperature.
    pub(crate) fn temperature(&self) -> Option<CentiCelsius> {
        self.last
    }

    /// The last believable temperature, unless what came since makes a fault.
    pub(crate) fn believed(&self) -> Option<CentiCelsius> {
        self.last.filter(|_| self.bad < FILTER)
    }

    /// Starts over after readings that make a fault. For when nothing is energised: the next reading may come through a wire that
    /// was mended.
    pub(crate) fn forgive(&mut self) {
        if self.bad >= FILTER {
            self.restart();
        }
    }

    /// Forgets what was learned, at arming: the hinge may have been exchanged.
    pub(crate) fn restart(&mut self) {
        *self = Self::NEW;
    }

    /// Takes a reading.
    pub(crate) fn sample(&mut self, counts: u16, thermistor: &Thermistor) {
        match self.judge(counts, thermistor) {
            Ok(temperature) => {
                self.last = Some(temperature);
                self.bad = 0;
                self.why = None;
            }
            Err(trip) => {
                self.bad = self.bad.saturating_add(1);
                self.why = Some(trip);
            }
        }
    }

    fn judge(&self, counts: u16, thermistor: &Thermistor) -> Result<CentiCelsius, Trip> {
        if counts > OPEN_ABOVE {
            return Err(Trip::new(FaultCode::SensorOpen, counts, OPEN_ABOVE));
        }
        if counts < SHORTED_BELOW {
            return Err(Trip::new(FaultCode::SensorShorted, counts, SHORTED_BELOW));
        }
        let temperature = thermistor.temperature(counts);
        match self.last {
            Some(last) if temperature.0.abs_diff(last.0) > JUMP.0.unsigned_abs() => {
                Err(Trip::new(FaultCode::SensorJumped, temperature.0, last.0))
            }
            _ => Ok(temperature),
        }
    }

    /// Holds the readings against what is believable, the limit, and what an unheated hinge may do.
    ///
    /// # Errors
    /// Three bad readings in a row, too hot, or warm without being heated.
    pub(crate) fn check(&mut self, driven: bool, max: CentiCelsius) -> Result<(), Trip> {
        if let Some(trip) = self.why.filter(|_| self.bad >= FILTER) {
            return Err(trip);
        }
        let Some(now) = self.last else { return Ok(()) };
        if now > max {
            return Err(Trip::new(FaultCode::OverTemperature, now.0, max.0));
        }
        if driven {
            self.floor = None;
            return Ok(());
        }
        let floor = self.floor.map_or(now, |floor| floor.min(now));
        self.floor = Some(floor);
        let most = floor.0.saturating_add(UNHEATED_RISE.0);
        if now.0 > most { Err(Trip::new(FaultCode::UnexpectedHeat, now.0, most)) } else { Ok(()) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::thermistor::NTC_10K;

    const MAX: CentiCelsius = CentiCelsius(12_000);
    /// Readings of the usual thermistor: about 22 °C and about 45 °C.
    const COLD: u16 = 2_190;
    const WARM: u16 = 1_226;

    /// Takes a reading and judges.
    fn read(guard: &mut ThermalGuard, counts: u16, driven: bool) -> Result<(), FaultCode> {
        guard.sample(counts, &NTC_10K);
        guard.check(driven, MAX).map_err(|trip| trip.code)
    }

    fn warmed_to(counts: u16, driven: bool) -> Result<(), FaultCode> {
        let mut guard = ThermalGuard::NEW;
        (counts..=COLD).rev().step_by(10).try_for_each(|step| read(&mut guard, step, driven))
    }

    #[test]
    fn s5_an_open_or_shorted_thermistor_trips_at_the_third_sample() {
        for (counts, code) in [(4_095, FaultCode::SensorOpen), (0, FaultCode::SensorShorted)] {
            let mut guard = ThermalGuard::NEW;
            assert_eq!(read(&mut guard, counts, true), Ok(()));
            assert_eq!(read(&mut guard, counts, true), Ok(()));
            assert_eq!(read(&mut guard, counts, true), Err(code));
        }
    }

    #[test]
    fn s5_two_bad_samples_and_a_good_one_are_noise() {
        let mut guard = ThermalGuard::NEW;
        for counts in [0, 0, COLD].into_iter().cycle().take(30) {
            assert_eq!(read(&mut guard, counts, true), Ok(()));
        }
    }

    #[test]
    fn s5_a_jump_that_stays_trips_and_the_last_good_value_stands() {
        let mut guard = ThermalGuard::NEW;
        read(&mut guard, COLD, true).unwrap();
        let before = guard.temperature();
        read(&mut guard, WARM, true).unwrap();
        read(&mut guard, WARM, true).unwrap();
        assert_eq!(guard.temperature(), before);
        assert_eq!(read(&mut guard, WARM, true), Err(FaultCode::SensorJumped));
    }

    #[test]
    fn s6_warming_without_being_heated_trips() {
        assert_eq!(warmed_to(WARM, false), Err(FaultCode::UnexpectedHeat));
    }

    #[test]
    fn s4_warming_while_heated_is_fine_up_to_the_limit() {
        assert_eq!(warmed_to(WARM, true), Ok(()));
        // About 130 °C.
        assert_eq!(warmed_to(120, true), Err(FaultCode::OverTemperature));
    }

    #[test]
    fn s5_readings_at_the_edge_of_what_is_believable_are_believed() {
        // About -45 °C and about 250 °C: far apart, so each in a guard of its own.
        for counts in [OPEN_ABOVE, SHORTED_BELOW] {
            let mut guard = ThermalGuard::NEW;
            for _ in 0..5 {
                guard.sample(counts, &NTC_10K);
                assert_eq!(
                    (guard.bad, guard.temperature()),
                    (0, Some(NTC_10K.temperature(counts))),
                    "{counts}"
                );
            }
        }
    }

    #[test]
    fn s5_the_largest_change_that_is_no_jump_is_believed() {
        let reading = |celsius: i16| {
            (0..=ADC_FULL_SCALE).rev().find(|counts| NTC_10K.temperature(*counts).0 >= celsius)
        };
        let (cold, warm) = (reading(2_200).unwrap(), reading(4_100).unwrap());
        let mut guard = ThermalGuard::NEW;
        guard.sample(cold, &NTC_10K);
        let change = NTC_10K.temperature(warm).0 - NTC_10K.temperature(cold).0;
        assert!((1_800..=JUMP.0).contains(&change), "{change}");
        // As far as a jump is from it, to the hundredth.
        guard.last = Some(CentiCelsius(NTC_10K.temperature(warm).0 - JUMP.0));
        guard.sample(warm, &NTC_10K);
        assert_eq!(guard.bad, 0);
    }

    #[test]
    fn s4_a_hinge_exactly_at_its_limit_and_a_rise_exactly_as_far_as_allowed_trip_nothing() {
        let mut guard = ThermalGuard { last: Some(MAX), ..ThermalGuard::NEW };
        assert_eq!(guard.check(true, MAX), Ok(()));
        let mut guard = ThermalGuard { last: Some(CentiCelsius(2_200)), ..ThermalGuard::NEW };
        assert_eq!(guard.check(false, MAX), Ok(()));
        guard.last = Some(CentiCelsius(2_200 + UNHEATED_RISE.0));
        assert_eq!(guard.check(false, MAX), Ok(()));
        guard.last = Some(CentiCelsius(2_201 + UNHEATED_RISE.0));
        assert!(guard.check(false, MAX).is_err());
    }

    #[test]
    fn a_restart_forgets_what_another_hinge_did() {
        let mut guard = ThermalGuard::NEW;
        read(&mut guard, COLD, false).unwrap();
        guard.restart();
        assert_eq!(guard.temperature(), None);
        // A warm hinge in its place is no rise.
        assert_eq!(read(&mut guard, WARM, false), Ok(()));
    }
}
