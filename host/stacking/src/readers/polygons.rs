//! Corners and polygons as most mesh formats have them, and the triangles that they make.

use super::ModelProblem;
use crate::mesh::{Corner, Triangle};

/// A mesh while it is read.
#[derive(Default)]
pub(super) struct Polygons {
    pub(super) corners: Vec<Corner>,
    triangles: Vec<[usize; 3]>,
}

impl Polygons {
    /// Adds a polygon as a fan of triangles; where it is flat, the fan winds round what the polygon winds round.
    ///
    /// # Errors
    /// The number of corners, where it is below three.
    pub(super) fn add(&mut self, corners: &[usize]) -> Result<(), usize> {
        let [first, rest @ ..] = corners else { return Err(0) };
        if rest.len() < 2 {
            return Err(corners.len());
        }
        self.triangles.extend(rest.windows(2).map(|pair| [*first, pair[0], pair[1]]));
        Ok(())
    }

    /// The triangles; `expected` says what is missing where there are none. Every corner was tested when it was added.
    pub(super) fn triangles(self, expected: &'static str) -> Result<Vec<Triangle>, ModelProblem> {
        if self.triangles.is_empty() {
            return Err(ModelProblem::Empty { expected });
        }
        Ok(self.triangles.iter().map(|triangle| triangle.map(|index| self.corners[index])).collect())
    }
}

/// A number in a text file; "nan" and "inf" are left for the mesh to refuse.
pub(super) fn number(word: &str) -> Option<f64> {
    word.parse().ok()
}
