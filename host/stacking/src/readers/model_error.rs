//! What can be wrong with a model file.

use crate::surface::SurfaceError;

/// A model file that can't be used.
#[derive(Debug, thiserror::Error)]
#[error("{file}: {problem}")]
pub struct ModelError {
    /// The file.
    pub file: String,
    /// What is wrong with it; part of the message, so no cause of its own.
    pub problem: ModelProblem,
}

/// What is wrong with a model file; lines are counted from 1.
#[derive(Debug, thiserror::Error)]
pub enum ModelProblem {
    /// The extension names no format that is known.
    #[error(
        "unknown format '.{extension}', expected .txt or .vox (voxels), .obj (quads or mesh), \
         .stl, .ply, .off, .gltf or .glb (mesh)"
    )]
    UnknownFormat {
        /// What was found.
        extension: String,
    },
    /// A triangle mesh without a voxel size.
    #[error(
        "a triangle mesh needs a voxel size, found none: give --voxel SIZE, in units of the mesh, or --panels N"
    )]
    VoxelSizeMissing,
    /// A resolution for a file that is on the lattice already.
    #[error(
        "a voxel size or a number of panels is for meshes only: this format has voxels already; leave it out"
    )]
    VoxelSizeUnused,
    /// A number of panels that no solid of voxels has.
    #[error("{wanted} panels: no solid of voxels has so many; the nearest numbers that one has: {nearest}")]
    PanelCount {
        /// What was asked for.
        wanted: usize,
        /// The nearest numbers that can be.
        nearest: String,
    },
    /// No way to a number of panels.
    #[error(
        "no solid of {wanted} panels found: at the sizes tried the nearest has {nearest} more or fewer, and no voxel can be \
         put or taken that leads there without a tear or a tunnel; try another number"
    )]
    PanelsNotReached {
        /// What was asked for.
        wanted: usize,
        /// How far the nearest solid is from it, in panels.
        nearest: usize,
    },
    /// A voxel size that is no length.
    #[error("voxel size {size}, expected a length above 0")]
    VoxelSize {
        /// What was given.
        size: f64,
    },
    /// The system can't read the file.
    #[error("cannot be read: {0}")]
    Unreadable(#[from] std::io::Error),
    /// Bytes that are no text.
    #[error("line {line}: not UTF-8, expected a text file")]
    NotText {
        /// The line.
        line: usize,
    },
    /// Nothing in it.
    #[error("empty: expected {expected}")]
    Empty {
        /// What should be there.
        expected: &'static str,
    },
    /// A character that voxel text doesn't have.
    #[error("line {line}, column {column}: found {found:?}, expected '#' (solid) or '.' (empty)")]
    BadCharacter {
        /// The line.
        line: usize,
        /// The column, from 1.
        column: usize,
        /// What was found.
        found: char,
    },
    /// A row of another length than the first.
    #[error("line {line}: a row of {found} characters, expected {expected} as in the first row")]
    RaggedRow {
        /// The line.
        line: usize,
        /// Length of this row.
        found: usize,
        /// Length of the first row.
        expected: usize,
    },
    /// A slice with another number of rows than the first.
    #[error("line {line}: slice {slice} ends after {found} rows, expected {expected} as in slice 0")]
    RaggedSlice {
        /// Last line of the slice.
        line: usize,
        /// The slice, from 0.
        slice: usize,
        /// Rows of this slice.
        found: usize,
        /// Rows of the first slice.
        expected: usize,
    },
    /// No voxel is solid.
    #[error("no voxel is solid, expected at least one '#'")]
    NoSolidVoxel,
    /// More voxels than the lattice has room for.
    #[error("{found} voxels in the box, expected at most {limit}")]
    TooManyVoxels {
        /// Voxels in the box.
        found: u128,
        /// The limit.
        limit: u128,
    },
    /// More voxels than the lattice has room for, of a size that was given or searched.
    #[error(
        "with voxels of size {size} the box of the mesh has {found}, expected at most {limit}: \
         expected a larger size, or fewer panels"
    )]
    TooFine {
        /// The voxel size.
        size: f64,
        /// Voxels in the box.
        found: u128,
        /// The limit.
        limit: u128,
    },
    /// A line of an OBJ file that can't be read.
    #[error("line {line}: {found:?}, expected {expected}")]
    BadLine {
        /// The line.
        line: usize,
        /// What was found.
        found: String,
        /// What should be there.
        expected: &'static str,
    },
    /// A vertex between the lattice points.
    #[error(
        "line {line}: vertex coordinate {found}, expected a whole number: faces are taken for panels on the integer lattice; \
         to cut a mesh into voxels give --voxel SIZE or --panels N"
    )]
    OffLattice {
        /// The line.
        line: usize,
        /// The coordinate.
        found: String,
    },
    /// A triangle, or another polygon.
    #[error(
        "line {line}: a face with {found} corners, expected 4: faces are taken for panels; \
         to cut a mesh into voxels give --voxel SIZE or --panels N"
    )]
    NotAQuad {
        /// The line.
        line: usize,
        /// Number of corners.
        found: usize,
    },
    /// A face that is no panel.
    #[error("{problem}; to cut a mesh into voxels give --voxel SIZE or --panels N")]
    NotAPanel {
        /// What is wrong with it.
        #[source]
        problem: SurfaceError,
    },
    /// A corner that is no vertex.
    #[error("line {line}: vertex number {found:?}, expected a vertex defined above: 1 to {vertices}")]
    NoSuchVertex {
        /// The line.
        line: usize,
        /// What was found.
        found: String,
        /// Vertices so far.
        vertices: usize,
    },
    /// A polygon of one or two corners.
    #[error("{place}: a face with {found} corners, expected at least 3")]
    TooFewCorners {
        /// The face or its line.
        place: String,
        /// Number of corners.
        found: usize,
    },
    /// A corner that is no vertex, in a format that counts from 0.
    #[error("{place}: vertex number {found}, expected 0 to {}", .vertices.saturating_sub(1))]
    VertexNumber {
        /// The face or its line.
        place: String,
        /// What was found.
        found: String,
        /// How many vertices there are.
        vertices: usize,
    },
    /// A PLY file that can't be read.
    #[error("not a PLY file: {message}")]
    NotPly {
        /// What the parser says.
        message: String,
    },
    /// An element of a PLY file without what a mesh needs.
    #[error("{place}: expected {expected}")]
    PlyProperty {
        /// The element.
        place: String,
        /// What should be there.
        expected: &'static str,
    },
    /// A glTF file that can't be read.
    #[error("not a glTF file: {message}")]
    NotGltf {
        /// What the parser says.
        message: String,
    },
    /// A part of a glTF file that can't be used.
    #[error("{place}: expected {expected}")]
    GltfData {
        /// The part.
        place: String,
        /// What should be there.
        expected: &'static str,
    },
    /// Bytes of a binary file that can't be read.
    #[error("byte {at} of {length}: expected {expected}")]
    BadBytes {
        /// The place.
        at: usize,
        /// Bytes in the file.
        length: usize,
        /// What should be there.
        expected: &'static str,
    },
    /// More than one model in a file.
    #[error("{found} models in the file, expected one: merge them before saving")]
    SeveralModels {
        /// How many.
        found: usize,
    },
    /// An STL file that can't be read.
    #[error("not an STL file: {0}")]
    NotStl(#[source] std::io::Error),
    /// A vertex that is nowhere.
    #[error("triangle {triangle}: a coordinate that is no finite number")]
    NotFinite {
        /// The triangle, from 0.
        triangle: usize,
    },
    /// A mesh with holes, or with triangles turned inside out.
    #[error(
        "the mesh is not closed: {open} open edges, {unlike} edges between triangles of unlike orientation; \
         the first from {from} to {to}; expected every edge to be passed once in each direction; \
         close its holes, or give an open sheet by its panels, unit squares on the lattice (.obj)"
    )]
    NotClosed {
        /// Edges that belong to one triangle only.
        open: usize,
        /// Edges whose triangles don't run against each other.
        unlike: usize,
        /// One end of the first such edge.
        from: String,
        /// The other end.
        to: String,
    },
    /// A mesh with holes so large that it doesn't tell inside from outside.
    #[error(
        "{open}; it doesn't tell inside from outside either: the winding numbers of {percent} % as many voxels as are inside \
         lie between 1/4 and 3/4, expected at most {most} %"
    )]
    Undecided {
        /// What is open.
        open: Box<ModelProblem>,
        /// Unsure voxels in percent of those inside.
        percent: usize,
        /// The limit.
        most: usize,
    },
    /// No voxel's centre is inside.
    #[error(
        "no voxel of size {size} has its centre inside the mesh, whose box is {bounds}: expected a smaller size"
    )]
    TooCoarse {
        /// The voxel size.
        size: f64,
        /// The box of the mesh.
        bounds: String,
    },
    /// Voxels that don't hang together.
    #[error(
        "with voxels of size {size} the mesh is a solid in {count} pieces, expected one: {pieces}; \
         join them in the mesh, or try smaller voxels"
    )]
    SolidInPieces {
        /// The voxel size.
        size: f64,
        /// How many.
        count: usize,
        /// Sizes and places of the first few.
        pieces: String,
    },
    /// The squares make no surface that panels can build.
    #[error(transparent)]
    Surface(#[from] SurfaceError),
}
