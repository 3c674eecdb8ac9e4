//! The sides of a solid of voxels, written down axis by axis and not as the readers do it.

use std::collections::BTreeSet;

pub(crate) type Voxel = [i32; 3];

/// The sides of a solid, outer side out.
pub(crate) fn boundary(solid: &BTreeSet<Voxel>) -> Vec<[Voxel; 4]> {
    let mut quads = Vec::new();
    for voxel in solid {
        for (axis, high) in [(0, false), (0, true), (1, false), (1, true), (2, false), (2, true)] {
            let mut beyond = *voxel;
            beyond[axis] += if high { 1 } else { -1 };
            if solid.contains(&beyond) {
                continue;
            }
            let corner = |du: i32, dv: i32| {
                let mut point = *voxel;
                point[axis] += i32::from(high);
                point[(axis + 1) % 3] += du;
                point[(axis + 2) % 3] += dv;
                point
            };
            let mut quad = [corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)];
            if !high {
                quad.reverse();
            }
            quads.push(quad);
        }
    }
    quads
}
