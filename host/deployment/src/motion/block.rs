//! Blocks: runs of layers of a pile that still lie on each other, moved as one box.

use super::cuboid::Cuboid;
use super::linkage::{Layer, Linkage};
use glam::{DAffine3, DVec3};

/// Consecutive layers of a pile with closed hinges between them.
#[derive(Debug, Clone, Copy)]
pub(super) struct Block<'a> {
    pub(super) layers: &'a [Layer],
    /// Height of the lowest one.
    height: usize,
    pub(super) cuboid: Cuboid,
}

/// The box of the cores of so many layers from the height of the lowest panel on, which is at `pose`.
fn cuboid(linkage: &Linkage, pose: &DAffine3, height: usize, layers: usize) -> Cuboid {
    let thickness = linkage.thickness();
    let (t, high) = (thickness.thickness, layers as f64 * thickness.thickness);
    // The lowest panel's own layer goes from its outer face to -t; the next ones are on the side that is up.
    let middle = if height.is_multiple_of(2) { 0.5 * high - t } else { -0.5 * high };
    let half = 0.5 - thickness.rim;
    Cuboid {
        centre: pose.transform_point3(DVec3::new(0.5, 0.5, middle)),
        half: [DVec3::X * half, DVec3::Y * half, DVec3::Z * (0.5 * high)]
            .map(|half| pose.transform_vector3(half)),
    }
}

/// Calls `take` with every block, when `closed` says which hinges are.
pub(super) fn each<'a>(
    linkage: &'a Linkage,
    poses: &[DAffine3],
    closed: impl Fn(usize) -> bool,
    mut take: impl FnMut(Block<'a>),
) {
    for pile in linkage.piles() {
        let mut height = 0;
        while height < pile.len() {
            let joined = pile[height..].iter().take_while(|layer| layer.fold.is_some_and(&closed)).count();
            let end = (height + joined + 1).min(pile.len());
            let layers = &pile[height..end];
            let cuboid = cuboid(linkage, &poses[layers[0].panel], height, layers.len());
            take(Block { layers, height, cuboid });
            height = end;
        }
    }
}

impl Block<'_> {
    /// The box of one of its layers, at the start of a motion.
    pub(super) fn layer(&self, linkage: &Linkage, poses: &[DAffine3], layer: usize) -> Cuboid {
        cuboid(linkage, &poses[self.layers[layer].panel], self.height + layer, 1)
    }
}
