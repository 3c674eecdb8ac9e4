//! The target, the zygote, or both side by side.

use super::document::Document;
use super::scene::{Plate, Scene};
use crate::kinematics::Kinematics;
use crate::tree::TreeError;
use glam::{DVec2, DVec3};
use zygote_stacking::Plan;

/// Room around everything, pixels.
pub(super) const MARGIN: f64 = 36.0;
/// Room for a headline and a line under it.
pub(super) const CAPTION: f64 = 66.0;
/// The whole picture is about as large as this at most.
const LARGEST: DVec2 = DVec2::new(1000.0, 640.0);
/// A panel isn't drawn larger, so that a cube doesn't fill a page.
const LARGEST_PANEL: f64 = 84.0;

/// A picture of the target.
pub fn target(plan: &Plan) -> String {
    side_by_side(plan, &[(target_scene(plan), target_caption(plan))])
}

/// A picture of the zygote, its panels spread by the plan's thickness.
///
/// # Errors
/// [`TreeError`] if the plan is no tree.
pub fn zygote(plan: &Plan) -> Result<String, TreeError> {
    Ok(side_by_side(plan, &[(zygote_scene(plan)?, zygote_caption(plan))]))
}

/// Zygote and target side by side, to the same scale.
///
/// # Errors
/// [`TreeError`] if the plan is no tree.
pub fn both(plan: &Plan) -> Result<String, TreeError> {
    let scenes = [(zygote_scene(plan)?, zygote_caption(plan)), (target_scene(plan), target_caption(plan))];
    Ok(side_by_side(plan, &scenes))
}

/// What the file says of itself.
pub(super) fn title(plan: &Plan) -> String {
    format!("{}: {} panels in {}", plan.source.model, plan.target.len(), piles(plan))
}

fn piles(plan: &Plan) -> String {
    match plan.piles.len() {
        1 => "1 pile".to_owned(),
        count => format!("{count} piles"),
    }
}

type Caption = [String; 2];

fn zygote_caption(plan: &Plan) -> Caption {
    let height = plan.piles.first().map_or(0, |pile| pile.panels.len());
    ["Zygote".to_owned(), format!("{} of {height} panels", piles(plan))]
}

fn target_caption(plan: &Plan) -> Caption {
    [
        "Target".to_owned(),
        format!("{} panels · {:.1} times the volume", plan.target.len(), plan.expansion_ratio()),
    ]
}

fn target_scene(plan: &Plan) -> Scene {
    let plates: Vec<_> = plan
        .target
        .iter()
        .map(|panel| Plate {
            corners: panel.map(|corner| DVec3::from_array(corner.map(f64::from))),
            down: DVec3::ZERO,
        })
        .collect();
    Scene::new(plan, &plates)
}

fn zygote_scene(plan: &Plan) -> Result<Scene, TreeError> {
    let closed = vec![0.0; plan.hinges.len()];
    Ok(Scene::new(plan, &plates(&Kinematics::new(plan)?, &closed, plan.thickness)))
}

/// The panels with their hinges at some fractions; what still lies in a stack has a body.
pub(super) fn plates(kinematics: &Kinematics, fractions: &[f64], thickness: f64) -> Vec<Plate> {
    let layers = kinematics.layers(fractions);
    let corners = kinematics.corners(fractions, thickness);
    corners
        .into_iter()
        .zip(layers)
        .map(|(corners, up)| {
            let normal = (corners[1] - corners[0]).cross(corners[3] - corners[0]);
            Plate { corners, down: normal * (-up * thickness) }
        })
        .collect()
}

/// How large a panel is drawn so that `size`, in panel lengths, with `around` pixels about it fits `largest`.
pub(super) fn scale_for(size: DVec2, around: DVec2, largest: DVec2) -> f64 {
    ((largest - around).max(DVec2::splat(100.0)) / size.max(DVec2::splat(1e-3)))
        .min_element()
        .min(LARGEST_PANEL)
}

fn side_by_side(plan: &Plan, scenes: &[(Scene, Caption)]) -> String {
    // Wide enough for the captions, too.
    const NARROWEST: f64 = 230.0;
    let sizes = || scenes.iter().map(|(scene, _)| scene.bounds.size());
    let size = DVec2::new(sizes().map(|size| size.x).sum(), sizes().map(|size| size.y).fold(0.0, f64::max));
    let count = scenes.len() as f64;
    let scale = scale_for(size, DVec2::new(MARGIN * (count + 1.0), MARGIN * 2.0 + CAPTION), LARGEST);
    let widths: Vec<_> = sizes().map(|size| (size.x * scale).max(NARROWEST)).collect();
    let floor = MARGIN + size.y * scale;
    let whole = DVec2::new(widths.iter().sum::<f64>() + MARGIN * (count + 1.0), floor + MARGIN + CAPTION);
    let mut document = Document::new(whole, scale);
    let mut left = MARGIN;
    for ((scene, [head, note]), width) in scenes.iter().zip(widths) {
        let extent = document.extent(&scene.bounds);
        document.scene(scene, &scene.bounds, DVec2::new(left + (width - extent.x) / 2.0, floor));
        captions(&mut document, head, note, DVec2::new(left + width / 2.0, floor));
        left += width + MARGIN;
    }
    document.finish(&title(plan))
}

/// Writes two lines below the floor of a scene.
pub(super) fn captions(document: &mut Document, head: &str, note: &str, floor: DVec2) {
    document.caption(head, floor + DVec2::new(0.0, 48.0), "head");
    document.caption(note, floor + DVec2::new(0.0, 70.0), "note");
}
