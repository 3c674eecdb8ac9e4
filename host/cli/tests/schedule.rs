//! `zygote schedule` and `zygote picture` as a user types them.
#![expect(clippy::expect_used, reason = "a test may fail by panicking, in its helpers too")]

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use zygote_deployment::{Rig, Schedule};
use zygote_stacking::fold;

/// Three voxels in a row: 14 panels.
const BAR: &str = "###\n";

const RIG: &str = "version = 1\n[rig]\nid = \"bench-1\"\n[supply]\nvoltage = \"5 V\"\nlimit = \"2 A\"\n\
                   resistance = \"50 mohm\"\n[[node]]\nname = \"a\"\nheaters = 16\n";

/// A folder of its own for each test, with `plan.fold` and `rig.toml` in it.
struct Folder(PathBuf);

impl Folder {
    fn new(test: &str) -> Self {
        let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("schedule-{test}"));
        if path.exists() {
            fs::remove_dir_all(&path).expect("an old folder goes");
        }
        fs::create_dir_all(&path).expect("a folder");
        let folder = Self(path);
        folder.write("bar.txt", BAR);
        folder.write("rig.toml", RIG);
        let planned = folder.zygote(&["plan", "bar.txt", "--piles", "2", "-o", "plan.fold"]);
        assert!(planned.status.success(), "{planned:?}");
        folder
    }

    fn zygote(&self, arguments: &[&str]) -> Output {
        Command::new(env!("CARGO_BIN_EXE_zygote"))
            .args(arguments)
            .current_dir(&self.0)
            .output()
            .expect("it runs")
    }

    fn write(&self, name: &str, text: &str) {
        fs::write(self.0.join(name), text).expect("a file");
    }

    fn read(&self, name: &str) -> String {
        fs::read_to_string(self.0.join(name)).expect("the file")
    }

    /// Runs a command that must fail with exit code 2 and leave every file as it was; returns what it says.
    fn refused(&self, arguments: &[&str]) -> String {
        let before = self.files();
        let output = self.zygote(arguments);
        let said = String::from_utf8(output.stderr).expect("text");
        assert_eq!(output.status.code(), Some(2), "{said}");
        assert!(output.stdout.is_empty());
        assert!(before == self.files(), "a refused command must leave all files alone");
        said
    }

    fn files(&self) -> Vec<(PathBuf, Vec<u8>)> {
        let entries = fs::read_dir(&self.0).expect("the folder").map(|entry| entry.expect("an entry").path());
        let mut files: Vec<_> =
            entries.map(|path| (path.clone(), fs::read(path).expect("the file"))).collect();
        files.sort();
        files
    }
}

#[test]
fn a_schedule_is_written_into_the_plan_and_verifies_there() {
    let folder = Folder::new("into-plan");
    let output = folder.zygote(&["schedule", "plan.fold", "--rig", "rig.toml"]);
    assert!(output.status.success(), "{output:?}");
    let said = String::from_utf8(output.stdout).expect("text");
    assert!(said.starts_with("plan.fold: 13 steps (13 sma) on rig bench-1 in 1 min "), "{said}");
    let plan = fold::read(folder.read("plan.fold").as_bytes()).expect("still a good plan");
    let rig = Rig::read("rig.toml", RIG).expect("a good rig");
    let schedule = Schedule::from_json(plan.schedule.as_ref().expect("a schedule")).expect("a good schedule");
    schedule.verify(&plan, &rig).expect("it belongs to plan and rig");
    // Again, it is the same file.
    let before = folder.read("plan.fold");
    assert!(folder.zygote(&["schedule", "plan.fold", "--rig", "rig.toml"]).status.success());
    assert_eq!(folder.read("plan.fold"), before);
}

/// The hinge of every step, and the hinges that it waits for.
fn steps(folder: &Folder, name: &str) -> Vec<(usize, Vec<usize>)> {
    let schedule = Schedule::from_text(&folder.read(name)).expect("a good schedule");
    let hinge = |step: usize| schedule.steps[step].hinge;
    schedule
        .steps
        .iter()
        .map(|step| (step.hinge, step.after.iter().map(|other| hinge(*other)).collect()))
        .collect()
}

/// Whether a hinge starts only when another is open, whatever their times.
fn waits(steps: &[(usize, Vec<usize>)], hinge: usize, other: usize) -> bool {
    let (_, direct) = steps.iter().find(|(of, _)| *of == hinge).expect("a step");
    direct.contains(&other) || direct.iter().any(|before| waits(steps, *before, other))
}

#[test]
fn a_hinge_waits_for_others_if_asked_to() {
    let folder = Folder::new("after");
    let schedule = |after: &[String], more: &[&str]| {
        let mut arguments = vec!["schedule", "plan.fold", "--rig", "rig.toml", "-o", "schedule.json"];
        for after in after {
            arguments.extend(["--after", after]);
        }
        arguments.extend(more);
        folder.zygote(&arguments)
    };
    assert!(schedule(&[], &[]).status.success());
    let free = steps(&folder, "schedule.json");
    let pairs = (0..13).flat_map(|a| (0..13).map(move |b| (a, b)));
    let loose: Vec<_> =
        pairs.filter(|(a, b)| a != b && !waits(&free, *a, *b) && !waits(&free, *b, *a)).collect();
    let (first, then) = *loose.first().expect("motions at once");
    // Either way about, among the other way of what the search found, and one by one.
    let (last, before) =
        free.iter().find_map(|(hinge, after)| Some((*hinge, *after.first()?))).expect("waits");
    for (hinge, other) in [(first, then), (then, first), (before, last)] {
        for more in [&[][..], &["--sequential"]] {
            let output = schedule(&[format!("{hinge}:{other}")], more);
            assert!(output.status.success(), "{hinge}:{other} {output:?}");
            assert!(waits(&steps(&folder, "schedule.json"), hinge, other), "{hinge}:{other}");
        }
    }
    // In the order of the tree too.
    let tree = ["--unchecked", "--parallel", "4"];
    assert!(schedule(&[], &tree).status.success());
    let made = steps(&folder, "schedule.json");
    let loose = (0..13).find(|hinge| *hinge != 0 && !waits(&made, *hinge, 0) && !waits(&made, 0, *hinge));
    let loose = loose.expect("motions at once");
    for (hinge, other) in [(loose, 0), (0, loose)] {
        assert!(schedule(&[format!("{hinge}:{other}")], &tree).status.success());
        assert!(waits(&steps(&folder, "schedule.json"), hinge, other), "{hinge}:{other}");
    }
}

#[test]
fn waits_that_no_order_keeps_are_refused_with_their_hinges() {
    let folder = Folder::new("after-refused");
    let refused = |after: &[&str], more: &[&str]| {
        let mut arguments = vec!["schedule", "plan.fold", "--rig", "rig.toml"];
        for after in after {
            arguments.extend(["--after", after]);
        }
        arguments.extend(more);
        folder.refused(&arguments)
    };
    let said = refused(&["5:3", "3:4,7", "7:5"], &[]);
    assert!(said.contains("--after") && said.contains("in a circle: 5 for 3 for 7 for 5"), "{said}");
    let said = refused(&["13:3"], &[]);
    assert!(
        said.contains("hinge 13 is to wait or to be waited for, expected one of the plan's 13"),
        "{said}"
    );
    for text in ["5", "5:", "5:x", "5:3,", ":3", "5.0:2"] {
        let said = refused(&[text], &[]);
        assert!(said.contains("as in 5:3 or 5:3,4"), "{said}");
    }
    // The way back from the tips is no order of the tree, and none that is free.
    assert!(
        folder
            .zygote(&["schedule", "plan.fold", "--rig", "rig.toml", "--unchecked", "-o", "s.json"])
            .status
            .success()
    );
    let tree = steps(&folder, "s.json");
    let back: Vec<_> = tree.windows(2).map(|pair| format!("{}:{}", pair[0].0, pair[1].0)).collect();
    let back: Vec<&str> = back.iter().map(String::as_str).collect();
    let said = refused(&back, &["--unchecked"]);
    assert!(said.contains("against the order of the tree") && said.contains("in a circle: "), "{said}");
    let said = refused(&back, &[]);
    assert!(said.contains("the order that is free needs the opposite"), "{said}");
}

#[test]
fn an_unchecked_spring_moves_alone() {
    let folder = Folder::new("springs");
    let springs = [2, 7];
    let entries = springs.map(|hinge| format!("[[hinge]]\nhinge = {hinge}\nkind = \"spring\"\n")).concat();
    folder.write("springs.toml", &(RIG.replace("heaters = 16", "heaters = 16\nsprings = 2") + &entries));
    let command =
        ["schedule", "plan.fold", "--rig", "springs.toml", "--unchecked", "--parallel", "3", "-o", "s.json"];
    assert!(folder.zygote(&command).status.success());
    let steps = steps(&folder, "s.json");
    let mut at_once = 0;
    for hinge in 0..13 {
        for other in (0..13).filter(|other| *other != hinge) {
            let parted = waits(&steps, hinge, other) || waits(&steps, other, hinge);
            assert!(parted || !springs.contains(&hinge), "hinges {hinge} and {other}");
            at_once += usize::from(!parted);
        }
    }
    assert!(at_once > 0, "others move at once");
}

#[test]
fn a_rig_that_says_nothing_of_masses_is_not_weighed_and_that_is_said() {
    let folder = Folder::new("weightless");
    let output = folder.zygote(&["schedule", "plan.fold", "--rig", "rig.toml", "-o", "s.json"]);
    assert!(output.status.success());
    let said = String::from_utf8(output.stdout).expect("text");
    assert!(said.contains("\nloads: not weighed: the rig doesn't say what panels weigh"), "{said}");
    assert!(!folder.read("s.json").contains("loads"));
}

#[test]
fn the_ground_is_where_the_rig_says_and_the_advice_names_it() {
    let folder = Folder::new("ground");
    for (gravity, advice) in [
        ("", "`zygote plan --free thick --ground`"),
        ("[gravity]\ndirection = [0, 0, 1]\n", "`zygote plan --free thick --ground --rig down.toml`"),
    ] {
        folder.write("down.toml", &format!("{RIG}{gravity}"));
        let command = ["schedule", "plan.fold", "--rig", "down.toml", "--panels", "thick", "--ground"];
        let output = folder.zygote(&command);
        assert_eq!(output.status.code(), Some(1), "{output:?}");
        let said = String::from_utf8(output.stderr).expect("text");
        assert!(said.contains(advice), "{said}");
        let told = String::from_utf8(output.stdout).expect("text");
        assert!(told.contains("the ground"), "{told}");
    }
    folder.write("down.toml", &format!("{RIG}[gravity]\ndirection = [1, 0, 0]\n"));
    let free = [
        "plan",
        "bar.txt",
        "--piles",
        "2",
        "--free",
        "ideal",
        "--ground",
        "--rig",
        "down.toml",
        "-o",
        "free.fold",
    ];
    let output = folder.zygote(&free);
    assert!(output.status.success(), "{output:?}");
    let output = folder.zygote(&["schedule", "free.fold", "--rig", "down.toml", "--ground"]);
    assert!(output.status.success(), "{output:?}");
    assert!(folder.zygote(&["check", "free.fold", "--motion"]).status.success());
    let plan = fold::read(folder.read("free.fold").as_bytes()).expect("a plan");
    let schedule = Schedule::from_json(plan.schedule.as_ref().expect("a schedule")).expect("a good schedule");
    assert_eq!(schedule.certificate.expect("checked").ground, Some([-1.0, 0.0, 0.0]));
    // On a table no closed shape opens: its lowest panel has the shape below it.
    let table = ["plan", "bar.txt", "--piles", "2", "--free", "ideal", "--ground", "-o", "table.fold"];
    let output = folder.zygote(&table);
    assert_eq!(output.status.code(), Some(1));
    let said = String::from_utf8(output.stderr).expect("text");
    assert!(said.contains("of 40 plans none has a panel that could stay fixed on the ground"), "{said}");
    assert!(folder.refused(&["plan", "bar.txt", "--ground", "-o", "x.fold"]).contains("--free"));
}

#[test]
fn a_schedule_beside_the_plan_leaves_the_plan_alone() {
    let folder = Folder::new("beside");
    let before = folder.read("plan.fold");
    let output = folder.zygote(&[
        "schedule",
        "plan.fold",
        "--rig",
        "rig.toml",
        "--parallel",
        "3",
        "-o",
        "schedule.json",
    ]);
    assert!(output.status.success(), "{output:?}");
    assert_eq!(folder.read("plan.fold"), before);
    let schedule = Schedule::from_text(&folder.read("schedule.json")).expect("a good schedule");
    let plan = fold::read(before.as_bytes()).expect("a good plan");
    schedule.verify(&plan, &Rig::read("rig.toml", RIG).expect("a good rig")).expect("it belongs to both");
    assert_eq!(schedule.parallel, Some(3));
}

#[test]
fn bad_rigs_are_refused_with_file_line_expected_and_found() {
    let folder = Folder::new("bad-rigs");
    for (from, to, said) in [
        ("limit", "limt", "bad.toml:6: unknown field `limt`, expected one of"),
        (
            "2 A",
            "2 V",
            "bad.toml:6: expected a current with its unit, as in \"2 A\" or \"500 mA\", found \"2 V\"",
        ),
        ("heaters = 16", "heaters = 12", "bad.toml:10: node[0].heaters: too few heaters: the plan needs 13"),
        ("version = 1", "version = 3", "bad.toml:1: version: expected version 1, found 3"),
        (
            "[[node]]",
            "[[hinge]]\nhinge = 13\n[[node]]",
            "bad.toml:9: hinge[0].hinge: expected a hinge of the plan",
        ),
        ("\"5 V\"", "5", "bad.toml:5: invalid type: integer `5`, expected a voltage with its unit"),
    ] {
        folder.write("bad.toml", &RIG.replace(from, to));
        let error = folder.refused(&["schedule", "plan.fold", "--rig", "bad.toml"]);
        assert!(error.contains(said), "expected {said}, found {error}");
        folder.refused(&["schedule", "plan.fold", "--rig", "bad.toml", "-o", "schedule.json"]);
    }
    let error = folder.refused(&["schedule", "plan.fold", "--rig", "none.toml"]);
    assert!(error.starts_with("error: none.toml: cannot be read\n"), "{error}");
}

#[test]
fn bad_plans_and_options_are_refused() {
    let folder = Folder::new("bad-plans");
    let (good, broken) = (folder.read("plan.fold"), "\"opening_deg\":45");
    folder.write("broken.fold", &good.replacen("\"opening_deg\":90", broken, 1));
    assert_ne!(folder.read("broken.fold"), good);
    folder.write("text.fold", "no JSON");
    for plan in ["broken.fold", "text.fold", "none.fold"] {
        let error = folder.refused(&["schedule", plan, "--rig", "rig.toml"]);
        assert!(error.contains(plan), "{error}");
        folder.refused(&["picture", plan, "-o", "out.svg"]);
    }
    assert!(
        folder
            .refused(&["schedule", "plan.fold", "--rig", "rig.toml", "--parallel", "0"])
            .contains("at least 1")
    );
    assert!(
        folder
            .refused(&["picture", "plan.fold", "-o", "out.svg", "--frames", "5"])
            .contains("film or animation")
    );
    let one = ["picture", "plan.fold", "-o", "out.svg", "--view", "film", "--frames", "1"];
    assert!(folder.refused(&one).contains("2 to 2000"));
}

#[test]
fn a_folder_that_does_not_exist_is_a_failure_not_a_panic() {
    let folder = Folder::new("no-folder");
    let output =
        folder.zygote(&["schedule", "plan.fold", "--rig", "rig.toml", "-o", "nowhere/schedule.json"]);
    assert_eq!(output.status.code(), Some(1));
    let said = String::from_utf8(output.stderr).expect("text");
    assert!(said.starts_with("error: nowhere/schedule.json: cannot be written\n  because: "), "{said}");
}

#[test]
fn a_stale_schedule_in_a_plan_is_not_drawn() {
    let folder = Folder::new("stale");
    assert!(folder.zygote(&["schedule", "plan.fold", "--rig", "rig.toml"]).status.success());
    let text = folder.read("plan.fold");
    let key = "\"plan_crc64\":";
    let digits = text.find(key).expect("the fingerprint") + key.len();
    let quote = digits + text[digits..].find('"').expect("a string");
    let mut stale = text.clone();
    let other = if &text[quote + 1..quote + 2] == "0" { "1" } else { "0" };
    stale.replace_range(quote + 1..quote + 2, other);
    folder.write("plan.fold", &stale);
    let error = folder.refused(&["picture", "plan.fold", "--view", "film", "-o", "film.svg"]);
    assert!(error.contains("schedule: it belongs to the plan"), "{error}");
}

#[test]
fn every_view_is_drawn_with_all_its_parts() {
    let folder = Folder::new("views");
    let groups = |svg: &str, mark: &str| svg.matches(mark).count();
    for (view, mark, least) in [
        ("target", "<path", 9),
        ("zygote", "<path", 2 + 14),
        ("both", "class=\"head\" x", 2),
        ("film", "class=\"head\" x", 6),
        ("animation", "<animate attributeName=\"display\"", 240),
    ] {
        let output = folder.zygote(&["picture", "plan.fold", "--view", view, "-o", "out.svg"]);
        assert!(output.status.success(), "{output:?}");
        let svg = folder.read("out.svg");
        assert!(svg.starts_with("<svg ") && svg.ends_with("</svg>\n"));
        assert!(groups(&svg, mark) >= least, "{view}: {} of {mark}, expected {least}", groups(&svg, mark));
        assert_eq!(groups(&svg, "<g "), groups(&svg, "</g>"));
        assert!(!svg.contains("NaN") && !svg.contains("inf"), "{view} has a number that is none");
    }
}
