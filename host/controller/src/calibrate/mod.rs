//! Calibrates the shape-memory hinges of a rig: checks the thermistors, drives the pulses that `zygote_calibration` asks for, and
//! samples. What the samples mean is that crate's business.
//!
//! ```text
//!   thermistors --> watch, all off --> probes --> pulses side by side --> full power --> every hinge ended
//!                                     one by one   as the supply allows     one by one
//! ```
//!
//! A pulse that is cut short leaves nothing in the records; everything else is kept by the caller after each step, so that a
//! calibration which was interrupted goes on where it was.

mod batch;
mod hinge;
mod progress;
mod pulse_step;
pub(crate) mod records;
mod sampler;
mod thermistors;

pub(crate) use hinge::nominal;
pub use hinge::{Ending, Hinge};
pub use progress::{Progress, Running};
pub use records::{Measured, RecordsError, chip_id};
pub use thermistors::ThermistorError;

use crate::deploy::{make_ready, start, upload};
use crate::session::{RequestError, Session};
use crate::{DeployError, Transport};
use batch::{Batch, End};
use sampler::{Look, Sampler};
use std::collections::BTreeMap;
use zygote_calibration::{Next, Pulse, Purpose, Sample};
use zygote_deployment::Rig;
use zygote_protocol::{Command, Fault, Limits, Micros, Millis, RigId};

/// The thermistors are looked at for so long before anything else.
const FIRST_LOOK: u32 = 20;
/// A hinge whose pulse was cut short cools for so long at the most before it is asked for another.
const COOLING_S: f64 = 300.0;
/// Samples so near to a pulse's ends may have been taken before or after.
const EDGE_S: f64 = 0.05;
/// Cool again: so near to where it began.
const COOL_K: f64 = 1.5;

/// Why a calibration ended before its time. What was measured is kept.
#[derive(Debug, thiserror::Error)]
pub enum CalibrateError {
    /// It didn't start, or a program was refused.
    #[error(transparent)]
    Start(#[from] DeployError),
    /// A command was refused, or the session ended.
    #[error(transparent)]
    Request(#[from] RequestError),
    /// Thermistors that can't be relied on, hinge by hinge.
    #[error("before anything was heated: {}", list(.0))]
    Thermistors(Vec<(usize, ThermistorError)>),
    /// A fault that isn't one hinge's own.
    #[error("{}: measured {}, limit {}{}; everything is off", .fault.code, .fault.value, .fault.limit, place(*.hinge))]
    Fault {
        /// What the MCU says.
        fault: Fault,
        /// The hinge concerned.
        hinge: Option<usize>,
    },
    /// The user stopped it.
    #[error("stopped, everything is off; --resume goes on with it")]
    Interrupted,
    /// What was measured can't be kept.
    #[error("what was measured can't be kept: {0}")]
    Keep(String),
}

fn list(errors: &[(usize, ThermistorError)]) -> String {
    errors.iter().map(|(hinge, error)| format!("hinge {hinge}: {error}")).collect::<Vec<_>>().join("; ")
}

fn place(hinge: Option<usize>) -> String {
    hinge.map_or_else(String::new, |hinge| format!(" at hinge {hinge}"))
}

/// What to calibrate, and how.
pub struct Calibration<'a> {
    /// The rig.
    pub rig: &'a Rig,
    /// Number of the first program; each has another.
    pub run: u32,
    /// Leave the safe state first: a person has looked at the rig.
    pub clear: bool,
    /// Asked often: does the user want to stop?
    pub interrupted: &'a dyn Fn() -> bool,
}

/// Measures until every hinge has ended; how, stands with it.
///
/// # Errors
/// [`CalibrateError`]; nothing is energised then.
pub fn calibrate<T: Transport>(
    session: &mut Session<T>,
    calibration: &Calibration<'_>,
    hinges: &mut [Hinge],
    keep: &mut dyn FnMut(&[Hinge]) -> Result<(), String>,
    show: &mut dyn FnMut(&Progress),
) -> Result<(), CalibrateError> {
    make_ready(session, calibration.clear)?;
    let last_s = hinges.iter().filter_map(|hinge| hinge.record.samples.last()).map(|sample| sample.t_s);
    let now = session.status()?.at;
    let sampler = Sampler::new(last_s.reduce(f64::max), now);
    let mut bench =
        Bench { session, calibration, hinges, sampler, ohms: BTreeMap::new(), run: calibration.run };
    let ended = bench.first_look().and_then(|()| bench.measure(keep, show));
    if ended.is_err() {
        // Perhaps something is armed; the error is what the user must know, not whether this last word got through.
        bench.session.stop().ok();
    }
    ended
}

/// Only the sum of all currents is measured, so heaters are measured one after the other.
fn is_alone(pulse: &Pulse) -> bool {
    match pulse.purpose {
        Purpose::Probe | Purpose::HeldOut => true,
        Purpose::Warm | Purpose::Ramp | Purpose::Again => false,
    }
}

/// As strict as the rig allows.
pub(crate) fn limits(rig: &Rig, ceiling: Limits) -> Limits {
    let whole = |value: f64, most: u32| {
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "it saturates")]
        let whole = value.round() as u32;
        whole.min(most)
    };
    Limits {
        supply: zygote_protocol::Milliamps(whole(rig.supply.limit.0 * 1e3, ceiling.supply.0)),
        link_timeout: Millis(whole(rig.link.timeout.0 * 1e3, ceiling.link_timeout.0)),
        ..ceiling
    }
}

struct Bench<'a, T> {
    session: &'a mut Session<T>,
    calibration: &'a Calibration<'a>,
    hinges: &'a mut [Hinge],
    sampler: Sampler,
    /// Resistance of heaters that were on alone.
    ohms: BTreeMap<usize, f64>,
    run: u32,
}

impl<T: Transport> Bench<'_, T> {
    /// Reads all thermistors for a while with everything off.
    fn first_look(&mut self) -> Result<(), CalibrateError> {
        let channels = self.channels(|_| true);
        let mut looks = BTreeMap::new();
        for _ in 0..FIRST_LOOK {
            looks = self.look(&channels)?;
        }
        let errors = thermistors::check(self.hinges, &looks);
        if errors.is_empty() {
            return Ok(());
        }
        let numbered = |(at, error): (usize, ThermistorError)| Some((self.hinges.get(at)?.number, error));
        Err(CalibrateError::Thermistors(errors.into_iter().filter_map(numbered).collect()))
    }

    fn measure(
        &mut self,
        keep: &mut dyn FnMut(&[Hinge]) -> Result<(), String>,
        show: &mut dyn FnMut(&Progress),
    ) -> Result<(), CalibrateError> {
        self.cool()?;
        loop {
            let wishes: Vec<(usize, Next)> = self
                .hinges
                .iter_mut()
                .enumerate()
                .filter_map(|(at, hinge)| Some((at, hinge.wish()?)))
                .collect();
            keep(self.hinges).map_err(CalibrateError::Keep)?;
            if wishes.is_empty() {
                return Ok(());
            }
            let watches: Vec<(usize, f64)> = wishes
                .iter()
                .filter_map(|(at, wish)| match wish {
                    Next::Watch { for_s } => Some((*at, *for_s)),
                    Next::Pulse(_) | Next::Done => None,
                })
                .collect();
            if !watches.is_empty() {
                show(&self.progress(format!("{} hinges at rest", watches.len())));
                self.watch(&watches)?;
                continue;
            }
            let pulses: Vec<(usize, Pulse)> = wishes
                .iter()
                .filter_map(|(at, wish)| match wish {
                    Next::Pulse(pulse) => Some((*at, *pulse)),
                    Next::Watch { .. } | Next::Done => None,
                })
                .collect();
            let room = usize::from(self.session.info().buffers.steps).max(1);
            // Those side by side before those one after the other: by then more is known of them.
            let (alone, beside): (Vec<_>, Vec<_>) =
                pulses.into_iter().partition(|(_, pulse)| is_alone(pulse));
            let probes: Vec<_> =
                alone.iter().copied().filter(|(_, pulse)| pulse.purpose == Purpose::Probe).collect();
            let next = [probes, beside, alone].into_iter().find(|pulses| !pulses.is_empty());
            let next = next.unwrap_or_default();
            let together = next.get(..room.min(next.len())).unwrap_or_default();
            self.pulse(together, show)?;
        }
    }

    /// Hinges that are warmer than where their records began are waited for: they were heated shortly before.
    fn cool(&mut self) -> Result<(), CalibrateError> {
        let channels = self.channels(|hinge| hinge.ending.is_none());
        let mut left = COOLING_S;
        while left > 0.0 {
            let looks = self.look(&channels)?;
            let is_warm = |hinge: &Hinge| {
                let reading_c = looks.get(&hinge.channel).and_then(|look| look.reading_c);
                hinge.ending.is_none()
                    && reading_c.zip(hinge.ambient_c()).is_some_and(|(now, begun)| now > begun + COOL_K)
            };
            if !self.hinges.iter().any(is_warm) {
                return Ok(());
            }
            left -= f64::from(sampler::EVERY.0) / 1e3;
        }
        for hinge in self.hinges.iter_mut().filter(|hinge| hinge.ending.is_none()) {
            // It is warmer here than when it began: what was measured then doesn't fit what comes.
            hinge.record = zygote_calibration::Record::default();
            hinge.keep();
        }
        Ok(())
    }

    /// Samples hinges with everything off.
    fn watch(&mut self, watches: &[(usize, f64)]) -> Result<(), CalibrateError> {
        let longest_s = watches.iter().map(|(_, for_s)| *for_s).fold(0.0, f64::max);
        let members: Vec<usize> = watches.iter().map(|(at, _)| *at).collect();
        let channels: Vec<u16> =
            members.iter().filter_map(|at| self.hinges.get(*at)).map(|hinge| hinge.channel).collect();
        let mut watched_s = 0.0;
        while watched_s < longest_s + 0.1 {
            let looks = self.look(&channels)?;
            for at in &members {
                let Some(hinge) = self.hinges.get_mut(*at) else { continue };
                let Some(look) = looks.get(&hinge.channel) else { continue };
                if let Some(reading_c) = look.reading_c {
                    let Look { t_s, supply_v: voltage_v, sum_a, .. } = *look;
                    let current_a = Some(sum_a);
                    hinge.record.samples.push(Sample { t_s, reading_c, voltage_v, current_a });
                }
            }
            watched_s += f64::from(sampler::EVERY.0) / 1e3;
        }
        for at in members {
            if let Some(hinge) = self.hinges.get_mut(at) {
                if hinge.is_as_it_was() {
                    hinge.lose_thermistor();
                }
                hinge.keep();
            }
        }
        Ok(())
    }

    /// Drives pulses side by side.
    fn pulse(
        &mut self,
        pulses: &[(usize, Pulse)],
        show: &mut dyn FnMut(&Progress),
    ) -> Result<(), CalibrateError> {
        let rig = self.calibration.rig;
        let supply_v = rig.supply.voltage.0;
        let steps: Vec<_> = pulses
            .iter()
            .filter_map(|(at, pulse)| {
                let hinge = self.hinges.get(*at)?;
                let ohm = self.ohms.get(at).copied().unwrap_or(hinge.nominal.heater_ohm);
                Some((is_alone(pulse), pulse_step::step(hinge, pulse, supply_v, ohm)))
            })
            .zip(0..)
            .map(|((alone, mut step), index): (_, u16)| {
                if let Some(before) = index.checked_sub(1).filter(|_| alone) {
                    // There is room for four.
                    step.after.push(before).ok();
                }
                step
            })
            .collect();
        let id = RigId::try_from(rig.id.as_str()).map_err(|_| DeployError::RigId { id: rig.id.clone() })?;
        self.run = self.run.wrapping_add(1);
        upload(self.session, self.run, &id, &steps)?;
        start(self.session, self.run, id, limits(rig, self.session.info().ceiling))?;
        let mut batch = Batch::new(pulses);
        let progress = self.progress(progress::describe(self.hinges, pulses));
        let begun = self.session.now();
        let mut seen = |now: Micros, hinges: &[Hinge], looks: &BTreeMap<u16, Look>| {
            let left_s = (progress.left_s - sampler::seconds(Micros(now.since(begun)))).max(1.0);
            let running = progress::running(hinges, pulses, looks);
            show(&Progress { running, left_s, ..progress.clone() });
        };
        let end = batch.watch(
            self.session,
            &mut self.sampler,
            self.hinges,
            self.calibration.interrupted,
            &mut seen,
        );
        for at in batch.rested() {
            if let Some(hinge) = self.hinges.get_mut(at) {
                hinge.keep();
            }
        }
        for hinge in self.hinges.iter_mut() {
            hinge.forget();
        }
        match end? {
            End::Rested => {
                self.learn_resistance(pulses);
                Ok(())
            }
            End::Interrupted => Err(CalibrateError::Interrupted),
            End::Fault(fault) => {
                let at = fault.step.and_then(|step| batch.hinge_of(step));
                let Some(hinge) = at.and_then(|at| self.hinges.get_mut(at)) else {
                    return Err(CalibrateError::Fault { fault, hinge: None });
                };
                if !hinge::is_of_one_hinge(fault.code) {
                    return Err(CalibrateError::Fault { fault, hinge: Some(hinge.number) });
                }
                hinge.fail(&fault);
                self.session.request(Command::Clear)?;
                self.cool()
            }
        }
    }

    /// From pulses of heaters that were on alone.
    fn learn_resistance(&mut self, pulses: &[(usize, Pulse)]) {
        for (at, _) in pulses.iter().filter(|(_, pulse)| is_alone(pulse)) {
            let Some(hinge) = self.hinges.get(*at) else { continue };
            let Some(drive) = hinge.record.drives.last() else { continue };
            let idle: Vec<f64> =
                hinge.record.baseline().iter().filter_map(|sample| sample.current_a).collect();
            let idle_a = idle.iter().sum::<f64>() / f64::from(u32::try_from(idle.len()).unwrap_or(1).max(1));
            let (mut volts, mut amps) = (0.0, 0.0);
            for sample in &hinge.record.samples {
                let inside = sample.t_s > drive.from_s + EDGE_S && sample.t_s < drive.until_s - EDGE_S;
                if let Some(current_a) = sample.current_a.filter(|_| inside) {
                    volts += drive.duty * sample.voltage_v;
                    amps += current_a - idle_a;
                }
            }
            if amps > 0.0 && volts > 0.0 {
                self.ohms.insert(*at, volts / amps);
            }
        }
    }

    /// The next sample of these channels; nothing is energised, so a fault is none of this calibration's doing.
    fn look(&mut self, channels: &[u16]) -> Result<BTreeMap<u16, Look>, CalibrateError> {
        if (self.calibration.interrupted)() {
            return Err(CalibrateError::Interrupted);
        }
        for notice in self.sampler.wait(self.session)? {
            if let crate::Notice::Fault(fault) = notice {
                return Err(CalibrateError::Fault { fault, hinge: None });
            }
        }
        Ok(self.sampler.look(self.session, channels)?)
    }

    fn channels(&self, which: impl Fn(&Hinge) -> bool) -> Vec<u16> {
        self.hinges.iter().filter(|hinge| which(hinge)).map(|hinge| hinge.channel).collect()
    }

    fn progress(&self, doing: String) -> Progress {
        let ended = self.hinges.iter().filter(|hinge| hinge.ending.is_some()).count();
        let left_s = progress::left_s(self.hinges, self.at_once());
        Progress { ended, total: self.hinges.len(), doing, running: Vec::new(), left_s }
    }

    /// How many heaters the supply carries, each with all its power: that is how the MCU counts them.
    fn at_once(&self) -> usize {
        let supply = &self.calibration.rig.supply;
        let heater_a =
            |hinge: &Hinge| pulse_step::CURRENT_MARGIN * supply.voltage.0 / hinge.nominal.heater_ohm;
        let most_a = self.hinges.iter().map(heater_a).fold(f64::MIN_POSITIVE, f64::max);
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "some tens; it saturates"
        )]
        let at_once = (supply.limit.0 / most_a).floor().max(1.0) as usize;
        at_once
    }
}
