//! What is left of a schedule when some hinges are open already: a run that broke off goes on from there (S12).

use super::{Millis, Schedule, Step};
use std::collections::BTreeSet;

impl Schedule {
    /// The steps of hinges that aren't among `open`. They wait for each other as before, and come as far apart; the first starts at 0.
    #[must_use]
    pub fn rest(&self, open: &BTreeSet<usize>) -> Self {
        let is_left = |step: &&Step| !open.contains(&step.hinge);
        let begin = self.steps.iter().filter(is_left).map(|step| step.start).min().unwrap_or_default();
        // Of each step, how many before it are left.
        let mut place = Vec::with_capacity(self.steps.len());
        let mut steps: Vec<Step> = Vec::with_capacity(self.steps.len());
        for step in &self.steps {
            place.push(steps.len());
            if !open.contains(&step.hinge) {
                let waits = step.after.iter().filter(|before| is_left(&&self.steps[**before]));
                let after = waits.map(|before| place[*before]).collect();
                steps.push(Step { after, start: Millis(step.start.0 - begin.0), ..step.clone() });
            }
        }
        let makespan = steps.iter().map(Step::opened).max().unwrap_or_default();
        Self { makespan, steps, ..self.clone() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::order::Order;
    use crate::rig::Rig;
    use crate::schedule::Limits;
    use crate::testing::{real_plans, rig_text};
    use crate::tree::Tree;

    fn scheduled() -> Schedule {
        let plan = &real_plans()[2];
        let text = rig_text("[hinges]\ndefault = \"servo\"\n").replace("servos = 4", "servos = 100");
        let rig = Rig::read("rig.toml", &text).expect("a good rig");
        let order = Order::of_tree(&Tree::new(plan).expect("a tree"));
        Schedule::plan(plan, &rig, &order, &Limits::at_most(3)).expect("a schedule")
    }

    #[test]
    fn what_is_left_waits_for_what_it_waited_for_unless_that_is_open() {
        let whole = scheduled();
        for count in [0, 1, whole.steps.len() / 2, whole.steps.len()] {
            let open: BTreeSet<_> = whole.steps.iter().take(count).map(|step| step.hinge).collect();
            let rest = whole.rest(&open);
            assert_eq!(rest.steps.len(), whole.steps.len() - count);
            for (step, before) in rest.steps.iter().zip(whole.steps.iter().skip(count)) {
                assert_eq!(step.hinge, before.hinge);
                let waits: Vec<_> = step.after.iter().map(|wait| rest.steps[*wait].hinge).collect();
                let expected: Vec<_> = before
                    .after
                    .iter()
                    .map(|wait| whole.steps[*wait].hinge)
                    .filter(|hinge| !open.contains(hinge))
                    .collect();
                assert_eq!(waits, expected);
            }
            assert!(rest.steps.is_empty() || rest.steps.iter().any(|step| step.start == Millis(0)));
        }
        assert_eq!(whole.rest(&BTreeSet::new()), whole);
    }
}
