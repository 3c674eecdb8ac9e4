//! STL meshes, ASCII or binary.

use super::ModelProblem;
use crate::mesh::Triangle;
use std::io::Cursor;

/// Reads the triangles.
///
/// # Errors
/// Bytes that are no STL, no triangle.
pub(super) fn read(bytes: &[u8]) -> Result<Vec<Triangle>, ModelProblem> {
    if bytes.is_empty() {
        return Err(ModelProblem::Empty { expected: "an STL mesh" });
    }
    let mut reader = Cursor::new(bytes);
    let facets = stl_io::create_stl_reader(&mut reader).map_err(ModelProblem::NotStl)?;
    let mut triangles = Vec::new();
    for facet in facets {
        let facet = facet.map_err(ModelProblem::NotStl)?;
        triangles.push(facet.vertices.map(|vertex| vertex.0.map(f64::from)));
    }
    if triangles.is_empty() {
        return Err(ModelProblem::Empty { expected: "triangles" });
    }
    Ok(triangles)
}
