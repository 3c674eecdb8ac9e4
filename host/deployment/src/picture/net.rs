//! The net of a plan: panels in the plane, coloured by pile, red where they lie on each other.

use super::camera::Bounds;
use super::colour;
use super::document::Document;
use super::scene::{Paint, Scene, Shape, piles};
use super::still::{CAPTION, MARGIN, captions, scale_for};
use glam::DVec2;
use zygote_stacking::{Net, Overlaps, Plan};

/// The whole picture is about as large as this at most.
const LARGEST: DVec2 = DVec2::new(1000.0, 1000.0);
/// Wide enough for the caption.
const NARROWEST: f64 = 420.0;
/// Squares of fewer pixels have no room for a number.
const ROOM_FOR_A_NUMBER: f64 = 14.0;
/// Lines in thousandths of a panel length: a cut, and a hinge.
const CUT: u32 = 70;
const HINGE: u32 = 20;

/// A picture of a plan's net.
pub fn net(plan: &Plan, net: &Net) -> String {
    // The picture's y is down.
    let point = |[x, y]: [i32; 2]| DVec2::new(f64::from(x), -f64::from(y));
    let pile_of_panel = piles(plan);
    let mut hinged = vec![[false; 4]; plan.panels()];
    for hinge in &plan.hinges {
        for (panel, edge) in hinge.panels.into_iter().zip(hinge.edges) {
            hinged[panel][edge] = true;
        }
    }
    let on_squares = net.on_squares();
    let (mut fills, mut hinges, mut cuts) = (Vec::new(), Vec::new(), Vec::new());
    for panels in on_squares.values() {
        for &panel in panels {
            let square = net.squares[panel].map(point);
            let pile = pile_of_panel[panel];
            let fill =
                if panels.len() > 1 { colour::overlap(panels.len()) } else { colour::panel(pile, true, 0.9) };
            fills.push(Shape {
                paint: Paint { fill: Some(fill), stroke: fill, width: 6 },
                runs: vec![square.to_vec()],
            });
            for edge in 0..4 {
                let run = vec![square[edge], square[(edge + 1) % 4]];
                let (list, width) = if hinged[panel][edge] { (&mut hinges, HINGE) } else { (&mut cuts, CUT) };
                let paint = Paint { fill: None, stroke: colour::edge(pile), width };
                list.push(Shape { paint, runs: vec![run] });
            }
        }
    }
    let shapes: Vec<Shape> = fills.into_iter().chain(hinges).chain(cuts).collect();
    let bounds = Bounds::around(net.squares.iter().flatten().copied().map(point));
    let scene = Scene { shapes, bounds };
    let size = bounds.size();
    let scale = scale_for(size, DVec2::new(MARGIN * 2.0, MARGIN * 2.0 + CAPTION), LARGEST);
    let width = (size.x * scale).max(NARROWEST);
    let floor = MARGIN + size.y * scale;
    let mut document = Document::new(DVec2::new(width + MARGIN * 2.0, floor + MARGIN + CAPTION), scale);
    let corner = DVec2::new(MARGIN + (width - size.x * scale) / 2.0, floor);
    document.scene(&scene, &bounds, corner);
    if scale >= ROOM_FOR_A_NUMBER {
        let origin = corner - DVec2::new(bounds.low.x, bounds.high.y) * scale;
        for (least, panels) in on_squares.iter().filter(|(_, panels)| panels.len() > 1) {
            let middle = origin + (point(*least) + DVec2::new(0.5, -0.5)) * scale;
            document.caption(&panels.len().to_string(), middle + DVec2::new(0.0, 5.0), "mark");
        }
    }
    let Overlaps { panels, pairs, pairs_in_a_pile, .. } = net.overlaps(plan);
    let note = if pairs == 0 {
        format!("{} panels, none overlap", plan.panels())
    } else {
        let across = pairs - pairs_in_a_pile;
        format!(
            "{panels} of {} panels overlap: {pairs_in_a_pile} pairs of one pile, {across} of two",
            plan.panels()
        )
    };
    captions(&mut document, "Net", &note, DVec2::new(MARGIN + width / 2.0, floor));
    document.finish(&format!("{}: net", plan.source.model))
}
