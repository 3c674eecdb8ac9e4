//! `MagicaVoxel` files (`.vox`): a header, then a `MAIN` chunk around chunks of which `SIZE` and `XYZI` count; colours, materials
//! and layers don't.

use super::ModelProblem;
use crate::voxels::Voxels;

/// Reads the only model of the file.
///
/// # Errors
/// Bytes that are no such file, a file that ends early, more models than one, a voxel outside the box, no voxel.
pub(super) fn read(bytes: &[u8]) -> Result<Voxels, ModelProblem> {
    let mut file = Bytes { bytes, at: 0 };
    file.require_word(*b"VOX ", "'VOX '")?;
    file.number("a version")?;
    let main = file.chunk()?;
    if main.name != b"MAIN" {
        return Err(file.problem(8, "a MAIN chunk"));
    }
    let end = main.children_end;
    let (mut sides, mut voxels, mut models) = (None, None, 0);
    while file.at < end {
        let chunk = file.chunk()?;
        match chunk.name {
            b"SIZE" => sides = Some([(); 3].map(|()| file.number("three sides"))),
            b"XYZI" => {
                models += 1;
                let at = file.at;
                let [x, y, z] = sides.take().ok_or_else(|| file.problem(at, "a SIZE chunk before XYZI"))?;
                voxels = Some(model([x?, y?, z?], &mut file)?);
            }
            _ => {}
        }
        if file.at > chunk.end {
            return Err(file.problem(chunk.end, "a chunk as long as its header says"));
        }
        file.at = chunk.end;
    }
    if models > 1 {
        return Err(ModelProblem::SeveralModels { found: models });
    }
    voxels.ok_or(ModelProblem::Empty { expected: "SIZE and XYZI chunks" })
}

fn model(sides: [u32; 3], file: &mut Bytes<'_>) -> Result<Voxels, ModelProblem> {
    // The coordinates of a voxel are single bytes.
    if sides.iter().any(|side| !(1..=256).contains(side)) {
        return Err(file.problem(file.at, "sides of 1 to 256"));
    }
    let [width, depth, height] = sides.map(|side| side as usize);
    let mut solid = vec![false; width * depth * height];
    for _ in 0..file.number("the number of voxels")? {
        let at = file.at;
        let [x, y, z, _colour] = file.word("x, y, z and a colour")?.map(usize::from);
        if x >= width || y >= depth || z >= height {
            return Err(file.problem(at, "a voxel inside the box of its SIZE chunk"));
        }
        solid[(z * depth + y) * width + x] = true;
    }
    let voxels = Voxels::new(sides.map(u32::cast_signed), solid);
    if voxels.any() { Ok(voxels) } else { Err(ModelProblem::Empty { expected: "a solid voxel" }) }
}

struct Chunk<'a> {
    name: &'a [u8; 4],
    end: usize,
    children_end: usize,
}

struct Bytes<'a> {
    bytes: &'a [u8],
    at: usize,
}

impl<'a> Bytes<'a> {
    fn problem(&self, at: usize, expected: &'static str) -> ModelProblem {
        ModelProblem::BadBytes { at, length: self.bytes.len(), expected }
    }

    fn word(&mut self, expected: &'static str) -> Result<&'a [u8; 4], ModelProblem> {
        let word = self.bytes.get(self.at..).and_then(<[u8]>::first_chunk);
        let word = word.ok_or_else(|| self.problem(self.at, expected))?;
        self.at += 4;
        Ok(word)
    }

    fn require_word(&mut self, wanted: [u8; 4], expected: &'static str) -> Result<(), ModelProblem> {
        let at = self.at;
        if self.word(expected)? == &wanted { Ok(()) } else { Err(self.problem(at, expected)) }
    }

    fn number(&mut self, expected: &'static str) -> Result<u32, ModelProblem> {
        self.word(expected).map(|word| u32::from_le_bytes(*word))
    }

    /// Reads the header of a chunk: its name, the length of its content and of its children.
    fn chunk(&mut self) -> Result<Chunk<'a>, ModelProblem> {
        let name = self.word("a chunk")?;
        let content = self.number("the length of a chunk")? as usize;
        let children = self.number("the length of a chunk's children")? as usize;
        let end = self.at.saturating_add(content);
        let children_end = end.saturating_add(children);
        if children_end > self.bytes.len() {
            return Err(self.problem(self.at, "a chunk that ends within the file"));
        }
        Ok(Chunk { name, end, children_end })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn chunk(name: [u8; 4], content: &[u8], children: &[u8]) -> Vec<u8> {
        let length = |bytes: &[u8]| u32::try_from(bytes.len()).unwrap().to_le_bytes();
        [&name[..], &length(content), &length(children), content, children].concat()
    }

    fn words(numbers: &[u32]) -> Vec<u8> {
        numbers.iter().flat_map(|number| number.to_le_bytes()).collect()
    }

    fn model_of(sides: [u32; 3], voxels: &[[u8; 4]]) -> Vec<u8> {
        let count = words(&[u32::try_from(voxels.len()).unwrap()]);
        let list = [count, voxels.concat()].concat();
        [chunk(*b"SIZE", &words(&sides), &[]), chunk(*b"XYZI", &list, &[])].concat()
    }

    fn file(children: &[u8]) -> Vec<u8> {
        [&b"VOX "[..], &words(&[150]), &chunk(*b"MAIN", &[], children)].concat()
    }

    fn message(bytes: &[u8]) -> String {
        read(bytes).map(|_| ()).unwrap_err().to_string()
    }

    #[test]
    fn a_model_of_three_voxels_is_read_and_its_palette_is_skipped() {
        let three = model_of([2, 2, 1], &[[0, 0, 0, 1], [1, 0, 0, 7], [0, 1, 0, 255]]);
        let bytes = file(&[three, chunk(*b"RGBA", &[9; 1024], &[])].concat());
        assert_eq!(read(&bytes).unwrap().boundary().len(), 14);
    }

    #[test]
    fn files_that_end_early_or_lie_are_refused_with_the_byte() {
        let good = file(&model_of([2, 1, 1], &[[0, 0, 0, 1], [1, 0, 0, 1]]));
        for length in 0..good.len() {
            assert!(read(&good[..length]).is_err(), "{length} of {} bytes", good.len());
        }
        assert_eq!(message(b"PLY "), "byte 0 of 4: expected 'VOX '");
        let outside = file(&model_of([2, 1, 1], &[[0, 1, 0, 1]]));
        assert!(message(&outside).ends_with("expected a voxel inside the box of its SIZE chunk"));
        assert!(message(&file(&model_of([0, 1, 1], &[]))).ends_with("expected sides of 1 to 256"));
    }

    #[test]
    fn no_voxel_and_several_models_are_refused() {
        assert_eq!(message(&file(&model_of([1, 1, 1], &[]))), "empty: expected a solid voxel");
        assert_eq!(message(&file(&[])), "empty: expected SIZE and XYZI chunks");
        let one = model_of([1, 1, 1], &[[0, 0, 0, 1]]);
        let told = message(&file(&[one.clone(), one].concat()));
        assert_eq!(told, "2 models in the file, expected one: merge them before saving");
    }
}
