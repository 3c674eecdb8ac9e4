//! S1 to S3, S5, S7, S8: what must be off by when, by the true current out of the supply.

use super::{Breach, seconds};
use crate::cause::What;
use crate::run::{Rehearsed, Trial};
use crate::witness::{Span, Witness};
use zygote_protocol::{Micros, Millis};
use zygote_sim::TICK;
use zygote_sim::plant::Fault;

/// S8: a stop acts within this.
const STOP: Millis = Millis(10);
/// S5: three bad samples, and 100 ms from the one after.
const SENSOR: Millis = Millis(100 + 3 * TICK.0);
/// S7: three samples, one tick until they are taken and one in which the third acts.
const OVER_CURRENT: Millis = Millis(5 * TICK.0);

pub(super) fn judge(trial: &Trial, rehearsed: &Rehearsed) -> Vec<Breach> {
    let witness = &rehearsed.witness;
    let mut breaches = Vec::new();
    for span in &witness.unarmed {
        breaches.push(Breach::new("S2", span.from, format!("current for {} us while nothing was armed", length(*span))));
    }
    for span in &witness.unheard {
        let last = witness.heard.last_frame.unwrap_or_default();
        let what = format!("current {} us later, last frame of the host at {:.3} s", length(*span), seconds(last));
        breaches.push(Breach::new("S3", span.from, what));
    }
    for span in witness.over_current.iter().filter(|span| length(**span) > OVER_CURRENT.to_micros()) {
        breaches.push(Breach::new("S7", span.from, format!("over the limit and its margin for {} us", length(*span))));
    }
    for (at, what) in rehearsed.script.happened() {
        if let Some((rule, deadline)) = deadline(trial, witness, at, what) {
            let still = witness.energised.iter().find(|span| span.to > deadline && span.from < deadline);
            if let Some(span) = still {
                let over = format!("{what}: current until {:.3} s, off was due at {:.3} s", seconds(span.to), seconds(deadline));
                breaches.push(Breach::new(rule, at, over));
            }
        }
    }
    breaches
}

/// The rule after which everything must be off, and by when; for causes that ask for it whatever else is the case.
fn deadline(trial: &Trial, witness: &Witness, at: Micros, what: &What) -> Option<(&'static str, Micros)> {
    match what {
        What::Break(Fault::ThermistorOpen(channel) | Fault::ThermistorShorted(channel)) => {
            let used = |hinge: &crate::witness::HingeTruth| {
                hinge.kind == zygote_deployment::Kind::Sma && hinge.channel == *channel
            };
            witness.hinges.iter().find(|hinge| used(hinge))?;
            // Guards look while something is armed.
            let armed = witness.energised.iter().find(|span| span.to > at)?;
            Some(("S5", at.max(armed.from).plus(SENSOR)))
        }
        What::Reset(_) => Some(("S1", at)),
        What::StopButton(true) => Some(("S8", at.plus(STOP))),
        What::StopFrame => Some(("S8", at.plus(STOP))),
        What::SecondHost => Some(("S2", at.plus(STOP))),
        What::KillHost => Some(("S3", at.plus(link_loss(trial)))),
        What::Break(_)
        | What::StopButton(false)
        | What::Cut(..)
        | What::Impair(..)
        | What::UserStops
        | What::Replay
        | What::Garbage(_) => None,
    }
}

/// From a host's last word to everything off. What it said before may still be under way on a slow line.
fn link_loss(trial: &Trial) -> Millis {
    let delay = trial.line.iter().map(|(_, line)| line.delay.0).max().unwrap_or(0);
    Millis(trial.link_timeout().0 + crate::run::LINK_GRACE.0 + delay)
}

fn length(span: Span) -> u64 {
    span.to.since(span.from)
}
