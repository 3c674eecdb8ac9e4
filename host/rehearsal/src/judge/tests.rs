//! Every rule of the judge condemns a rehearsal that breaks it: a good one, doctored.
#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]

use super::*;
use crate::cause::{Cause, What, When};
use crate::run::Ending;
use crate::witness::Span;
use zygote_controller::{HingeOutcome, Outcome};
use zygote_protocol::{Millis, State, StepState};
use zygote_sim::plant::{Fault, Hinge};

const SPAN: Span = Span { from: Micros(1_000_000), to: Micros(1_200_000) };

/// The first random trial with an SMA hinge that waits for another, in which nothing goes wrong.
fn good() -> (Trial, Rehearsed) {
    for number in 0.. {
        let mut trial = crate::campaign::trial(7, number).unwrap();
        (trial.causes, trial.line) = (Vec::new(), Vec::new());
        let heaters = trial.plant.heaters.len();
        if heaters > 0 && trial.schedule.steps.iter().any(|step| !step.after.is_empty()) {
            let rehearsed = trial.run().unwrap();
            assert_eq!(judge(&trial, &rehearsed), []);
            return (trial, rehearsed);
        }
    }
    unreachable!("one in a few trials is such a one")
}

fn rules(doctor: impl FnOnce(&mut Trial, &mut Rehearsed)) -> Vec<&'static str> {
    let (mut trial, mut rehearsed) = good();
    doctor(&mut trial, &mut rehearsed);
    judge(&trial, &rehearsed).iter().map(|breach| breach.rule).collect()
}

#[test]
fn currents_at_the_wrong_time_or_too_strong_are_condemned() {
    assert_eq!(rules(|_, rehearsed| rehearsed.witness.unarmed.push(SPAN)), ["S2"]);
    assert_eq!(rules(|_, rehearsed| rehearsed.witness.unheard.push(SPAN)), ["S3"]);
    assert_eq!(rules(|_, rehearsed| rehearsed.witness.over_current.push(SPAN)), ["S7"]);
    let short = Span { to: SPAN.from.plus(Millis(25)), ..SPAN };
    assert!(rules(|_, rehearsed| rehearsed.witness.over_current.push(short)).is_empty(), "the guard filters");
}

#[test]
fn a_foil_over_its_limit_and_physics_is_condemned_and_one_over_the_ceiling_twice() {
    let heat = |celsius| {
        rules(|_, rehearsed| {
            let sma = rehearsed.witness.hinges.iter_mut().find(|hinge| hinge.hottest.is_some());
            sma.unwrap().hottest = Some((celsius, SPAN.from));
        })
    };
    assert!(heat(95.0).is_empty());
    assert_eq!(heat(129.0), ["S4"]);
    assert_eq!(heat(131.0), ["S4", "S4"]);
}

#[test]
fn current_past_the_deadline_of_a_cause_is_condemned_by_its_rule() {
    for (what, rule) in [
        (What::StopButton(true), "S8"),
        (What::StopFrame, "S8"),
        (What::SecondHost, "S2"),
        (What::Reset(zygote_protocol::ResetCause::Pin), "S1"),
        (What::Break(Fault::ThermistorOpen(0)), "S5"),
        (What::Hang(zygote_sim::Stuck::Everything), "S9"),
    ] {
        let found = rules(|_, rehearsed| {
            let cause = Cause { when: When::At(Micros(0)), after: Millis(0), what: what.clone() };
            rehearsed.script = crate::script::Script::of_the_past(vec![(cause, SPAN.from)]);
            rehearsed.witness.energised = vec![Span { to: SPAN.from.plus(Millis(501)), ..SPAN }];
        });
        // The deadline lies within the span: its start is the cause.
        assert_eq!(found, [rule], "{what}");
    }
}

#[test]
fn an_order_that_was_not_kept_is_condemned_unless_the_hinge_before_is_jammed() {
    let early = |rehearsed: &mut Rehearsed| {
        let steps = &mut rehearsed.witness.hinges;
        let last = steps.len() - 1;
        steps[last].driven_before = vec![0];
    };
    assert_eq!(rules(|_, rehearsed| early(rehearsed)), ["S10"]);
    let excused = rules(|trial, rehearsed| {
        early(rehearsed);
        let step = &trial.schedule.steps[0];
        let channel = usize::from(step.channel);
        let hinge = match step.motion.kind() {
            zygote_deployment::Kind::Sma => Hinge::Sma(channel),
            zygote_deployment::Kind::Servo => Hinge::Servo(channel),
            zygote_deployment::Kind::Spring => Hinge::Spring(channel),
        };
        let what = What::Break(Fault::Jammed(hinge));
        let cause = Cause { when: When::At(Micros(0)), after: Millis(0), what };
        rehearsed.script = crate::script::Script::of_the_past(vec![(cause, Micros(0))]);
    });
    assert!(excused.is_empty(), "{excused:?}");
}

#[test]
fn what_is_done_twice_is_condemned() {
    assert_eq!(rules(|_, rehearsed| rehearsed.witness.states.push((SPAN.from, State::Armed))), ["S11"]);
    assert_eq!(rules(|_, rehearsed| rehearsed.witness.states.push((SPAN.from, State::Running))), ["S11"]);
    assert_eq!(rules(|_, rehearsed| rehearsed.witness.hinges[0].starts = 2), ["S11"]);
}

#[test]
fn a_report_that_is_not_so_is_condemned() {
    let report = |rehearsed: &mut Rehearsed, change: &dyn Fn(&mut zygote_controller::RunReport)| {
        let Ending::Report(report) = &mut rehearsed.ending else { panic!("{:?}", rehearsed.ending) };
        change(report);
    };
    assert_eq!(rules(|_, rehearsed| rehearsed.witness.hinges[0].angle_deg = 45.0), ["S12"]);
    let not_moved = |outcome: Outcome| {
        rules(|_, rehearsed| {
            report(rehearsed, &|report| {
                report.outcome = outcome.clone();
                report.hinges[0].outcome = HingeOutcome::NotMoved;
            });
        })
    };
    assert_eq!(not_moved(Outcome::Stopped), ["S12"]);
    assert!(not_moved(Outcome::Lost(String::new())).is_empty(), "a host that lost its board can't know");
    assert_eq!(not_moved(Outcome::Deployed), ["S12", "S12"], "neither whole nor true");
}

#[test]
fn a_host_that_does_not_end_is_condemned() {
    assert_eq!(rules(|_, rehearsed| rehearsed.overran = true), ["end"]);
}

#[test]
fn a_cause_waits_for_its_step_and_then_for_its_time() {
    let (mut trial, _) = good();
    let when = When::Step { step: 0, state: StepState::Moving };
    trial.causes = vec![Cause { when, after: Millis(123), what: What::StopFrame }];
    let rehearsed = trial.run().unwrap();
    let started = rehearsed.witness.hinges[0].driven_at.unwrap();
    assert_eq!(rehearsed.script.time_of(0), Some(started.plus(Millis(123))));
    assert_eq!(judge(&trial, &rehearsed), []);
}
