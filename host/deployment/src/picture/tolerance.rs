//! The target twice, as the tree and as a single strip: every panel in the colour of its error, on one scale.

use super::scene::Scene;
use super::still::{side_by_side, target_plates};
use crate::tolerance::Tolerance;
use zygote_stacking::Plan;

/// A picture of the errors of panels in plans of one target, each with its heading. The scale goes from no error, dark, to the
/// greatest of all, bright.
pub fn tolerance(plans: &[(&Plan, &Tolerance, &str)]) -> String {
    let greatest = |tolerance: &Tolerance| tolerance.panel_rms.iter().copied().fold(0.0, f64::max);
    let top = plans.iter().map(|(_, tolerance, _)| greatest(tolerance)).fold(0.0, f64::max);
    let scenes: Vec<_> = plans
        .iter()
        .map(|(plan, tolerance, head)| {
            let share = |rms: &f64| if top > 0.0 { rms / top } else { 0.0 };
            let values: Vec<f64> = tolerance.panel_rms.iter().map(share).collect();
            let scene = Scene::by_value(plan, &target_plates(plan), &values);
            let at_most = greatest(tolerance) * plan.panel_length_mm;
            let note =
                format!("off by up to {at_most:.1} mm rms, scale to {:.1} mm", top * plan.panel_length_mm);
            (scene, [(*head).to_owned(), note])
        })
        .collect();
    plans.first().map_or_else(String::new, |(plan, _, _)| side_by_side(plan, &scenes))
}
