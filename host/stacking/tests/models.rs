//! The models of this repository, planned with one, two and four piles, and checked.

#![allow(clippy::unwrap_used, reason = "helpers of tests fail as tests do")]

use std::path::PathBuf;
use zygote_stacking::{Model, PlanError, Request, Resolution, Surface, check, fold, plan};

fn model(name: &str) -> Model {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../models").join(name);
    Model::read(&path, path.extension().is_some_and(|name| name == "stl").then_some(Resolution::Voxel(1.0)))
        .unwrap()
}

fn request(piles: usize) -> Request {
    Request { piles, ..Request::default() }
}

#[test]
fn every_model_stacks_into_one_two_and_four_piles_that_break_no_rule() {
    let voxels =
        ["cube6", "i14", "l14", "diagonal24", "torus32", "fish92", "vehicle92", "airplane92", "fish144"];
    let names = voxels.map(|name| format!("{name}.txt"));
    for name in names.iter().map(String::as_str).chain(["fish4000.txt", "sheet12.obj", "house.stl"]) {
        let model = model(name);
        for piles in [1, 2, 4].into_iter().filter(|piles| model.surface().len().is_multiple_of(*piles)) {
            let plan =
                plan(&model, &request(piles)).unwrap_or_else(|error| panic!("{name} K={piles}: {error}"));
            let bytes = fold::write(&plan).unwrap();
            let report = check(&fold::parse(&bytes).unwrap());
            assert!(report.is_valid(), "{name} K={piles}: {:?}", report.lines(3));
            assert_eq!(plan.target, model.surface().quads(), "{name} K={piles}");
            assert_eq!(plan.piles.len(), piles);
            assert_eq!(fold::read(&bytes).unwrap(), plan, "{name} K={piles}: read as it was written");
        }
    }
}

#[test]
fn the_same_seed_gives_the_same_bytes_and_another_seed_another_plan() {
    let model = model("fish144.txt");
    let bytes = |seed| fold::write(&plan(&model, &Request { seed, ..request(4) }).unwrap()).unwrap();
    assert_eq!(bytes(3), bytes(3));
    assert_ne!(bytes(3), bytes(4));
}

#[test]
fn a_schedule_in_the_file_is_kept_as_it_stands() {
    let mut made = plan(&model("i14.txt"), &request(2)).unwrap();
    made.schedule = Some(serde_json::json!({"steps": [1, 2.5, "three"]}));
    assert_eq!(fold::read(&fold::write(&made).unwrap()).unwrap().schedule, made.schedule);
}

#[test]
fn a_number_of_piles_that_does_not_divide_names_the_nearest_that_do() {
    let error = plan(&model("fish92.txt"), &request(3)).unwrap_err();
    assert_eq!(
        error.to_string(),
        "92 panels don't make 3 equally high piles; the nearest numbers that do: 2 and 4"
    );
    for piles in [0, 93] {
        assert!(matches!(plan(&model("fish92.txt"), &request(piles)), Err(PlanError::Indivisible { .. })));
    }
}

#[test]
fn piles_without_room_end_in_an_error_that_says_what_was_tried() {
    // A ribbon of six panels in piles of two: the middle pile begins and ends on the same side, where the first one stands.
    let quads = (0..6).map(|x| [[x, 0, 0], [x + 1, 0, 0], [x + 1, 1, 0], [x, 1, 0]]).collect();
    let ribbon = Model::new("ribbon", Surface::new(quads, Vec::new()).unwrap()).unwrap();
    assert_eq!(plan(&ribbon, &request(2)).unwrap().piles.len(), 2);
    let error = plan(&ribbon, &request(3)).unwrap_err().to_string();
    assert!(error.starts_with("no 3 parts that match found: tried 6 partitions"), "{error}");
    assert!(error.contains("no layout of 3 piles of 2 panels found: tried 16 strips"), "{error}");
    assert!(error.contains("at most 2 piles found a free cell"), "{error}");
}

#[test]
fn a_root_can_be_chosen_and_must_be_a_panel() {
    let model = model("i14.txt");
    assert_eq!(plan(&model, &Request { root: Some(13), ..request(1) }).unwrap().root, 13);
    let error = plan(&model, &Request { root: Some(14), ..request(1) }).unwrap_err();
    assert_eq!(error.to_string(), "root panel 14, expected a panel number from 0 to 13");
}

#[test]
fn the_default_root_of_a_strip_is_half_way_along_it() {
    let made = plan(&model("fish92.txt"), &request(1)).unwrap();
    let height = made.piles[0].panels.iter().position(|panel| *panel == made.root).unwrap();
    assert!((45..=46).contains(&height), "{height}");
}

#[test]
fn lengths_that_are_none_are_refused() {
    let model = model("i14.txt");
    for length in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let thin = Request { thickness: length, ..request(1) };
        let short = Request { panel_length_mm: length, ..request(1) };
        assert!(matches!(plan(&model, &thin), Err(PlanError::Length { what: "thickness", .. })));
        assert!(matches!(plan(&model, &short), Err(PlanError::Length { what: "panel length", .. })));
    }
}

#[test]
fn the_expansion_ratio_of_the_airplane_is_that_of_its_boxes() {
    // 9 x 8 x 2 into one cell with 92 panels of t = L / 20.
    let made = plan(&model("airplane92.txt"), &Request { thickness: 0.05, ..request(1) }).unwrap();
    assert!((made.expansion_ratio() - 144.0 / 4.6).abs() < 1e-9);
}
