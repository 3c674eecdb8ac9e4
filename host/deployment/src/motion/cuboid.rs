//! A box anywhere in space, and how far two of them are apart or in each other.

use glam::DVec3;

/// A box: its centre and half its three edges, at right angles to each other; the third one is the plates' normal.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cuboid {
    /// The centre.
    pub centre: DVec3,
    /// Half the edges.
    pub half: [DVec3; 3],
}

/// Edges of two boxes that are this near to parallel (square of the sine) span no direction of their own.
const PARALLEL: f64 = 1e-12;

/// The directions one of which parts two boxes that are apart: first the likely ones.
pub(super) fn directions(a: &[DVec3; 3], b: &[DVec3; 3]) -> impl Iterator<Item = DVec3> {
    let (a, b) = (a.map(DVec3::normalize_or_zero), b.map(DVec3::normalize_or_zero));
    let across = (0..9).filter_map(move |pair| {
        let cross = a[pair / 3].cross(b[pair % 3]);
        (cross.length_squared() > PARALLEL).then(|| cross.normalize())
    });
    [a[2], b[2], a[0], a[1], b[0], b[1]].into_iter().chain(across)
}

impl Cuboid {
    /// Half of how wide the box is along a unit vector.
    pub(super) fn reach(&self, direction: DVec3) -> f64 {
        self.half.iter().map(|half| half.dot(direction).abs()).sum()
    }

    /// The radius of the sphere about the centre that holds the box.
    pub(super) fn radius(&self) -> f64 {
        (self.half[0] + self.half[1] + self.half[2]).length()
    }

    /// How far two boxes are apart, at least; negative where they are in each other: the shortest way out.
    pub fn gap(&self, other: &Self) -> f64 {
        let between = other.centre - self.centre;
        directions(&self.half, &other.half)
            .map(|direction| between.dot(direction).abs() - self.reach(direction) - other.reach(direction))
            .fold(f64::NEG_INFINITY, f64::max)
    }
}
