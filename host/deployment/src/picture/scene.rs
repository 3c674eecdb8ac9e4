//! Panels in space as shaded polygons on the picture.

use super::camera::{Bounds, Camera};
use super::colour::{self, Colour};
use super::painter::{Fragment, back_to_front};
use glam::{DVec2, DVec3};
use zygote_stacking::Plan;

/// To the light: from above, a little behind the eye's left shoulder, so that a box shows three tones.
const TO_LIGHT: DVec3 = DVec3::new(-0.35, -0.55, 0.95);
/// Rims of open panels, in panel lengths.
const RIM: f64 = 0.03;
/// Rims of panels in a stack, in thicknesses: the layers must stay apart.
const STACKED_RIM: f64 = 0.3;

/// A panel as it stands at one moment.
#[derive(Debug, Clone)]
pub(super) struct Plate {
    /// Corners, counter-clockwise seen from the outer side.
    pub(super) corners: [DVec3; 4],
    /// How far it still reaches down from its corners' plane as a layer of a stack; zero once it is open.
    pub(super) down: DVec3,
}

/// How a polygon is drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Paint {
    /// Inside.
    pub(super) fill: Option<Colour>,
    /// Rim.
    pub(super) stroke: Colour,
    /// Width of the rim in thousandths of a panel length.
    pub(super) width: u32,
}

/// A polygon or some lines, in panel lengths on the picture.
#[derive(Debug, Clone)]
pub(super) struct Shape {
    pub(super) paint: Paint,
    /// Each one a run of points; closed if there is a fill.
    pub(super) runs: Vec<Vec<DVec2>>,
}

/// A scene, painted back to front.
#[derive(Debug, Clone)]
pub(super) struct Scene {
    pub(super) shapes: Vec<Shape>,
    pub(super) bounds: Bounds,
}

impl Scene {
    /// Paints the plates of a plan.
    pub(super) fn new(plan: &Plan, plates: &[Plate]) -> Self {
        let camera = Camera::new();
        let pile_of_panel = piles(plan);
        let mut fragments = Vec::with_capacity(plates.len());
        for (panel, plate) in plates.iter().enumerate() {
            fragments.push(Fragment::whole(panel, &plate.corners));
            fragments.extend(walls(panel, plate, camera.to_eye()));
        }
        let mut shapes = Vec::with_capacity(fragments.len());
        for fragment in back_to_front(fragments, camera.to_eye()) {
            let plate = &plates[fragment.panel];
            let stacked = plate.down != DVec3::ZERO;
            let width = if stacked { (STACKED_RIM * plan.thickness).min(RIM) } else { RIM };
            push_shapes(&mut shapes, &fragment, pile_of_panel[fragment.panel], width, &camera);
        }
        let bounds = Bounds::around(shapes.iter().flat_map(|shape| shape.runs.iter().flatten().copied()));
        Self { shapes, bounds }
    }
}

/// The pile of each panel.
fn piles(plan: &Plan) -> Vec<usize> {
    let mut pile_of_panel = vec![0; plan.target.len()];
    for (number, pile) in plan.piles.iter().enumerate() {
        for &panel in &pile.panels {
            if let Some(slot) = pile_of_panel.get_mut(panel) {
                *slot = number;
            }
        }
    }
    pile_of_panel
}

/// The sides of a layer that the eye sees.
fn walls(panel: usize, plate: &Plate, to_eye: DVec3) -> impl Iterator<Item = Fragment> {
    let middle = (plate.corners[0] + plate.corners[2]) / 2.0;
    let (corners, down) = (plate.corners, plate.down);
    (0..4).filter(move |_| down != DVec3::ZERO).filter_map(move |edge| {
        let (from, to) = (corners[edge], corners[(edge + 1) % 4]);
        let outward = (from + to) / 2.0 - middle;
        let mut wall = Fragment::whole(panel, &[from, to, to + down, from + down]);
        if wall.normal.dot(outward) < 0.0 {
            wall = Fragment::whole(panel, &[to, from, from + down, to + down]);
        }
        // Its rim is drawn whole: of the line between two layers each would cover half of the other's.
        (wall.normal.dot(to_eye) > 0.0).then_some(wall)
    })
}

fn push_shapes(shapes: &mut Vec<Shape>, fragment: &Fragment, pile: usize, width: f64, camera: &Camera) {
    let outer = fragment.normal.dot(camera.to_eye()) > 0.0;
    let facing = if outer { fragment.normal } else { -fragment.normal };
    // A little light from everywhere, and half-lit where the light only grazes.
    let light = 0.5 + 0.5 * facing.dot(TO_LIGHT.normalize());
    let fill = colour::panel(pile, outer, light);
    let points: Vec<_> = fragment.corners.iter().map(|corner| camera.project(*corner)).collect();
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a small positive width")]
    let width = (width * 1e3).round().max(1.0) as u32;
    let rim = colour::edge(pile);
    if fragment.rim.iter().all(|rim| *rim) {
        shapes.push(Shape { paint: Paint { fill: Some(fill), stroke: rim, width }, runs: vec![points] });
        return;
    }
    // A cut must not show: a hair of the fill's own colour closes the seam.
    shapes.push(Shape {
        paint: Paint { fill: Some(fill), stroke: fill, width: 6 },
        runs: vec![points.clone()],
    });
    let count = points.len();
    let runs: Vec<_> =
        (0..count).filter(|i| fragment.rim[*i]).map(|i| vec![points[i], points[(i + 1) % count]]).collect();
    if !runs.is_empty() {
        shapes.push(Shape { paint: Paint { fill: None, stroke: rim, width }, runs });
    }
}
