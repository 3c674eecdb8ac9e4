//! Lattice quad meshes in Wavefront OBJ: `v` and `f` count, names, groups, normals, textures and materials don't.

use super::ModelProblem;
use crate::square::{Point, Quad};
use crate::surface::Surface;

/// Statements that say nothing about the geometry of faces.
const IGNORED: [&str; 9] = ["vn", "vt", "vp", "o", "g", "s", "usemtl", "mtllib", "mg"];

/// Reads a quad mesh.
///
/// # Errors
/// A line that can't be read, a vertex off the lattice, a face that is no quad or no unit square, a face given twice.
pub(super) fn read(text: &str) -> Result<Surface, ModelProblem> {
    let (mut points, mut quads, mut lines) = (Vec::new(), Vec::new(), Vec::new());
    for (index, whole) in text.lines().enumerate() {
        let line = index + 1;
        let statement = whole.split('#').next().unwrap_or_default();
        let mut words = statement.split_whitespace();
        match words.next() {
            None => {}
            Some("v") => points.push(vertex(line, whole, &words.collect::<Vec<_>>())?),
            Some("f") => {
                quads.push(face(line, &words.collect::<Vec<_>>(), &points)?);
                lines.push(line);
            }
            Some(word) if IGNORED.contains(&word) => {}
            Some(_) => {
                return Err(bad_line(line, whole, "a statement of an OBJ mesh: v, f, vn, vt, o, g, s, ..."));
            }
        }
    }
    if quads.is_empty() {
        return Err(ModelProblem::Empty { expected: "faces ('f' lines)" });
    }
    Ok(Surface::new(quads, lines)?)
}

fn bad_line(line: usize, whole: &str, expected: &'static str) -> ModelProblem {
    ModelProblem::BadLine { line, found: whole.trim().to_string(), expected }
}

fn vertex(line: usize, whole: &str, words: &[&str]) -> Result<Point, ModelProblem> {
    // OBJ allows a weight or a colour after the three coordinates.
    let Some([x, y, z]) = words.first_chunk() else {
        return Err(bad_line(line, whole, "v with three coordinates"));
    };
    let mut point = [0; 3];
    for (place, word) in point.iter_mut().zip([x, y, z]) {
        let value: f64 =
            word.parse().map_err(|_| bad_line(line, whole, "v with three coordinates that are numbers"))?;
        *place =
            lattice(value).ok_or_else(|| ModelProblem::OffLattice { line, found: (*word).to_string() })?;
    }
    Ok(point)
}

/// The whole number that a coordinate is, far enough from the limits of 32 bits to be added to.
fn lattice(value: f64) -> Option<i32> {
    const FAR: f64 = 1e9;
    #[expect(clippy::cast_possible_truncation, reason = "whole and within +-1e9, as just tested")]
    let whole = (value.fract() == 0.0 && value.abs() < FAR).then_some(value as i32);
    whole
}

fn face(line: usize, words: &[&str], points: &[Point]) -> Result<Quad, ModelProblem> {
    let Ok(corners) = <&[&str; 4]>::try_from(words) else {
        return Err(ModelProblem::NotAQuad { line, found: words.len() });
    };
    let mut quad = [[0; 3]; 4];
    for (place, word) in quad.iter_mut().zip(corners) {
        let number = word.split('/').next().and_then(|word| word.parse::<isize>().ok());
        let index = number.and_then(|number| match number {
            1.. => usize::try_from(number - 1).ok(),
            // Negative numbers count back from the last vertex so far.
            _ => points.len().checked_sub(number.unsigned_abs()).filter(|_| number != 0),
        });
        *place = *index.and_then(|index| points.get(index)).ok_or_else(|| ModelProblem::NoSuchVertex {
            line,
            found: (*word).to_string(),
            vertices: points.len(),
        })?;
    }
    Ok(quad)
}

#[cfg(test)]
mod tests {
    use super::*;

    const CORNERS: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

    fn message(faces: &str) -> String {
        read(&format!("{CORNERS}{faces}")).map(|_| ()).unwrap_err().to_string()
    }

    #[test]
    fn corners_may_carry_textures_and_count_from_the_end() {
        let plain = read(&format!("{CORNERS}f 1 2 3 4\n")).unwrap();
        let dressed = read(&format!("# a sheet\n{CORNERS}vn 0 0 1\nf -4/1/1 -3//1 3 4 # so\n")).unwrap();
        assert_eq!(plain.quads(), dressed.quads());
    }

    #[test]
    fn a_triangle_is_refused_with_its_line() {
        assert_eq!(message("f 1 2 3\n"), "line 5: a face with 3 corners, expected 4: quads only");
    }

    #[test]
    fn a_vertex_off_the_lattice_is_refused_with_its_line() {
        assert!(message("v 0.5 0 0\n").starts_with("line 5: vertex coordinate 0.5, expected a whole number"));
        assert!(message("v 1e300 0 0\n").starts_with("line 5"));
        assert!(message("v nan 0 0\n").starts_with("line 5"));
    }

    #[test]
    fn a_face_that_is_no_unit_square_is_refused_with_its_line() {
        let found = message("f 1 3 2 4\n");
        assert!(found.starts_with("the face on line 5: corners (0, 0, 0) (1, 1, 0)"), "{found}");
    }

    #[test]
    fn a_face_given_twice_is_refused_with_both_lines() {
        let found = message("f 1 2 3 4\nf 2 3 4 1\n");
        assert!(
            found.starts_with("the face on line 6: the same square and outer side as the face on line 5"),
            "{found}"
        );
    }

    #[test]
    fn an_unknown_vertex_is_refused_with_its_line() {
        assert_eq!(
            message("f 1 2 3 9\n"),
            "line 5: vertex number \"9\", expected a vertex defined above: 1 to 4"
        );
        assert!(message("f 1 2 3 0\n").starts_with("line 5"));
    }

    #[test]
    fn a_word_that_obj_does_not_have_is_refused() {
        assert!(message("solid\n").starts_with("line 5: \"solid\""));
    }
}
