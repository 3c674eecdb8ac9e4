//! Rules that are known not to hold today, each with what it takes: such breaches are counted apart, so that a
//! campaign fails for what is new. A line is taken off as soon as its rule holds.

use crate::cause::{What, Way};
use crate::judge::Breach;
use crate::run::Rehearsed;
use zygote_sim::plant::Fault;

/// A gap that is known.
struct Gap {
    rule: &'static str,
    about: &'static str,
    needs: fn(&What) -> bool,
}

const GAPS: &[Gap] = &[
    Gap {
        rule: "S4",
        about: "S5: a frozen thermistor isn't recognised, so its hinge heats until the longest on-time",
        needs: |what| matches!(what, What::Break(Fault::ThermistorFrozen(_))),
    },
    Gap {
        rule: "S12",
        about: "a host whose commands don't get through, but who hears the board, waits for ever",
        needs: |what| matches!(what, What::Cut(Way::ToBoard, None)),
    },
];

/// The gap that a breach belongs to.
pub(super) fn gap(rehearsed: &Rehearsed, breach: &Breach) -> Option<&'static str> {
    let fits = |gap: &&Gap| {
        gap.rule == breach.rule && rehearsed.script.happened().any(|(_, what)| (gap.needs)(what))
    };
    GAPS.iter().find(fits).map(|gap| gap.about)
}
