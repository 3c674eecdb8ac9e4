//! Pulses side by side: one program, watched until every hinge of it has rested. What was measured is given to the hinges'
//! records as it comes; whoever calls decides what is kept.

use super::hinge::Hinge;
use super::sampler::{Look, Sampler};
use crate::Transport;
use crate::inbox::Notice;
use crate::session::{RequestError, Session};
use std::collections::BTreeMap;
use zygote_calibration::{Drive, Pulse, Sample};
use zygote_protocol::{Event, EventKind, Fault, Micros, State};

/// Is told every look: when, at what hinges, and what was seen.
pub(crate) type Seen<'a> = dyn FnMut(Micros, &[Hinge], &BTreeMap<u16, Look>) + 'a;

/// How watching ended.
pub(crate) enum End {
    /// Every hinge has rested.
    Rested,
    /// The MCU turned everything off.
    Fault(Fault),
    /// The user wants to stop.
    Interrupted,
}

/// A pulse under way.
#[derive(Debug, Clone)]
struct Course {
    pulse: Pulse,
    started_s: Option<f64>,
    ended_s: Option<f64>,
    /// Times at which it was off although it hadn't ended, as far as was known: a reading was put to the test.
    offs: Vec<Off>,
    last: Option<Look>,
    /// Looks in a row without a reading.
    unread: u32,
    rested: bool,
}

/// A thermistor without a reading in so many looks in a row, 3 s, isn't waited for.
const MOST_UNREAD: u32 = 30;

/// A time without power.
#[derive(Debug, Clone, Copy)]
#[expect(clippy::struct_field_names, reason = "the suffix is their unit")]
struct Off {
    from_s: f64,
    /// The first sample without power.
    seen_s: f64,
    until_s: f64,
}

/// The pulses of one program, in the order of its steps: which hinge, and which pulse.
pub(crate) struct Batch {
    members: Vec<(usize, Course)>,
    /// Channels that had power at the look before.
    driven: Vec<u16>,
}

impl Batch {
    pub(crate) fn new(pulses: &[(usize, Pulse)]) -> Self {
        let course = |(hinge, pulse): &(usize, Pulse)| {
            let course = Course {
                pulse: *pulse,
                started_s: None,
                ended_s: None,
                offs: Vec::new(),
                last: None,
                unread: 0,
                rested: false,
            };
            (*hinge, course)
        };
        Self { members: pulses.iter().map(course).collect(), driven: Vec::new() }
    }

    /// Hinges whose pulse and rest are over.
    pub(crate) fn rested(&self) -> impl Iterator<Item = usize> {
        self.members.iter().filter(|(_, course)| course.rested).map(|(hinge, _)| *hinge)
    }

    /// The hinge of a step.
    pub(crate) fn hinge_of(&self, step: u16) -> Option<usize> {
        self.members.get(usize::from(step)).map(|(hinge, _)| *hinge)
    }

    /// Samples until every hinge has rested, or something ends it.
    ///
    /// # Errors
    /// The session ended.
    pub(crate) fn watch<T: Transport>(
        &mut self,
        session: &mut Session<T>,
        sampler: &mut Sampler,
        hinges: &mut [Hinge],
        interrupted: &dyn Fn() -> bool,
        seen: &mut Seen<'_>,
    ) -> Result<End, RequestError> {
        let channels: Vec<u16> =
            self.members.iter().filter_map(|(at, _)| hinges.get(*at)).map(|hinge| hinge.channel).collect();
        let mut running = true;
        loop {
            if interrupted() {
                return Ok(End::Interrupted);
            }
            for notice in sampler.wait(session)? {
                match notice {
                    Notice::Fault(fault) => return Ok(End::Fault(fault)),
                    Notice::Event(event) => {
                        running &= !matches!(event.kind, EventKind::State(State::Finished | State::Safe));
                        self.take(&event, sampler, hinges);
                    }
                    Notice::Telemetry(_) => {}
                }
            }
            let looks = sampler.look(session, &channels)?;
            self.sample(&looks, hinges);
            seen(session.now(), hinges, &looks);
            if !running && self.members.iter().all(|(_, course)| course.rested) {
                return Ok(End::Rested);
            }
        }
    }

    fn take(&mut self, event: &Event, sampler: &Sampler, hinges: &mut [Hinge]) {
        let at_s = sampler.at_s(event.at);
        match event.kind {
            EventKind::StepStarted { step } => {
                if let Some((_, course)) = self.members.get_mut(usize::from(step)) {
                    course.started_s = Some(at_s);
                }
            }
            EventKind::StepOpened { step } => {
                if let Some((at, course)) = self.members.get_mut(usize::from(step))
                    && let Some(hinge) = hinges.get_mut(*at)
                {
                    course.ended_s = Some(at_s);
                    hinge.record.drives.extend(course.drives(at_s));
                }
            }
            EventKind::State(_) | EventKind::StepDone { .. } => {}
        }
    }

    fn sample(&mut self, looks: &BTreeMap<u16, Look>, hinges: &mut [Hinge]) {
        // Of all heaters of this program: others are off.
        let on = |channel: &u16| looks.get(channel).is_some_and(|look| look.duty > 0.0);
        let driven: Vec<u16> = looks.keys().copied().filter(|channel| on(channel)).collect();
        for (at, course) in &mut self.members {
            let Some(hinge) = hinges.get_mut(*at) else { continue };
            let Some(look) = looks.get(&hinge.channel) else { continue };
            if course.rested || course.started_s.is_none_or(|started_s| look.t_s <= started_s) {
                continue;
            }
            let Some(reading_c) = look.reading_c else {
                course.unread += 1;
                // Under power the MCU decides.
                if course.unread > MOST_UNREAD && course.ended_s.is_some() {
                    hinge.lose_thermistor();
                    course.rested = true;
                }
                continue;
            };
            course.unread = 0;
            let alone = driven.iter().chain(&self.driven).all(|channel| *channel == hinge.channel);
            let current_a = alone.then_some(look.sum_a);
            let later = hinge.record.samples.last().is_none_or(|last| look.t_s > last.t_s);
            if later {
                let Look { t_s, supply_v: voltage_v, .. } = *look;
                hinge.record.samples.push(Sample { t_s, reading_c, voltage_v, current_a });
            }
            course.notice(look);
            course.rested = course.has_rested(look.t_s, reading_c, hinge.bounds.min_rest_s);
        }
        self.driven = driven;
    }
}

impl Course {
    /// Sees power that is off although the pulse goes on.
    fn notice(&mut self, look: &Look) {
        let under_way = self.ended_s.is_none();
        if let Some(last) = self.last.replace(*look)
            && under_way
        {
            let between = f64::midpoint(last.t_s, look.t_s);
            match (last.duty > 0.0, look.duty > 0.0) {
                (true, false) => {
                    self.offs.push(Off { from_s: between, seen_s: look.t_s, until_s: f64::INFINITY });
                }
                (false, true) => {
                    if let Some(off) = self.offs.last_mut() {
                        off.until_s = between;
                    }
                }
                (true, true) | (false, false) => {}
            }
        }
    }

    /// The times that it was on, once it ended.
    fn drives(&self, ended_s: f64) -> Vec<Drive> {
        let Some(mut from_s) = self.started_s else { return Vec::new() };
        let Pulse { purpose, duty, .. } = self.pulse;
        let mut drives = Vec::new();
        // The last of them may be its end, seen before it was told.
        for off in self.offs.iter().filter(|off| off.seen_s < ended_s) {
            drives.push(Drive { from_s, until_s: off.from_s, duty, purpose });
            from_s = off.until_s;
        }
        drives.push(Drive { from_s, until_s: ended_s, duty, purpose });
        drives.retain(|drive| drive.until_s > drive.from_s);
        drives
    }

    fn has_rested(&self, t_s: f64, reading_c: f64, least_s: f64) -> bool {
        let Some(ended_s) = self.ended_s else { return false };
        let rested_s = t_s - ended_s;
        rested_s >= least_s && (reading_c < self.pulse.rest_below_c || rested_s >= self.pulse.longest_rest_s)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use zygote_calibration::Purpose;

    fn look(t_s: f64, duty: f64) -> Look {
        Look { t_s, reading_c: Some(30.0), duty, supply_v: 5.0, sum_a: 0.1 }
    }

    #[test]
    fn a_pulse_that_was_off_for_a_moment_is_two_drives() {
        let pulse = Pulse {
            purpose: Purpose::Warm,
            duty: 0.5,
            longest_s: 9.0,
            until_c: 60.0,
            rest_below_c: 24.0,
            longest_rest_s: 60.0,
        };
        let (_, mut course) = Batch::new(&[(0, pulse)]).members.remove(0);
        course.started_s = Some(1.0);
        for (t_s, duty) in [(1.1, 0.5), (1.2, 0.0), (1.3, 0.0), (1.4, 0.5), (1.5, 0.5)] {
            course.notice(&look(t_s, duty));
        }
        let drives: Vec<_> = course.drives(2.0).iter().map(|drive| (drive.from_s, drive.until_s)).collect();
        assert_eq!(drives.len(), 2);
        for (got, expected) in drives.iter().flat_map(|(a, b)| [*a, *b]).zip([1.0, 1.15, 1.35, 2.0]) {
            assert!((got - expected).abs() < 1e-9, "{got} for {expected}");
        }
        course.notice(&look(2.02, 0.0));
        assert!(course.drives(2.0).last().unwrap().until_s > 1.999, "that was its end");
        assert!(course.drives(2.1).last().unwrap().until_s < 1.8, "it ended while it was off");
    }
}
