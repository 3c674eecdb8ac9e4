//! `zygote check` as a user meets it: verdicts and exit codes.

mod scratch;

use scratch::{Scratch, model};

fn planned(name: &str) -> Scratch {
    let place = Scratch::new(name);
    let run = place.zygote(&["plan", &model("fish92.txt"), "--piles", "2", "-o", "fish.fold"]);
    assert_eq!(run.code, 0, "{}", run.errors);
    place
}

#[test]
fn a_plan_as_it_was_made_is_valid() {
    let place = planned("check_valid");
    let run = place.zygote(&["check", "fish.fold"]);
    assert_eq!(run.code, 0, "{}", run.errors);
    assert!(run.output.starts_with("fish.fold: valid: N = 92 panels, K = 2 piles"), "{}", run.output);
}

#[test]
fn a_plan_edited_by_hand_is_refused_with_rule_key_and_index() {
    let place = planned("check_edited");
    let edited = place.read("fish.fold").replacen("\"opening_deg\":270", "\"opening_deg\":90", 1);
    place.write("fish.fold", &edited);
    let run = place.zygote(&["check", "fish.fold"]);
    assert_eq!(run.code, 1);
    assert!(run.output.starts_with("opening: zygote:hinges["), "{}", run.output);
    assert!(run.output.contains("stated 90, fold angle"), "{}", run.output);
    assert!(run.errors.contains("fish.fold: breaks 1 of the rules"), "{}", run.errors);
}

#[test]
fn only_the_first_few_places_of_a_rule_are_listed() {
    let place = planned("check_many");
    let edited = place.read("fish.fold").replace("\"side\":\"E\"", "\"side\":\"W\"");
    place.write("fish.fold", &edited);
    let run = place.zygote(&["check", "fish.fold"]);
    assert_eq!(run.code, 1);
    assert_eq!(run.output.lines().count(), 6, "{}", run.output);
    assert!(run.output.lines().last().unwrap().starts_with("side: ... and "), "{}", run.output);
}

#[test]
fn what_is_no_plan_at_all_is_unreadable() {
    let place = Scratch::new("check_unreadable");
    place.write("half.fold", "{\"file_spec\": 1.2,");
    place.write("list.fold", "[]");
    for (name, told) in
        [("half.fold", "not JSON"), ("list.fold", "found an array"), ("none.fold", "cannot be read")]
    {
        let run = place.zygote(&["check", name]);
        assert_eq!(run.code, 2, "{name}: {}", run.errors);
        assert!(run.errors.contains(name) && run.errors.contains(told), "{name}: {}", run.errors);
    }
}
