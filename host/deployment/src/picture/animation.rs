//! The whole deployment in one SVG that plays by itself, over and over.

use super::camera::Bounds;
use super::document::Document;
use super::film::Set;
use super::scene::Scene;
use super::stage::{Timeline, TimelineError};
use super::still::{MARGIN, scale_for, title};
use glam::DVec2;
use zygote_stacking::Plan;

/// The picture is about as large as this at most.
const LARGEST: DVec2 = DVec2::new(760.0, 760.0);
/// A frame shows for this long, seconds.
const FRAME_S: f64 = 0.05;
/// The zygote and the target are shown this long, seconds.
const REST_S: [f64; 2] = [1.0, 2.5];
/// Room for the bar below.
const BAR: f64 = 30.0;
/// Polygons of all frames together: what keeps a file below some 3 MB.
const POLYGONS: usize = 52_000;

/// An animation of `frames` frames; `None` for as many as keep the file small, at most 240. The times go as in
/// the plan's schedule. A viewer that plays nothing shows the target.
///
/// # Errors
/// [`TimelineError`] if the plan is no tree or its schedule isn't its own.
pub fn animation(plan: &Plan, frames: Option<usize>) -> Result<String, TimelineError> {
    let timeline = Timeline::new(plan)?;
    let set = Set::new(plan)?;
    // A panel in a stack is up to three polygons, an open one is one.
    let last =
        frames.unwrap_or_else(|| (POLYGONS / (2 * plan.target.len()).max(1)).clamp(12, 240)).max(2) - 1;
    let scenes: Vec<_> =
        (0..=last).map(|frame| set.scene(&timeline, timeline.end() * frame as f64 / last as f64)).collect();
    let middles = followed(&scenes);
    let bounds = scenes
        .iter()
        .zip(&middles)
        .fold(Bounds::NOTHING, |bounds, (scene, middle)| bounds.join(scene.bounds.moved(-*middle)));
    let around = DVec2::new(2.0 * MARGIN, 2.0 * MARGIN + BAR);
    let scale = scale_for(bounds.size(), around, LARGEST);
    let size = bounds.size() * scale + around;
    let mut document = Document::new(size, scale);
    let playing = last as f64 * FRAME_S;
    let whole = REST_S[0] + playing + REST_S[1];
    for (frame, scene) in scenes.iter().enumerate() {
        let at =
            |frame: usize| if frame == 0 { 0.0 } else { (REST_S[0] + (frame - 1) as f64 * FRAME_S) / whole };
        let (from, to) = (at(frame), at(frame + 1));
        let (shown, values, times) = if frame == last {
            ("inline", "none;inline".to_owned(), format!("0;{from:.5}"))
        } else if frame == 0 {
            ("none", "inline;none".to_owned(), format!("0;{to:.5}"))
        } else {
            ("none", "none;inline;none".to_owned(), format!("0;{from:.5};{to:.5}"))
        };
        document.raw(format_args!(
            "<g display=\"{shown}\"><animate attributeName=\"display\" dur=\"{whole:.2}s\" \
             repeatCount=\"indefinite\" calcMode=\"discrete\" values=\"{values}\" keyTimes=\"{times}\"/>\n"
        ));
        document.scene(scene, &bounds.moved(middles[frame]), DVec2::new(MARGIN, size.y - MARGIN - BAR));
        document.raw(format_args!("</g>\n"));
    }
    bar(&mut document, size, REST_S[0] / whole, (REST_S[0] + playing) / whole, whole);
    Ok(document.finish(&title(plan)))
}

/// Where the eye looks in each frame: at the middle of what there is to see, smoothed so that it doesn't jerk.
fn followed(scenes: &[Scene]) -> Vec<DVec2> {
    let middles: Vec<_> = scenes.iter().map(|scene| (scene.bounds.low + scene.bounds.high) / 2.0).collect();
    let reach = scenes.len() / 12;
    (0..middles.len())
        .map(|frame| {
            // As far to either side as there are frames, so that the first and the last stand in the middle.
            let reach = reach.min(frame).min(middles.len() - 1 - frame);
            let near = &middles[frame - reach..=frame + reach];
            near.iter().sum::<DVec2>() / near.len() as f64
        })
        .collect()
}

/// A bar that fills while the hinges move, from `begin` to `end` as shares of the whole.
fn bar(document: &mut Document, size: DVec2, begin: f64, end: f64, whole: f64) {
    let [x, y, width, height] = [MARGIN, size.y - MARGIN, size.x - 2.0 * MARGIN, 4.0].map(Document::units);
    let place = format!("x=\"{x}\" y=\"{y}\" height=\"{height}\" rx=\"{}\"", height / 2);
    document.raw(format_args!(
        "<rect class=\"rail\" {place} width=\"{width}\"/>\n\
         <rect class=\"bar\" {place} width=\"{width}\"><animate attributeName=\"width\" dur=\"{whole:.2}s\" \
         repeatCount=\"indefinite\" values=\"0;0;{width};{width}\" keyTimes=\"0;{begin:.5};{end:.5};1\"/></rect>\n"
    ));
}
