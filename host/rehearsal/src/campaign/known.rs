//! Rules that are known not to hold today, each with what it takes: such breaches are counted apart, so that a
//! campaign fails for what is new. A line is taken off as soon as its rule holds.

use crate::cause::What;
use crate::judge::Breach;
use crate::run::Rehearsed;
use zygote_protocol::ResetCause;

/// A gap that is known.
struct Gap {
    rule: &'static str,
    about: &'static str,
    /// Of what happened, all of these.
    needs: &'static [fn(&What, &Breach) -> bool],
}

const REPLAYED: &str = "a session that is replayed from its hello on is executed again after power was off: nothing is kept over that";
const REPLAY_AFTER_POWER: &[fn(&What, &Breach) -> bool] =
    &[|what, _| matches!(what, What::Replay), |what, _| matches!(what, What::Reset(ResetCause::Power))];

const GAPS: &[Gap] = &[
    Gap { rule: "S11", about: REPLAYED, needs: REPLAY_AFTER_POWER },
    // What such a second run does to hinges that the host knows to be open.
    Gap { rule: "S12", about: REPLAYED, needs: REPLAY_AFTER_POWER },
];

/// The gap that a breach belongs to.
pub(super) fn gap(rehearsed: &Rehearsed, breach: &Breach) -> Option<&'static str> {
    let happened =
        |need: &fn(&What, &Breach) -> bool| rehearsed.script.happened().any(|(_, what)| need(what, breach));
    let fits = |gap: &&Gap| gap.rule == breach.rule && gap.needs.iter().all(happened);
    GAPS.iter().find(fits).map(|gap| gap.about)
}
