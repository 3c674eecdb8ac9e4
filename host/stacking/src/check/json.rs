//! Numbers and lists out of JSON, as the plan format has them.

use serde_json::Value;

/// Coordinates farther out than this are none that a plan has.
const FAR: f64 = 1e9;

/// A list of exactly so many numbers of panels, vertices or the like, each below a limit.
pub(super) fn indices<const COUNT: usize>(value: &Value, limit: usize) -> Option<[usize; COUNT]> {
    let list = value.as_array().filter(|list| list.len() == COUNT)?;
    let mut found = [0; COUNT];
    for (place, entry) in found.iter_mut().zip(list) {
        *place = index(entry, limit)?;
    }
    Some(found)
}

/// A number below a limit.
pub(super) fn index(value: &Value, limit: usize) -> Option<usize> {
    value.as_u64().and_then(|number| usize::try_from(number).ok()).filter(|number| *number < limit)
}

/// A lattice point: three whole numbers, however they are written.
pub(super) fn lattice_point(value: &Value) -> Option<[i32; 3]> {
    let [x, y, z] = value.as_array()?.as_slice() else { return None };
    Some([whole(x)?, whole(y)?, whole(z)?])
}

fn whole(value: &Value) -> Option<i32> {
    let number = value.as_f64()?;
    #[expect(clippy::cast_possible_truncation, reason = "whole and within +-1e9, as just tested")]
    let whole = (number.fract() == 0.0 && number.abs() < FAR).then_some(number as i32);
    whole
}

/// A cell: two integers, far from the limits of 32 bits.
pub(super) fn cell(value: &Value) -> Option<[i32; 2]> {
    let [x, y] = value.as_array()?.as_slice() else { return None };
    let near = |value: &Value| {
        value.as_i64().and_then(|c| i32::try_from(c).ok()).filter(|c| f64::from(*c).abs() < FAR)
    };
    Some([near(x)?, near(y)?])
}

/// Whether two JSON values are the same, numbers by their value.
pub(super) fn same(found: &Value, expected: &Value) -> bool {
    match (found.as_f64(), expected.as_f64()) {
        (Some(found), Some(expected)) => found.total_cmp(&expected).is_eq(),
        _ => found == expected,
    }
}
