//! A schedule run backwards: servos go both ways, so a shape that opened folds up again.
//!
//! What waits for what is turned round, and so are pulses, angles and times. [`Schedule::verify`] holds a schedule against the way
//! out, so it is the forward schedule that is to be verified before.

use super::{MOST_AFTER, Milliamps, Millis, Motion, Schedule, ServoMotion, Step};
use crate::rig::Kind;

/// Why a schedule can't be run backwards.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum ReverseError {
    /// A hinge that doesn't close by itself.
    #[error("hinge {hinge} is a {} hinge, which doesn't close by itself: only servos fold a shape up again", kind.name())]
    OneWay {
        /// The first such hinge in the order of the schedule.
        hinge: usize,
        /// What moves it.
        kind: Kind,
    },
    /// A step that so many others wait for.
    #[error(
        "hinge {hinge} would have to wait for {found} others, a step may wait for {MOST_AFTER}; schedule fewer motions at once"
    )]
    TooManyBefore {
        /// The hinge.
        hinge: usize,
        /// How many hinges it would wait for.
        found: usize,
    },
    /// More current than the supply gives: what is closed holds, and other hinges are closed now than were open then.
    #[error(
        "at {time} the hinges would draw {drawn}, expected at most the supply limit of {limit}; schedule fewer motions at once"
    )]
    Current {
        /// When.
        time: Millis,
        /// The sum of currents.
        drawn: Milliamps,
        /// The limit.
        limit: Milliamps,
    },
}

impl Schedule {
    /// The same motions backwards: the last step first, each from its end to its start, after all that waited for it.
    ///
    /// # Errors
    /// [`ReverseError`] if a hinge is no servo, or if waits or currents don't fit the other way round.
    pub fn reversed(&self) -> Result<Self, ReverseError> {
        let last = self.steps.len().saturating_sub(1);
        let makespan = self.steps.iter().map(Step::opened).max().unwrap_or_default();
        let mut after = vec![Vec::new(); self.steps.len()];
        for (index, step) in self.steps.iter().enumerate() {
            for &other in &step.after {
                if let Some(waits) = after.get_mut(other) {
                    waits.push(last - index);
                }
            }
        }
        // In the new order, so that all that a step waits for comes before it.
        after.reverse();
        let mut steps: Vec<Step> = Vec::with_capacity(self.steps.len());
        for (index, step) in self.steps.iter().rev().enumerate() {
            let waits = fewest(&after, index);
            if waits.len() > MOST_AFTER {
                return Err(ReverseError::TooManyBefore { hinge: step.hinge, found: waits.len() });
            }
            steps.push(Step {
                after: waits.clone(),
                from_opening_deg: step.opening_deg,
                opening_deg: step.from_opening_deg,
                start: Millis(makespan.0.saturating_sub(step.opened().0)),
                motion: Motion::Servo(backwards(step)?),
                ..step.clone()
            });
            after[index] = waits;
        }
        let mut reversed = Self { steps, ..self.clone() };
        reversed.peak_current = reversed.peak()?;
        Ok(reversed)
    }

    /// The highest sum of currents, if it is within the limit.
    fn peak(&self) -> Result<Milliamps, ReverseError> {
        // At one time what ends comes first.
        let mut changes: Vec<(Millis, bool, i128)> = Vec::with_capacity(2 * self.steps.len());
        for step in &self.steps {
            let (current, hold) = (i128::from(step.current.0), i128::from(step.hold_current.0));
            changes.push((step.start, true, current));
            changes.push((step.opened(), false, hold - current));
        }
        changes.sort_unstable();
        let (mut drawn, mut peak) = (0, Milliamps(0));
        for (time, _, change) in changes {
            drawn += change;
            let now = Milliamps(u64::try_from(drawn).unwrap_or(0));
            if now > self.supply_limit {
                return Err(ReverseError::Current { time, drawn: now, limit: self.supply_limit });
            }
            peak = peak.max(now);
        }
        Ok(peak)
    }
}

/// What a step waits for, rising: all of it, or if that is too much only what nothing else of it waits for.
fn fewest(after: &[Vec<usize>], step: usize) -> Vec<usize> {
    let mut waits = after[step].clone();
    waits.sort_unstable();
    waits.dedup();
    if waits.len() <= MOST_AFTER {
        return waits;
    }
    let implied = |wait: &usize| waits.iter().any(|other| other > wait && reaches(after, *other, *wait));
    waits.iter().copied().filter(|wait| !implied(wait)).collect()
}

/// Whether one step waits for another, directly or through others.
fn reaches(after: &[Vec<usize>], from: usize, to: usize) -> bool {
    let (mut open, mut seen) = (vec![from], vec![false; from + 1]);
    while let Some(step) = open.pop() {
        if step == to {
            return true;
        }
        // What a step waits for comes before it, so nothing below `to` leads there.
        let unseen = after[step].iter().copied().filter(|next| *next >= to);
        open.extend(unseen.filter(|next| !std::mem::replace(&mut seen[*next], true)));
    }
    false
}

fn backwards(step: &Step) -> Result<ServoMotion, ReverseError> {
    match step.motion {
        Motion::Servo(motion) => Ok(ServoMotion { from: motion.to, to: motion.from, ..motion }),
        Motion::Sma(_) | Motion::Spring(_) => {
            Err(ReverseError::OneWay { hinge: step.hinge, kind: step.motion.kind() })
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rig::Rig;
    use crate::testing::{real_plans, rig_text};

    fn scheduled(extra: &str, limit: &str, parallel: usize, plan: usize) -> Schedule {
        let text = rig_text(&format!("[hinges]\ndefault = \"servo\"\n{extra}"));
        let text = text.replace("servos = 4", "servos = 100").replace("2 A", limit);
        let rig = Rig::read("rig.toml", &text).expect("a good rig");
        let plan = &real_plans()[plan];
        let schedule = Schedule::plan(plan, &rig, parallel).expect("a schedule");
        schedule.verify(plan, &rig).expect("a good schedule");
        schedule
    }

    #[test]
    fn every_motion_goes_back_at_the_mirrored_time_after_all_that_waited_for_it() {
        for (plan, parallel) in [(1, 1), (2, 3), (3, 4)] {
            let forward = scheduled("", "2 A", parallel, plan);
            let back = forward.reversed().expect("servos alone");
            let last = forward.steps.len() - 1;
            for (index, step) in back.steps.iter().enumerate() {
                let there = &forward.steps[last - index];
                assert_eq!((step.hinge, step.channel), (there.hinge, there.channel));
                assert_eq!(
                    [step.from_opening_deg, step.opening_deg],
                    [there.opening_deg, there.from_opening_deg]
                );
                assert_eq!(step.start.0 + there.opened().0, forward.makespan.0);
                let (Motion::Servo(back), Motion::Servo(there)) = (step.motion, there.motion) else {
                    panic!("servos")
                };
                assert_eq!((back.from, back.to, back.duration), (there.to, there.from, there.duration));
                assert!(step.after.iter().all(|other| *other < index));
            }
            // Whatever waited is waited for, directly or not, and is over by then.
            let after: Vec<_> = back.steps.iter().map(|step| step.after.clone()).collect();
            for (index, step) in forward.steps.iter().enumerate() {
                for other in &step.after {
                    assert!(reaches(&after, last - other, last - index));
                    assert!(back.steps[last - other].start >= back.steps[last - index].opened());
                }
            }
        }
    }

    #[test]
    fn twice_reversed_one_by_one_it_is_what_it_was() {
        let forward = scheduled("", "2 A", 1, 3);
        assert_eq!(forward.reversed().and_then(|back| back.reversed()), Ok(forward));
    }

    #[test]
    fn hinges_that_do_not_close_are_refused_by_name() {
        let refusal = |kind: &str| {
            let extra = format!("[[hinge]]\nhinge = 2\nkind = \"{kind}\"\n");
            scheduled(&extra, "2 A", 1, 1).reversed().expect_err("one way").to_string()
        };
        assert!(refusal("sma").starts_with("hinge 2 is a sma hinge, which doesn't close by itself"));
        assert!(refusal("spring").starts_with("hinge 2 is a spring hinge"));
    }

    #[test]
    fn a_current_that_fits_one_way_alone_is_refused() {
        // The hinge that opens first holds nothing while others move but all of them hold when it goes back.
        let mut forward = scheduled("", "2 A", 1, 1);
        let last = forward.steps.len() - 1;
        forward.steps[0].current = Milliamps(1900);
        forward.steps[last].current = Milliamps(100);
        assert!(forward.reversed().is_err_and(|error| matches!(error, ReverseError::Current { .. })));
    }

    #[test]
    fn waits_that_others_imply_are_left_out_where_there_are_too_many() {
        let after = [vec![], vec![0], vec![1], vec![], vec![], vec![0, 1, 2, 3, 4]];
        assert_eq!(fewest(&after, 5), [2, 3, 4]);
        assert_eq!(fewest(&after[..5], 2), [1]);
    }
}
