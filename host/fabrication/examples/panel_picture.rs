//! Draws the panel with its magnet holes for the book: `cargo run -p zygote-fabrication --example panel_picture > panel-holes.svg`.

#![expect(clippy::print_stdout, reason = "the picture goes to standard output")]

use zygote_fabrication::{Holes, Magnet, Panel, PanelError, Point, Rim};

/// Thick for its side, so that there is something to see.
const PANEL: Panel = Panel {
    side_mm: 56.0,
    thickness_mm: 6.0,
    rim: Rim::Round,
    holes: Holes::Magnets(Magnet { diameter_mm: 3.0, length_mm: 30.0, clearance_mm: 0.1 }),
};

fn main() -> Result<(), PanelError> {
    let body = PANEL.body()?;
    // From above one corner; y down, as in SVG, and the distance to the eye.
    let seen = |[x, y, z]: Point| {
        let (across, away) = ((x + y) * 0.707, (y - x) * 0.707);
        [across * 6.0 + 250.0, -(away * 0.55 + z * 0.83) * 6.0 + 165.0, away * 0.83 - z * 0.55]
    };
    println!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 500 330\" width=\"500\" height=\"330\">"
    );
    println!("<title>A panel with a magnet hole along each side</title>");
    println!("<rect width=\"500\" height=\"330\" rx=\"12\" fill=\"#f5f4f0\"/>");
    let mut triangles: Vec<_> =
        body.triangles.iter().map(|triangle| (is_of_hole(triangle), triangle.map(seen))).collect();
    // Holes first: they show through what is around them. The rest from afar.
    let depth = |triangle: &[Point; 3]| triangle.iter().map(|point| point[2]).sum::<f64>();
    triangles.sort_by(|(hole_a, a), (hole_b, b)| hole_b.cmp(hole_a).then(depth(b).total_cmp(&depth(a))));
    for (hole, [a, b, c]) in &triangles {
        let turn = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
        if !hole && turn > 0.0 {
            continue;
        }
        let light = if *hole { "#d9772e" } else { "#7f9cb8" };
        let (opacity, line) = if *hole { (0.5, 0.3) } else { (0.45, 0.25) };
        println!(
            "<path d=\"M{:.1} {:.1}L{:.1} {:.1}L{:.1} {:.1}z\" fill=\"{light}\" fill-opacity=\"{opacity}\" stroke=\"#3c4654\" stroke-width=\"{line}\"/>",
            a[0], a[1], b[0], b[1], c[0], c[1]
        );
    }
    println!("</svg>");
    Ok(())
}

/// Whether a triangle is a wall or the end of a hole: it then lies behind the side.
fn is_of_hole(triangle: &[Point; 3]) -> bool {
    let middle = [0, 1, 2].map(|axis| triangle.iter().map(|point| point[axis]).sum::<f64>() / 3.0);
    let half = PANEL.thickness_mm / 2.0;
    let is_face = triangle.iter().all(|point| (point[2].abs() - half).abs() < 1e-9);
    let on_side = {
        let reach = |z: f64| PANEL.side_mm / 2.0 - half + (half * half - z * z).max(0.0).sqrt();
        [0, 1]
            .iter()
            .any(|axis| triangle.iter().all(|point| (point[*axis].abs() - reach(point[2])).abs() < 1e-9))
    };
    !is_face && !on_side && middle[2].abs() < half
}
