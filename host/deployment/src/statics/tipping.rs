//! Whether the whole stands: its centre of mass over the polygon that it stands on.

use super::swing::Swing;
use crate::rig::Millimetres;
use glam::{DVec2, DVec3};
use serde::{Deserialize, Serialize};

/// What the whole stands on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Support {
    /// All that touches the [ground](crate::motion::Ground), the plane across gravity that the zygote lies on.
    #[default]
    Touching,
    /// The root alone, as on a stand of its size.
    Root,
}

/// How well the whole stands in every step.
#[derive(Debug, Clone, PartialEq)]
pub struct Tipping {
    /// What it stands on.
    pub support: Support,
    /// Of every step, the least distance of the centre of mass to the sides of the polygon, over the whole turn; negative
    /// outside. `None` where nothing that stands still touches the ground, or too little to stand on.
    pub margins: Vec<Option<Millimetres>>,
}

/// So far outside is rounding, mm.
const ROUNDING: f64 = 1e-6;

impl Tipping {
    /// The first step in which the whole tips, or has nothing to stand on.
    pub fn first(&self) -> Option<usize> {
        self.margins.iter().position(|margin| margin.is_none_or(|margin| margin.0 < -ROUNDING))
    }

    /// The least margin, where there are any, and its step.
    pub fn least(&self) -> Option<(usize, Millimetres)> {
        let known = self.margins.iter().enumerate().filter_map(|(step, margin)| Some((step, (*margin)?)));
        known.min_by(|a, b| a.1.0.total_cmp(&b.1.0).then(a.0.cmp(&b.0)))
    }
}

/// The centre of mass while a hinge turns: `constant + cosine cos(x) + sine sin(x) + slope x`.
#[derive(Debug, Clone, Copy)]
pub(super) struct Centre {
    pub(super) constant: DVec3,
    pub(super) cosine: DVec3,
    pub(super) sine: DVec3,
    pub(super) slope: DVec3,
}

/// The least distance of the centre, inwards, to the sides of the hull of some points, all seen along `up`.
pub(super) fn margin(points: &[DVec3], up: DVec3, centre: &Centre, angle: f64) -> Option<f64> {
    let (u, v) = up.any_orthonormal_pair();
    // Of any two such vectors one order is right-handed seen against `up`.
    let v = if u.cross(v).dot(up) < 0.0 { -v } else { v };
    let hull = hull(points.iter().map(|point| DVec2::new(point.dot(u), point.dot(v))).collect());
    let sides = hull.iter().zip(hull.iter().cycle().skip(1)).filter(|_| hull.len() > 2);
    let distances = sides.map(|(from, to)| {
        let inward = (*to - *from).perp().normalize();
        let normal = u * inward.x + v * inward.y;
        let swing = Swing {
            constant: centre.constant.dot(normal) - from.dot(inward),
            cosine: centre.cosine.dot(normal),
            sine: centre.sine.dot(normal),
            slope: centre.slope.dot(normal),
        };
        swing.least(angle)
    });
    distances.reduce(f64::min)
}

/// Corners of the convex hull, counter-clockwise; none of them in a line with its neighbours.
fn hull(mut points: Vec<DVec2>) -> Vec<DVec2> {
    /// Twice the area of a triangle that is a line, panel lengths squared.
    const FLAT: f64 = 1e-9;
    points.sort_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
    let half = |points: &mut dyn Iterator<Item = &DVec2>| {
        let mut chain: Vec<DVec2> = Vec::new();
        for point in points {
            while let [.., a, b] = chain[..]
                && (b - a).perp_dot(*point - b) <= FLAT
            {
                chain.pop();
            }
            chain.push(*point);
        }
        chain.pop();
        chain
    };
    let mut hull = half(&mut points.iter());
    hull.extend(half(&mut points.iter().rev()));
    hull
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_hull_has_the_corners_and_nothing_between_them() {
        let points = [[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [1.0, 0.5], [2.0, 1.0], [0.0, 1.0], [0.0, 0.0]];
        let found = hull(points.map(DVec2::from_array).to_vec());
        assert_eq!(found, [[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [0.0, 1.0]].map(DVec2::from_array));
        assert!(hull(vec![DVec2::ZERO, DVec2::X, DVec2::X * 2.0]).len() < 3);
    }
}
