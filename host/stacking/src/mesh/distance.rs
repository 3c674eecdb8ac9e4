//! How far the solid's surface and the mesh are apart, measured both ways from points on each. `Mesh` calls it.

use super::nearest::{Nearest, Square};
use super::{Corner, Mesh, Solid, Triangle, area, dot, minus, normal};
use crate::square::Quad;
use std::fmt;

/// Points on the mesh are so far apart at most, in voxels, ...
const SPACING: f64 = 0.5;

/// ... unless there would be more points than this.
const POINTS: f64 = 200_000.0;

/// A point on the mesh that is so deep in the solid, in voxels, may be on a wall between shells that overlap: it is none of the outside
/// when the mesh winds round both of its sides, and isn't counted.
const DEEP: f64 = 0.75;

/// Those sides are so far from the wall, in voxels.
const BESIDE: f64 = 1e-3;

/// How far two surfaces are apart, in voxels. Sampled: from the corners and the centre of every panel to the mesh, and from points
/// on the mesh half a voxel apart to the panels (fewer on very large ones). Walls inside, where shells of the mesh overlap, don't
/// count.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Distance {
    /// The largest distance from a point on either to the other: the Hausdorff distance.
    #[serde(rename = "hausdorff_voxels")]
    pub hausdorff: f64,
    /// The mean over the points on the mesh and over those on the panels, half of each.
    #[serde(rename = "mean_voxels")]
    pub mean: f64,
    /// The point that is farthest from the other surface, in units of the mesh.
    pub at: [f64; 3],
}

impl fmt::Display for Distance {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [x, y, z] = self.at;
        let Self { hausdorff, mean, .. } = self;
        write!(f, "Hausdorff {hausdorff:.2} voxels, at ({x}, {y}, {z}); mean {mean:.2} voxels (sampled)")
    }
}

/// A sum of distances and the largest of them.
#[derive(Default)]
struct Tally {
    sum: f64,
    weight: f64,
    largest: f64,
    at: Corner,
}

impl Tally {
    fn add(&mut self, point: Corner, distance: f64, weight: f64) {
        self.sum += distance * weight;
        self.weight += weight;
        if distance > self.largest {
            (self.largest, self.at) = (distance, point);
        }
    }
}

/// Measures; the panels are in voxels from the least corner of the mesh's box.
pub(super) fn measure(mesh: &Mesh, solid: &Solid, panels: &[Quad]) -> Distance {
    let voxel_size = solid.voxel_size;
    let (mut from_panels, mut from_mesh) = (Tally::default(), Tally::default());
    let every = (5.0 * panels.len() as f64 / POINTS).ceil().max(1.0);
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "at most the number of panels"
    )]
    for quad in panels.iter().step_by(every as usize) {
        let corners = quad.map(|corner| corner.map(f64::from));
        let middle = [0, 1, 2].map(|axis| f64::midpoint(corners[0][axis], corners[2][axis]));
        for point in corners.into_iter().chain([middle]) {
            from_panels.add(point, mesh.distance(point, voxel_size), 1.0);
        }
    }
    let squares = Nearest::new(panels.iter().map(Square::of).collect());
    let spacing = SPACING.max((mesh.area() / (voxel_size * voxel_size) / POINTS).sqrt());
    let in_mesh = |point: Corner| [0, 1, 2].map(|axis| mesh.least[axis] + point[axis] * voxel_size);
    for triangle in mesh.in_voxels(voxel_size) {
        let points = points_on(&triangle, spacing);
        let share = area(&triangle) / points.len() as f64;
        let normal = normal(&triangle).unwrap_or_default();
        let beside = |point: Corner, by: f64| [0, 1, 2].map(|axis| point[axis] + by * normal[axis]);
        for point in points {
            let distance = squares.distance(point);
            let hidden = distance > DEEP
                && solid.holds(point)
                && [BESIDE, -BESIDE].iter().all(|by| mesh.is_inside(in_mesh(beside(point, *by))));
            if !hidden {
                from_mesh.add(point, distance, share);
            }
        }
    }
    let farthest = if from_mesh.largest > from_panels.largest { &from_mesh } else { &from_panels };
    let mean = |tally: &Tally| tally.sum / tally.weight.max(f64::MIN_POSITIVE);
    Distance {
        hausdorff: rounded(farthest.largest),
        mean: rounded(f64::midpoint(mean(&from_panels), mean(&from_mesh))),
        at: in_mesh(farthest.at).map(|c| rounded_at(c, voxel_size)),
    }
}

/// Points on a triangle at most so far apart: the middle of a small one, of others rows along the longest side, with the corners.
pub(super) fn points_on(corners: &Triangle, spacing: f64) -> Vec<Corner> {
    let length = |side: usize| {
        let way = minus(corners[(side + 1) % 3], corners[side]);
        dot(way, way).sqrt()
    };
    let first = (0..3).max_by(|a, b| length(*a).total_cmp(&length(*b))).unwrap_or(0);
    let [a, b, c] = [0, 1, 2].map(|place| corners[(first + place) % 3]);
    let longest = length(first);
    if longest <= spacing {
        return vec![[0, 1, 2].map(|axis| (a[axis] + b[axis] + c[axis]) / 3.0)];
    }
    let steps = |length: f64| (length / spacing).ceil().clamp(1.0, POINTS);
    let rows = steps(2.0 * area(corners) / longest);
    let mut points = Vec::new();
    for up in counted(rows).map(|row| row / rows) {
        let on_row = if up < 1.0 { steps((1.0 - up) * longest) } else { 1.0 };
        for along in counted(if up < 1.0 { on_row } else { 0.0 }).map(|step| (1.0 - up) * step / on_row) {
            points
                .push([0, 1, 2].map(|axis| a[axis] + along * (b[axis] - a[axis]) + up * (c[axis] - a[axis])));
        }
    }
    points
}

/// 0, 1, 2 and so on up to a whole number.
fn counted(last: f64) -> impl Iterator<Item = f64> {
    std::iter::successors(Some(0.0), move |number| (*number < last).then_some(number + 1.0))
}

/// Few digits: nobody needs more, and they come back from the file as they were.
fn rounded(distance: f64) -> f64 {
    (distance * 1e4).round() / 1e4
}

/// A coordinate to about a hundredth of a voxel.
pub(super) fn rounded_at(c: f64, voxel_size: f64) -> f64 {
    let scale = 10_f64.powf((100.0 / voxel_size).log10().ceil().clamp(-12.0, 12.0));
    (c * scale).round() / scale
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_cover_a_triangle_and_a_needle_with_few_of_them() {
        let broad = points_on(&[[0.0; 3], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0]], 0.5);
        for corner in [[0.0; 3], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0]] {
            assert!(broad.iter().any(|point| dot(minus(*point, corner), minus(*point, corner)) < 1e-12));
        }
        for probe in
            (0..40).flat_map(|i| (0..40 - i).map(move |j| [f64::from(i) / 10.0, f64::from(j) / 10.0, 0.0]))
        {
            let nearest = broad.iter().map(|point| dot(minus(*point, probe), minus(*point, probe)).sqrt());
            assert!(nearest.fold(f64::INFINITY, f64::min) < 0.5, "{probe:?}");
        }
        assert!(points_on(&[[0.0; 3], [0.01, 100.0, 0.0], [0.0, 50.0, 0.01]], 0.5).len() < 500);
        assert!(points_on(&[[1.0; 3]; 3], 0.5).len() < 10);
    }
}
