//! glTF 2.0 meshes, text or binary (`.gltf`, `.glb`), whose buffers are inside the file: all triangles of the scene, with the
//! transforms of their nodes.

use super::ModelProblem;
use super::polygons::Polygons;
use crate::mesh::Triangle;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use gltf::accessor::{DataType, Dimensions};
use gltf::buffer;
use gltf::mesh::{Mode, Primitive};

/// A node's transform, by columns, as glTF has it.
type Matrix = [[f64; 4]; 4];

/// No scene that people draw nests deeper; a file whose nodes run in a circle does.
const DEPTH_LIMIT: usize = 256;

/// Reads the triangles.
///
/// # Errors
/// Bytes that are no glTF, a buffer outside the file, data that don't fit their description, no triangle.
pub(super) fn read(bytes: &[u8]) -> Result<Vec<Triangle>, ModelProblem> {
    if bytes.is_empty() {
        return Err(ModelProblem::Empty { expected: "a glTF mesh" });
    }
    let file = gltf::Gltf::from_slice(bytes)
        .map_err(|error| ModelProblem::NotGltf { message: error.to_string() })?;
    let buffers: Vec<Vec<u8>> =
        file.buffers().map(|held| buffer_bytes(&held, file.blob.as_deref())).collect::<Result<_, _>>()?;
    let mut scene = Scene { buffers, polygons: Polygons::default() };
    let identity: Matrix =
        [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0], [0.0, 0.0, 0.0, 1.0]];
    let shown = file.default_scene().or_else(|| file.scenes().next());
    for node in shown.iter().flat_map(gltf::Scene::nodes) {
        scene.add_node(&node, &identity, 0)?;
    }
    scene.polygons.triangles("a scene with triangles")
}

fn buffer_bytes(held: &gltf::Buffer<'_>, blob: Option<&[u8]>) -> Result<Vec<u8>, ModelProblem> {
    let problem = |expected| ModelProblem::GltfData { place: format!("buffer {}", held.index()), expected };
    let bytes = match held.source() {
        buffer::Source::Bin => blob.map(<[u8]>::to_vec).ok_or_else(|| problem("a binary chunk"))?,
        buffer::Source::Uri(uri) => {
            let data = uri.strip_prefix("data:").and_then(|rest| rest.split_once(";base64,"));
            let (_, data) = data.ok_or_else(|| {
                problem("its bytes inside the file (a data: URI): save it as .glb, or with embedded buffers")
            })?;
            STANDARD.decode(data).map_err(|_| problem("base64"))?
        }
    };
    if bytes.len() < held.length() { Err(problem("as many bytes as byteLength says")) } else { Ok(bytes) }
}

struct Scene {
    buffers: Vec<Vec<u8>>,
    polygons: Polygons,
}

impl Scene {
    fn add_node(
        &mut self,
        node: &gltf::Node<'_>,
        scene_from_parent: &Matrix,
        depth: usize,
    ) -> Result<(), ModelProblem> {
        let problem = |expected| ModelProblem::GltfData { place: format!("node {}", node.index()), expected };
        if depth > DEPTH_LIMIT {
            return Err(problem("a tree of nodes, at most 256 deep"));
        }
        let parent_from_node = node.transform().matrix().map(|column| column.map(f64::from));
        let scene_from_node = parent_from_node.map(|column| apply(scene_from_parent, column));
        for primitive in node.mesh().iter().flat_map(gltf::Mesh::primitives) {
            let place = || format!("node {}, primitive {}", node.index(), primitive.index());
            self.add_primitive(&primitive, &scene_from_node)
                .map_err(|expected| ModelProblem::GltfData { place: place(), expected })?;
        }
        node.children().try_for_each(|child| self.add_node(&child, &scene_from_node, depth + 1))
    }

    /// On failure says what was expected.
    fn add_primitive(
        &mut self,
        primitive: &Primitive<'_>,
        scene_from_node: &Matrix,
    ) -> Result<(), &'static str> {
        match primitive.mode() {
            Mode::Triangles => {}
            Mode::Points | Mode::Lines | Mode::LineLoop | Mode::LineStrip => return Ok(()),
            Mode::TriangleStrip | Mode::TriangleFan => return Err("separate triangles (mode 4)"),
        }
        let positions = primitive.get(&gltf::Semantic::Positions).ok_or("positions")?;
        let plain = |accessor: &gltf::Accessor<'_>, size: usize| {
            let stride = accessor.view().and_then(|view| view.stride());
            accessor.count() > 0 && accessor.sparse().is_none() && stride.is_none_or(|stride| stride >= size)
        };
        let vectors = positions.data_type() == DataType::F32 && positions.dimensions() == Dimensions::Vec3;
        if !vectors || !plain(&positions, 12) {
            return Err("positions that are vectors of three 32-bit floats, not compressed and not sparse");
        }
        let buffers = &self.buffers;
        let reader = primitive.reader(|held| buffers.get(held.index()).map(Vec::as_slice));
        let count = positions.count();
        let first = self.polygons.corners.len();
        let read = reader.read_positions().ok_or("positions within their buffer")?;
        let corners: Vec<_> = read
            .map(|[x, y, z]| {
                let [x, y, z, _] = apply(scene_from_node, [f64::from(x), f64::from(y), f64::from(z), 1.0]);
                [x, y, z]
            })
            .collect();
        let indices: Vec<usize> = match primitive.indices() {
            None => (0..count).collect(),
            Some(accessor) => {
                let size = match (accessor.data_type(), accessor.dimensions()) {
                    (DataType::U8, Dimensions::Scalar) => 1,
                    (DataType::U16, Dimensions::Scalar) => 2,
                    (DataType::U32, Dimensions::Scalar) => 4,
                    _ => return Err("indices that are unsigned whole numbers"),
                };
                if !plain(&accessor, size) {
                    return Err("indices, at least one, not sparse");
                }
                let read = reader.read_indices().ok_or("indices within their buffer")?;
                read.into_u32().map(|index| index as usize).collect()
            }
        };
        if !indices.len().is_multiple_of(3) {
            return Err("three indices a triangle");
        }
        if corners.len() != count || indices.iter().any(|index| *index >= count) {
            return Err("indices below the number of positions");
        }
        self.polygons.corners.extend(corners);
        // A mirror turns triangles inside out; glTF asks to turn them back.
        let mirrored = determinant(scene_from_node) < 0.0;
        for triangle in indices.chunks_exact(3) {
            let mut corners = [triangle[0], triangle[1], triangle[2]].map(|index| first + index);
            if mirrored {
                corners.swap(1, 2);
            }
            self.polygons.add(&corners).map_err(|_| "triangles")?;
        }
        Ok(())
    }
}

fn apply(matrix: &Matrix, vector: [f64; 4]) -> [f64; 4] {
    [0, 1, 2, 3].map(|row| (0..4).map(|column| matrix[column][row] * vector[column]).sum())
}

fn determinant(matrix: &Matrix) -> f64 {
    let [[a, b, c, _], [d, e, f, _], [g, h, i, _], _] = matrix;
    a * (e * i - f * h) - d * (b * i - c * h) + g * (b * f - c * e)
}
