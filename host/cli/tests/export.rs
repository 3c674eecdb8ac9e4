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
    for (option, file, expected) in [
        ("-o", "plan.xyz", ".glb"),
        ("--stl", "plan.obj", ".stl"),
        ("--cut", "plan", ".svg or .dxf"),
        ("--bom", "bill.xls", ".csv or .json or .txt"),
    ] {
        let run = place.zygote(&["export", "plan.fold", "--net", "net.svg", option, file]);
        assert_eq!(run.code, 2);
        let expected = format!("{file}: expected a file that ends with {expected}");
        assert!(run.errors.contains(&expected), "{}", run.errors);
    }
    assert_eq!(place.files(), ["plan.fold"]);
}

#[test]
fn a_fish_goes_into_a_folder_as_everything_that_a_workshop_needs() {
    let place = Scratch::new("export_all");
    let plan = ["plan", &model("fish92.txt"), "--piles", "4", "--thickness", "0.05", "-o", "fish.fold"];
    assert_eq!(place.zygote(&plan).code, 0);
    let rig = model("rigs/sma-160.toml");
    let run = place.zygote(&["export", "fish.fold", "--rig", &rig, "--all", "made"]);
    assert_eq!(run.code, 0, "{}", run.errors);
    let mut files: Vec<String> = std::fs::read_dir(place.path("made"))
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    files.sort();
    let expected = "assembly.html bom.csv bom.json crease.fold cut-1.dxf cut-1.svg cut-2.dxf cut-2.svg cut-3.dxf cut-3.svg cut-4.dxf \
                    cut-4.svg deployment.glb net.svg plan.fold target.glb zygote.stl";
    assert_eq!(files.join(" "), expected);
    assert_eq!(
        run.output.lines().count(),
        files.len() - 6,
        "a line a file, and one for all sheets: {}",
        run.output
    );
    assert!(run.output.contains("made/cut-1.svg to made/cut-4.svg: "), "{}", run.output);
    assert_eq!(place.bytes("made/plan.fold"), place.bytes("fish.fold"));
    let stl = place.bytes("made/zygote.stl");
    let triangles = u32::from_le_bytes(stl[80..84].try_into().unwrap()) as usize;
    assert_eq!((stl.len(), triangles % 92), (84 + 50 * triangles, 0));
    let of_stl = run.output.lines().find(|line| line.contains("zygote.stl")).unwrap();
    // 2 x 2 panels of 90 mm, 23 of 4.5 mm, 0.2 mm between any two.
    assert!(of_stl.contains("180.2 x 180.2 x 107.9 mm; 184 of 368 magnet holes open towards"), "{of_stl}");
    let bill = place.read("made/bom.csv");
    assert!(bill.contains("\nthermistor,\"simulated\",91\n"), "{bill}");
    assert!(place.read("made/assembly.html").contains(", sma at simulated, channel 90."));
    // The same again, over what is there.
    let again = place.zygote(&["export", "fish.fold", "--rig", &rig, "--all", "made"]);
    assert_eq!((again.code, again.output), (0, run.output));
    assert_eq!(place.bytes("made/zygote.stl"), stl);
}

#[test]
fn a_panel_too_thin_for_magnets_is_told_or_refused_where_magnets_were_asked_for() {
    let place = planned("export_thin");
    let run = place.zygote(&["export", "plan.fold", "--bom", "bom.txt"]);
    assert_eq!(run.code, 0, "{}", run.errors);
    assert!(run.output.contains("panels have no holes (magnet hole: 2.17 mm wide"), "{}", run.output);
    assert!(!place.read("bom.txt").contains("magnet"), "{}", place.read("bom.txt"));
    let run =
        place.zygote(&["export", "plan.fold", "--stl", "a.stl", "--net", "net.svg", "--holes", "magnets"]);
    assert_eq!(run.code, 2);
    assert!(run.errors.contains("needs a panel 2.97 mm thick or more, got 0.90 mm"), "{}", run.errors);
    let run =
        place.zygote(&["export", "plan.fold", "--stl", "a.stl", "--thickness", "4.8", "--magnet", "2by30"]);
    assert_eq!(run.code, 2);
    assert!(run.errors.contains("expected 2 numbers of millimetres"), "{}", run.errors);
    assert_eq!(place.files(), ["bom.txt", "plan.fold"]);
}

#[test]
fn a_sheet_without_room_and_a_rig_without_channels_are_refused_and_nothing_is_written() {
    let place = planned("export_room");
    let run =
        place.zygote(&["export", "plan.fold", "--cut", "cut.svg", "--net", "net.svg", "--sheet", "99x400"]);
    assert_eq!(run.code, 2);
    assert!(run.errors.contains("takes 100.2 x 100.2 mm, got a sheet of 99 x 400 mm"), "{}", run.errors);
    let rig = std::fs::read_to_string(model("rigs/mixed.toml")).unwrap().replace("servos = 16", "servos = 3");
    place.write("small.toml", &rig);
    let run = place.zygote(&["export", "plan.fold", "--bom", "bom.csv", "--rig", "small.toml"]);
    assert_eq!(run.code, 2);
    assert!(run.errors.contains("small.toml"), "{}", run.errors);
    assert_eq!(place.files(), ["plan.fold", "small.toml"]);
}

#[test]
fn what_is_no_plan_and_what_has_no_hinges_are_refused() {
    let place = planned("export_no_plan");
    let mut plan: serde_json::Value = serde_json::from_str(&place.read("plan.fold")).unwrap();
    plan.as_object_mut().unwrap().remove("zygote:hinges");
    place.write("bare.fold", &plan.to_string());
    for (file, why) in [("bare.fold", "zygote:hinges"), ("none.fold", "cannot be read")] {
        let run = place.zygote(&["export", file, "--all", "made"]);
        assert_eq!(run.code, 2);
        assert!(run.errors.contains(file) && run.errors.contains(why), "{}", run.errors);
    }
    let run = place.zygote(&["export", "plan.fold"]);
    assert_eq!(run.code, 2, "nothing asked for");
    assert_eq!(place.files(), ["bare.fold", "plan.fold"]);
}

#[test]
fn where_one_file_cannot_be_written_none_is() {
    let place = planned("export_unwritable");
    std::fs::create_dir(place.path("net.svg")).unwrap();
    let run = place.zygote(&["export", "plan.fold", "--bom", "bom.csv", "--net", "net.svg"]);
    assert_eq!(run.code, 1);
    assert!(run.errors.contains("net.svg: cannot be written: it is a folder"), "{}", run.errors);
    let run = place.zygote(&["export", "plan.fold", "--bom", "bom.csv", "--stl", "no/folder/a.stl"]);
    assert_eq!(run.code, 1);
    assert!(run.errors.contains("no/folder/a.stl: cannot be written"), "{}", run.errors);
    let run = place.zygote(&["export", "plan.fold", "--all", "plan.fold"]);
    assert_eq!(run.code, 1);
    assert!(run.errors.contains("plan.fold: cannot be made"), "{}", run.errors);
    let run = place.zygote(&["export", "plan.fold", "--all", "no/folder"]);
    assert_eq!(run.code, 1);
    let run = place.zygote(&["export", "plan.fold", "--net", "a.svg", "--cut", "a.svg"]);
    assert_eq!(run.code, 2);
    assert!(run.errors.contains("a.svg: asked for twice"), "{}", run.errors);
    assert_eq!(place.files(), ["net.svg", "plan.fold"]);
}

#[test]
fn the_net_is_that_of_the_verb_and_the_target_stands_still() {
    let place = planned("export_net");
    let run =
        place.zygote(&["export", "plan.fold", "--net", "a.svg", "--target", "a.glb", "--crease", "a.fold"]);
    assert_eq!(run.code, 0, "{}", run.errors);
    assert_eq!(place.zygote(&["net", "plan.fold", "--svg", "b.svg"]).code, 0);
    assert_eq!(place.bytes("a.svg"), place.bytes("b.svg"));
    let glb = place.bytes("a.glb");
    assert!(!String::from_utf8_lossy(&glb).contains("animations"));
    assert!(place.read("a.fold").contains("creasePattern"));
}
