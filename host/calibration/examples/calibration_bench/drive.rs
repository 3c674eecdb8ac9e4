//! Drives the pulses of the plan on a simulated plant, as the firmware would: temperatures from counts by its own
//! conversion, a tick of 10 ms, ten samples a second, off at a limit.

use crate::hinges::Subject;
use core::time::Duration;
use std::error::Error;
use zygote_calibration::{Bounds, Drive, Next, Pulse, Record, Refusal, Sample, next};
use zygote_core::{ADC_FULL_SCALE, Duty, NTC_10K};
use zygote_sim::plant::{self, Fault, Plant, Readings};

/// What came of driving the plan.
pub(crate) struct Session {
    pub(crate) record: Record,
    /// Why it ended before its time.
    pub(crate) ended: Option<Ended>,
}

/// An early end.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Ended {
    /// The plan would not go on.
    Refused(Refusal),
    /// The MCU would have cut the power.
    Tripped(&'static str),
}

const TICK: Duration = Duration::from_millis(10);
const TICKS_PER_SAMPLE: u32 = 10;
/// Counts so near to the rails are no thermistor's.
const RAIL: u16 = 35;

struct Rig {
    plant: Plant,
    record: Record,
    tick: u32,
    fault: Option<(f64, Fault)>,
    max_c: f64,
}

/// Why a rest or a pulse stopped.
type Stepped = Result<Result<f64, Ended>, Box<dyn Error>>;

/// Calibrates a hinge from its plan's start to its end, or to where it is stopped. A fault comes at its time.
pub(crate) fn session(
    subject: &Subject,
    bounds: &Bounds,
    fault: Option<(f64, Fault)>,
) -> Result<Session, Box<dyn Error>> {
    let plant = Plant::new(&subject.config)?;
    let mut rig = Rig { plant, record: Record::default(), tick: 0, fault, max_c: bounds.max_temperature_c };
    let ended = loop {
        match next(&rig.record, &subject.nominal, bounds) {
            Err(refusal) => break Some(Ended::Refused(refusal)),
            Ok(Next::Done) => break None,
            Ok(Next::Watch { for_s }) => {
                if let Err(ended) = rig.rest(f64::NEG_INFINITY, for_s, for_s)? {
                    break Some(ended);
                }
            }
            Ok(Next::Pulse(pulse)) => {
                if let Err(ended) = rig.pulse(&pulse)? {
                    break Some(ended);
                }
                if let Err(ended) = rig.rest(pulse.rest_below_c, bounds.min_rest_s, pulse.longest_rest_s)? {
                    break Some(ended);
                }
            }
        }
    };
    Ok(Session { record: rig.record, ended })
}

impl Rig {
    fn now_s(&self) -> f64 {
        f64::from(self.tick) * TICK.as_secs_f64()
    }

    fn pulse(&mut self, pulse: &Pulse) -> Stepped {
        let from_s = self.now_s();
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to 1000")]
        let duty = Duty::new((pulse.duty * 1000.0).round() as u16);
        let ended = loop {
            match self.step(duty)? {
                Ok(reading_c) if reading_c >= pulse.until_c => break Ok(reading_c),
                Ok(reading_c) if self.now_s() - from_s >= pulse.longest_s - 1e-9 => break Ok(reading_c),
                Ok(_) => {}
                Err(ended) => break Err(ended),
            }
        };
        let until_s = self.now_s();
        self.record.drives.push(Drive { from_s, until_s, duty: pulse.duty, purpose: pulse.purpose });
        Ok(ended)
    }

    fn rest(&mut self, below_c: f64, least_s: f64, longest_s: f64) -> Stepped {
        let from_s = self.now_s();
        loop {
            let reading_c = match self.step(Duty::OFF)? {
                Ok(reading_c) => reading_c,
                Err(ended) => return Ok(Err(ended)),
            };
            let rested_s = self.now_s() - from_s;
            if (reading_c < below_c && rested_s >= least_s) || rested_s >= longest_s {
                return Ok(Ok(reading_c));
            }
        }
    }

    /// One tick; what the thermistor reads then.
    fn step(&mut self, duty: Duty) -> Stepped {
        if let Some((_, fault)) = self.fault.take_if(|(at_s, _)| *at_s <= f64::from(self.tick) * 0.01) {
            self.plant.inject(fault)?;
        }
        let drive = plant::Drive { heaters: &[duty], servos: &[], springs: &[], main_switch: true };
        self.plant.advance(TICK, &drive)?;
        self.tick += 1;
        let Readings { thermistors, supply, current } = self.plant.sense();
        let counts = thermistors.first().copied().ok_or("a plant without a heater")?;
        let reading_c = f64::from(NTC_10K.temperature(counts).0) / 100.0;
        if self.tick.is_multiple_of(TICKS_PER_SAMPLE) {
            self.record.samples.push(Sample {
                t_s: self.now_s(),
                reading_c,
                voltage_v: f64::from(supply.0) / 1000.0,
                current_a: Some(f64::from(current.0) / 1000.0),
            });
        }
        if !(RAIL..=ADC_FULL_SCALE - RAIL).contains(&counts) {
            return Ok(Err(Ended::Tripped("sensor")));
        }
        if reading_c > self.max_c {
            return Ok(Err(Ended::Tripped("too hot")));
        }
        Ok(Ok(reading_c))
    }
}
