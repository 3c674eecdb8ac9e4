//! A solid with exactly so many panels: the voxel size is searched, then the solid is edited. `Mesh` calls it.

use super::edit;
use super::{Mesh, Solid};
use crate::readers::ModelProblem;

/// Sizes that are tried.
const SIZES: usize = 24;

/// The search for a size ends when the count is so near, as a share of the panels wanted.
const NEAR: f64 = 0.004;

/// Solids that are kept for editing, and so many are tried.
const KEPT: usize = 4;

/// A factor to step over a size that gives no solid.
const ASIDE: f64 = 0.97;

/// Significant digits of a size that is chosen here.
const DIGITS: i32 = 6;

/// The least counts: one voxel, two; from three voxels on every even number.
const LEAST: [usize; 3] = [6, 10, 14];

/// Looks for the voxel size at which the solid has nearly so many panels, and edits the solid until it has them.
///
/// # Errors
/// A number of panels that no solid has, or no size with a solid in one piece.
pub(super) fn solid(mesh: &Mesh, wanted: usize) -> Result<Solid, ModelProblem> {
    check(wanted)?;
    let mut search = Search { mesh, wanted, kept: Vec::new(), tried: Vec::new(), refused: None };
    search.run()?;
    let Some(nearest) = search.kept.first().map(|best| best.panels.abs_diff(wanted)) else {
        return Err(search.refused.unwrap_or(ModelProblem::PanelsNotReached { wanted, nearest: wanted }));
    };
    for Sized { panels, mut solid } in std::mem::take(&mut search.kept) {
        let size = solid.voxel_size;
        let distance = |voxel: [i32; 3]| mesh.distance(voxel.map(|c| f64::from(c) + 0.5), size);
        if let Some(voxels) = edit::edit(&mut solid.voxels, panels, wanted, &distance) {
            if voxels > 0 {
                solid.repairs.push(super::Repair::Edited { voxels, panels });
            }
            return Ok(solid);
        }
    }
    Err(ModelProblem::PanelsNotReached { wanted, nearest })
}

/// Refuses numbers of panels that no solid of voxels has: n voxels with c common sides have 6n - 2c.
fn check(wanted: usize) -> Result<(), ModelProblem> {
    let is_reachable = |count: &usize| LEAST.contains(count) || *count > LEAST[2] && count.is_multiple_of(2);
    if is_reachable(&wanted) {
        return Ok(());
    }
    let below = (LEAST[0]..wanted).rev().find(is_reachable);
    let above = (wanted.saturating_add(1)..=wanted.saturating_add(LEAST[0])).find(is_reachable);
    let list: Vec<String> = below.into_iter().chain(above).map(|count| count.to_string()).collect();
    Err(ModelProblem::PanelCount { wanted, nearest: list.join(" and ") })
}

/// A solid and its number of panels.
struct Sized {
    panels: usize,
    solid: Solid,
}

struct Search<'a> {
    mesh: &'a Mesh,
    wanted: usize,
    /// The solids nearest to the number wanted, the nearest first; of equal ones the one with fewer panels.
    kept: Vec<Sized>,
    /// Logarithms of the sizes that gave a solid, and of the numbers of panels over the one wanted.
    tried: Vec<(f64, f64)>,
    /// Why a size gave no solid.
    refused: Option<ModelProblem>,
}

impl Search<'_> {
    fn run(&mut self) -> Result<(), ModelProblem> {
        // The squares of a lattice that follow a surface have half as much area again, on average over all directions.
        let mut size = rounded((1.5 * self.mesh.area() / self.wanted as f64).sqrt());
        for _ in 0..SIZES {
            match self.mesh.solid_of(size) {
                Ok(solid) => {
                    let panels = solid.voxels.panels();
                    self.tried.push((size.ln(), (panels as f64 / self.wanted as f64).ln()));
                    self.keep(Sized { panels, solid });
                    if self.is_near() {
                        break;
                    }
                    let next = rounded(self.next().exp());
                    if self.tried.iter().any(|(tried, _)| (next.ln() - tried).abs() < 1e-9) {
                        break;
                    }
                    size = next;
                }
                Err(problem @ ModelProblem::TooCoarse { .. }) => {
                    // As good as one panel: the size to try is between this one and any that gave a solid.
                    self.tried.push((size.ln(), (1.0 / self.wanted as f64).ln()));
                    size = if self.kept.is_empty() { size / 2.0 } else { rounded(self.next().exp()) };
                    self.refused = Some(problem);
                }
                Err(problem @ ModelProblem::SolidInPieces { .. }) => {
                    size = rounded(size * ASIDE);
                    self.refused = Some(problem);
                }
                Err(problem @ ModelProblem::TooFine { .. }) => {
                    self.refused = Some(problem);
                    break;
                }
                Err(problem) => return Err(problem),
            }
        }
        Ok(())
    }

    fn keep(&mut self, sized: Sized) {
        self.kept.push(sized);
        self.kept.sort_by_key(|sized| (sized.panels.abs_diff(self.wanted), sized.panels));
        self.kept.truncate(KEPT);
    }

    fn is_near(&self) -> bool {
        self.kept.first().is_some_and(|best| {
            best.panels.abs_diff(self.wanted) as f64 <= (NEAR * self.wanted as f64).max(4.0)
        })
    }

    /// The logarithm of the size to try next: between the two nearest that have too many and too few panels, else as if
    /// the count fell with the square of the size.
    fn next(&self) -> f64 {
        let nearest = |fits: fn(f64) -> bool| {
            let tried = self.tried.iter().copied().filter(|(_, excess)| fits(*excess));
            tried.min_by(|a, b| a.1.abs().total_cmp(&b.1.abs()))
        };
        match (nearest(|excess| excess > 0.0), nearest(|excess| excess <= 0.0)) {
            (Some((fine, more)), Some((coarse, less))) => {
                let share = more / (more - less);
                // Counts jump where sides of the shape lie along the lattice: then halving is quicker.
                let share = if self.tried.len().is_multiple_of(3) { 0.5 } else { share.clamp(0.1, 0.9) };
                fine + share * (coarse - fine)
            }
            (Some((size, excess)), None) | (None, Some((size, excess))) => size + excess / 2.0,
            (None, None) => 0.0,
        }
    }
}

/// A size with few digits, so that people can give it again.
fn rounded(size: f64) -> f64 {
    #[expect(clippy::cast_possible_truncation, reason = "a logarithm")]
    let digits = DIGITS - 1 - size.log10().floor() as i32;
    let scale = 10_f64.powi(digits.abs());
    if digits >= 0 { (size * scale).round() / scale } else { (size / scale).round() * scale }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_that_no_solid_has_are_refused_with_the_nearest_that_one_has() {
        for (wanted, told) in [
            (0, "6"),
            (7, "6 and 10"),
            (8, "6 and 10"),
            (12, "10 and 14"),
            (13, "10 and 14"),
            (999, "998 and 1000"),
        ] {
            let Err(ModelProblem::PanelCount { nearest, .. }) = check(wanted) else { panic!("{wanted}") };
            assert_eq!(nearest, told);
        }
        for wanted in [6, 10, 14, 16, 18, 1000] {
            assert!(check(wanted).is_ok(), "{wanted}");
        }
    }

    #[test]
    fn sizes_are_rounded_to_six_digits() {
        for (size, expected) in [(0.012_345_678, 0.012_345_7), (123_456_789.0, 123_457_000.0), (2.0, 2.0)] {
            assert!((rounded(size) - expected).abs() < 1e-12 * expected, "{size}");
        }
    }
}
