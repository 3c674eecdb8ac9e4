//! `zygote reconfigure` as a user meets it.

mod scratch;

use scratch::{Scratch, model};

fn plan(place: &Scratch, shape: &str, piles: &str, name: &str) {
    let run = place.zygote(&["plan", &model(shape), "--piles", piles, "-o", name]);
    assert_eq!(run.code, 0, "{}", run.errors);
}

#[test]
fn the_changes_are_listed_counted_and_written_as_csv() {
    let place = Scratch::new("reconfigure_list");
    plan(&place, "fish92.txt", "2", "fish.fold");
    plan(&place, "vehicle92.txt", "2", "vehicle.fold");
    let run = place.zygote(&["reconfigure", "fish.fold", "vehicle.fold", "--csv", "list.csv"]);
    assert_eq!(run.code, 0, "{}", run.errors);
    assert!(run.output.starts_with("turn the stack of fish.fold: "), "{}", run.output);
    let csv = place.read("list.csv");
    let mut rows = csv.lines();
    assert_eq!(rows.next(), Some("what,kind,cell_x,cell_y,height,from_side,from_deg,to_side,to_deg"));
    let count = |what: &str| csv.lines().skip(1).filter(|row| row.starts_with(&format!("{what},"))).count();
    let [kept, turned, moved, removed, added] = ["keep", "turn", "move", "remove", "add"].map(count);
    assert_eq!((kept + turned + moved + removed, removed), (91, added));
    assert!(csv.lines().all(|row| row.split(',').count() == 9), "{csv}");
    let told = format!("91 hinges: keep {kept}, turn {turned}, move {moved}, remove {removed}, add {added}");
    assert_eq!(run.output.lines().last(), Some(told.as_str()));
    assert_eq!(run.output.lines().count(), 3 + turned + moved + removed + added, "{}", run.output);
    let all = place.zygote(&["reconfigure", "fish.fold", "vehicle.fold", "--all"]);
    assert_eq!(all.output.lines().count(), 3 + csv.lines().count() - 1);
}

#[test]
fn a_plan_needs_no_change_to_become_itself() {
    let place = Scratch::new("reconfigure_same");
    plan(&place, "i14.txt", "2", "i.fold");
    let run = place.zygote(&["reconfigure", "i.fold", "i.fold"]);
    assert!(run.output.starts_with("turn the stack of i.fold: as it stands;"), "{}", run.output);
    assert!(run.output.ends_with("13 hinges: keep 13, turn 0, move 0, remove 0, add 0\n"), "{}", run.output);
}

#[test]
fn stacks_of_another_form_are_refused_and_no_list_written() {
    let place = Scratch::new("reconfigure_refused");
    plan(&place, "fish92.txt", "2", "two.fold");
    plan(&place, "fish92.txt", "4", "four.fold");
    plan(&place, "i14.txt", "2", "i.fold");
    for (other, told) in
        [("four.fold", "2 piles in the first plan and 4"), ("i.fold", "92 panels in the first plan and 14")]
    {
        let run = place.zygote(&["reconfigure", "two.fold", other, "--csv", "list.csv"]);
        assert_eq!(run.code, 2);
        assert!(run.errors.contains(told) && run.errors.contains(other), "{}", run.errors);
    }
    assert_eq!(place.zygote(&["reconfigure", "two.fold", "none.fold"]).code, 2);
    let run = place.zygote(&["reconfigure", "two.fold", "two.fold", "--csv", "no/list.csv"]);
    assert_eq!(run.code, 1, "a list that can't be written");
    assert!(run.output.is_empty(), "{}", run.output);
    assert_eq!(place.files(), ["four.fold", "i.fold", "two.fold"]);
}

#[test]
fn a_plan_like_another_tells_what_it_saves_and_reconfigure_agrees() {
    let place = Scratch::new("reconfigure_like");
    plan(&place, "fish92.txt", "2", "fish.fold");
    let run = place.zygote(&["plan", &model("vehicle92.txt"), "--like", "fish.fold", "-o", "vehicle.fold"]);
    assert_eq!(run.code, 0, "{}", run.errors);
    assert!(run.output.contains("K = 2 piles"), "as many as the fish: {}", run.output);
    assert!(run.output.contains("like fish.fold: 64 plans tried, 64 on its cells"), "{}", run.output);
    let told = run.output.lines().last().unwrap();
    let list = place.zygote(&["reconfigure", "fish.fold", "vehicle.fold"]);
    assert_eq!(list.output.lines().last(), Some(told));
    assert_eq!(place.zygote(&["check", "vehicle.fold"]).code, 0);
}

#[test]
fn a_shape_that_cannot_be_like_a_plan_is_refused_with_the_reason() {
    let place = Scratch::new("reconfigure_like_refused");
    plan(&place, "fish92.txt", "2", "fish.fold");
    let run = place.zygote(&["plan", &model("i14.txt"), "--like", "fish.fold", "-o", "i.fold"]);
    assert_eq!(run.code, 2);
    assert!(run.errors.contains("92 panels in the first plan and 14"), "{}", run.errors);
    let arguments = ["plan", &model("vehicle92.txt"), "--piles", "4", "--like", "fish.fold", "-o", "v.fold"];
    let run = place.zygote(&arguments);
    assert_eq!(run.code, 2);
    assert!(run.errors.contains("2 piles in the first plan and 4"), "{}", run.errors);
    assert_eq!(place.files(), ["fish.fold"]);
}
