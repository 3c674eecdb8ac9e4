//! OFF meshes (Object File Format), text: three counts, the vertices, then the faces with their numbers of corners.

use super::ModelProblem;
use super::polygons::{Polygons, number};
use crate::mesh::Triangle;

/// Reads the triangles.
///
/// # Errors
/// No OFF header, a line that can't be read, too few lines, a corner that is no vertex.
pub(super) fn read(text: &str) -> Result<Vec<Triangle>, ModelProblem> {
    let mut lines = text.lines().enumerate().filter_map(|(index, whole)| {
        let words: Vec<&str> = whole.split('#').next().unwrap_or_default().split_whitespace().collect();
        (!words.is_empty()).then_some((index + 1, whole, words))
    });
    let mut next = |expected| lines.next().ok_or(ModelProblem::Empty { expected });
    let (line, whole, mut words) = next("OFF")?;
    // COFF, NOFF, ...: colours or normals follow the three coordinates of a vertex, and are skipped. 4OFF isn't three-dimensional.
    if !["OFF", "COFF", "NOFF", "CNOFF", "STOFF"].contains(&words[0]) {
        return Err(bad_line(line, whole, "OFF"));
    }
    words.remove(0);
    let (line, whole, words) =
        if words.is_empty() { next("the numbers of vertices and faces")? } else { (line, whole, words) };
    let counts: Vec<usize> = words.iter().map_while(|word| word.parse().ok()).collect();
    let [vertices, faces, ..] = counts[..] else {
        return Err(bad_line(line, whole, "the numbers of vertices, faces and edges"));
    };
    let mut polygons = Polygons::default();
    for _ in 0..vertices {
        let (line, whole, words) = next("as many vertices as announced")?;
        let corner: Vec<f64> = words.iter().take(3).filter_map(|word| number(word)).collect();
        let corner =
            <[f64; 3]>::try_from(corner).map_err(|_| bad_line(line, whole, "a vertex: three coordinates"))?;
        polygons.corners.push(corner);
    }
    for _ in 0..faces {
        let (line, whole, words) = next("as many faces as announced")?;
        let bad = || bad_line(line, whole, "a face: its number of corners, then as many vertex numbers");
        let count: usize = words[0].parse().map_err(|_| bad())?;
        let corners = words.get(1..).and_then(|words| words.get(..count)).ok_or_else(bad)?;
        let corners: Vec<usize> =
            corners.iter().map(|word| word.parse()).collect::<Result<_, _>>().map_err(|_| bad())?;
        if let Some(found) = corners.iter().find(|corner| **corner >= vertices) {
            return Err(ModelProblem::VertexNumber {
                place: format!("line {line}"),
                found: found.to_string(),
                vertices,
            });
        }
        polygons
            .add(&corners)
            .map_err(|found| ModelProblem::TooFewCorners { place: format!("line {line}"), found })?;
    }
    polygons.triangles("faces")
}

fn bad_line(line: usize, whole: &str, expected: &'static str) -> ModelProblem {
    ModelProblem::BadLine { line, found: whole.trim().chars().take(60).collect(), expected }
}

#[cfg(test)]
mod tests {
    use super::*;

    const CORNERS: &str = "OFF\n# two triangles\n4 2 0\n\n0 0 0\n1 0 0 255 0 0\n1 1 0\n0 1 0\n";

    fn message(text: &str) -> String {
        read(text).map(|_| ()).unwrap_err().to_string()
    }

    #[test]
    fn counts_comments_and_colours_are_read_as_they_come() {
        assert_eq!(read(&format!("{CORNERS}3 0 1 2 0.5 0.5 0.5\n4 0 1 2 3\n")).unwrap().len(), 3);
        assert_eq!(read("OFF 3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n").unwrap().len(), 1);
    }

    #[test]
    fn what_is_missing_or_no_number_is_refused_with_its_line() {
        assert_eq!(message(&format!("{CORNERS}3 0 1 2\n")), "empty: expected as many faces as announced");
        assert!(message("ply\n").starts_with("line 1: \"ply\", expected OFF"));
        assert!(message("OFF\n3 x\n").starts_with("line 2: \"3 x\", expected the numbers"));
        assert!(message("OFF\n1 1 0\n0 zero 0\n").starts_with("line 3: \"0 zero 0\", expected a vertex"));
        assert!(message(&format!("{CORNERS}3 0 1\n")).starts_with("line 9: \"3 0 1\", expected a face"));
        assert_eq!(message(&format!("{CORNERS}3 0 1 4\n")), "line 9: vertex number 4, expected 0 to 3");
        assert_eq!(message("OFF\n0 0 0\n"), "empty: expected faces");
    }
}
