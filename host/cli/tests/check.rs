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

/// The plan in the folder, with a schedule on a rig that has room for all of it.
fn scheduled(name: &str) -> Scratch {
    let place = planned(name);
    let rig = "version = 1\n[rig]\nid = \"bench\"\n[supply]\nvoltage = \"5 V\"\nlimit = \"2 A\"\n\
               resistance = \"50 mohm\"\n[[node]]\nname = \"a\"\nheaters = 128\n";
    place.write("rig.toml", rig);
    let run = place.zygote(&["schedule", "fish.fold", "--rig", "rig.toml"]);
    assert_eq!(run.code, 0, "{}", run.errors);
    place
}

#[test]
fn the_motion_of_a_schedule_is_seen_to_be_free_or_its_collisions_are_listed() {
    let place = scheduled("check_motion");
    let run = place.zygote(&["check", "fish.fold", "--motion", "--thickness", "0.05", "--step", "5"]);
    assert_eq!(run.code, 1, "{}", run.output);
    assert!(run.output.lines().any(|line| line.starts_with("hinge ") && line.contains(" is in panel ")));
    assert!(run.errors.contains("collisions seen in its motion"), "{}", run.errors);
    assert!(run.errors.contains("samples of 5 degrees or less"), "{}", run.errors);
}

#[test]
fn a_motion_without_a_schedule_or_with_numbers_without_sense_cannot_be_looked_at() {
    let place = planned("check_motionless");
    let run = place.zygote(&["check", "fish.fold", "--motion"]);
    assert_eq!(run.code, 2, "{}", run.output);
    assert!(run.errors.contains("fish.fold: has no schedule"), "{}", run.errors);
    let place = scheduled("check_motion_step");
    let run = place.zygote(&["check", "fish.fold", "--motion", "--thickness", "0.05", "--step", "0"]);
    assert_eq!(run.code, 2, "{}", run.output);
    assert!(run.errors.contains("step: expected a finite number of degrees above 0"), "{}", run.errors);
    let run = place.zygote(&["check", "fish.fold", "--step", "2"]);
    assert_eq!(run.code, 2, "{}", run.output);
}
