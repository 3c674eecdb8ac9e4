//! A schedule run backwards: servos go both ways, so a shape that opened folds up again.
//!
//! What waits for what is turned round, and so are pulses, angles and times. [`Schedule::verify`] holds a schedule against the way
//! out; the way back is verified by turning it round once more.

use super::{
    Fingerprint, MOST_AFTER, Milliamps, Millis, Motion, Schedule, ServoMotion, Step, VerifyError, reduction,
};
use crate::rig::{Kind, Rig};
use serde::{Deserialize, Serialize};
use zygote_stacking::Plan;

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
    /// Turned round, it is no good schedule.
    #[error(transparent)]
    Verify(#[from] VerifyError),
}

/// Which way a schedule goes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Direction {
    /// From the zygote to the target.
    Deploy,
    /// From the target to the zygote.
    Fold,
}

impl Schedule {
    /// Which way it goes: an opening angle that falls is on the way back.
    pub fn direction(&self) -> Direction {
        let falls = |step: &Step| step.opening_deg < step.from_opening_deg;
        if self.steps.iter().any(falls) { Direction::Fold } else { Direction::Deploy }
    }

    /// Checks that this schedule may be run for this plan on this rig, whichever way it goes.
    ///
    /// # Errors
    /// [`ReverseError`] with the first thing that is wrong.
    pub fn verify_either_way(&self, plan: &Plan, rig: &Rig) -> Result<(), ReverseError> {
        match self.direction() {
            Direction::Deploy => Ok(self.verify(plan, rig)?),
            Direction::Fold => self.verify_reversed(plan, rig),
        }
    }

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
        let order: Vec<_> = (0..after.len()).collect();
        let mut after = reduction::of(after, &order).into_iter();
        let mut steps: Vec<Step> = Vec::with_capacity(self.steps.len());
        for step in self.steps.iter().rev() {
            let waits = after.next().unwrap_or_default();
            if waits.len() > MOST_AFTER {
                return Err(ReverseError::TooManyBefore { hinge: step.hinge, found: waits.len() });
            }
            steps.push(Step {
                after: waits,
                from_opening_deg: step.opening_deg,
                opening_deg: step.from_opening_deg,
                start: Millis(makespan.0.saturating_sub(step.opened().0)),
                motion: Motion::Servo(backwards(step)?),
                ..step.clone()
            });
        }
        let order_crc64 = Fingerprint::of_order(&steps);
        let mut reversed = Self { order_crc64, steps, ..self.clone() };
        reversed.peak_current = reversed.peak()?;
        Ok(reversed)
    }

    /// Checks that this schedule folds this plan up again on this rig: turned round once more it is verified, and its own currents are.
    ///
    /// # Errors
    /// [`ReverseError`] with the first thing that is wrong.
    pub fn verify_reversed(&self, plan: &Plan, rig: &Rig) -> Result<(), ReverseError> {
        let same = |key, expected: String, found: String| {
            if expected == found { Ok(()) } else { Err(VerifyError::Whole { key, expected, found }) }
        };
        let order = Fingerprint::of_order(&self.steps);
        same("order_crc64", order.to_string(), self.order_crc64.to_string())?;
        same("peak_current_ma", self.peak()?.to_string(), self.peak_current.to_string())?;
        Ok(self.reversed()?.verify(plan, rig)?)
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
    use crate::order::Order;
    use crate::schedule::Limits;
    use crate::testing::{real_plans, rig_text};
    use crate::tree::Tree;

    fn rig(extra: &str, limit: &str) -> Rig {
        let text = rig_text(&format!("[hinges]\ndefault = \"servo\"\n{extra}"));
        let text = text.replace("servos = 4", "servos = 100").replace("2 A", limit);
        Rig::read("rig.toml", &text).expect("a good rig")
    }

    fn scheduled(extra: &str, limit: &str, parallel: usize, plan: usize) -> Schedule {
        let (plan, rig) = (&real_plans()[plan], rig(extra, limit));
        let order = Order::of_tree(&Tree::new(plan).expect("a tree"));
        let schedule = Schedule::plan(plan, &rig, &order, &Limits::at_most(parallel)).expect("a schedule");
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
            back.verify_reversed(&real_plans()[plan], &rig("", "2 A")).expect("it is good backwards");
            // Whatever waited is over by then.
            for (index, step) in forward.steps.iter().enumerate() {
                for other in &step.after {
                    assert!(back.steps[last - other].start >= back.steps[last - index].opened());
                }
            }
        }
    }

    #[test]
    fn twice_reversed_it_is_what_it_was_but_for_waits_that_others_imply() {
        let forward = scheduled("", "2 A", 1, 3);
        let back = forward.reversed().expect("servos alone");
        let again = back.reversed().expect("servos alone");
        for (step, before) in again.steps.iter().zip(&forward.steps) {
            assert!(step.after.iter().all(|wait| before.after.contains(wait)));
            assert_eq!(
                Step { after: Vec::new(), ..step.clone() },
                Step { after: Vec::new(), ..before.clone() }
            );
        }
        assert_eq!(again.reversed().expect("servos alone"), back);
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
    fn a_way_back_that_was_changed_is_refused() {
        let plan = &real_plans()[1];
        let back = scheduled("", "2 A", 1, 1).reversed().expect("servos alone");
        let refusal = |change: &dyn Fn(&mut Schedule)| {
            let mut changed = back.clone();
            change(&mut changed);
            changed.verify_reversed(plan, &rig("", "2 A")).expect_err("changed").to_string()
        };
        assert!(refusal(&|back| back.steps[2].after = vec![]).contains("order_crc64 should be"));
        assert!(refusal(&|back| back.peak_current.0 += 1).contains("peak_current_ma should be"));
        let swapped = refusal(&|back| {
            back.steps.swap(3, 4);
            back.order_crc64 = Fingerprint::of_order(&back.steps);
        });
        assert!(swapped.contains("after should be"), "{swapped}");
        assert!(refusal(&|back| back.steps[1].opening_deg = 90).contains("from_opening_deg should be"));
    }
}
