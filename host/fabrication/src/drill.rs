//! The two faces of a panel with screw holes in them, and the walls of the holes.

use crate::panel::Screws;
use crate::soup::Soup;
use earcut::Earcut;
use std::f64::consts::TAU;

/// Corners of a hole.
const CORNERS: u32 = 24;

/// Adds both faces, which reach `flat` from the middle and lie `half` above and below it, with holes from one to the other.
pub(crate) fn drilled_faces(body: &mut Soup, flat: f64, half: f64, screws: &Screws, side_mm: f64) {
    let mut outline = vec![[-flat, -flat], [flat, -flat], [flat, flat], [-flat, flat]];
    let mut holes = Vec::new();
    // No narrower than asked for, so that the screw goes through.
    let radius = screws.diameter_mm / 2.0 / (TAU / 2.0 / f64::from(CORNERS)).cos();
    for [x, y] in screws.middles(side_mm) {
        holes.push(outline.len());
        outline.extend((0..CORNERS).map(|corner| {
            let (sin, cos) = (TAU * f64::from(corner) / f64::from(CORNERS)).sin_cos();
            [x + radius * cos, y + radius * sin]
        }));
    }
    let mut corners: Vec<usize> = Vec::new();
    Earcut::new().earcut(outline.iter().copied(), &holes, &mut corners);
    for triangle in corners.chunks_exact(3) {
        let [a, b, c] = [0, 1, 2].map(|corner| outline[triangle[corner]]);
        let counter_clockwise = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]) > 0.0;
        let [up, down] = if counter_clockwise { [[a, b, c], [a, c, b]] } else { [[a, c, b], [a, b, c]] };
        for (face, z) in [(up, half), (down, -half)] {
            body.triangles.push(face.map(|[x, y]| [x, y, z]));
        }
    }
    for first in holes {
        let ring = &outline[first..][..CORNERS as usize];
        for (corner, [x, y]) in ring.iter().enumerate() {
            let [next_x, next_y] = ring[(corner + 1) % ring.len()];
            // Seen from inside the hole.
            body.strip(
                &[[*x, *y, -half], [next_x, next_y, -half]],
                &[[*x, *y, half], [next_x, next_y, half]],
            );
        }
    }
}
