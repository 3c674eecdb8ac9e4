//! Hinges held against their calibration, those first that need another one.

use super::{Html, escaped};
use crate::run::Run;
use zygote_controller::{DriftVerdict, HingeDrift};

pub(super) fn section(page: &mut Html, run: &Run<'_>) {
    let Some(report) = run.recording.report.as_ref().filter(|report| !report.drift.is_empty()) else {
        return;
    };
    let of = |verdict| report.drift.iter().filter(move |hinge| hinge.verdict == verdict);
    page.add(format_args!(
        "<section><h2>Calibration</h2><p>{} of {} hinges are as they were measured.</p>\n",
        of(DriftVerdict::Keep).count(),
        report.drift.len()
    ));
    let rows: Vec<&HingeDrift> = of(DriftVerdict::Recalibrate).chain(of(DriftVerdict::CannotTell)).collect();
    if !rows.is_empty() {
        page.add(
            "<div class=\"wide\"><table><thead><tr><th>hinge</th><th>calibrated</th><th>verdict</th><th>why</th></tr></thead><tbody>\n",
        );
        for hinge in rows {
            let class = if hinge.verdict == DriftVerdict::Recalibrate { "bad" } else { "muted" };
            page.add(format_args!(
                "<tr><td class=\"n\">{}</td><td>{}</td><td class=\"{class}\">{}</td><td>{}</td></tr>\n",
                hinge.hinge,
                escaped(&hinge.calibrated),
                hinge.verdict.name(),
                escaped(hinge.why.join("; ")),
            ));
        }
        page.add("</tbody></table></div>\n");
    }
    page.add("</section>\n");
}
