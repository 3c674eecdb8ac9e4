//! Meshes cut into exactly as many panels as asked for, and how far the result is from the mesh.

#![allow(clippy::unwrap_used, reason = "helpers of tests fail as tests do")]
#![allow(clippy::format_push_string, reason = "small files, plainly written")]

mod boundary;
mod lump;

use boundary::{Voxel, boundary};
use lump::solid;
use proptest::prelude::*;
use std::collections::BTreeSet;
use std::path::PathBuf;
use zygote_stacking::{Model, ModelProblem, Repair, Request, Resolution, check, fold, plan};

fn read(name: &str, resolution: Resolution) -> Result<Model, ModelProblem> {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../models").join(name);
    Model::read(&path, Some(resolution)).map_err(|error| error.problem)
}

fn planned(model: &Model, piles: usize) -> Vec<u8> {
    let request = Request { piles, ..Request::default() };
    let bytes = fold::write(&plan(model, &request).unwrap()).unwrap();
    let report = check(&fold::parse(&bytes).unwrap());
    assert!(report.is_valid(), "{:?}", report.lines(3));
    bytes
}

/// Vertices less edges plus faces: 2 for a ball, 0 for a ring, where no two sheets touch.
fn euler(model: &Model) -> i64 {
    let quads = model.surface().quads();
    let corners: BTreeSet<[i32; 3]> = quads.iter().flatten().copied().collect();
    i64::try_from(corners.len()).unwrap() - i64::try_from(quads.len()).unwrap()
}

#[test]
fn meshes_become_as_many_panels_as_asked_for_and_stack_into_four_piles() {
    for name in ["bird.obj", "knot.off", "airplane.stl"] {
        for wanted in [1000, 4000] {
            let model = read(name, Resolution::Panels(wanted)).unwrap_or_else(|e| panic!("{name}: {e}"));
            assert_eq!(model.surface().len(), wanted, "{name}");
            let bytes = planned(&model, 4);
            let distance = model.distance().unwrap();
            assert!(distance.hausdorff < 2.0 && distance.mean < 0.6, "{name} {wanted}: {distance}");
            assert!(distance.mean <= distance.hausdorff);
            let source = fold::read(&bytes).unwrap().source;
            assert_eq!((source.distance, source.voxel_size), (Some(distance), model.voxel_size()));
        }
    }
}

#[test]
fn the_same_number_gives_the_same_panels() {
    let quads = || read("bird.obj", Resolution::Panels(1234)).unwrap().surface().quads().to_vec();
    assert_eq!(quads(), quads());
}

#[test]
fn a_voxel_size_that_was_found_gives_nearly_the_same_solid_again() {
    let found = read("knot.off", Resolution::Panels(1000)).unwrap();
    let again = read("knot.off", Resolution::Voxel(found.voxel_size().unwrap())).unwrap();
    assert!(again.surface().len().abs_diff(1000) <= 40, "{}", again.surface().len());
}

#[test]
fn a_knot_keeps_its_tunnel_while_it_is_edited() {
    let first = read("knot.off", Resolution::Panels(4000)).unwrap();
    let ring = euler(&first);
    for wanted in [3996, 3998, 4002, 4004] {
        let model = read("knot.off", Resolution::Panels(wanted)).unwrap();
        assert!(euler(&model).abs_diff(ring) <= 4, "{wanted}: {} and {ring}", euler(&model));
    }
}

#[test]
fn thin_wings_are_kept_and_told() {
    let model = read("airplane.stl", Resolution::Panels(1000)).unwrap();
    assert!(
        model.repairs().iter().any(|repair| matches!(repair, Repair::Thickened { .. })),
        "{:?}",
        model.repairs()
    );
    let [long, wide, _] = model.surface().bounds();
    assert!(f64::from(wide) > 0.85 * f64::from(long), "{long} x {wide}: wings 18 wide, fuselage 19 long");
}

#[test]
fn a_house_with_a_triangle_inside_out_is_the_house() {
    let house = read("house.stl", Resolution::Voxel(0.5)).unwrap();
    let turned = read("house_turned.stl", Resolution::Voxel(0.5)).unwrap();
    assert_eq!(turned.repairs(), [Repair::Turned(1)]);
    assert_eq!(turned.surface().quads(), house.surface().quads());
    let distance = house.distance().unwrap().hausdorff;
    assert!((0.3..=1.0).contains(&distance), "steps beside the slope of the roof: {distance}");
}

#[test]
fn numbers_of_panels_that_can_not_be_are_refused() {
    for (wanted, nearest) in [(999, "998 and 1000"), (8, "6 and 10"), (12, "10 and 14")] {
        let told = read("house.stl", Resolution::Panels(wanted)).unwrap_err().to_string();
        assert!(told.contains(&format!("{wanted} panels: no solid")) && told.ends_with(nearest), "{told}");
    }
}

#[test]
fn sheets_that_bound_nothing_are_refused_with_a_place() {
    let bowl = read("bad/bowl.obj", Resolution::Panels(1000)).unwrap_err().to_string();
    assert!(bowl.contains("16 open edges") && bowl.contains("doesn't tell inside from outside"), "{bowl}");
    let strip = read("bad/moebius.off", Resolution::Panels(1000)).unwrap_err().to_string();
    assert!(strip.contains("of unlike orientation; the first from ("), "{strip}");
}

/// The boundary of a solid as an OBJ mesh, with corners of its own for every face.
fn obj(solid: &BTreeSet<Voxel>) -> (String, usize) {
    let mut text = String::new();
    let quads = boundary(solid);
    for quad in &quads {
        for [x, y, z] in quad {
            text.push_str(&format!("v {x} {y} {z}\n"));
        }
        text.push_str("f -4 -3 -2 -1\n");
    }
    (text, quads.len())
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 150, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn random_solids_come_to_every_number_of_panels_near_and_above_their_own(
        choices in prop::collection::vec((0..1000usize, 0..6usize), 0..40),
        factor in 0.5..8.0_f64,
        number in any::<u32>(),
    ) {
        let (text, faces) = obj(&solid(&choices));
        let path = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(format!("grown_{number}.obj"));
        std::fs::write(&path, text).unwrap();
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a few thousand")]
        let wanted = (factor * faces as f64 / 2.0).ceil() as usize * 2;
        let found = Model::read(&path, Some(Resolution::Panels(wanted)));
        std::fs::remove_file(&path).unwrap();
        match found {
            Ok(model) => prop_assert_eq!(model.surface().len(), wanted),
            // A solid with tunnels or arms has no likeness of a few panels.
            Err(error) => match error.problem {
                ModelProblem::PanelCount { .. } => prop_assert!([2, 4, 8, 12].contains(&wanted), "{}", wanted),
                problem => prop_assert!(wanted < faces, "{} of {}: {}", wanted, faces, problem),
            },
        }
    }
}
