//! STL meshes, ASCII or binary. Files are set right first where the parser is narrower than what programs write.

use super::ModelProblem;
use crate::mesh::Triangle;
use std::io::Cursor;

/// A binary file: a header, the number of triangles, the triangles.
const HEADER: usize = 80;
const COUNT: usize = 4;
const TRIANGLE: usize = 50;

/// Reads the triangles.
///
/// # Errors
/// Bytes that are no STL, fewer than announced, no triangle.
pub(super) fn read(bytes: &[u8]) -> Result<Vec<Triangle>, ModelProblem> {
    if bytes.is_empty() {
        return Err(ModelProblem::Empty { expected: "an STL mesh" });
    }
    // A text has no zero bytes; the end of every binary triangle has.
    let mut reader = Cursor::new(if bytes.contains(&0) { binary(bytes)? } else { text(bytes) });
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

/// A binary file without its header, which may begin with "solid" as if it were a text.
fn binary(bytes: &[u8]) -> Result<Vec<u8>, ModelProblem> {
    let Some(count) = bytes.get(HEADER..).and_then(<[u8]>::first_chunk::<COUNT>) else {
        return Err(ends_early(bytes, "a header of 80 bytes and a number of triangles"));
    };
    if bytes.len() < HEADER + COUNT + u32::from_le_bytes(*count) as usize * TRIANGLE {
        return Err(ends_early(bytes, "more triangles, as many as announced at byte 80"));
    }
    Ok([&[0; HEADER], &bytes[HEADER..]].concat())
}

fn ends_early(bytes: &[u8], expected: &'static str) -> ModelProblem {
    ModelProblem::BadBytes { at: bytes.len(), length: bytes.len(), expected }
}

/// All solids of a text file as one, without their names, in small letters.
fn text(bytes: &[u8]) -> Vec<u8> {
    let text = String::from_utf8_lossy(bytes).to_ascii_lowercase();
    let mut lines: Vec<&str> = text.lines().map(str::trim).filter(|line| !line.is_empty()).collect();
    let begins = |line: &str, word| line.split_whitespace().next() == Some(word);
    if !lines.first().is_some_and(|line| begins(line, "solid")) {
        return bytes.to_vec();
    }
    let ends = lines.last().is_some_and(|line| begins(line, "endsolid"));
    lines.retain(|line| !begins(line, "solid") && !begins(line, "endsolid"));
    lines.insert(0, "solid mesh");
    if ends {
        // Otherwise the parser says that the end is missing.
        lines.push("endsolid mesh");
    }
    lines.join("\n").into_bytes()
}

#[cfg(test)]
mod tests {
    use super::*;

    const FACET: &str =
        "facet normal 0 0 1\n outer loop\n vertex 0 0 0\n vertex 1 0 0\n vertex 0 1 0\n endloop\nendfacet\n";

    #[test]
    fn a_text_may_lack_a_name_shout_and_hold_several_solids() {
        for text in [
            format!("solid\n{FACET}endsolid\n"),
            format!("\n  SOLID a\r\n{}ENDSOLID a", FACET.to_uppercase()),
        ] {
            assert_eq!(read(text.as_bytes()).unwrap().len(), 1, "{text}");
        }
        let two = format!("solid a\n{FACET}endsolid a\nsolid b\n{FACET}{FACET}endsolid b\n");
        assert_eq!(read(two.as_bytes()).unwrap().len(), 3);
    }

    #[test]
    fn a_text_that_ends_early_and_bytes_that_are_no_stl_are_refused() {
        for text in [format!("solid a\n{FACET}"), format!("solid a\n{}", &FACET[..40]), "<html>".to_string()]
        {
            let told = read(text.as_bytes()).map(|_| ()).unwrap_err().to_string();
            assert!(told.starts_with("not an STL file: "), "{told}");
        }
        let told = read(&[0; 20]).map(|_| ()).unwrap_err().to_string();
        assert!(told.starts_with("byte 20 of 20: expected a header of 80 bytes"), "{told}");
    }
}
