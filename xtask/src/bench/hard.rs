//! Solids on which a strip is hard to find: a torus, a plate with single voxels all over it, a rod.

use super::blob::{MARGIN, Solid};

/// Radii of the torus, in voxels.
const TORUS: [f64; 2] = [135.0, 57.0];
const PLATE: usize = 300;
const ROD: usize = 25_000;
/// Of so many places on a flat terrace one gets a voxel.
const PLACES_PER_BUMP: u64 = 10;

/// The solids and their names.
pub(super) fn solids() -> [(&'static str, Solid); 3] {
    let [ring, tube] = TORUS;
    let (across, high) = (2.0 * (ring + tube), 2.0 * tube);
    let mut torus = Solid::filled([across, across, high].map(rounded), |[x, y, z]| {
        let out = (x - across / 2.0).hypot(y - across / 2.0) - ring;
        out.hypot(z - high / 2.0) <= tube
    });
    let mut plate = Solid::filled([PLATE, PLATE, 1], |_| true);
    let rod = Solid::filled([1, 1, ROD], |_| true);
    torus.scatter_bumps();
    plate.scatter_bumps();
    [("torus with bumps", torus), ("plate with bumps", plate), ("rod", rod)]
}

impl Solid {
    /// The voxels of a box whose centres a shape holds.
    fn filled(box_sides: [usize; 3], holds: impl Fn([f64; 3]) -> bool) -> Self {
        let sides = box_sides.map(|side| side + 2 * MARGIN);
        let mut voxels = vec![false; sides.iter().product()];
        for (number, voxel) in voxels.iter_mut().enumerate() {
            let at = [number % sides[0], number / sides[0] % sides[1], number / sides[0] / sides[1]];
            let inside = (0..3).all(|axis| (MARGIN..MARGIN + box_sides[axis]).contains(&at[axis]));
            *voxel = inside && holds(at.map(|c| c as f64 + 0.5 - MARGIN as f64));
        }
        Self { sides, voxels }
    }

    /// Puts voxels on every flat place that looks up, here and there.
    fn scatter_bumps(&mut self) {
        let before = self.voxels.clone();
        let [width, depth, _] = self.sides;
        let edge = (depth + 1) * width + 1;
        for at in edge..before.len() - edge {
            let around = || (0..9).map(|n| at + (n / 3) * width + n % 3 - width - 1);
            let is_flat = around()
                .all(|i| before.get(i - width * depth) == Some(&true) && before.get(i) == Some(&false));
            if is_flat && mixed(at as u64).is_multiple_of(PLACES_PER_BUMP) {
                self.voxels[at] = true;
            }
        }
    }
}

/// A number that looks like chance (the mixing of `SplitMix64`).
fn mixed(number: u64) -> u64 {
    let z = number.wrapping_mul(0x9E37_79B9_7F4A_7C15);
    let z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    let z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    z ^ (z >> 31)
}

fn rounded(length: f64) -> usize {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "lengths of a box, above 0")]
    let whole = length.round() as usize;
    whole
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bench::stacking::panels_of;

    #[test]
    fn the_torus_and_the_plate_have_bumps_and_the_text_tells_the_same_solid() {
        for (name, solid) in solids() {
            assert_eq!(panels_of(&solid.text()), solid.panels(), "{name}");
        }
        let smooth = 2 * PLATE * PLATE + 4 * PLATE;
        assert!(solids()[1].1.panels() > smooth + 10_000);
        assert_eq!(solids()[2].1.panels(), 4 * ROD + 2);
    }
}
