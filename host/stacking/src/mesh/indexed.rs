//! A triangle mesh by numbers of corners, and its edges that keep it from bounding a solid. The repairs work on it.

use super::{Corner, Triangle, distance, dot};
use crate::readers::ModelProblem;
use std::collections::HashMap;

/// A mesh by numbers of corners.
#[derive(Clone)]
pub(super) struct Indexed {
    pub(super) corners: Vec<Corner>,
    pub(super) triangles: Vec<[usize; 3]>,
}

/// An edge that isn't passed as often one way as the other: it runs as the triangles that are too many pass it.
pub(super) struct Loose {
    pub(super) ends: [usize; 2],
    /// By how many.
    pub(super) excess: usize,
    /// In how many triangles it is.
    pub(super) triangles: usize,
}

impl Indexed {
    /// Gives one number to corners in one place.
    pub(super) fn new(triangles: &[Triangle]) -> Self {
        let mut numbers: HashMap<[u64; 3], usize> = HashMap::new();
        let mut mesh = Self { corners: Vec::new(), triangles: Vec::with_capacity(triangles.len()) };
        for triangle in triangles {
            mesh.triangles.push(triangle.map(|corner| {
                // Adding 0 makes +0 of -0, so that equal corners have equal bits.
                let corner = corner.map(|c| c + 0.0);
                *numbers.entry(corner.map(f64::to_bits)).or_insert_with(|| {
                    mesh.corners.push(corner);
                    mesh.corners.len() - 1
                })
            }));
        }
        mesh
    }

    pub(super) fn at(&self, triangle: &[usize; 3]) -> Triangle {
        triangle.map(|number| self.corners[number])
    }

    /// Where two corners coincide, the edges cancel each other. Three corners in a row are kept: their neighbours need them.
    pub(super) fn drop_degenerate(&mut self) -> usize {
        let before = self.triangles.len();
        self.triangles.retain(|[a, b, c]| a != b && b != c && c != a);
        before - self.triangles.len()
    }

    pub(super) fn loose(&self) -> Vec<Loose> {
        let mut passes: Vec<([usize; 2], bool)> = Vec::with_capacity(3 * self.triangles.len());
        for triangle in &self.triangles {
            for side in 0..3 {
                let (from, to) = (triangle[side], triangle[(side + 1) % 3]);
                passes.push(([from.min(to), from.max(to)], from < to));
            }
        }
        passes.sort_unstable();
        let mut loose = Vec::new();
        for passes in passes.chunk_by(|a, b| a.0 == b.0) {
            let [low, high] = passes[0].0;
            let there = passes.iter().filter(|(_, upwards)| *upwards).count();
            let back = passes.len() - there;
            if there != back {
                let ends = if there > back { [low, high] } else { [high, low] };
                loose.push(Loose { ends, excess: there.abs_diff(back), triangles: passes.len() });
            }
        }
        loose
    }

    pub(super) fn diagonal(&self) -> f64 {
        let side = |axis: usize| {
            let all = || self.corners.iter().map(|corner| corner[axis]);
            all().fold(f64::NEG_INFINITY, f64::max) - all().fold(f64::INFINITY, f64::min)
        };
        dot([side(0), side(1), side(2)], [side(0), side(1), side(2)]).sqrt()
    }

    pub(super) fn not_closed(&self, loose: &[Loose]) -> ModelProblem {
        let open = loose.iter().filter(|edge| edge.triangles == 1).count();
        let place = |edge: &Loose| {
            let [a, b] = edge.ends.map(|end| self.corners[end]);
            if a.partial_cmp(&b).is_none_or(std::cmp::Ordering::is_le) { [a, b] } else { [b, a] }
        };
        let first = loose.iter().map(place).reduce(|a, b| if b < a { b } else { a }).unwrap_or_default();
        // A millionth of the box is no place on a mesh.
        let digits = 1e-6 * self.diagonal();
        let first = first.map(|corner| corner.map(|c| distance::rounded_at(c, digits)));
        let [from, to] = first.map(|[x, y, z]| format!("({x}, {y}, {z})"));
        ModelProblem::NotClosed { open, unlike: loose.len() - open, from, to }
    }
}
