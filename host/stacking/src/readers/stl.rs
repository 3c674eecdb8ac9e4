//! STL meshes, ASCII or binary, and the test that they are closed.

use super::ModelProblem;
use std::collections::BTreeMap;
use std::io::Cursor;

/// A corner, in units of the mesh.
pub(super) type Corner = [f64; 3];

/// Reads a closed mesh as its triangles.
///
/// # Errors
/// Bytes that are no STL, no triangle, coordinates that are no numbers, a mesh that is not closed.
pub(super) fn read(bytes: &[u8]) -> Result<Vec<[Corner; 3]>, ModelProblem> {
    if bytes.is_empty() {
        return Err(ModelProblem::Empty { expected: "an STL mesh" });
    }
    let mut reader = Cursor::new(bytes);
    let facets = stl_io::create_stl_reader(&mut reader).map_err(ModelProblem::NotStl)?;
    let mut triangles = Vec::new();
    for (triangle, facet) in facets.enumerate() {
        let facet = facet.map_err(ModelProblem::NotStl)?;
        // Adding 0 makes +0 of -0, so that equal corners have equal bits.
        let corners = facet.vertices.map(|vertex| vertex.0.map(|c| f64::from(c) + 0.0));
        if !corners.iter().flatten().all(|c| c.is_finite()) {
            return Err(ModelProblem::NotFinite { triangle });
        }
        triangles.push(corners);
    }
    if triangles.is_empty() {
        return Err(ModelProblem::Empty { expected: "triangles" });
    }
    require_closed(&triangles)?;
    Ok(triangles)
}

/// A mesh bounds a solid when every edge is passed as often one way as the other.
fn require_closed(triangles: &[[Corner; 3]]) -> Result<(), ModelProblem> {
    let mut passes: BTreeMap<[[u64; 3]; 2], (usize, usize)> = BTreeMap::new();
    for corners in triangles {
        for side in 0..3 {
            let ends = [corners[side], corners[(side + 1) % 3]].map(|corner| corner.map(f64::to_bits));
            if ends[0] < ends[1] {
                passes.entry(ends).or_default().0 += 1;
            } else if ends[0] > ends[1] {
                passes.entry([ends[1], ends[0]]).or_default().1 += 1;
            }
        }
    }
    let broken = || passes.iter().filter(|(_, (there, back))| there != back);
    let Some((ends, _)) = broken().next() else { return Ok(()) };
    let open = broken().filter(|(_, (there, back))| there + back == 1).count();
    let [from, to] = ends.map(|corner| {
        let [x, y, z] = corner.map(f64::from_bits);
        format!("({x}, {y}, {z})")
    });
    Err(ModelProblem::NotClosed { open, unlike: broken().count() - open, from, to })
}
