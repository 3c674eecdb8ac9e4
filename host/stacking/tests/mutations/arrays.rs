//! Mutations that look at no geometry: keys and entries gone, doubled, exchanged, of another type, out of range.

use crate::dice::Dice;
use crate::plan_file::{array, index, integer, length, order_faces, panels, put};
use serde_json::{Value, json};

/// Arrays by their place in the file.
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
const NUMBERS: [(&str, &str); 12] = [
    ("/vertices_coords", "/0"),
    ("/faces_vertices", "/2"),
    ("/edges_vertices", "/1"),
    ("/edges_faces", "/0"),
    ("/edges_foldAngle", ""),
    ("/zygote:piles", "/cell/1"),
    ("/zygote:piles", "/panels/0"),
    ("/zygote:hinges", "/panels/1"),
    ("/zygote:hinges", "/opening_deg"),
    ("/file_frames/0/vertices_coords", "/1"),
    ("/file_frames/0/edges_foldAngle", ""),
    ("/file_frames/0/faceOrders", "/2"),
];
/// What an index or a cell never is.
fn no_index(dice: &mut Dice) -> Value {
    let values = [
        json!(-1),
        json!(1_u64 << 32),
        json!(1_u64 << 53),
        json!(u64::MAX),
        json!(i64::MIN),
        json!(1e300),
        json!(0.5),
        json!(2.0),
        json!("1"),
        json!(null),
        json!(true),
        json!([]),
    ];
    dice.of(&values).clone()
}
/// Values of all types.
fn any_value(dice: &mut Dice) -> Value {
    let values = [
        json!(null),
        json!(true),
        json!(false),
        json!(0),
        json!(1),
        json!(-1),
        json!(2.5),
        json!(1e300),
        json!(""),
        json!("E"),
        json!([]),
        json!([[]]),
        json!({}),
        json!({ "cell": [0, 0] }),
    ];
    dice.of(&values).clone()
}
/// The keys of the target and of the zygote's frame that a plan can't do without.
fn keys(file: &Value) -> Vec<(&'static str, String)> {
    let of = |place: &'static str| {
        let object = file.pointer(place).and_then(Value::as_object).unwrap();
        object.keys().map(move |key| (place, key.clone())).collect::<Vec<_>>()
    };
    let mut all = of("");
    all.extend(of("/file_frames/0"));
    all
}

pub(crate) fn key_gone(file: &mut Value, dice: &mut Dice) -> bool {
    let (place, key) = dice.of(&keys(file)).clone();
    file.pointer_mut(place).and_then(Value::as_object_mut).unwrap().remove(&key).is_some()
}

pub(crate) fn key_of_another_type(file: &mut Value, dice: &mut Dice) -> bool {
    let (place, key) = dice.of(&keys(file)).clone();
    let place = format!("{place}/{key}");
    let value = any_value(dice);
    let possible = match key.as_str() {
        "zygote:source" => value.is_object(),
        "file_creator" => value == json!("E"),
        "faceOrders" => value == json!([]),
        _ => file.pointer(&place).unwrap().is_number() && value.is_number(),
    };
    !possible && put(file, &place, value)
}

pub(crate) fn zygote_key_of_another_type(file: &mut Value, dice: &mut Dice) -> bool {
    let all: Vec<_> = keys(file).into_iter().filter(|(_, key)| key.starts_with("zygote:")).collect();
    let (_, key) = dice.of(&all);
    let value = dice.of(&[json!("92"), json!(null), json!(true), json!([1]), json!(-3)]).clone();
    put(file, &format!("/{key}"), value)
}

pub(crate) fn entry_gone(file: &mut Value, dice: &mut Dice) -> bool {
    let place = *dice.of(&ARRAYS);
    let list = array(file, place);
    if list.is_empty() {
        return false;
    }
    list.remove(dice.below(list.len()));
    true
}

pub(crate) fn entry_twice(file: &mut Value, dice: &mut Dice) -> bool {
    let place = *dice.of(&ARRAYS);
    let list = array(file, place);
    if list.is_empty() {
        return false;
    }
    let entry = list[dice.below(list.len())].clone();
    list.insert(dice.below(list.len() + 1), entry);
    true
}

pub(crate) fn entry_of_another_type(file: &mut Value, dice: &mut Dice) -> bool {
    let place = *dice.of(&ARRAYS);
    if length(file, place) == 0 {
        return false;
    }
    let entry = format!("{place}/{}", dice.below(length(file, place)));
    let value = any_value(dice);
    // Two numbers differ by value only, which another kind sees to.
    let numeric = file.pointer(&entry).unwrap().is_number() && value.is_number();
    !numeric && put(file, &entry, value)
}

pub(crate) fn entries_exchanged(file: &mut Value, dice: &mut Dice) -> bool {
    let place = *dice.of(&ARRAYS[..6]);
    if length(file, place) < 2 {
        return false;
    }
    let [a, b] = dice.two_below(length(file, place));
    let same_panel = file.pointer(&format!("/edges_faces/{a}")) == file.pointer(&format!("/edges_faces/{b}"));
    let list = array(file, place);
    // The cut edges of one panel stand in any order.
    if list[a] == list[b] || (place == "/edges_vertices" && same_panel) {
        return false;
    }
    list.swap(a, b);
    true
}

pub(crate) fn number_off(file: &mut Value, dice: &mut Dice) -> bool {
    let (place, way) = *dice.of(&NUMBERS);
    if length(file, place) == 0 {
        return false;
    }
    let place = format!("{place}/{}{way}", dice.below(length(file, place)));
    let sum = integer(file, &place) + dice.of(&[-180, -90, -2, -1, 1, 2, 90, 180]);
    put(file, &place, json!(sum))
}

pub(crate) fn number_out_of_range(file: &mut Value, dice: &mut Dice) -> bool {
    let (place, way) = *dice.of(&NUMBERS);
    if length(file, place) == 0 {
        return false;
    }
    let place = format!("{place}/{}{way}", dice.below(length(file, place)));
    let value = no_index(dice);
    // 2.0 stands for 2 where numbers aren't indices.
    value.as_f64() != file.pointer(&place).unwrap().as_f64() && put(file, &place, value)
}

pub(crate) fn angle_off_by_a_hair(file: &mut Value, dice: &mut Dice) -> bool {
    let place = *dice.of(&["/edges_foldAngle", "/file_frames/0/edges_foldAngle"]);
    let place = format!("{place}/{}", dice.below(length(file, place)));
    let angle = file.pointer(&place).and_then(Value::as_f64).unwrap();
    let hair = if angle == 0.0 { 1e-17 } else { angle * (1.0 + 2.0 * f64::EPSILON) };
    put(file, &place, json!(hair))
}

pub(crate) fn head_with_another_value(file: &mut Value, dice: &mut Dice) -> bool {
    let changes = [
        ("/file_spec", json!(1.1)),
        ("/file_spec", json!("1.2")),
        ("/file_creator", json!("")),
        ("/file_classes", json!([])),
        ("/file_classes", json!(["singleModel", "singleModel"])),
        ("/frame_title", json!("zygote")),
        ("/frame_classes", json!(["creasePattern"])),
        ("/frame_attributes", json!(["2D"])),
        ("/zygote:version", json!(2)),
        ("/zygote:version", json!(true)),
        ("/zygote:panel_length_mm", json!(-90)),
        ("/zygote:panel_length_mm", json!(0)),
        ("/zygote:source", json!("fish92.txt")),
        ("/file_frames/0/frame_title", json!("target")),
        ("/file_frames/0/frame_parent", json!(1)),
        ("/file_frames/0/frame_parent", json!(false)),
        ("/file_frames/0/frame_inherit", json!(1)),
        ("/file_frames/0/frame_attributes", json!(["3D"])),
        ("/file_frames/0/frame_attributes", json!("2D")),
    ];
    let (place, value) = dice.of(&changes).clone();
    put(file, place, value)
}

pub(crate) fn root_out_of_range(file: &mut Value, dice: &mut Dice) -> bool {
    let count = panels(file);
    let values =
        [json!(count), json!(count + 1), json!(-1), json!(0.5), json!(0.0), json!("0"), json!(u64::MAX)];
    let value = dice.of(&values).clone();
    put(file, "/zygote:root", value)
}

pub(crate) fn thickness_of_nothing(file: &mut Value, dice: &mut Dice) -> bool {
    let value =
        dice.of(&[json!(0), json!(-0.01), json!(0.0), json!("0.01"), json!(null), json!([0.01])]).clone();
    put(file, "/zygote:thickness", value)
}

pub(crate) fn thickness_without_its_ratio(file: &mut Value, dice: &mut Dice) -> bool {
    let thickness = file.pointer("/zygote:thickness").and_then(Value::as_f64).unwrap();
    let factor = *dice.of(&[0.5, 2.0, 1.0 + 1e-8, 10.0]);
    // A flat target is as thick as its zygote's panels: its ratio doesn't change.
    let ratio = file.pointer("/zygote:ver").and_then(Value::as_f64).unwrap();
    let flat = (0..3).any(|axis| extent(file, axis) == 0);
    ratio > 0.0 && !flat && put(file, "/zygote:thickness", json!(thickness * factor))
}

fn extent(file: &Value, axis: usize) -> i64 {
    let points = file["vertices_coords"].as_array().unwrap();
    let values = || points.iter().map(|point| point[axis].as_i64().unwrap());
    values().max().unwrap() - values().min().unwrap()
}

pub(crate) fn ratio_off(file: &mut Value, dice: &mut Dice) -> bool {
    let ratio = file.pointer("/zygote:ver").and_then(Value::as_f64).unwrap();
    put(file, "/zygote:ver", json!(ratio * dice.of(&[0.5, 2.0, 1.0 + 1e-8, -1.0, 0.0])))
}

pub(crate) fn frames_that_are_none(file: &mut Value, dice: &mut Dice) -> bool {
    let frame = file.pointer("/file_frames/0").unwrap().clone();
    let values =
        [json!([]), json!({}), json!([null]), json!([[frame.clone()]]), json!(null), json!([{}, frame])];
    let value = dice.of(&values).clone();
    put(file, "/file_frames", value)
}

pub(crate) fn inherited_key_overridden(file: &mut Value, dice: &mut Dice) -> bool {
    let key = *dice.of(&["faces_vertices", "edges_vertices", "edges_faces"]);
    let value = if dice.below(2) == 0 { file[key].clone() } else { json!(null) };
    file["file_frames"][0].as_object_mut().unwrap().insert(key.into(), value).is_none()
}

pub(crate) fn order_of_layers_wrong(file: &mut Value, dice: &mut Dice) -> bool {
    let count = length(file, "/file_frames/0/faceOrders");
    if count == 0 {
        return false;
    }
    let entry = format!("/file_frames/0/faceOrders/{}", dice.below(count));
    let [upper, lower, s] = [0, 1, 2].map(|at| integer(file, &format!("{entry}/{at}")));
    let value = dice
        .of(&[
            json!([lower, upper, s]),
            json!([upper, lower, -s]),
            json!([upper, lower, 0]),
            json!([upper, lower]),
            json!([upper, lower, s, s]),
            json!([upper, upper, s]),
            json!([index(file, "/zygote:piles/0/panels/0") + panels(file), lower, s]),
            json!([upper, -1 - lower, s]),
        ])
        .clone();
    put(file, &entry, value)
}

pub(crate) fn order_over_two_layers(file: &mut Value, dice: &mut Dice) -> bool {
    let column = crate::plan_file::pile(file, dice.below(length(file, "/zygote:piles")));
    if column.len() < 3 {
        return false;
    }
    // True of the stack, but FOLD readers need neighbours.
    let at = dice.below(column.len() - 2);
    let s = if at.is_multiple_of(2) { 1 } else { -1 };
    array(file, "/file_frames/0/faceOrders").push(json!([column[at + 2], column[at], s]));
    true
}

/// What may be changed without harm: the orders written anew are the same set in another order at most.
pub(crate) fn orders_in_another_order(file: &mut Value, dice: &mut Dice) -> bool {
    order_faces(file);
    let orders = array(file, "/file_frames/0/faceOrders");
    if orders.len() < 2 {
        return false;
    }
    let [a, b] = dice.two_below(orders.len());
    orders.swap(a, b);
    true
}

/// Any value anywhere, by another of any kind: what becomes of it is open.
pub(crate) fn anything_anywhere(file: &mut Value, dice: &mut Dice) -> bool {
    let mut place = &mut *file;
    loop {
        let deeper = match &*place {
            Value::Array(list) => list.len(),
            Value::Object(object) => object.len(),
            _ => 0,
        };
        if deeper == 0 || dice.below(6) == 0 {
            break;
        }
        let at = dice.below(deeper);
        place = match place {
            Value::Array(list) => &mut list[at],
            Value::Object(object) => object.iter_mut().nth(at).unwrap().1,
            _ => unreachable!("a value without parts"),
        };
    }
    let value = match (dice.below(3), place.as_f64()) {
        (0, Some(number)) => json!(number),
        (0, None) => place.as_str().map_or(json!(null), |text| json!(text.to_lowercase())),
        (1, _) => no_index(dice),
        _ => any_value(dice),
    };
    std::mem::replace(place, value) != *place
}
