//! What is changed on the way from a mesh to a model, as the user is told. All that repairs lists it.

use std::fmt;

/// What was changed to make a model of a mesh.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Repair {
    /// Triangles with two corners in one place.
    Degenerate(usize),
    /// Triangles that were there before.
    Duplicate(usize),
    /// Corners that were moved onto their neighbours.
    Welded(usize),
    /// Triangles that were inside out against their neighbours.
    Turned(usize),
    /// Open edges that stay: inside is what the mesh winds round more than half.
    Wound {
        /// How many.
        edges: usize,
        /// Voxels whose winding number is between a quarter and three quarters, in percent of those inside, rounded up.
        unsure_percent: usize,
    },
    /// Small flat holes.
    Closed {
        /// How many.
        holes: usize,
        /// The open edges around them.
        edges: usize,
    },
    /// Cavities that can't be seen from outside.
    Filled {
        /// How many.
        cavities: usize,
        /// The voxels in them.
        voxels: usize,
    },
    /// Parts without a voxel's centre inside, which would be missing.
    Thickened {
        /// The voxels put there.
        voxels: usize,
    },
    /// Pieces that hang together by parts thinner than a voxel.
    Joined {
        /// How many.
        pieces: usize,
        /// The voxels put between them.
        voxels: usize,
    },
    /// Voxels put or taken to come to a number of panels.
    Edited {
        /// How many.
        voxels: usize,
        /// The panels before.
        panels: usize,
    },
    /// Crumbs off the solid.
    Dropped {
        /// How many.
        pieces: usize,
        /// The voxels in them.
        voxels: usize,
    },
}

impl fmt::Display for Repair {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Degenerate(count) => write!(f, "dropped {count} triangles without area"),
            Self::Duplicate(count) => write!(f, "dropped {count} triangles that were there before"),
            Self::Welded(count) => write!(f, "joined {count} corners to others in almost the same place"),
            Self::Turned(count) => {
                write!(f, "turned over {count} triangles that were inside out against their neighbours")
            }
            Self::Wound { edges, unsure_percent } => write!(
                f,
                "left {edges} open edges and took for inside what the mesh winds round more than half; \
                 {unsure_percent} % of the voxels could as well be outside"
            ),
            Self::Closed { holes, edges } => write!(f, "closed {holes} small holes of {edges} edges in all"),
            Self::Filled { cavities, voxels } => {
                write!(f, "filled {cavities} cavities ({voxels} voxels) that can't be seen from outside")
            }
            Self::Thickened { voxels } => {
                write!(f, "put {voxels} voxels where parts of the mesh are too thin for a voxel's centre")
            }
            Self::Joined { pieces, voxels } => {
                write!(f, "joined {pieces} pieces by {voxels} voxels where the mesh is thinner than a voxel")
            }
            Self::Edited { voxels, panels } => {
                write!(
                    f,
                    "put or took {voxels} voxels at the surface of {panels} panels to come to the number asked for"
                )
            }
            Self::Dropped { pieces, voxels } => {
                write!(f, "dropped {pieces} crumbs ({voxels} voxels) that hang on nothing")
            }
        }
    }
}
