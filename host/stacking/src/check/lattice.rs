//! Names for places on the lattice that sort fast.

/// A number for a point and one of up to eight things that it may have: its edges, or squares with their outer sides.
pub(super) fn name(point: [i32; 3], which: usize) -> u128 {
    // Shifted by 2^31 the coordinates keep their order as numbers without a sign.
    let place = point.iter().fold(0, |place, c| place << 32 | u128::from(c.cast_unsigned() ^ (1 << 31)));
    place << 3 | which as u128
}
