//! PLY meshes, text or binary: `vertex` elements with x, y, z and `face` elements with a list of vertex numbers.

use super::ModelProblem;
use super::polygons::Polygons;
use crate::mesh::Triangle;
use ply_rs_bw::parser::Parser;
use ply_rs_bw::ply::{DefaultElement, Property};
use std::io::Cursor;

/// Reads the triangles.
///
/// # Errors
/// Bytes that are no PLY, a property that is missing, a corner that is no vertex.
pub(super) fn read(bytes: &[u8]) -> Result<Vec<Triangle>, ModelProblem> {
    if bytes.is_empty() {
        return Err(ModelProblem::Empty { expected: "a PLY mesh" });
    }
    let read = Parser::<DefaultElement>::new().read_ply(&mut Cursor::new(bytes));
    let ply = read.map_err(|error| ModelProblem::NotPly { message: error.to_string() })?;
    let mut polygons = Polygons::default();
    for (number, vertex) in ply.payload.get("vertex").into_iter().flatten().enumerate() {
        let mut corner = [0.0; 3];
        for (place, name) in corner.iter_mut().zip(["x", "y", "z"]) {
            *place = vertex.get(name).and_then(coordinate).ok_or_else(|| ModelProblem::PlyProperty {
                place: format!("vertex {number}"),
                expected: "numbers x, y and z",
            })?;
        }
        polygons.corners.push(corner);
    }
    let vertices = polygons.corners.len();
    for (number, face) in ply.payload.get("face").into_iter().flatten().enumerate() {
        let place = || format!("face {number}");
        let corners = face.get("vertex_indices").or_else(|| face.get("vertex_index")).and_then(indices);
        let corners = corners.ok_or_else(|| ModelProblem::PlyProperty {
            place: place(),
            expected: "a list vertex_indices of whole numbers",
        })?;
        let mut known = Vec::with_capacity(corners.len());
        for found in corners {
            let index = usize::try_from(found).ok().filter(|index| *index < vertices);
            known.push(index.ok_or_else(|| ModelProblem::VertexNumber {
                place: place(),
                found: found.to_string(),
                vertices,
            })?);
        }
        polygons.add(&known).map_err(|found| ModelProblem::TooFewCorners { place: place(), found })?;
    }
    polygons.triangles("faces")
}

fn coordinate(property: &Property) -> Option<f64> {
    match property {
        Property::Float(value) => Some(f64::from(*value)),
        Property::Double(value) => Some(*value),
        Property::Char(value) => Some(f64::from(*value)),
        Property::UChar(value) => Some(f64::from(*value)),
        Property::Short(value) => Some(f64::from(*value)),
        Property::UShort(value) => Some(f64::from(*value)),
        Property::Int(value) => Some(f64::from(*value)),
        Property::UInt(value) => Some(f64::from(*value)),
        _ => None,
    }
}

fn indices(property: &Property) -> Option<Vec<i64>> {
    fn wide<T: Copy + Into<i64>>(list: &[T]) -> Vec<i64> {
        list.iter().map(|index| (*index).into()).collect()
    }
    match property {
        Property::ListChar(list) => Some(wide(list)),
        Property::ListUChar(list) => Some(wide(list)),
        Property::ListShort(list) => Some(wide(list)),
        Property::ListUShort(list) => Some(wide(list)),
        Property::ListInt(list) => Some(wide(list)),
        Property::ListUInt(list) => Some(wide(list)),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn message(text: &str) -> String {
        read(text.as_bytes()).map(|_| ()).unwrap_err().to_string()
    }

    fn head(vertex: &str, faces: usize) -> String {
        format!(
            "ply\nformat ascii 1.0\nelement vertex 3\n{vertex}element face {faces}\n\
             property list uchar int vertex_indices\nend_header\n"
        )
    }

    const XYZ: &str = "property float x\nproperty float y\nproperty float z\n";

    #[test]
    fn bytes_that_are_no_ply_and_properties_that_are_missing_are_refused() {
        assert!(message("solid\n").starts_with("not a PLY file: "), "{}", message("solid\n"));
        let flat = format!("{}0 0\n1 0\n0 1\n3 0 1 2\n", head("property float x\nproperty float y\n", 1));
        assert_eq!(message(&flat), "vertex 0: expected numbers x, y and z");
    }

    #[test]
    fn a_corner_that_is_no_vertex_is_refused_with_its_face() {
        let ply = format!("{}0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n3 0 1 3\n", head(XYZ, 2));
        assert_eq!(message(&ply), "face 1: vertex number 3, expected 0 to 2");
        let ply = format!("{}0 0 0\n1 0 0\n0 1 0\n2 0 1\n", head(XYZ, 1));
        assert_eq!(message(&ply), "face 0: a face with 2 corners, expected at least 3");
    }

    #[test]
    fn a_file_that_ends_early_or_has_no_face_is_refused() {
        assert!(message(&format!("{}0 0 0\n", head(XYZ, 1))).starts_with("not a PLY file: "));
        assert_eq!(message(&format!("{}0 0 0\n1 0 0\n0 1 0\n", head(XYZ, 0))), "empty: expected faces");
        let huge = head(XYZ, 1).replace("vertex 3", "vertex 99999999999");
        assert!(message(&huge).starts_with("not a PLY file: "));
    }
}
