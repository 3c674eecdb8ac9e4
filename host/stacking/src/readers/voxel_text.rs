//! Voxel text: slices from z = 0 up with a blank line between them, rows along x, `#` solid and `.` empty.

use super::ModelProblem;
use crate::voxels::Voxels;

/// A text holds more: a byte each, as many as a file of a quarter of a gigabyte.
const TEXT_LIMIT: usize = 1 << 28;

/// A row and its line in the file.
type Row<'a> = (usize, &'a str);

/// Reads a voxel text file.
///
/// # Errors
/// No row, rows or slices of unequal size, another character, or no solid voxel.
pub(super) fn read(text: &str) -> Result<Voxels, ModelProblem> {
    let rows: Vec<Row<'_>> = text.lines().enumerate().map(|(index, row)| (index + 1, row)).collect();
    let slices: Vec<&[Row<'_>]> =
        rows.split(|(_, row)| row.is_empty()).filter(|slice| !slice.is_empty()).collect();
    let Some((first, others)) = slices.split_first() else {
        return Err(ModelProblem::Empty { expected: "rows of '#' and '.'" });
    };
    let (width, depth) = (first[0].1.chars().count(), first.len());
    let mut solid = Vec::with_capacity(text.len());
    for (z, slice) in std::iter::once(first).chain(others).enumerate() {
        for (line, row) in *slice {
            for (column, found) in row.chars().enumerate() {
                match found {
                    '#' => solid.push(true),
                    '.' => solid.push(false),
                    _ => {
                        return Err(ModelProblem::BadCharacter { line: *line, column: column + 1, found });
                    }
                }
            }
            let found = row.chars().count();
            if found != width {
                return Err(ModelProblem::RaggedRow { line: *line, found, expected: width });
            }
        }
        if slice.len() != depth {
            let line = slice[slice.len() - 1].0;
            return Err(ModelProblem::RaggedSlice { line, slice: z, found: slice.len(), expected: depth });
        }
    }
    let too_many = ModelProblem::TooManyVoxels { found: solid.len() as u128, limit: TEXT_LIMIT as u128 };
    if solid.len() > TEXT_LIMIT {
        return Err(too_many);
    }
    let side = |length: usize| i32::try_from(length).map_err(|_| ModelProblem::NoSolidVoxel);
    let voxels = Voxels::new([side(width)?, side(depth)?, side(slices.len())?], solid);
    if voxels.any() { Ok(voxels) } else { Err(ModelProblem::NoSolidVoxel) }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn message(text: &str) -> String {
        read(text).map(|_| ()).unwrap_err().to_string()
    }

    #[test]
    fn blank_lines_around_and_between_slices_count_for_nothing() {
        let voxels = read("\n\n##\n#.\n\n\n\n##\n..\n\n").unwrap();
        assert_eq!(voxels.boundary().len(), read("##\n#.\n\n##\n..\n").unwrap().boundary().len());
    }

    #[test]
    fn lines_may_end_as_on_windows() {
        assert_eq!(read("###\r\n").unwrap().boundary().len(), 14);
    }

    #[test]
    fn a_ragged_row_is_refused_with_its_line() {
        assert_eq!(message("###\n##\n"), "line 2: a row of 2 characters, expected 3 as in the first row");
    }

    #[test]
    fn a_slice_with_a_row_too_many_is_refused_with_its_line() {
        assert_eq!(message("##\n\n##\n#.\n"), "line 4: slice 1 ends after 2 rows, expected 1 as in slice 0");
    }

    #[test]
    fn another_character_is_refused_with_line_and_column() {
        assert_eq!(message("##\n#x\n"), "line 2, column 2: found 'x', expected '#' (solid) or '.' (empty)");
    }

    #[test]
    fn nothing_and_nothing_solid_are_refused() {
        assert_eq!(message("\n\n"), "empty: expected rows of '#' and '.'");
        assert_eq!(message("..\n..\n"), "no voxel is solid, expected at least one '#'");
    }
}
