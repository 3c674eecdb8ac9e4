//! S1 to S3, S5, S7, S8: what must be off by when, by the true current out of the supply.

use super::{Breach, seconds};
use crate::cause::What;
use crate::run::Rehearsed;
use crate::witness::{HingeTruth, Span, Witness};
use zygote_deployment::Kind;
use zygote_protocol::{Micros, Millis, State};
use zygote_sim::TICK;
use zygote_sim::plant::Fault;

/// S8: a stop acts within this.
const STOP: Millis = Millis(10);
/// S5: three bad samples, and 100 ms from the one after.
const SENSOR: Millis = Millis(100 + 3 * TICK.0);
/// S9: a stuck program ends in a reset within this.
const WATCHDOG: Millis = Millis(500);
/// S7: three samples, one tick until they are taken and one in which the third acts.
const OVER_CURRENT: Millis = Millis(5 * TICK.0);

/// Whose current a dead thermistor ends.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Ends {
    /// That of all hinges of the program.
    All,
    /// That of its own: a program may leave the others' out.
    Own,
}

pub(super) fn judge(rehearsed: &Rehearsed, ends: Ends) -> Vec<Breach> {
    let witness = &rehearsed.witness;
    let mut breaches = Vec::new();
    for span in &witness.unarmed {
        let what = format!("current for {} us while nothing was armed", length(*span));
        breaches.push(Breach::new("S2", span.from, what));
    }
    for span in witness.unheard.iter().filter(|span| span.to > stuck_until(rehearsed, span.from)) {
        let last = witness.heard.last_frame.unwrap_or_default();
        let what =
            format!("current for {} us, last frame of the host at {:.3} s", length(*span), seconds(last));
        breaches.push(Breach::new("S3", span.from, what));
    }
    let long = |span: &&Span| length(**span) > OVER_CURRENT.to_micros();
    for span in witness.over_current.iter().filter(long) {
        if span.to > stuck_until(rehearsed, span.from) {
            let what = format!("over the limit and its margin for {} us", length(*span));
            breaches.push(Breach::new("S7", span.from, what));
        }
    }
    for (at, what) in rehearsed.script.happened() {
        let Some((rule, deadline)) = deadline(witness, at, what, ends) else { continue };
        let deadline = deadline.max(stuck_until(rehearsed, at));
        // Armed anew after the cause is another matter, which S2 and S11 judge; but not for a sensor that is still dead.
        let anew = |span: &Span| {
            let armed =
                |(when, state): &(Micros, State)| *state == State::Armed && at < *when && *when <= span.from;
            rule != "S5" && witness.states.iter().any(armed)
        };
        let still = |span: &&Span| span.to > deadline && span.from <= deadline && !anew(span);
        if let Some(span) = witness.energised.iter().find(still) {
            let (until, due) = (seconds(span.to), seconds(deadline));
            let over = format!("{what}: current until {until:.3} s, off was due at {due:.3} s");
            breaches.push(Breach::new(rule, at, over));
        }
    }
    breaches
}

/// A program that is stuck decides nothing: until its reset, S9's time is the one that holds for all others. `at` where
/// nothing is stuck then.
fn stuck_until(rehearsed: &Rehearsed, at: Micros) -> Micros {
    let happened = rehearsed.script.happened();
    let stuck = happened.filter(|(since, what)| matches!(what, What::Hang(_)) && *since <= at);
    let until = stuck.map(|(since, _)| since.plus(WATCHDOG)).filter(|until| *until > at).max();
    until.unwrap_or(at)
}

/// The rule after which everything must be off, and by when; for causes that ask for it whatever else is the case. A lost
/// link is judged by the host's last frame, not here.
fn deadline(witness: &Witness, at: Micros, what: &What, ends: Ends) -> Option<(&'static str, Micros)> {
    match what {
        What::Break(Fault::ThermistorOpen(channel) | Fault::ThermistorShorted(channel)) => {
            let used = |hinge: &&HingeTruth| hinge.kind == Kind::Sma && hinge.channel == *channel;
            let hinge = witness.hinges.iter().find(used)?;
            // Guards look while something is armed.
            let armed = match ends {
                Ends::All => witness.energised.iter().find(|span| span.to > at)?,
                Ends::Own => hinge.heated.iter().find(|span| span.to > at.plus(SENSOR))?,
            };
            Some(("S5", at.max(armed.from).plus(SENSOR)))
        }
        What::Reset(_) => Some(("S1", at)),
        What::Hang(_) => Some(("S9", at.plus(WATCHDOG))),
        What::StopButton(true) | What::StopFrame => Some(("S8", at.plus(STOP))),
        What::SecondHost => Some(("S2", at.plus(STOP))),
        What::Break(_)
        | What::StopButton(false)
        | What::Cut(..)
        | What::Impair(..)
        | What::KillHost
        | What::UserStops
        | What::Replay
        | What::Garbage(_) => None,
    }
}

fn length(span: Span) -> u64 {
    span.to.since(span.from)
}
