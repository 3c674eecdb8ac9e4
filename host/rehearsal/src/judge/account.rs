//! S10 to S12: the order that was kept, what was done twice, and whether the report is so.

use super::{Breach, Excuses};
use crate::run::{Ending, Rehearsed};
use zygote_controller::{HingeOutcome, Outcome, RunReport};
use zygote_protocol::State;

pub(super) fn judge(rehearsed: &Rehearsed, excuses: &Excuses) -> Vec<Breach> {
    let mut breaches = order(rehearsed, excuses);
    breaches.extend(once(rehearsed));
    if rehearsed.overran {
        breaches.push(Breach::new("end", rehearsed.ended_at, "the host didn't end".to_owned()));
    }
    match &rehearsed.ending {
        Ending::Report(report) => breaches.extend(account(rehearsed, report, excuses)),
        Ending::Measured { .. } | Ending::Refused(_) | Ending::Killed => {}
    }
    breaches
}

fn order(rehearsed: &Rehearsed, excuses: &Excuses) -> Vec<Breach> {
    let hinges = &rehearsed.witness.hinges;
    let mut breaches = Vec::new();
    for hinge in hinges {
        for before in hinge.driven_before.iter().filter(|before| !excuses.may_be_closed(**before)) {
            let (at, first) =
                (hinge.driven_at.unwrap_or_default(), hinges.get(*before).map(|first| first.hinge));
            let what = format!("hinge {} was driven while hinge {first:?} before it was closed", hinge.hinge);
            breaches.push(Breach::new("S10", at, what));
        }
    }
    breaches
}

fn once(rehearsed: &Rehearsed) -> Vec<Breach> {
    let (witness, at) = (&rehearsed.witness, rehearsed.ended_at);
    let mut breaches = Vec::new();
    for state in [State::Armed, State::Running] {
        let times = witness.times_in(state);
        if times > 1 {
            breaches.push(Breach::new("S11", at, format!("{state:?} {times} times, asked for once")));
        }
    }
    for hinge in witness.hinges.iter().filter(|hinge| hinge.starts > 1) {
        breaches.push(Breach::new(
            "S11",
            at,
            format!("hinge {} started {} times", hinge.hinge, hinge.starts),
        ));
    }
    breaches
}

fn account(rehearsed: &Rehearsed, report: &RunReport, excuses: &Excuses) -> Vec<Breach> {
    let mut breaches = Vec::new();
    let complete = matches!(report.outcome, Outcome::Deployed | Outcome::Folded);
    if complete != report.is_complete() {
        let what = format!("{:?}, but not every hinge is at its angle", report.outcome);
        breaches.push(Breach::new("S12", rehearsed.ended_at, what));
    }
    for (at, (told, truth)) in report.hinges.iter().zip(&rehearsed.witness.hinges).enumerate() {
        let wrong = match told.outcome {
            HingeOutcome::Opened => !truth.is_open() && !excuses.may_be_closed(at),
            // A host that lost its board knows no later than that.
            HingeOutcome::NotMoved if matches!(report.outcome, Outcome::Lost(_)) => false,
            HingeOutcome::NotMoved => !truth.has_not_moved() && !excuses.may_have_moved(at),
            HingeOutcome::Interrupted => false,
        };
        if wrong {
            let what = format!(
                "hinge {} is reported as {:?}, truly at {:.1}° of {:.1}°",
                told.hinge, told.outcome, truth.angle_deg, truth.goal_deg
            );
            breaches.push(Breach::new("S12", rehearsed.ended_at, what));
        }
    }
    breaches
}
