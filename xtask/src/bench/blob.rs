//! A solid of any size with an exact number of panels: overlapping ellipsoids, and single voxels on its flat terraces and in
//! its angles for the panels that are missing. The bumps on terraces are the hard places for a strip.

use anyhow::{Result, bail};
use std::fmt::Write;

/// Centre and half axes, in units of the body's size: a body, a head and two fins.
const PARTS: [([f64; 3], [f64; 3]); 4] = [
    ([0.0, 0.0, 0.0], [1.0, 0.45, 0.5]),
    ([-1.1, 0.0, 0.05], [0.35, 0.2, 0.6]),
    ([0.1, 0.5, -0.1], [0.3, 0.35, 0.12]),
    ([0.1, -0.5, -0.1], [0.3, 0.35, 0.12]),
];
/// The box of the parts, in the same units.
const LOW: [f64; 3] = [-1.45, -0.85, -0.55];
const HIGH: [f64; 3] = [1.0, 0.85, 0.65];
/// Panels of the solid of size 1, by measurement; sets where the search for the size begins.
const PANELS_PER_SIZE: f64 = 9.5;
/// Sizes tried.
const TRIES: usize = 60;
/// Empty voxels around the solid: room for bumps, and nobody beyond the edge.
pub(super) const MARGIN: usize = 2;

/// Voxels in a box, x fastest.
pub(super) struct Solid {
    pub(super) sides: [usize; 3],
    pub(super) voxels: Vec<bool>,
}

/// The solid with exactly so many panels, as voxel text.
///
/// # Errors
/// No size was found.
pub(super) fn voxel_text(panels: usize) -> Result<String> {
    let mut size = (panels as f64 / PANELS_PER_SIZE).sqrt();
    for _ in 0..TRIES {
        let mut solid = Solid::of(size);
        let found = solid.panels();
        if found <= panels && (panels - found).is_multiple_of(2) {
            // A bump is four panels more, a ledge two.
            let left = panels - found - 4 * solid.add_bumps((panels - found) / 4);
            if solid.add_ledges(left / 2) {
                return Ok(solid.text());
            }
        }
        // Straight to the size that should do while the number is far off, then on in small steps.
        let ratio = panels as f64 / found as f64;

        size *= if (0.98..1.0).contains(&(1.0 / ratio)) { 0.9995 } else { ratio.sqrt() * 0.997 };
    }
    bail!("found no solid with {panels} panels in {TRIES} tries")
}

impl Solid {
    fn of(size: f64) -> Self {
        let sides = [0, 1, 2].map(|axis| whole((HIGH[axis] - LOW[axis]) * size) + 1 + 2 * MARGIN);
        let mut voxels = vec![false; sides.iter().product()];
        // The centre of a voxel, in units of the size.
        let centre = |index: usize, axis: usize| (index as f64 + 0.5 - MARGIN as f64) / size + LOW[axis];
        for (number, row) in voxels.chunks_mut(sides[0]).enumerate() {
            let (y, z) = (centre(number % sides[1], 1), centre(number / sides[1], 2));
            for (middle, half) in PARTS {
                let rest = 1.0 - ((y - middle[1]) / half[1]).powi(2) - ((z - middle[2]) / half[2]).powi(2);
                if rest > 0.0 {
                    let reach = half[0] * rest.sqrt();
                    let place = |x: f64| whole((x - LOW[0]) * size - 0.5) + MARGIN;
                    for voxel in &mut row[place(middle[0] - reach)..place(middle[0] + reach)] {
                        *voxel = true;
                    }
                }
            }
        }
        Self { sides, voxels }
    }

    /// Squares between solid and empty.
    pub(super) fn panels(&self) -> usize {
        let steps = [1, self.sides[0], self.sides[0] * self.sides[1]];
        let faces =
            |step: usize| self.voxels.iter().zip(&self.voxels[step..]).filter(|(a, b)| a != b).count();
        steps.into_iter().map(faces).sum()
    }

    /// Puts single voxels into the angles of floors and walls, and says whether there was room for so many.
    fn add_ledges(&mut self, mut ledges: usize) -> bool {
        let steps = [1, self.sides[0], self.sides[0] * self.sides[1]];
        let margin = MARGIN * steps[2];
        for at in margin..self.voxels.len() - margin {
            if ledges == 0 {
                break;
            }
            let voxels = &self.voxels;
            let axes = steps.map(|step| usize::from(voxels[at - step]) + usize::from(voxels[at + step]));
            if !voxels[at] && axes.iter().sum::<usize>() == 2 && axes.iter().all(|solid| *solid < 2) {
                self.voxels[at] = true;
                ledges -= 1;
            }
        }
        ledges == 0
    }

    /// Puts single voxels on flat places that look up, apart from one another, and says how many.
    fn add_bumps(&mut self, most: usize) -> usize {
        let [width, depth, height] = self.sides;
        let layer = width * depth;
        let mut bumps = 0;
        for z in 1..height - 1 {
            for y in (2..depth - 2).step_by(4) {
                for x in (2..width - 2).step_by(4) {
                    if bumps == most {
                        return bumps;
                    }
                    let at = (z * depth + y) * width + x;
                    let around = || (0..9).map(|n| at + (n / 3) * width + n % 3 - width - 1);
                    if around().all(|i| self.voxels[i - layer] && !self.voxels[i] && !self.voxels[i + layer])
                    {
                        self.voxels[at] = true;
                        bumps += 1;
                    }
                }
            }
        }
        bumps
    }

    pub(super) fn text(&self) -> String {
        let mut text = String::with_capacity(self.voxels.len() + self.voxels.len() / 8);
        for (number, row) in self.voxels.chunks(self.sides[0]).enumerate() {
            if number > 0 && number % self.sides[1] == 0 {
                text.push('\n');
            }
            text.extend(row.iter().map(|solid| if *solid { '#' } else { '.' }));
            // Writing to a string can't fail.
            writeln!(text).ok();
        }
        text
    }
}

fn whole(length: f64) -> usize {
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "lengths of a box, never below 0"
    )]
    let whole = length.ceil().max(0.0) as usize;
    whole
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bench::stacking::panels_of;

    #[test]
    fn a_solid_has_as_many_panels_as_asked_for() {
        for panels in [1_000, 1_002, 10_000, 30_000, 100_000] {
            assert_eq!(panels_of(&voxel_text(panels).unwrap()), panels);
        }
    }
}
