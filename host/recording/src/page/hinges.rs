//! The table of hinges.

use super::Html;
use crate::run::Run;
use std::collections::BTreeMap;
use zygote_controller::HingeOutcome;

pub(super) fn section(page: &mut Html, run: &Run<'_>) {
    let planned: BTreeMap<_, _> = run.schedule.steps.iter().map(|step| (step.hinge, step)).collect();
    page.add(
        "<section><h2>Hinges</h2><div class=\"wide\"><table><thead><tr><th>hinge</th><th>kind</th><th>channel</th><th>outcome</th>\
         <th>planned start, s</th><th>started, s</th><th>at its angle, s</th><th>done, s</th><th>hottest, °C</th></tr></thead><tbody>\n",
    );
    for hinge in run.hinges.values() {
        let (class, outcome) = match hinge.outcome {
            HingeOutcome::Opened
                if hinge.started_s.is_none() && run.recording.open.contains(&hinge.hinge) =>
            {
                ("muted", "before this run")
            }
            HingeOutcome::Opened => ("good", "at its angle"),
            HingeOutcome::Interrupted => ("bad", "interrupted"),
            HingeOutcome::NotMoved => ("muted", "not moved"),
        };
        let number = |value: Option<f64>| value.map_or_else(String::new, |value| format!("{value:.1}"));
        #[expect(clippy::cast_precision_loss, reason = "a makespan is far below 2^52 ms")]
        let planned = planned.get(&hinge.hinge).map(|step| step.start.0 as f64 / 1e3);
        page.add(format_args!(
            "<tr><td class=\"n\">{}</td><td>{}</td><td class=\"n\">{}</td><td class=\"{class}\">{outcome}</td><td class=\"n\">{}</td>\
             <td class=\"n\">{}</td><td class=\"n\">{}</td><td class=\"n\">{}</td><td class=\"n\">{}</td></tr>\n",
            hinge.hinge,
            hinge.kind.name(),
            hinge.channel,
            number(planned),
            number(hinge.started_s),
            number(hinge.opened_s),
            number(hinge.done_s),
            number(hinge.peak_c),
        ));
    }
    page.add("</tbody></table></div></section>\n");
}
