//! `zygote export` as a user meets it.

mod scratch;

use scratch::{Scratch, model};

fn planned(name: &str) -> Scratch {
    let place = Scratch::new(name);
    let run = place.zygote(&["plan", &model("i14.txt"), "--piles", "2", "-o", "plan.fold"]);
    assert_eq!(run.code, 0, "{}", run.errors);
    place
}

#[test]
fn a_plan_becomes_an_animated_scene_at_the_times_of_its_schedule() {
    let place = planned("scene");
    let export = || {
        let run = place.zygote(&["export", "plan.fold", "-o", "plan.glb"]);
        assert_eq!(run.code, 0, "{}", run.errors);
        assert!(run.output.starts_with("plan.glb: "), "{}", run.output);
        place.bytes("plan.glb")
    };
    let unscheduled = export();
    assert_eq!(unscheduled[..4], *b"glTF");
    let rig = model("rigs/sma-160.toml");
    assert_eq!(place.zygote(&["schedule", "plan.fold", "--rig", &rig, "--unchecked"]).code, 0);
    assert_ne!(export(), unscheduled);
}

#[test]
fn an_unknown_ending_is_refused_and_nothing_is_written() {
    let place = planned("ending");
    let run = place.zygote(&["export", "plan.fold", "-o", "plan.xyz"]);
    assert_eq!(run.code, 2);
    assert!(run.errors.contains("plan.xyz: expected a file that ends with .glb"), "{}", run.errors);
    assert_eq!(place.files(), ["plan.fold"]);
}
