//! Mutations of the shape and of the cut surface: corners, faces, vertices, edges, angles.

use crate::dice::Dice;
use crate::plan_file::{add, array, index, integer, length, panels, put};
use serde_json::{Value, json};

const TARGET: &str = "/vertices_coords";
const ZYGOTE: &str = "/file_frames/0/vertices_coords";

/// Points at a place, as they stand there.
fn map_points(file: &mut Value, place: &str, change: impl Fn([i64; 3]) -> Value) -> bool {
    let mut changed = false;
    for at in 0..length(file, place) {
        let point = [0, 1, 2].map(|axis| integer(file, &format!("{place}/{at}/{axis}")));
        changed |= put(file, &format!("{place}/{at}"), change(point));
    }
    changed
}

pub(crate) fn target_corner_moved(file: &mut Value, dice: &mut Dice) -> bool {
    let at = format!("{TARGET}/{}/{}", dice.below(length(file, TARGET)), dice.below(3));
    add(file, &at, *dice.of(&[-3, -1, 1, 2]));
    true
}

pub(crate) fn zygote_corner_moved(file: &mut Value, dice: &mut Dice) -> bool {
    let at = format!("{ZYGOTE}/{}/{}", dice.below(length(file, ZYGOTE)), dice.below(3));
    add(file, &at, *dice.of(&[-3, -1, 1, 2]));
    true
}

pub(crate) fn corners_far_away(file: &mut Value, dice: &mut Dice) -> bool {
    let place = *dice.of(&[TARGET, ZYGOTE]);
    let at = format!("{place}/{}/{}", dice.below(length(file, place)), dice.below(3));
    let far = [json!(i32::MAX), json!(i32::MIN), json!(1_u64 << 40), json!(1e300), json!(u64::MAX)];
    let value = dice.of(&far).clone();
    put(file, &at, value)
}

pub(crate) fn target_off_the_lattice(file: &mut Value, dice: &mut Dice) -> bool {
    let axis = dice.below(3);
    let by = *dice.of(&[0.5, 1e-9, 0.25]);
    map_points(file, TARGET, |point| {
        let mut moved = point.map(|c| c as f64);
        moved[axis] += by;
        json!(moved)
    })
}

pub(crate) fn target_of_another_lattice(file: &mut Value, dice: &mut Dice) -> bool {
    let (axis, other, kind) = (dice.below(3), dice.below(3), dice.below(3));
    map_points(file, TARGET, |point| {
        let mut moved = point;
        match kind {
            // Panels of twice the length, long panels, panels leaning over.
            0 => moved = point.map(|c| 2 * c),
            1 => moved[axis] *= 2,
            _ => moved[axis] += point[other] * i64::from(axis != other),
        }
        json!(moved)
    }) && !is_whole(file)
}

/// Whether all panels of the target are unit squares still: so where a sheet lies across the changed axis.
fn is_whole(file: &Value) -> bool {
    (0..panels(file)).all(|panel| {
        let point = |corner: usize| {
            let vertex = index(file, &format!("/faces_vertices/{panel}/{corner}"));
            [0, 1, 2].map(|axis| integer(file, &format!("{TARGET}/{vertex}/{axis}")))
        };
        let corners = [0, 1, 2, 3].map(point);
        (0..4).all(|c| {
            let (p, q) = (corners[c], corners[(c + 1) % 4]);
            (0..3).map(|axis| (p[axis] - q[axis]).abs()).sum::<i64>() == 1
        })
    })
}

pub(crate) fn target_inside_out(file: &mut Value, dice: &mut Dice) -> bool {
    let bent = file["edges_foldAngle"].as_array().unwrap().iter().any(|angle| angle != 0);
    let axis = dice.below(3);
    // Its mirror image: what was convex is concave. A sheet that is flat all over is none the worse for it.
    bent && map_points(file, TARGET, |mut point| {
        point[axis] = -point[axis];
        json!(point)
    })
}

pub(crate) fn zygote_inside_out(file: &mut Value, _: &mut Dice) -> bool {
    map_points(file, ZYGOTE, |[x, y, z]| json!([-x, y, z]))
}

pub(crate) fn zygote_lifted(file: &mut Value, dice: &mut Dice) -> bool {
    let by = *dice.of(&[-1, 1]);
    map_points(file, ZYGOTE, |[x, y, z]| json!([x, y, z + by]))
}

pub(crate) fn zygote_beside_its_cells(file: &mut Value, dice: &mut Dice) -> bool {
    let [dx, dy] = *dice.of(&[[1, 0], [0, 1], [-1, 0], [5, -7]]);
    map_points(file, ZYGOTE, |[x, y, z]| json!([x + dx, y + dy, z]))
}

pub(crate) fn face_turned_over(file: &mut Value, dice: &mut Dice) -> bool {
    let panel = dice.below(panels(file));
    array(file, &format!("/faces_vertices/{panel}")).reverse();
    true
}

pub(crate) fn all_faces_and_edges_turned_over(file: &mut Value, _: &mut Dice) -> bool {
    for place in ["/faces_vertices", "/edges_vertices"] {
        for entry in array(file, place) {
            entry.as_array_mut().unwrap().reverse();
        }
    }
    true
}

pub(crate) fn face_crossed(file: &mut Value, dice: &mut Dice) -> bool {
    let panel = dice.below(panels(file));
    let [a, b] = *dice.of(&[[0, 1], [1, 2], [2, 3], [0, 3]]);
    array(file, &format!("/faces_vertices/{panel}")).swap(a, b);
    true
}

pub(crate) fn edge_turned_round(file: &mut Value, dice: &mut Dice) -> bool {
    let edge = dice.below(length(file, "/edges_vertices"));
    array(file, &format!("/edges_vertices/{edge}")).reverse();
    true
}

pub(crate) fn edge_across_its_panel(file: &mut Value, dice: &mut Dice) -> bool {
    let edge = dice.below(length(file, "/edges_vertices"));
    let panel = index(file, &format!("/edges_faces/{edge}/0"));
    let corners = file.pointer(&format!("/faces_vertices/{panel}")).unwrap().clone();
    let start = dice.below(4);
    put(file, &format!("/edges_vertices/{edge}"), json!([corners[start], corners[(start + 2) % 4]]))
}

pub(crate) fn cut_edge_twice(file: &mut Value, dice: &mut Dice) -> bool {
    let first = panels(file) - 1;
    let [a, b] = dice.two_below(2 * panels(file) + 2).map(|at| first + at);
    for place in ["/edges_vertices", "/edges_faces"] {
        let entry = file.pointer(&format!("{place}/{a}")).unwrap().clone();
        put(file, &format!("{place}/{b}"), entry);
    }
    true
}

pub(crate) fn vertex_shared_without_a_hinge(file: &mut Value, dice: &mut Dice) -> bool {
    // Two vertices at one place in both frames become one; the other is used by nobody.
    let [a, b] = dice.two_below(length(file, TARGET));
    let same = |place: &str| {
        file.pointer(&format!("{place}/{a}")).unwrap() == file.pointer(&format!("{place}/{b}")).unwrap()
    };
    if !same(TARGET) {
        return false;
    }
    rename(file, b, a);
    true
}

pub(crate) fn vertex_gone(file: &mut Value, dice: &mut Dice) -> bool {
    let [gone, instead] = dice.two_below(length(file, TARGET));
    rename(file, gone, instead);
    let last = length(file, TARGET) - 1;
    for place in [TARGET, ZYGOTE] {
        array(file, place).swap_remove(gone);
    }
    if gone != last {
        rename(file, last, gone);
    }
    true
}

/// Writes one vertex for another in faces and edges.
fn rename(file: &mut Value, from: usize, to: usize) {
    for place in ["/faces_vertices", "/edges_vertices"] {
        for vertex in array(file, place).iter_mut().flat_map(|entry| entry.as_array_mut().unwrap()) {
            if *vertex == json!(from) {
                *vertex = json!(to);
            }
        }
    }
}

pub(crate) fn vertex_split(file: &mut Value, dice: &mut Dice) -> bool {
    // One face goes to a vertex of its own beside the shared one.
    let (panel, corner) = (dice.below(panels(file)), dice.below(4));
    let place = format!("/faces_vertices/{panel}/{corner}");
    let other = dice.below(length(file, TARGET));
    put(file, &place, json!(other))
}

pub(crate) fn target_angle_with_its_letter(file: &mut Value, dice: &mut Dice) -> bool {
    let hinge = dice.below(panels(file) - 1);
    let angle = *dice.of(&[-90, 0, 90, 180]);
    let old = integer(file, &format!("/edges_foldAngle/{hinge}"));
    // All that the file says of it agrees; only the coordinates don't.
    let opening = integer(file, &format!("/zygote:hinges/{hinge}/opening_deg"));
    let inner = opening == 180 + old && old != 0;
    put(file, &format!("/edges_assignment/{hinge}"), letter(angle));
    put(
        file,
        &format!("/zygote:hinges/{hinge}/opening_deg"),
        json!(if inner { 180 + angle } else { 180 - angle }),
    );
    put(file, &format!("/edges_foldAngle/{hinge}"), json!(angle))
}

pub(crate) fn zygote_angle_with_its_letter(file: &mut Value, dice: &mut Dice) -> bool {
    let hinge = dice.below(panels(file) - 1);
    let angle = *dice.of(&[-180, 0, 90, 180]);
    put(file, &format!("/file_frames/0/edges_assignment/{hinge}"), letter(angle));
    put(file, &format!("/file_frames/0/edges_foldAngle/{hinge}"), json!(angle))
}

fn letter(angle: i64) -> Value {
    json!(match angle {
        1.. => "V",
        0 => "F",
        _ => "M",
    })
}

pub(crate) fn another_letter(file: &mut Value, dice: &mut Dice) -> bool {
    let place = *dice.of(&["/edges_assignment", "/file_frames/0/edges_assignment"]);
    let place = format!("{place}/{}", dice.below(length(file, place)));
    let value = json!(*dice.of(&["M", "V", "F", "B", "U", "C", "J", "v", "VV", ""]));
    put(file, &place, value)
}

pub(crate) fn two_panels_on_one_square(file: &mut Value, dice: &mut Dice) -> bool {
    // Their corners' places, one by one, and both their zygotes: as if the shape were folded back onto itself there.
    let [a, b] = dice.two_below(panels(file));
    let mut changed = false;
    for corner in 0..4 {
        let vertex = |panel: usize| index(file, &format!("/faces_vertices/{panel}/{corner}"));
        let (from, to) = (vertex(a), vertex(b));
        let point = file.pointer(&format!("{TARGET}/{from}")).unwrap().clone();
        changed |= put(file, &format!("{TARGET}/{to}"), point);
    }
    changed
}
