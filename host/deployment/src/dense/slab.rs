//! Slabs: the cores of layers that lie on each other, as one box in space; and how far two of them are apart.

use glam::{DAffine3, DVec3};

/// A box in space: its centre, the directions of its edges, and half their lengths.
#[derive(Debug, Clone, Copy)]
pub(super) struct Slab {
    pub(super) centre: DVec3,
    axes: [DVec3; 3],
    half: [f64; 3],
    pub(super) radius: f64,
}

/// Edges nearer to parallel than this span no direction (square of the sine).
const PARALLEL: f64 = 1e-10;

impl Slab {
    /// The box between two corners.
    pub(super) fn between(low: DVec3, high: DVec3) -> Self {
        let half = (high - low) * 0.5;
        Self {
            centre: (low + high) * 0.5,
            axes: [DVec3::X, DVec3::Y, DVec3::Z],
            half: half.to_array(),
            radius: half.length(),
        }
    }

    /// The same box after a motion.
    pub(super) fn moved(&self, motion: &DAffine3) -> Self {
        Self {
            centre: motion.transform_point3(self.centre),
            axes: self.axes.map(|axis| motion.transform_vector3(axis)),
            ..*self
        }
    }

    /// Half of its width along a unit vector.
    fn reach(&self, direction: DVec3) -> f64 {
        (0..3).map(|i| self.half[i] * self.axes[i].dot(direction).abs()).sum()
    }

    /// How far it goes down along a unit vector.
    pub(super) fn lowest(&self, direction: DVec3) -> f64 {
        self.centre.dot(direction) - self.reach(direction)
    }

    /// The least and the greatest coordinates.
    pub(super) fn bounds(&self) -> [[f64; 3]; 2] {
        let reach = DVec3::new(self.reach(DVec3::X), self.reach(DVec3::Y), self.reach(DVec3::Z));
        [(self.centre - reach).to_array(), (self.centre + reach).to_array()]
    }

    /// How far two boxes are apart, at least; below 0 the shortest way out of each other. The fifteen directions that can part
    /// two boxes, in the frame of the first one (Gottschalk, Lin and Manocha, "`OBBTree`", 1996, section 5).
    pub(super) fn gap(&self, other: &Self) -> f64 {
        let between = other.centre - self.centre;
        let at = self.axes.map(|axis| axis.dot(between));
        let turned = self.axes.map(|axis| other.axes.map(|of_other| axis.dot(of_other)));
        let (a, b) = (&self.half, &other.half);
        let mut gap = f64::NEG_INFINITY;
        for i in 0..3 {
            let reach = (0..3).map(|j| b[j] * turned[i][j].abs()).sum::<f64>();
            gap = gap.max(at[i].abs() - a[i] - reach);
        }
        for j in 0..3 {
            let along = (0..3).map(|i| at[i] * turned[i][j]).sum::<f64>();
            let reach = (0..3).map(|i| a[i] * turned[i][j].abs()).sum::<f64>();
            gap = gap.max(along.abs() - b[j] - reach);
        }
        for i in 0..3 {
            let (i1, i2) = ((i + 1) % 3, (i + 2) % 3);
            for j in 0..3 {
                let square = 1.0 - turned[i][j] * turned[i][j];
                if square < PARALLEL {
                    continue;
                }
                let (j1, j2) = ((j + 1) % 3, (j + 2) % 3);
                let along = at[i2] * turned[i1][j] - at[i1] * turned[i2][j];
                let reach = a[i1] * turned[i2][j].abs()
                    + a[i2] * turned[i1][j].abs()
                    + b[j1] * turned[i][j2].abs()
                    + b[j2] * turned[i][j1].abs();
                gap = gap.max((along.abs() - reach) / square.sqrt());
            }
        }
        gap
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DQuat;

    #[test]
    fn boxes_side_by_side_are_apart_by_what_is_between_them() {
        let cube = Slab::between(DVec3::ZERO, DVec3::ONE);
        for (shift, gap) in [(1.5, 0.5), (1.0, 0.0), (0.75, -0.25)] {
            let other = cube.moved(&DAffine3::from_translation(DVec3::new(shift, 0.1, 0.2)));
            assert!((cube.gap(&other) - gap).abs() < 1e-12, "{shift}");
        }
    }

    #[test]
    fn an_edge_across_an_edge_is_parted_by_neither_box_s_faces() {
        // Two bars on edge, one above the other and across it: only the cross product of their edges parts them.
        let bar = Slab::between(DVec3::new(-5.0, -0.5, -0.5), DVec3::new(5.0, 0.5, 0.5));
        let on_edge = bar.moved(&DAffine3::from_quat(DQuat::from_rotation_x(0.25 * std::f64::consts::PI)));
        let across = DAffine3::from_translation(DVec3::Z * 1.5)
            * DAffine3::from_quat(DQuat::from_rotation_z(0.5 * std::f64::consts::PI));
        let gap = on_edge.gap(&on_edge.moved(&across));
        assert!((gap - (1.5 - 2_f64.sqrt())).abs() < 1e-12, "{gap}");
    }
}
