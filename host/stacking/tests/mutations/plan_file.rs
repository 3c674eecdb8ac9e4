//! A plan file as a tree of JSON values, with short ways to its parts.

use serde_json::{Value, json};

/// The array at a place.
pub(crate) fn array<'a>(file: &'a mut Value, place: &str) -> &'a mut Vec<Value> {
    file.pointer_mut(place).and_then(Value::as_array_mut).unwrap()
}

/// The number of entries of the array at a place.
pub(crate) fn length(file: &Value, place: &str) -> usize {
    file.pointer(place).and_then(Value::as_array).unwrap().len()
}

/// The whole number at a place.
pub(crate) fn integer(file: &Value, place: &str) -> i64 {
    file.pointer(place).and_then(Value::as_i64).unwrap()
}

/// The whole number at a place that is an index.
pub(crate) fn index(file: &Value, place: &str) -> usize {
    usize::try_from(integer(file, place)).unwrap()
}

/// Puts a value at a place that is there; says whether that changed anything.
pub(crate) fn put(file: &mut Value, place: &str, value: Value) -> bool {
    let old = std::mem::replace(file.pointer_mut(place).unwrap(), value);
    old != *file.pointer(place).unwrap()
}

/// Adds to the whole number at a place.
pub(crate) fn add(file: &mut Value, place: &str, by: i64) {
    let sum = integer(file, place) + by;
    put(file, place, json!(sum));
}

/// The number of panels.
pub(crate) fn panels(file: &Value) -> usize {
    length(file, "/faces_vertices")
}

/// The panels of a pile, from the bottom up.
pub(crate) fn pile(file: &Value, number: usize) -> Vec<i64> {
    let list = file.pointer(&format!("/zygote:piles/{number}/panels")).and_then(Value::as_array).unwrap();
    list.iter().map(|panel| panel.as_i64().unwrap()).collect()
}

/// Writes `faceOrders` anew, as the piles ask for.
pub(crate) fn order_faces(file: &mut Value) {
    let mut orders = Vec::new();
    for number in 0..length(file, "/zygote:piles") {
        for (height, pair) in pile(file, number).windows(2).enumerate() {
            orders.push(json!([pair[1], pair[0], if height % 2 == 0 { 1 } else { -1 }]));
        }
    }
    put(file, "/file_frames/0/faceOrders", orders.into());
}
