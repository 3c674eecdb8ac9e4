//! Stages of a deployment in a row.

use super::document::Document;
use super::scene::Scene;
use super::stage::{Timeline, TimelineError, ease};
use super::still::{CAPTION, MARGIN, captions, plates, scale_for, title};
use crate::kinematics::Kinematics;
use glam::{DQuat, DVec2, DVec3};
use zygote_stacking::Plan;

/// The whole strip is about as large as this at most.
const LARGEST: DVec2 = DVec2::new(1500.0, 900.0);

/// A strip of `stages` stages (at least 2), from the zygote to the target, evenly spaced in time.
///
/// The root stays where it is on the picture, and the eye goes around it: the zygote stands upright at the start,
/// the target at the end.
///
/// # Errors
/// [`TimelineError`] if the plan is no tree or its schedule isn't its own.
pub fn film(plan: &Plan, stages: usize) -> Result<String, TimelineError> {
    let timeline = Timeline::new(plan)?;
    let set = Set::new(plan)?;
    let last = stages.max(2) - 1;
    let times: Vec<_> = (0..=last).map(|stage| timeline.end() * stage as f64 / last as f64).collect();
    let scenes: Vec<_> = times.iter().map(|time| set.scene(&timeline, *time)).collect();
    let count = scenes.len() as f64;
    let tallest = scenes.iter().map(|scene| scene.bounds.size().y).fold(0.0, f64::max);
    let widths: f64 = scenes.iter().map(|scene| scene.bounds.size().x).sum();
    let around = DVec2::new(MARGIN * (count + 1.0), MARGIN * 2.0 + CAPTION);
    let scale = scale_for(DVec2::new(widths, tallest), around, LARGEST);
    // Wide enough for the captions.
    let width = |scene: &Scene| (scene.bounds.size().x * scale).max(110.0);
    let floor = MARGIN + tallest * scale;
    let whole = DVec2::new(scenes.iter().map(width).sum::<f64>() + around.x, floor + MARGIN + CAPTION);
    let mut document = Document::new(whole, scale);
    let mut left = MARGIN;
    for (scene, time) in scenes.iter().zip(times) {
        let extent = document.extent(&scene.bounds);
        document.scene(scene, &scene.bounds, DVec2::new(left + (width(scene) - extent.x) / 2.0, floor));
        let opened = format!("{} of {}", timeline.opened(time), plan.hinges.len());
        let middle = DVec2::new(left + width(scene) / 2.0, floor);
        let (head, note) = match timeline.clock(time) {
            Some(clock) => (clock, format!("{opened} hinges")),
            None => (opened, "hinges".to_owned()),
        };
        captions(&mut document, &head, &note, middle);
        left += width(scene) + MARGIN;
    }
    Ok(document.finish(&title(plan)))
}

/// A plan ready to be shown at any time.
pub(super) struct Set<'a> {
    plan: &'a Plan,
    kinematics: Kinematics,
    /// From the zygote's space to the target's.
    turn: DQuat,
    /// Middle of the root.
    middle: DVec3,
}

impl<'a> Set<'a> {
    pub(super) fn new(plan: &'a Plan) -> Result<Self, TimelineError> {
        let kinematics = Kinematics::new(plan)?;
        let turn = DQuat::from_mat3(&kinematics.target_from_zygote().matrix3);
        let closed = vec![0.0; plan.hinges.len()];
        let root = kinematics.corners(&closed, plan.thickness)[plan.root];
        Ok(Self { plan, kinematics, turn, middle: (root[0] + root[2]) / 2.0 })
    }

    pub(super) fn scene(&self, timeline: &Timeline, time: f64) -> Scene {
        let fractions = timeline.fractions(time);
        let mut plates = plates(&self.kinematics, &fractions, self.plan.thickness);
        let turn = DQuat::IDENTITY.slerp(self.turn, ease(time / timeline.end().max(1e-9)));
        for plate in &mut plates {
            plate.corners = plate.corners.map(|corner| turn * (corner - self.middle));
            plate.down = turn * plate.down;
        }
        Scene::new(self.plan, &plates)
    }
}
