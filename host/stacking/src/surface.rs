//! The surface to build, as a set of unit squares. The readers make it, `Dual` says which squares are neighbours.

use crate::square::{self, At, Quad};

/// Why a set of squares is no surface that panels can build.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum SurfaceError {
    /// Nothing there.
    #[error("no panel: expected at least one unit square")]
    Empty,
    /// A face whose corners are not those of a unit square.
    #[error("{face}: corners {corners}, expected a unit square of the integer lattice, corners in order")]
    NotUnitSquare {
        /// The face.
        face: String,
        /// Its corners.
        corners: String,
    },
    /// Two faces on one square with the same outer side.
    #[error("{face}: the same square and outer side as {first}, expected every face once")]
    Twice {
        /// The second face.
        face: String,
        /// The first one.
        first: String,
    },
    /// Two neighbours of opposite orientation.
    #[error("{first} and {second} run the same way along the edge {edge}: expected one orientation all over")]
    Unlike {
        /// A face.
        first: String,
        /// Its neighbour.
        second: String,
        /// The lattice edge between them.
        edge: String,
    },
    /// Sheets that pass through each other.
    #[error(
        "sheets cross at the edge {edge}: {faces}; expected one or two faces, or four that pair by their inner sides"
    )]
    Crossing {
        /// The lattice edge.
        edge: String,
        /// The faces that meet there.
        faces: String,
    },
    /// Several surfaces in place of one.
    #[error("the surface is in {count} pieces, expected one: {pieces}")]
    Pieces {
        /// How many.
        count: usize,
        /// Sizes and places of the first few.
        pieces: String,
    },
}

/// A set of unit squares, each with an outer side, no two alike.
#[derive(Debug, Clone)]
pub struct Surface {
    quads: Vec<Quad>,
    /// The line of the model file that each square stands on, where it stands on one.
    lines: Vec<usize>,
}

impl Surface {
    /// Makes a surface of squares given by their corners, counter-clockwise seen from outside. `lines` holds the line of
    /// the file for each, or nothing.
    ///
    /// # Errors
    /// No square at all, corners that make no unit square, or a square given twice.
    pub fn new(quads: Vec<[[i32; 3]; 4]>, lines: Vec<usize>) -> Result<Self, SurfaceError> {
        let surface = Self { quads, lines };
        if surface.quads.is_empty() {
            return Err(SurfaceError::Empty);
        }
        // Of what is wrong, the first in the file is told.
        let sound = surface.quads.iter().position(|quad| !square::is_unit(quad)).unwrap_or(surface.len());
        let names = surface.quads[..sound].iter().map(square::place_name);
        let mut taken: Vec<(u128, usize)> = names.enumerate().map(|(panel, name)| (name, panel)).collect();
        taken.sort_unstable();
        let twice = taken.windows(2).filter(|pair| pair[0].0 == pair[1].0).map(|pair| (pair[1].1, pair[0].1));
        if let Some((panel, first)) = twice.min() {
            return Err(SurfaceError::Twice { face: surface.name(panel), first: surface.name(first) });
        }
        if let Some(quad) = surface.quads.get(sound) {
            let corners = quad.map(|p| At(p).to_string()).join(" ");
            return Err(SurfaceError::NotUnitSquare { face: surface.name(sound), corners });
        }
        Ok(surface)
    }

    /// The corners of every panel.
    pub fn quads(&self) -> &[[[i32; 3]; 4]] {
        &self.quads
    }

    /// The number of panels.
    pub fn len(&self) -> usize {
        self.quads.len()
    }

    /// Never true: a surface has a panel.
    pub fn is_empty(&self) -> bool {
        self.quads.is_empty()
    }

    /// The sides of the surface's box, in panel lengths.
    pub fn bounds(&self) -> [i32; 3] {
        [0, 1, 2].map(|axis| {
            let values = || self.quads.iter().flatten().map(|point| point[axis]);
            values().max().unwrap_or(0) - values().min().unwrap_or(0)
        })
    }

    /// What to call a panel before people: its line in the model file, or its place.
    pub(crate) fn name(&self, panel: usize) -> String {
        match self.lines.get(panel) {
            Some(line) => format!("the face on line {line}"),
            None => format!("the face at {}", At(square::least_corner(&self.quads[panel]))),
        }
    }
}
