//! Model files into surfaces: one reader a format, chosen by the file's extension.

mod gltf;
mod magica_voxel;
mod model_error;
mod obj;
mod off;
mod ply;
mod polygons;
mod stl;
mod voxel_text;

pub use model_error::{ModelError, ModelProblem};

use crate::dual::Dual;
use crate::mesh::{Distance, Mesh, Repair, Solid, Triangle};
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
    pub(crate) distance: Option<Distance>,
    repairs: Vec<Repair>,
}

/// So many voxels fit in memory with ease, and every coordinate in 32 bits.
pub(crate) const VOXEL_LIMIT: usize = 1 << 26;

/// How finely a mesh is cut into voxels.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Resolution {
    /// Edge of a voxel, in units of the mesh, above 0.
    Voxel(f64),
    /// The number of panels: the size is searched, and the solid edited voxel by voxel.
    Panels(usize),
}

impl Model {
    /// Makes a model of a surface from elsewhere than a file.
    ///
    /// # Errors
    /// Sheets that cross, neighbours of unlike orientation, a surface in pieces.
    pub fn new(name: impl Into<String>, surface: Surface) -> Result<Self, SurfaceError> {
        let dual = Dual::of(&surface)?;
        Ok(Self { name: name.into(), surface, dual, voxel_size: None, distance: None, repairs: Vec::new() })
    }

    /// Reads a model file: voxels (`.txt`, `.vox`), a lattice quad mesh (`.obj`), or with a resolution a closed mesh (`.obj`,
    /// `.stl`, `.ply`, `.off`, `.gltf`, `.glb`) that is cut into voxels.
    ///
    /// # Errors
    /// Whatever is wrong with the file, with its name and the place in it.
    pub fn read(path: &Path, resolution: Option<Resolution>) -> Result<Self, ModelError> {
        read(path, resolution).map_err(|problem| ModelError { file: path.display().to_string(), problem })
    }

    /// The file's name, without its folder.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// What was repaired or changed on the way from a mesh.
    pub fn repairs(&self) -> &[Repair] {
        &self.repairs
    }

    /// Edge of a voxel in units of the mesh, where a mesh was cut into voxels.
    pub fn voxel_size(&self) -> Option<f64> {
        self.voxel_size
    }

    /// How far the surface is from the mesh, where it was made of one.
    pub fn distance(&self) -> Option<Distance> {
        self.distance
    }

    /// The surface.
    pub fn surface(&self) -> &Surface {
        &self.surface
    }
}

/// The formats, by extension.
#[derive(Clone, Copy)]
enum Format {
    VoxelText,
    MagicaVoxel,
    Obj,
    Stl,
    Ply,
    Off,
    Gltf,
}

impl Format {
    fn of(path: &Path) -> Result<Self, ModelProblem> {
        let extension = path.extension().unwrap_or_default().to_string_lossy().to_lowercase();
        match extension.as_str() {
            "txt" => Ok(Self::VoxelText),
            "vox" => Ok(Self::MagicaVoxel),
            "obj" => Ok(Self::Obj),
            "stl" => Ok(Self::Stl),
            "ply" => Ok(Self::Ply),
            "off" => Ok(Self::Off),
            "gltf" | "glb" => Ok(Self::Gltf),
            _ => Err(ModelProblem::UnknownFormat { extension }),
        }
    }
}

fn read(path: &Path, resolution: Option<Resolution>) -> Result<Model, ModelProblem> {
    let format = Format::of(path)?;
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let Some(resolution) = resolution else {
        let surface = match format {
            Format::VoxelText => {
                Surface::new(voxel_text::read(text(&bytes(path)?)?)?.boundary(), Vec::new())?
            }
            Format::MagicaVoxel => Surface::new(magica_voxel::read(&bytes(path)?)?.boundary(), Vec::new())?,
            Format::Obj => obj::quads(&mesh_text(path)?)?,
            Format::Stl | Format::Ply | Format::Off | Format::Gltf => {
                return Err(ModelProblem::VoxelSizeMissing);
            }
        };
        return Ok(Model::new(name, surface)?);
    };
    let triangles: Vec<Triangle> = match format {
        Format::VoxelText | Format::MagicaVoxel => return Err(ModelProblem::VoxelSizeUnused),
        Format::Obj => obj::mesh(&mesh_text(path)?)?,
        Format::Stl => stl::read(&bytes(path)?)?,
        Format::Ply => ply::read(&bytes(path)?)?,
        Format::Off => off::read(&mesh_text(path)?)?,
        Format::Gltf => gltf::read(&bytes(path)?)?,
    };
    let mesh = Mesh::new(triangles)?;
    let solid = mesh.solid(resolution)?;
    let surface = Surface::new(solid.voxels.boundary(), Vec::new())?;
    let distance = Some(mesh.distance_of(&solid, surface.quads()));
    let Solid { voxel_size, repairs, .. } = solid;
    Ok(Model { voxel_size: Some(voxel_size), distance, repairs, ..Model::new(name, surface)? })
}

/// What a mesh says in words, names and comments, is in any encoding and counts for nothing.
fn mesh_text(path: &Path) -> Result<String, ModelProblem> {
    Ok(String::from_utf8_lossy(&bytes(path)?).into_owned())
}

fn bytes(path: &Path) -> Result<Vec<u8>, ModelProblem> {
    Ok(std::fs::read(path)?)
}

fn text(bytes: &[u8]) -> Result<&str, ModelProblem> {
    str::from_utf8(bytes).map_err(|error| {
        let before = bytes[..error.valid_up_to()].split(|byte| *byte == b'\n');
        ModelProblem::NotText { line: before.count() }
    })
}
