//! Parts of a mesh that are thinner than a voxel and have no centre inside: wings, fins, ropes. `Mesh` calls it.

use super::{Corner, Mesh, distance, dot, normal};
use crate::square::Point;
use crate::voxels::Voxels;
use std::collections::BTreeSet;

/// A point on the mesh is lost when the solid is farther than this, in voxels: a little more than one, which is what a slope along
/// the diagonals of the lattice comes to.
const LOST: f64 = 1.05;

/// Points are moved by so much, in voxels, against the normal and to the middle of their triangle: those on a lattice plane
/// belong to the voxel on the inner side.
const INWARDS: f64 = 1e-6;

/// Points on the mesh are so far apart, in voxels.
const SPACING: f64 = 0.5;

/// A lost part is put together with what the mesh passes through so many voxels around it, so that it hangs on.
const SEAM: i32 = 2;

/// Puts the voxels that the mesh passes through where no solid voxel is near; gives their number. The box has two empty layers
/// around the mesh.
pub(super) fn thicken(voxels: &mut Voxels, mesh: &Mesh, voxel_size: f64) -> usize {
    let around = |reach: i32| {
        let range = move || -reach..=reach;
        range().flat_map(move |z| range().flat_map(move |y| range().map(move |x| [x, y, z])))
    };
    let near: Vec<(Point, isize)> = around(1).map(|step| (step, voxels.stride(step))).collect();
    let (mut passed, mut lost) = (BTreeSet::new(), BTreeSet::new());
    // Both sides of a plate without thickness are in one layer.
    let last = mesh.extent.map(|length| ((length / voxel_size).ceil() - 1.0).max(0.0));
    for triangle in mesh.in_voxels(voxel_size) {
        let Some(normal) = normal(&triangle) else { continue };
        for point in distance::points_on(&triangle, SPACING) {
            let inner: Corner = [0, 1, 2].map(|axis| {
                let middle = triangle.iter().map(|corner| corner[axis]).sum::<f64>() / 3.0;
                point[axis] + INWARDS * (middle - point[axis] - normal[axis])
            });
            #[expect(
                clippy::cast_possible_truncation,
                reason = "within the box, whose sides are small numbers"
            )]
            let voxel: Point = [0, 1, 2].map(|axis| inner[axis].clamp(0.0, last[axis]).floor() as i32);
            let number = voxels.number(voxel);
            if voxels.solid(number) {
                continue;
            }
            passed.insert(number);
            let holds = |(step, stride): &(Point, isize)| {
                let is_solid = number.checked_add_signed(*stride).is_some_and(|next| voxels.solid(next));
                is_solid && distance_2(inner, [0, 1, 2].map(|axis| voxel[axis] + step[axis])) <= LOST * LOST
            };
            if !lost.contains(&number) && !near.iter().any(holds) {
                lost.insert(number);
            }
        }
    }
    if lost.is_empty() {
        return 0;
    }
    let reach: Vec<isize> = around(SEAM).map(|step| voxels.stride(step)).collect();
    let at_lost = |number: &usize| {
        reach.iter().any(|step| number.checked_add_signed(*step).is_some_and(|n| lost.contains(&n)))
    };
    passed.retain(at_lost);
    for &number in &passed {
        voxels.set(number, true);
    }
    passed.len()
}

/// The square of the distance from a point to a voxel.
fn distance_2(point: Corner, voxel: Point) -> f64 {
    let away = [0, 1, 2].map(|axis| {
        let low = f64::from(voxel[axis]);
        point[axis] - point[axis].clamp(low, low + 1.0)
    });
    dot(away, away)
}
