//! A plan that somebody changed is refused, and the message names key and index.

#![allow(clippy::unwrap_used, reason = "helpers of tests fail as tests do")]

use proptest::prelude::*;
use serde_json::{Value, json};
use std::path::PathBuf;
use std::sync::LazyLock;
use zygote_stacking::{Model, Request, check, fold, plan};

static FISH: LazyLock<Value> = LazyLock::new(|| {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../models/fish92.txt");
    let model = Model::read(&path, None).unwrap();
    let request = Request { piles: 4, ..Request::default() };
    fold::parse(&fold::write(&plan(&model, &request).unwrap()).unwrap()).unwrap()
});

/// Keys at the top that a plan can't do without, and arrays by their place in the file.
const KEYS: [&str; 19] = [
    "file_spec",
    "file_creator",
    "file_classes",
    "frame_title",
    "frame_classes",
    "frame_attributes",
    "vertices_coords",
    "faces_vertices",
    "edges_vertices",
    "edges_faces",
    "edges_assignment",
    "edges_foldAngle",
    "file_frames",
    "zygote:version",
    "zygote:thickness",
    "zygote:panel_length_mm",
    "zygote:piles",
    "zygote:hinges",
    "zygote:root",
];
const ARRAYS: [&str; 12] = [
    "/vertices_coords",
    "/faces_vertices",
    "/edges_vertices",
    "/edges_faces",
    "/edges_assignment",
    "/edges_foldAngle",
    "/zygote:piles",
    "/zygote:hinges",
    "/file_frames/0/vertices_coords",
    "/file_frames/0/edges_foldAngle",
    "/file_frames/0/edges_assignment",
    "/file_frames/0/faceOrders",
];
/// Numbers that stand in entries of arrays: the array, and the way from an entry to the number.
const NUMBERS: [(&str, &str); 9] = [
    ("/vertices_coords", "/0"),
    ("/faces_vertices", "/2"),
    ("/edges_vertices", "/1"),
    ("/edges_faces", "/0"),
    ("/edges_foldAngle", ""),
    ("/zygote:piles", "/cell/1"),
    ("/file_frames/0/vertices_coords", "/1"),
    ("/file_frames/0/edges_foldAngle", ""),
    ("/file_frames/0/faceOrders", "/2"),
];

fn array<'a>(file: &'a mut Value, place: &str) -> &'a mut Vec<Value> {
    file.pointer_mut(place).and_then(Value::as_array_mut).unwrap()
}

fn assert_refused(file: &Value) -> Result<(), TestCaseError> {
    let report = check(file);
    prop_assert!(!report.is_valid(), "the change was not noticed");
    let bytes = serde_json::to_vec(file).unwrap();
    let refusal = fold::read(&bytes).map(|_| ()).unwrap_err().to_string();
    let (rule, violations) = report.violations().next().unwrap();
    prop_assert!(refusal.contains(&format!("{rule}: {}: ", violations[0].place)), "{}", refusal);
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn a_key_that_is_gone_is_noticed(key in prop::sample::select(&KEYS[..])) {
        let mut file = FISH.clone();
        file.as_object_mut().unwrap().remove(key).unwrap();
        assert_refused(&file)?;
    }

    #[test]
    fn an_entry_that_is_gone_is_noticed(place in prop::sample::select(&ARRAYS[..]), at in any::<prop::sample::Index>()) {
        let mut file = FISH.clone();
        let list = array(&mut file, place);
        list.remove(at.index(list.len()));
        assert_refused(&file)?;
    }

    #[test]
    fn an_entry_that_stands_there_twice_is_noticed(
        place in prop::sample::select(&ARRAYS[..]),
        at in any::<prop::sample::Index>(),
    ) {
        let mut file = FISH.clone();
        let list = array(&mut file, place);
        let entry = list[at.index(list.len())].clone();
        list.push(entry);
        assert_refused(&file)?;
    }

    #[test]
    fn two_entries_that_changed_places_are_noticed(
        place in prop::sample::select(&ARRAYS[..6]),
        a in any::<prop::sample::Index>(),
        b in any::<prop::sample::Index>(),
    ) {
        let mut file = FISH.clone();
        let panels = array(&mut file, "/edges_faces").clone();
        let list = array(&mut file, place);
        let (a, b) = (a.index(list.len()), b.index(list.len()));
        prop_assume!(list[a] != list[b]);
        // The cut edges of one panel stand in any order.
        prop_assume!(place != "/edges_vertices" || panels[a] != panels[b]);
        list.swap(a, b);
        assert_refused(&file)?;
    }

    #[test]
    fn a_number_that_is_one_more_or_less_is_noticed(
        (place, way) in prop::sample::select(&NUMBERS[..]),
        at in any::<prop::sample::Index>(),
        by in prop::sample::select(vec![-1, 1, 2, -90, 90]),
    ) {
        let mut file = FISH.clone();
        let list = array(&mut file, place);
        let at = at.index(list.len());
        let number = list[at].pointer_mut(way).unwrap();
        *number = json!(number.as_i64().unwrap() + by);
        assert_refused(&file)?;
    }

    #[test]
    fn panels_that_changed_places_in_the_piles_are_noticed(
        a in (0..4usize, 0..23usize),
        b in (0..4usize, 0..23usize),
    ) {
        prop_assume!(a != b);
        let mut file = FISH.clone();
        let panel = |(pile, height): (usize, usize)| format!("/zygote:piles/{pile}/panels/{height}");
        let (p, q) = (file.pointer(&panel(a)).unwrap().clone(), file.pointer(&panel(b)).unwrap().clone());
        *file.pointer_mut(&panel(a)).unwrap() = q;
        *file.pointer_mut(&panel(b)).unwrap() = p;
        assert_refused(&file)?;
    }

    #[test]
    fn a_hinge_with_another_kind_side_or_opening_is_noticed(
        at in 0..91usize,
        change in prop::sample::select(vec![
            ("kind", json!("bridge")), ("kind", json!("fold")), ("kind", json!("glue")),
            ("side", json!("E")), ("side", json!("N")), ("side", json!("W")), ("side", json!("S")),
            ("opening_deg", json!(90)), ("opening_deg", json!(180)), ("opening_deg", json!(270)),
            ("opening_deg", json!(0)), ("panels", json!([0, 1])), ("panels", json!([91, 92])),
        ]),
    ) {
        let mut file = FISH.clone();
        let (key, value) = change;
        let entry = &mut array(&mut file, "/zygote:hinges")[at][key];
        prop_assume!(*entry != value);
        *entry = value;
        assert_refused(&file)?;
    }

    #[test]
    fn a_panel_turned_on_its_square_is_noticed(panel in 0..92usize, quarters in 1..4usize) {
        let mut file = FISH.clone();
        let face = array(&mut file, &format!("/faces_vertices/{panel}"));
        // The corners go round among the vertices: the square stays where it is, in both frames its edges move.
        let corners: Vec<Value> = (0..4).map(|corner| face[(corner + quarters) % 4].clone()).collect();
        face.clone_from(&corners);
        // Which corner comes first means nothing by itself ...
        prop_assert!(check(&file).is_valid());
        // ... but the order does.
        array(&mut file, &format!("/faces_vertices/{panel}")).reverse();
        assert_refused(&file)?;
    }
}

#[test]
fn fixed_keys_with_another_value_are_noticed() {
    let changes = [
        ("/file_spec", json!(1.1)),
        ("/file_creator", json!("")),
        ("/file_classes", json!([])),
        ("/frame_title", json!("zygote")),
        ("/frame_attributes", json!(["2D"])),
        ("/zygote:version", json!(2)),
        ("/zygote:version", json!(true)),
        ("/zygote:thickness", json!(0)),
        ("/zygote:thickness", json!(0.02)),
        ("/zygote:panel_length_mm", json!(-90)),
        ("/zygote:root", json!(92)),
        ("/zygote:ver", json!(13.7)),
        ("/zygote:source", json!("fish92.txt")),
        ("/file_frames/0/frame_parent", json!(1)),
        ("/file_frames/0/frame_inherit", json!(1)),
        ("/file_frames/0/frame_attributes", json!(["3D"])),
    ];
    for (place, value) in changes {
        let mut file = FISH.clone();
        *file.pointer_mut(place).unwrap() = value.clone();
        assert!(!check(&file).is_valid(), "{place} {value}");
    }
    let mut file = FISH.clone();
    file["file_frames"][0]["edges_faces"] = file["edges_faces"].clone();
    assert!(!check(&file).is_valid(), "an inherited key that is overridden");
}

#[test]
fn bytes_that_are_no_json_object_are_no_plan() {
    assert_eq!(fold::read(b"{").unwrap_err().to_string(), "not JSON");
    assert_eq!(fold::read(b"[]").unwrap_err().to_string(), "expected a JSON object, found an array");
    let empty = fold::read(b"{}").unwrap_err().to_string();
    assert!(
        empty.contains("missing: file_frames: expected an array with the zygote's frame, found none"),
        "{empty}"
    );
}
