//! Wavefront OBJ: `v` and `f` count, names, groups, normals, textures and materials don't. A file is read either as a quad
//! mesh on the integer lattice, whose faces are the panels, or as a mesh that is to be cut into voxels.

use super::ModelProblem;
use super::polygons::{Polygons, number};
use crate::mesh::{Corner, Triangle};
use crate::square::{Point, Quad};
use crate::surface::{Surface, SurfaceError};

/// Statements that say nothing about the geometry of faces.
const IGNORED: [&str; 11] = ["vn", "vt", "vp", "o", "g", "s", "usemtl", "mtllib", "mg", "l", "p"];

/// So many characters of a line that can't be read are shown.
const LINE_SHOWN: usize = 60;

/// Reads a quad mesh on the integer lattice.
///
/// # Errors
/// A line that can't be read, a vertex off the lattice, a face that is no quad or no unit square, a face given twice.
pub(super) fn quads(text: &str) -> Result<Surface, ModelProblem> {
    let (mut points, mut quads, mut lines) = (Vec::new(), Vec::new(), Vec::new());
    for_each_statement(text, |line, statement| {
        match statement {
            Statement::Vertex(corner, words) => points.push(lattice_point(line, corner, words)?),
            Statement::Face(words) => {
                let Ok(corners) = <&[&str; 4]>::try_from(words) else {
                    return Err(ModelProblem::NotAQuad { line, found: words.len() });
                };
                let mut quad: Quad = [[0; 3]; 4];
                for (place, word) in quad.iter_mut().zip(corners) {
                    *place = points[vertex_index(line, word, points.len())?];
                }
                quads.push(quad);
                lines.push(line);
            }
        }
        Ok(())
    })?;
    if quads.is_empty() {
        return Err(ModelProblem::Empty { expected: "faces ('f' lines)" });
    }
    Surface::new(quads, lines).map_err(|problem| match problem {
        SurfaceError::NotUnitSquare { .. } => ModelProblem::NotAPanel { problem },
        problem => problem.into(),
    })
}

/// Reads a mesh of any polygons as triangles.
///
/// # Errors
/// A line that can't be read, a corner that is no vertex, no face.
pub(super) fn mesh(text: &str) -> Result<Vec<Triangle>, ModelProblem> {
    let mut polygons = Polygons::default();
    for_each_statement(text, |line, statement| {
        match statement {
            Statement::Vertex(corner, _) => polygons.corners.push(corner),
            Statement::Face(words) => {
                let corners = words.iter().map(|word| vertex_index(line, word, polygons.corners.len()));
                let corners: Vec<usize> = corners.collect::<Result<_, _>>()?;
                polygons
                    .add(&corners)
                    .map_err(|found| ModelProblem::TooFewCorners { place: format!("line {line}"), found })?;
            }
        }
        Ok(())
    })?;
    polygons.triangles("faces ('f' lines)")
}

/// A line that counts.
enum Statement<'a> {
    Vertex(Corner, [&'a str; 3]),
    Face(&'a [&'a str]),
}

fn for_each_statement(
    text: &str,
    mut take: impl FnMut(usize, Statement<'_>) -> Result<(), ModelProblem>,
) -> Result<(), ModelProblem> {
    let mut lines = text.lines().enumerate();
    while let Some((index, whole)) = lines.next() {
        let line = index + 1;
        let mut words: Vec<&str> = words_of(whole).collect();
        // A backslash at its end makes a line go on in the next.
        while words.last() == Some(&"\\") {
            words.pop();
            words.extend(lines.next().into_iter().flat_map(|(_, more)| words_of(more)));
        }
        match words.split_first() {
            None => {}
            Some((&"v", words)) => {
                // OBJ allows a weight or a colour after the three coordinates.
                let Some(words) = words.first_chunk::<3>() else {
                    return Err(bad_line(line, whole, "v with three coordinates"));
                };
                let mut corner = [0.0; 3];
                for (place, word) in corner.iter_mut().zip(words) {
                    *place = number(word)
                        .ok_or_else(|| bad_line(line, whole, "v with three coordinates that are numbers"))?;
                }
                take(line, Statement::Vertex(corner, *words))?;
            }
            Some((&"f", words)) => take(line, Statement::Face(words))?,
            Some((word, _)) if IGNORED.contains(word) => {}
            Some(_) => {
                return Err(bad_line(line, whole, "a statement of an OBJ mesh: v, f, vn, vt, o, g, s, ..."));
            }
        }
    }
    Ok(())
}

/// The words of a line, a backslash at its end being one of its own.
fn words_of(line: &str) -> impl Iterator<Item = &str> {
    let statement = line.split('#').next().unwrap_or_default().trim_end();
    let (statement, goes_on) =
        statement.strip_suffix('\\').map_or((statement, None), |line| (line, Some("\\")));
    statement.split_whitespace().chain(goes_on)
}

fn bad_line(line: usize, whole: &str, expected: &'static str) -> ModelProblem {
    ModelProblem::BadLine { line, found: whole.trim().chars().take(LINE_SHOWN).collect(), expected }
}

/// The lattice point of a vertex, far enough from the limits of 32 bits to be added to.
fn lattice_point(line: usize, corner: Corner, words: [&str; 3]) -> Result<Point, ModelProblem> {
    const FAR: f64 = 1e9;
    let mut point = [0; 3];
    for axis in 0..3 {
        let value = corner[axis];
        if value.fract() != 0.0 || value.abs() >= FAR {
            return Err(ModelProblem::OffLattice { line, found: words[axis].to_string() });
        }
        #[expect(clippy::cast_possible_truncation, reason = "whole and within +-1e9, as just tested")]
        let whole = value as i32;
        point[axis] = whole;
    }
    Ok(point)
}

/// The vertex that a corner of a face names, from 0.
fn vertex_index(line: usize, word: &str, vertices: usize) -> Result<usize, ModelProblem> {
    let number = word.split('/').next().and_then(|word| word.parse::<isize>().ok());
    let index = number.and_then(|number| match number {
        1.. => usize::try_from(number - 1).ok(),
        // Negative numbers count back from the last vertex so far.
        _ => vertices.checked_sub(number.unsigned_abs()).filter(|_| number != 0),
    });
    index.filter(|index| *index < vertices).ok_or_else(|| ModelProblem::NoSuchVertex {
        line,
        found: word.to_string(),
        vertices,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    const CORNERS: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

    fn message(faces: &str) -> String {
        quads(&format!("{CORNERS}{faces}")).map(|_| ()).unwrap_err().to_string()
    }

    #[test]
    fn corners_may_carry_textures_and_count_from_the_end() {
        let plain = quads(&format!("{CORNERS}f 1 2 3 4\n")).unwrap();
        let dressed = quads(&format!("# a sheet\n{CORNERS}vn 0 0 1\nf -4/1/1 -3//1 3 4 # so\n")).unwrap();
        assert_eq!(plain.quads(), dressed.quads());
    }

    #[test]
    fn a_triangle_is_refused_with_its_line_and_the_way_out() {
        assert_eq!(
            message("f 1 2 3\n"),
            "line 5: a face with 3 corners, expected 4: faces are taken for panels; \
             to cut a mesh into voxels give --voxel SIZE or --panels N"
        );
    }

    #[test]
    fn a_vertex_off_the_lattice_is_refused_with_its_line_and_the_way_out() {
        assert!(
            message("v 0.5 0 0\n").ends_with("to cut a mesh into voxels give --voxel SIZE or --panels N")
        );
        assert!(message("v 0.5 0 0\n").starts_with("line 5: vertex coordinate 0.5, expected a whole number"));
        assert!(message("v 1e300 0 0\n").starts_with("line 5"));
        assert!(message("v nan 0 0\n").starts_with("line 5"));
    }

    #[test]
    fn a_face_that_is_no_unit_square_is_refused_with_its_line() {
        let found = message("f 1 3 2 4\n");
        assert!(found.starts_with("the face on line 5: corners (0, 0, 0) (1, 1, 0)"), "{found}");
        assert!(found.ends_with("to cut a mesh into voxels give --voxel SIZE or --panels N"), "{found}");
    }

    #[test]
    fn a_line_that_ends_with_a_backslash_goes_on_in_the_next() {
        let plain = quads(&format!("{CORNERS}f 1 2 3 4\n")).unwrap();
        let parted = quads(&format!("{CORNERS}f 1 2 \\\n  3\\\n4\n")).unwrap();
        assert_eq!(plain.quads(), parted.quads());
        assert!(message("f 1 2 \\").starts_with("line 5: a face with 2 corners"));
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
        assert!(message("f 1 2 3 -5\n").starts_with("line 5"));
    }

    #[test]
    fn a_word_that_obj_does_not_have_is_refused() {
        assert!(message("solid\n").starts_with("line 5: \"solid\""));
    }

    #[test]
    fn polygons_of_a_mesh_become_triangles() {
        let found = mesh(&format!("{CORNERS}v 0.5 0.5 1\nf 1 2 5\nf 1 2 3 4\n")).unwrap();
        assert_eq!(found.len(), 3);
        assert_eq!(
            found[0].map(|corner| corner.map(|c| c.to_string())).concat().join(" "),
            "0 0 0 1 0 0 0.5 0.5 1"
        );
        let short = mesh(&format!("{CORNERS}f 1 2\n")).unwrap_err().to_string();
        assert_eq!(short, "line 5: a face with 2 corners, expected at least 3");
    }
}
