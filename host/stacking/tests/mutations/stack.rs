//! Mutations of the stack: piles, cells, heights, hinges and the tree that they make.

use crate::dice::Dice;
use crate::plan_file::{add, array, index, integer, length, order_faces, panels, pile, put};
use serde_json::{Value, json};

/// A hinge of the file, with all that stands in parallel arrays.
const PARALLEL: [&str; 7] = [
    "/zygote:hinges",
    "/edges_vertices",
    "/edges_faces",
    "/edges_foldAngle",
    "/edges_assignment",
    "/file_frames/0/edges_foldAngle",
    "/file_frames/0/edges_assignment",
];

fn put_pile(file: &mut Value, number: usize, panels: &[i64]) -> bool {
    put(file, &format!("/zygote:piles/{number}/panels"), json!(panels))
}

fn any_pile(file: &Value, dice: &mut Dice) -> (usize, Vec<i64>) {
    let number = dice.below(length(file, "/zygote:piles"));
    (number, pile(file, number))
}

pub(crate) fn panels_exchanged_in_the_piles(file: &mut Value, dice: &mut Dice) -> bool {
    let (number, mut first) = any_pile(file, dice);
    let (other, mut second) = any_pile(file, dice);
    let (a, b) = (dice.below(first.len()), dice.below(second.len()));
    if number == other {
        first.swap(a, b);
        let changed = put_pile(file, number, &first);
        order_faces(file);
        return changed;
    }
    std::mem::swap(&mut first[a], &mut second[b]);
    put_pile(file, number, &first);
    put_pile(file, other, &second);
    order_faces(file);
    true
}

pub(crate) fn panel_twice_in_a_pile(file: &mut Value, dice: &mut Dice) -> bool {
    let (number, mut list) = any_pile(file, dice);
    if list.len() < 2 {
        return false;
    }
    let [a, b] = dice.two_below(list.len());
    list[a] = list[b];
    put_pile(file, number, &list)
}

pub(crate) fn panel_in_two_piles(file: &mut Value, dice: &mut Dice) -> bool {
    if length(file, "/zygote:piles") < 2 {
        return false;
    }
    let [a, b] = dice.two_below(length(file, "/zygote:piles"));
    let (first, mut second) = (pile(file, a), pile(file, b));
    let at = dice.below(second.len());
    second[at] = first[dice.below(first.len())];
    put_pile(file, b, &second)
}

pub(crate) fn panel_moved_to_another_pile(file: &mut Value, dice: &mut Dice) -> bool {
    if length(file, "/zygote:piles") < 2 {
        return false;
    }
    let [a, b] = dice.two_below(length(file, "/zygote:piles"));
    let (mut first, mut second) = (pile(file, a), pile(file, b));
    second.extend(first.pop());
    put_pile(file, a, &first);
    put_pile(file, b, &second);
    order_faces(file);
    true
}

pub(crate) fn pile_run_round(file: &mut Value, dice: &mut Dice) -> bool {
    let (number, mut list) = any_pile(file, dice);
    if list.len() < 3 {
        return false;
    }
    // By two, outer sides stay up at even heights: bridges come to unequal heights, folds to join top and bottom.
    let by = if dice.below(2) == 0 { 2 } else { list.len() - 2 };
    list.rotate_left(by);
    let changed = put_pile(file, number, &list);
    order_faces(file);
    changed
}

pub(crate) fn pile_upside_down(file: &mut Value, dice: &mut Dice) -> bool {
    let (number, mut list) = any_pile(file, dice);
    list.reverse();
    let changed = put_pile(file, number, &list);
    order_faces(file);
    changed
}

pub(crate) fn pile_added_that_is_empty(file: &mut Value, dice: &mut Dice) -> bool {
    let cell = file.pointer("/zygote:piles/0/cell").unwrap().clone();
    let beside = json!([cell[0].as_i64().unwrap() + dice.of(&[-1, 0, 1, 9]), cell[1]]);
    array(file, "/zygote:piles").push(json!({ "cell": beside, "panels": [] }));
    true
}

pub(crate) fn two_piles_joined_into_one(file: &mut Value, dice: &mut Dice) -> bool {
    if length(file, "/zygote:piles") < 2 {
        return false;
    }
    let [a, b] = dice.two_below(length(file, "/zygote:piles"));
    let mut both = pile(file, a);
    both.extend(pile(file, b));
    put_pile(file, a, &both);
    array(file, "/zygote:piles").remove(b);
    order_faces(file);
    true
}

pub(crate) fn two_piles_on_one_cell(file: &mut Value, dice: &mut Dice) -> bool {
    if length(file, "/zygote:piles") < 2 {
        return false;
    }
    let [a, b] = dice.two_below(length(file, "/zygote:piles"));
    let cell = file.pointer(&format!("/zygote:piles/{a}/cell")).unwrap().clone();
    put(file, &format!("/zygote:piles/{b}/cell"), cell)
}

pub(crate) fn two_piles_with_exchanged_cells(file: &mut Value, dice: &mut Dice) -> bool {
    if length(file, "/zygote:piles") < 2 {
        return false;
    }
    let [a, b] =
        dice.two_below(length(file, "/zygote:piles")).map(|number| format!("/zygote:piles/{number}/cell"));
    let (first, second) = (file.pointer(&a).unwrap().clone(), file.pointer(&b).unwrap().clone());
    put(file, &a, second);
    put(file, &b, first)
}

pub(crate) fn cell_apart(file: &mut Value, dice: &mut Dice) -> bool {
    let cell = format!("/zygote:piles/{}/cell/{}", dice.below(length(file, "/zygote:piles")), dice.below(2));
    add(file, &cell, *dice.of(&[-40, 40, 2_000_000_000, -2_000_000_000]));
    true
}

pub(crate) fn cell_of_another_type(file: &mut Value, dice: &mut Dice) -> bool {
    let cell = format!("/zygote:piles/{}/cell", dice.below(length(file, "/zygote:piles")));
    let values = [json!([0]), json!([0, 0, 0]), json!([0.0, 0.0]), json!(["0", "0"]), json!({}), json!(null)];
    let value = dice.of(&values).clone();
    put(file, &cell, value)
}

pub(crate) fn hinge_on_another_side(file: &mut Value, dice: &mut Dice) -> bool {
    let hinge = dice.below(panels(file) - 1);
    let side = json!(*dice.of(&["E", "N", "W", "S", "e", "NE", ""]));
    put(file, &format!("/zygote:hinges/{hinge}/side"), side)
}

pub(crate) fn hinge_opening_otherwise(file: &mut Value, dice: &mut Dice) -> bool {
    let hinge = dice.below(panels(file) - 1);
    let opening = dice.of(&[json!(90), json!(180), json!(270), json!(0), json!(360), json!("90")]).clone();
    put(file, &format!("/zygote:hinges/{hinge}/opening_deg"), opening)
}

pub(crate) fn hinge_of_another_kind(file: &mut Value, dice: &mut Dice) -> bool {
    let hinge = dice.below(panels(file) - 1);
    let kind = json!(*dice.of(&["fold", "bridge", "glue", "Fold"]));
    put(file, &format!("/zygote:hinges/{hinge}/kind"), kind)
}

pub(crate) fn hinge_between_other_panels(file: &mut Value, dice: &mut Dice) -> bool {
    let count = panels(file);
    let hinge = format!("/zygote:hinges/{}/panels", dice.below(count - 1));
    let [a, b] = [0, 1].map(|end| index(file, &format!("{hinge}/{end}")));
    let values = [json!([b, a]), json!([a, a]), json!([a, (b + 1) % count]), json!([count, b]), json!([a])];
    let value = dice.of(&values).clone();
    put(file, &hinge, value)
}

pub(crate) fn hinge_entry_lacking_a_key(file: &mut Value, dice: &mut Dice) -> bool {
    let hinge = dice.below(panels(file) - 1);
    let key = *dice.of(&["kind", "panels", "side", "opening_deg"]);
    array(file, "/zygote:hinges")[hinge].as_object_mut().unwrap().remove(key).is_some()
}

pub(crate) fn hinge_missing(file: &mut Value, dice: &mut Dice) -> bool {
    let hinge = dice.below(panels(file) - 1);
    for place in PARALLEL {
        array(file, place).remove(hinge);
    }
    true
}

pub(crate) fn hinge_added(file: &mut Value, dice: &mut Dice) -> bool {
    let hinge = dice.below(panels(file) - 1);
    for place in PARALLEL {
        let list = array(file, place);
        let entry = list[hinge].clone();
        list.insert(hinge, entry);
    }
    true
}

pub(crate) fn hinge_in_place_of_another(file: &mut Value, dice: &mut Dice) -> bool {
    if panels(file) < 3 {
        return false;
    }
    // Two panels hinged twice, and a piece that hangs on nothing.
    let [from, to] = dice.two_below(panels(file) - 1);
    for place in PARALLEL {
        let list = array(file, place);
        list[to] = list[from].clone();
    }
    true
}

pub(crate) fn hinge_that_closes_a_loop(file: &mut Value, dice: &mut Dice) -> bool {
    // A hinge taken off and put between two panels that are joined already, at their cut edges.
    let count = panels(file);
    let [a, b] = dice.two_below(count);
    let hinge = dice.below(count - 1);
    let changed = put(file, &format!("/edges_faces/{hinge}"), json!([a, b]));
    put(file, &format!("/zygote:hinges/{hinge}/panels"), json!([a, b]));
    changed
}

pub(crate) fn fold_with_its_upper_panel_first(file: &mut Value, dice: &mut Dice) -> bool {
    let hinge = dice.below(panels(file) - 1);
    if file.pointer(&format!("/zygote:hinges/{hinge}/kind")) != Some(&json!("fold")) {
        return false;
    }
    turn_round(file, hinge);
    true
}

/// Says the same of a hinge from its other panel.
fn turn_round(file: &mut Value, hinge: usize) {
    array(file, &format!("/edges_vertices/{hinge}")).reverse();
    array(file, &format!("/edges_faces/{hinge}")).reverse();
    array(file, &format!("/zygote:hinges/{hinge}/panels")).reverse();
}

/// A bridge may begin at either of its panels.
pub(crate) fn bridge_from_its_other_end(file: &mut Value, dice: &mut Dice) -> bool {
    let hinge = dice.below(panels(file) - 1);
    if file.pointer(&format!("/zygote:hinges/{hinge}/kind")) != Some(&json!("bridge")) {
        return false;
    }
    turn_round(file, hinge);
    let place = format!("/zygote:hinges/{hinge}/side");
    let sides = ["E", "N", "W", "S"];
    let side = sides.iter().position(|side| file.pointer(&place) == Some(&json!(side))).unwrap();
    put(file, &place, json!(sides[(side + 2) % 4]))
}

pub(crate) fn bridge_at_unequal_heights(file: &mut Value, dice: &mut Dice) -> bool {
    let hinge = dice.below(panels(file) - 1);
    if file.pointer(&format!("/zygote:hinges/{hinge}/kind")) != Some(&json!("bridge")) {
        return false;
    }
    let panel = integer(file, &format!("/zygote:hinges/{hinge}/panels/{}", dice.below(2)));
    let number =
        (0..length(file, "/zygote:piles")).find(|number| pile(file, *number).contains(&panel)).unwrap();
    let mut list = pile(file, number);
    let at = list.iter().position(|other| *other == panel).unwrap();
    // Two up or down, where the outer side looks the same way.
    let Some(to) = [at + 2, at.wrapping_sub(2)].into_iter().find(|to| *to < list.len()) else { return false };
    list.swap(at, to);
    put_pile(file, number, &list);
    order_faces(file);
    true
}
