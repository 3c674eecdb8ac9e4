//! One shape in every mesh format, and what becomes of meshes that are not as they should be.

#![allow(clippy::unwrap_used, reason = "helpers of tests fail as tests do")]
#![allow(clippy::format_collect, clippy::format_push_string, reason = "small files, plainly written")]

use std::path::PathBuf;
use zygote_stacking::{Model, Repair, Resolution};

type Corner = [f64; 3];

/// A box as corners and quads.
fn cuboid(low: Corner, high: Corner) -> (Vec<Corner>, Vec<[usize; 4]>) {
    let corners = (0..8)
        .map(|number| [0, 1, 2].map(|axis| if number >> axis & 1 == 0 { low[axis] } else { high[axis] }));
    let quads = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
    (corners.collect(), quads.to_vec())
}

/// Several boxes as one mesh.
fn boxes(list: &[(Corner, Corner)]) -> (Vec<Corner>, Vec<[usize; 4]>) {
    let (mut corners, mut quads) = (Vec::new(), Vec::new());
    for (low, high) in list {
        let (more, faces) = cuboid(*low, *high);
        quads.extend(faces.iter().map(|quad| quad.map(|corner| corner + corners.len())));
        corners.extend(more);
    }
    (corners, quads)
}

fn obj((corners, quads): &(Vec<Corner>, Vec<[usize; 4]>)) -> String {
    let vertices = corners.iter().map(|[x, y, z]| format!("v {x} {y} {z}\n"));
    let faces = quads.iter().map(|quad| {
        let [a, b, c, d] = quad.map(|corner| corner + 1);
        format!("f {a} {b} {c} {d}\n")
    });
    vertices.chain(faces).collect()
}

fn read(name: &str, bytes: &[u8], size: f64) -> Result<Model, String> {
    let path = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(name);
    std::fs::write(&path, bytes).unwrap();
    Model::read(&path, Some(Resolution::Voxel(size))).map_err(|error| error.to_string())
}

/// A glTF file around base64 that was made of the same corners, with two triangles for each quad.
fn gltf((corners, quads): &(Vec<Corner>, Vec<[usize; 4]>), uri: Option<&str>) -> Vec<u8> {
    let mut bytes = Vec::new();
    for c in corners.iter().flatten() {
        #[expect(clippy::cast_possible_truncation, reason = "small whole numbers")]
        bytes.extend((*c as f32).to_le_bytes());
    }
    let positions = bytes.len();
    for index in quads.iter().flat_map(|[a, b, c, d]| [a, b, c, a, c, d]) {
        bytes.extend(u32::try_from(*index).unwrap().to_le_bytes());
    }
    let buffer = match uri {
        Some(uri) => format!("{{\"byteLength\":{},\"uri\":\"{uri}\"}}", bytes.len()),
        None => format!("{{\"byteLength\":{}}}", bytes.len()),
    };
    let json = format!(
        "{{\"asset\":{{\"version\":\"2.0\"}},\"scene\":0,\"scenes\":[{{\"nodes\":[0]}}],\
         \"nodes\":[{{\"mesh\":0,\"scale\":[-2,2,2]}}],\
         \"meshes\":[{{\"primitives\":[{{\"attributes\":{{\"POSITION\":0}},\"indices\":1}}]}}],\
         \"buffers\":[{buffer}],\"bufferViews\":[{{\"buffer\":0,\"byteLength\":{positions}}},\
         {{\"buffer\":0,\"byteOffset\":{positions},\"byteLength\":{}}}],\
         \"accessors\":[{{\"bufferView\":0,\"componentType\":5126,\"count\":{},\"type\":\"VEC3\",\
         \"min\":[0,0,0],\"max\":[9,9,9]}},{{\"bufferView\":1,\"componentType\":5125,\"count\":{},\"type\":\"SCALAR\"}}]}}",
        bytes.len() - positions,
        corners.len(),
        6 * quads.len()
    );
    if uri.is_some() {
        return json.into_bytes();
    }
    let padded = format!("{json:width$}", width = json.len().next_multiple_of(4));
    let word = |number: usize| u32::try_from(number).unwrap().to_le_bytes();
    let total = 12 + 8 + padded.len() + 8 + bytes.len();
    [
        &b"glTF"[..],
        &word(2),
        &word(total),
        &word(padded.len()),
        b"JSON",
        padded.as_bytes(),
        &word(bytes.len()),
        b"BIN\0",
        &bytes,
    ]
    .concat()
}

/// Symmetric in x, so that the mirror in the glTF file shows only if triangles are not turned back.
fn shape() -> (Vec<Corner>, Vec<[usize; 4]>) {
    boxes(&[([0.0; 3], [6.0, 4.0, 2.0]), ([1.0, 1.0, 1.0], [5.0, 3.0, 5.0])])
}

#[test]
fn one_shape_gives_the_same_panels_from_every_format() {
    let shape = shape();
    let (corners, quads) = &shape;
    let expected = read("shape.obj", obj(&shape).as_bytes(), 1.0).unwrap();
    assert_eq!(expected.surface().len(), 2 * (6 * 4 + 6 * 2 + 4 * 2) + 2 * (4 + 2) * 3);
    let vertices: String = corners.iter().map(|[x, y, z]| format!("{x} {y} {z}\n")).collect();
    let faces: String = quads.iter().map(|[a, b, c, d]| format!("4 {a} {b} {c} {d}\n")).collect();
    let off = format!("OFF\n{} {} 0\n{vertices}{faces}", corners.len(), quads.len());
    let ply = format!(
        "ply\nformat ascii 1.0\nelement vertex {}\nproperty float x\nproperty float y\nproperty float z\n\
         element face {}\nproperty list uchar int vertex_indices\nend_header\n{vertices}{faces}",
        corners.len(),
        quads.len()
    );
    let mut stl = "solid shape\n".to_string();
    for corner in quads.iter().flat_map(|[a, b, c, d]| [[a, b, c], [a, c, d]]) {
        let [p, q, r] = corner.map(|number| corners[*number].map(|c| c.to_string()).join(" "));
        stl.push_str(&format!(
            "facet normal 0 0 0\nouter loop\nvertex {p}\nvertex {q}\nvertex {r}\nendloop\nendfacet\n"
        ));
    }
    stl += "endsolid shape\n";
    for (name, bytes) in
        [("shape.off", off), ("shape.ply", ply), ("shape.stl", stl)].map(|(n, text)| (n, text.into_bytes()))
    {
        let found = read(name, &bytes, 1.0).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(found.surface().quads(), expected.surface().quads(), "{name}");
    }
    // Its node mirrors and scales by 2.
    let found = read("shape.glb", &gltf(&shape, None), 2.0).unwrap();
    assert_eq!(found.surface().quads(), expected.surface().quads());
}

#[test]
fn a_gltf_file_must_hold_its_buffers() {
    let told = read("outside.gltf", &gltf(&shape(), Some("shape.bin")), 1.0).unwrap_err();
    assert!(told.contains("buffer 0: expected its bytes inside the file"), "{told}");
    let told = read("short.gltf", &gltf(&shape(), Some("data:application/octet-stream;base64,AAAA")), 1.0);
    assert!(told.unwrap_err().contains("buffer 0: expected as many bytes as byteLength says"));
    let told = read("garbled.glb", b"glTF and nothing", 1.0).unwrap_err();
    assert!(told.contains("not a glTF file: "), "{told}");
}

#[test]
fn a_cavity_is_filled_and_told() {
    let (mut corners, mut quads) = cuboid([0.0; 3], [5.0; 3]);
    let (inner, faces) = cuboid([1.0; 3], [3.0; 3]);
    // Turned inwards.
    quads.extend(faces.iter().map(|[a, b, c, d]| [d, c, b, a].map(|corner| corner + 8)));
    corners.extend(inner);
    let model = read("hollow.obj", obj(&(corners, quads)).as_bytes(), 1.0).unwrap();
    assert_eq!(model.surface().len(), 150);
    assert_eq!(model.repairs(), [Repair::Filled { cavities: 1, voxels: 8 }]);
}

#[test]
fn a_neck_thinner_than_a_voxel_is_bridged_and_told() {
    let (left, right) = (([0.0; 3], [3.0; 3]), ([6.0, 0.0, 0.0], [9.0, 3.0, 3.0]));
    let neck = ([2.5, 1.3, 1.3], [6.5, 1.45, 1.45]);
    let model = read("neck.obj", obj(&boxes(&[left, right, neck])).as_bytes(), 1.0).unwrap();
    assert_eq!(model.repairs(), [Repair::Thickened { voxels: 3 }]);
    assert_eq!(model.surface().len(), 2 * 54 + 3 * 4 - 2);
}

#[test]
fn crumbs_are_dropped_and_two_bodies_are_refused() {
    let body = ([0.0; 3], [6.0; 3]);
    let crumb = ([9.0, 0.0, 0.0], [10.0, 1.0, 1.0]);
    let model = read("crumb.obj", obj(&boxes(&[body, crumb])).as_bytes(), 1.0).unwrap();
    assert_eq!(model.repairs(), [Repair::Dropped { pieces: 1, voxels: 1 }]);
    assert_eq!(model.surface().len(), 216);
    let told = read("bodies.obj", obj(&boxes(&[body, ([9.0; 3], [12.0; 3])])).as_bytes(), 1.0).unwrap_err();
    assert!(
        told.contains("a solid in 2 pieces, expected one: 216 voxels with the one at (0.5, 0.5, 0.5)"),
        "{told}"
    );
}

/// A binary STL file of the same corners, with two triangles for each quad.
fn binary_stl((corners, quads): &(Vec<Corner>, Vec<[usize; 4]>)) -> Vec<u8> {
    let mut bytes = format!("{:80}", "solid of a program that says so of binary files too").into_bytes();
    bytes.extend(u32::try_from(2 * quads.len()).unwrap().to_le_bytes());
    for triangle in quads.iter().flat_map(|[a, b, c, d]| [[a, b, c], [a, c, d]]) {
        bytes.extend([0; 12]);
        for c in triangle.iter().flat_map(|corner| corners[**corner]) {
            #[expect(clippy::cast_possible_truncation, reason = "small whole numbers")]
            bytes.extend((c as f32).to_le_bytes());
        }
        bytes.extend([0; 2]);
    }
    bytes
}

#[test]
fn a_binary_stl_that_ends_early_is_refused_with_its_length() {
    let whole = binary_stl(&cuboid([0.0; 3], [3.0, 2.0, 2.0]));
    assert_eq!(read("whole.stl", &whole, 1.0).unwrap().surface().len(), 32);
    let told = read("early.stl", &whole[..500], 1.0).unwrap_err();
    assert!(
        told.contains("byte 500 of 500: expected more triangles, as many as announced at byte 80"),
        "{told}"
    );
}

#[test]
fn a_plate_without_a_voxels_centre_inside_is_one_voxel_thick_and_told() {
    for (name, thickness) in [("thin.obj", 0.2), ("flat.obj", 0.0)] {
        let plate = cuboid([0.0; 3], [6.0, 4.0, thickness]);
        let model = read(name, obj(&plate).as_bytes(), 1.0).unwrap();
        assert_eq!(model.surface().len(), 2 * (6 * 4 + 6 + 4), "{name}");
        assert_eq!(model.repairs().last(), Some(&Repair::Thickened { voxels: 24 }), "{name}");
    }
}

#[test]
fn a_mesh_smaller_than_a_voxel_and_one_of_too_many_voxels_are_refused_with_the_way_out() {
    let mesh = obj(&cuboid([0.0; 3], [1.0; 3]));
    let told = read("coarse.obj", mesh.as_bytes(), 3.0).unwrap_err();
    assert!(told.ends_with("whose box is 1 x 1 x 1: expected a smaller size"), "{told}");
    let told = read("fine.obj", mesh.as_bytes(), 1e-4).unwrap_err();
    assert!(told.ends_with("expected at most 67108864: expected a larger size, or fewer panels"), "{told}");
}

#[test]
fn names_in_any_encoding_do_not_keep_a_mesh_from_being_read() {
    let shape = cuboid([0.0; 3], [2.0; 3]);
    let named = [&b"o W\xfcrfel # f\xfcr uns\n"[..], obj(&shape).as_bytes()].concat();
    assert_eq!(read("named.obj", &named, 1.0).unwrap().surface().len(), 24);
}
