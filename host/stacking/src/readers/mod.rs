//! Model files into surfaces: one reader a format, chosen by the file's extension.

mod model_error;
mod quad_obj;
mod stl;
mod stl_voxels;
mod voxel_text;

pub use model_error::{ModelError, ModelProblem};

use crate::dual::Dual;
use crate::surface::{Surface, SurfaceError};
use std::path::Path;
use std::str;

/// A surface that panels can build: one piece, no sheets that cross.
#[derive(Debug, Clone)]
pub struct Model {
    pub(crate) name: String,
    pub(crate) surface: Surface,
    pub(crate) dual: Dual,
    pub(crate) voxel_size: Option<f64>,
}

impl Model {
    /// Makes a model of a surface from elsewhere than a file.
    ///
    /// # Errors
    /// Sheets that cross, neighbours of unlike orientation, a surface in pieces.
    pub fn new(name: impl Into<String>, surface: Surface) -> Result<Self, SurfaceError> {
        let dual = Dual::of(&surface)?;
        Ok(Self { name: name.into(), surface, dual, voxel_size: None })
    }

    /// Reads a model file: voxel text (`.txt`), a lattice quad mesh (`.obj`), or a closed triangle mesh (`.stl`) that is cut
    /// into voxels with edges of `voxel_size`, in units of the mesh.
    ///
    /// # Errors
    /// Whatever is wrong with the file, with its name and the place in it.
    pub fn read(path: &Path, voxel_size: Option<f64>) -> Result<Self, ModelError> {
        read(path, voxel_size).map_err(|problem| ModelError { file: path.display().to_string(), problem })
    }

    /// The file's name, without its folder.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The surface.
    pub fn surface(&self) -> &Surface {
        &self.surface
    }
}

/// The formats, by extension.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Format {
    VoxelText,
    QuadObj,
    Stl,
}

impl Format {
    fn of(path: &Path) -> Result<Self, ModelProblem> {
        let extension = path.extension().unwrap_or_default().to_string_lossy().to_lowercase();
        match extension.as_str() {
            "txt" => Ok(Self::VoxelText),
            "obj" => Ok(Self::QuadObj),
            "stl" => Ok(Self::Stl),
            _ => Err(ModelProblem::UnknownFormat { extension }),
        }
    }
}

fn read(path: &Path, voxel_size: Option<f64>) -> Result<Model, ModelProblem> {
    let format = Format::of(path)?;
    match (format, voxel_size) {
        (Format::Stl, None) => return Err(ModelProblem::VoxelSizeMissing),
        (Format::VoxelText | Format::QuadObj, Some(_)) => return Err(ModelProblem::VoxelSizeUnused),
        (Format::Stl, Some(_)) | (Format::VoxelText | Format::QuadObj, None) => {}
    }
    let bytes = std::fs::read(path)?;
    let surface = match (format, voxel_size) {
        (Format::VoxelText, _) => Surface::new(voxel_text::read(text(&bytes)?)?.boundary(), Vec::new())?,
        (Format::QuadObj, _) => quad_obj::read(text(&bytes)?)?,
        (Format::Stl, size) => {
            let voxels = stl_voxels::fill(&stl::read(&bytes)?, size.unwrap_or(f64::NAN))?;
            Surface::new(voxels.boundary(), Vec::new())?
        }
    };
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    Ok(Model { voxel_size, ..Model::new(name, surface)? })
}

fn text(bytes: &[u8]) -> Result<&str, ModelProblem> {
    str::from_utf8(bytes).map_err(|error| {
        let before = bytes[..error.valid_up_to()].split(|byte| *byte == b'\n');
        ModelProblem::NotText { line: before.count() }
    })
}
