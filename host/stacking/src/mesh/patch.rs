//! Patches over small flat holes of a mesh. `closed` puts them on when nothing else closes it.

use super::indexed::{Indexed, Loose};
use super::{area, cross, dot, minus};
use std::collections::BTreeMap;

/// A hole is closed unasked when its corners are so near to one plane, as a share of the box's diagonal ...
const FLAT_SHARE: f64 = 0.01;

/// ... and its patch has at most this share of the mesh's area.
const HOLE_SHARE: f64 = 0.01;

impl Indexed {
    /// A patch for each hole, or nothing if any isn't small, flat and on its own.
    pub(super) fn patches(&self, loose: &[Loose]) -> Option<Vec<Vec<[usize; 3]>>> {
        let mut next: BTreeMap<usize, usize> = BTreeMap::new();
        for edge in loose {
            // Two edges away from one corner could be paired in two ways.
            if edge.excess != 1 || edge.triangles != 1 || next.insert(edge.ends[0], edge.ends[1]).is_some() {
                return None;
            }
        }
        let total: f64 = self.triangles.iter().map(|triangle| area(&self.at(triangle))).sum();
        let mut patches = Vec::new();
        while let Some((start, mut corner)) = next.pop_first() {
            let mut rim = vec![start];
            while corner != start {
                rim.push(corner);
                corner = next.remove(&corner)?;
            }
            // The patch runs against the triangles at the rim. Flat, it winds rightly whatever the shape of the hole.
            let patch: Vec<[usize; 3]> = rim[1..].windows(2).map(|pair| [start, pair[1], pair[0]]).collect();
            let patch_area: f64 = patch.iter().map(|triangle| area(&self.at(triangle))).sum();
            if patch_area > HOLE_SHARE * total || !self.is_flat(&rim) {
                return None;
            }
            patches.push(patch);
        }
        Some(patches)
    }

    fn is_flat(&self, rim: &[usize]) -> bool {
        let at = |place: usize| self.corners[rim[place % rim.len()]];
        let mut normal = [0.0; 3];
        for place in 0..rim.len() {
            let part = cross(minus(at(place), at(0)), minus(at(place + 1), at(0)));
            normal = [0, 1, 2].map(|axis| normal[axis] + part[axis]);
        }
        let length = dot(normal, normal).sqrt();
        let tolerance = FLAT_SHARE * self.diagonal();
        rim.len() == 3
            || (0..rim.len()).all(|place| dot(minus(at(place), at(0)), normal).abs() <= tolerance * length)
    }
}
