//! Mutations that change how a plan is written and not what it says: it stays valid.

use crate::dice::Dice;
use crate::plan_file::{array, index, integer, length, panels, put};
use serde_json::{Value, json};

pub(crate) fn face_from_another_corner(file: &mut Value, dice: &mut Dice) -> bool {
    let panel = dice.below(panels(file));
    array(file, &format!("/faces_vertices/{panel}")).rotate_left(1 + dice.below(3));
    true
}

pub(crate) fn vertices_renumbered(file: &mut Value, dice: &mut Dice) -> bool {
    let [a, b] = dice.two_below(length(file, "/vertices_coords"));
    for place in ["/vertices_coords", "/file_frames/0/vertices_coords"] {
        array(file, place).swap(a, b);
    }
    for place in ["/faces_vertices", "/edges_vertices"] {
        for row in array(file, place) {
            exchange(row, a, b);
        }
    }
    true
}

pub(crate) fn panels_renumbered(file: &mut Value, dice: &mut Dice) -> bool {
    let [a, b] = dice.two_below(panels(file));
    array(file, "/faces_vertices").swap(a, b);
    for row in array(file, "/edges_faces") {
        exchange(row, a, b);
    }
    for list in ["/zygote:piles", "/zygote:hinges"] {
        for entry in array(file, list) {
            exchange(&mut entry["panels"], a, b);
        }
    }
    for row in array(file, "/file_frames/0/faceOrders") {
        // The third number is a side, no panel.
        for at in 0..2 {
            row[at] = renumbered(&row[at], a, b);
        }
    }
    let root = index(file, "/zygote:root");
    put(file, "/zygote:root", renumbered(&json!(root), a, b));
    true
}

fn exchange(row: &mut Value, a: usize, b: usize) {
    for number in row.as_array_mut().unwrap() {
        *number = renumbered(number, a, b);
    }
}

fn renumbered(number: &Value, a: usize, b: usize) -> Value {
    if *number == json!(a) {
        json!(b)
    } else if *number == json!(b) {
        json!(a)
    } else {
        number.clone()
    }
}

pub(crate) fn hinges_in_another_order(file: &mut Value, dice: &mut Dice) -> bool {
    if panels(file) < 3 {
        return false;
    }
    let [a, b] = dice.two_below(panels(file) - 1);
    array(file, "/zygote:hinges").swap(a, b);
    exchange_edges(file, a, b);
    true
}

pub(crate) fn cut_edges_in_another_order(file: &mut Value, dice: &mut Dice) -> bool {
    let hinges = panels(file) - 1;
    let [a, b] = dice.two_below(2 * panels(file) + 2);
    exchange_edges(file, hinges + a, hinges + b);
    true
}

fn exchange_edges(file: &mut Value, a: usize, b: usize) {
    for place in ["/edges_vertices", "/edges_faces"] {
        array(file, place).swap(a, b);
    }
    for frame in ["", "/file_frames/0"] {
        for key in ["edges_foldAngle", "edges_assignment"] {
            array(file, &format!("{frame}/{key}")).swap(a, b);
        }
    }
}

pub(crate) fn piles_in_another_order(file: &mut Value, dice: &mut Dice) -> bool {
    let count = length(file, "/zygote:piles");
    if count < 2 {
        return false;
    }
    let [a, b] = dice.two_below(count);
    array(file, "/zygote:piles").swap(a, b);
    true
}

pub(crate) fn whole_numbers_written_with_a_point(file: &mut Value, dice: &mut Dice) -> bool {
    let places = [
        "/vertices_coords",
        "/file_frames/0/vertices_coords",
        "/edges_foldAngle",
        "/file_frames/0/edges_foldAngle",
    ];
    let place = *dice.of(&places);
    let mut place = format!("{place}/{}", dice.below(length(file, place)));
    if file.pointer(&place).unwrap().is_array() {
        place.push_str("/1");
    }
    let value = integer(file, &place);
    put(file, &place, json!(value as f64))
}

pub(crate) fn keys_of_others_added(file: &mut Value, dice: &mut Dice) -> bool {
    let values = [json!(null), json!([[1, 2]]), json!({ "a": { "b": [] } }), json!("text"), json!(1e300)];
    let value = dice.of(&values).clone();
    let place = *dice.of(&["", "/file_frames/0", "/zygote:hinges/0", "/zygote:piles/0", "/zygote:source"]);
    file.pointer_mut(place)
        .and_then(Value::as_object_mut)
        .unwrap()
        .insert("other:key".into(), value)
        .is_none()
}

pub(crate) fn frame_of_others_added(file: &mut Value, dice: &mut Dice) -> bool {
    let value = dice.of(&[json!({}), json!({ "frame_title": "halfway" }), json!(null)]).clone();
    array(file, "/file_frames").push(value);
    true
}

pub(crate) fn another_root(file: &mut Value, dice: &mut Dice) -> bool {
    let root = dice.below(panels(file));
    put(file, "/zygote:root", json!(root))
}

pub(crate) fn another_panel_length(file: &mut Value, dice: &mut Dice) -> bool {
    let length = dice.of(&[json!(1), json!(1e-3), json!(12.5), json!(1e9)]).clone();
    put(file, "/zygote:panel_length_mm", length)
}

pub(crate) fn ratio_off_by_rounding(file: &mut Value, dice: &mut Dice) -> bool {
    let ratio = file.pointer("/zygote:ver").and_then(Value::as_f64).unwrap();
    put(file, "/zygote:ver", json!(ratio * dice.of(&[1.0 + 1e-12, 1.0 - 1e-12, 1.0 + 9e-10])))
}

pub(crate) fn target_elsewhere(file: &mut Value, dice: &mut Dice) -> bool {
    let by = *dice.of(&[[1, 0, 0], [-5, 7, 1000], [999_000_000, 0, -999_000_000]]);
    let (turns, points) = (dice.below(3), length(file, "/vertices_coords"));
    for vertex in 0..points {
        let place = format!("/vertices_coords/{vertex}");
        let mut point = [0, 1, 2].map(|axis| integer(file, &format!("{place}/{axis}")) + by[axis]);
        // x, y, z in turn: a turn about the diagonal of space.
        point.rotate_left(turns);
        put(file, &place, json!(point));
    }
    true
}

pub(crate) fn zygote_elsewhere(file: &mut Value, dice: &mut Dice) -> bool {
    let by = *dice.of(&[[1, 0], [0, -3], [-999_000_000, 999_000_000]]);
    for pile in 0..length(file, "/zygote:piles") {
        for (axis, by) in by.into_iter().enumerate() {
            crate::plan_file::add(file, &format!("/zygote:piles/{pile}/cell/{axis}"), by);
        }
    }
    for vertex in 0..length(file, "/file_frames/0/vertices_coords") {
        for (axis, by) in by.into_iter().enumerate() {
            crate::plan_file::add(file, &format!("/file_frames/0/vertices_coords/{vertex}/{axis}"), by);
        }
    }
    true
}

pub(crate) fn zygote_turned(file: &mut Value, _: &mut Dice) -> bool {
    // A quarter turn counter-clockwise: the corner (x, y) comes to (-y, x), the cell with it.
    for vertex in 0..length(file, "/file_frames/0/vertices_coords") {
        let place = format!("/file_frames/0/vertices_coords/{vertex}");
        let [x, y] = [0, 1].map(|axis| integer(file, &format!("{place}/{axis}")));
        put(file, &place, json!([-y, x, 0]));
    }
    for pile in 0..length(file, "/zygote:piles") {
        let place = format!("/zygote:piles/{pile}/cell");
        let [i, j] = [0, 1].map(|axis| integer(file, &format!("{place}/{axis}")));
        put(file, &place, json!([-j - 1, i]));
    }
    for entry in array(file, "/zygote:hinges") {
        let side = entry["side"].as_str().unwrap();
        let sides = ["E", "N", "W", "S"];
        let at = sides.iter().position(|other| *other == side).unwrap();
        entry["side"] = json!(sides[(at + 1) % 4]);
    }
    true
}
