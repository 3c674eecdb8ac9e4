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
