//! A plan that somebody changed is refused, and the message names key and index; one that was only written otherwise is
//! not. Every kind of change on every model, by seeds; a failure names all three.

#![allow(clippy::unwrap_used, reason = "helpers of tests fail as tests do")]

mod arrays;
mod dice;
mod harmless;
mod kinds;
mod plan_file;
mod shape;
mod stack;

use dice::Dice;
use kinds::{KINDS, Verdict};
use serde_json::{Value, json};
use std::path::PathBuf;
use zygote_stacking::{Model, Request, check, fold, plan};

/// Closed and open, with an edge where two sheets touch, with a hole; in one pile and in several.
const MODELS: [(&str, usize); 9] = [
    ("cube6.txt", 1),
    ("i14.txt", 2),
    ("l14.txt", 7),
    ("diagonal24.txt", 4),
    ("torus32.txt", 2),
    ("airplane92.txt", 1),
    ("vehicle92.txt", 2),
    ("fish92.txt", 4),
    ("sheet12.obj", 6),
];
/// Seeds for each kind and model.
const SEEDS: u64 = 8;
/// Times a kind is tried on one model for one seed; some find something to change in few places only.
const TRIES: u64 = 400;

fn planned(name: &str, piles: usize) -> Value {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../models").join(name);
    let model = Model::read(&path, None).unwrap();
    let request = Request { piles, ..Request::default() };
    fold::parse(&fold::write(&plan(&model, &request).unwrap()).unwrap()).unwrap()
}

/// A file changed by a kind, unless the model has nothing of that kind.
fn changed(file: &Value, kind: &kinds::Kind, seed: u64) -> Option<Value> {
    (0..TRIES).find_map(|attempt| {
        let mut file = file.clone();
        (kind.change)(&mut file, &mut Dice::new(seed << 32 | attempt)).then_some(file)
    })
}

#[test]
fn every_kind_of_change_gets_its_verdict_on_every_model() {
    let mut seen = vec![0; KINDS.len()];
    for (model, piles) in MODELS {
        let file = planned(model, piles);
        assert!(check(&file).is_valid(), "{model}");
        for (kind, seen) in KINDS.iter().zip(&mut seen) {
            for seed in 0..SEEDS {
                let Some(file) = changed(&file, kind, seed) else { break };
                *seen += 1;
                let told = format!("{} of {model} in {piles} piles, seed {seed}", kind.name);
                assert_verdict(&file, kind.verdict, &told);
            }
        }
    }
    for (kind, seen) in KINDS.iter().zip(seen) {
        assert!(seen >= SEEDS, "{}: found something to change {seen} times only", kind.name);
    }
}

/// The report, and that bytes and tree of values give the same one, and that a reader refuses what breaks a rule, with the
/// rule and the place.
#[track_caller]
fn assert_verdict(file: &Value, verdict: Verdict, told: &str) {
    let report = check(file);
    match verdict {
        Verdict::Valid => assert!(report.is_valid(), "{told}: {}", report.lines(3).join("\n")),
        Verdict::Refused => assert!(!report.is_valid(), "{told}: not noticed"),
        Verdict::Open => {}
    }
    let bytes = serde_json::to_vec(file).unwrap();
    let of_bytes = fold::check(&bytes);
    if !file.is_object() {
        assert!(of_bytes.is_err(), "{told}");
        return;
    }
    assert_eq!(of_bytes.unwrap().lines(9), report.lines(9), "{told}");
    let read = fold::read(&bytes).map_err(|error| error.to_string());
    if let Some((rule, violations)) = report.violations().next() {
        let refusal = read.unwrap_err();
        assert!(refusal.contains(&format!("{rule}: {}: ", violations[0].place)), "{told}: {refusal}");
    } else if verdict == Verdict::Valid {
        assert!(read.is_ok(), "{told}: {read:?}");
    }
}

#[test]
fn kinds_of_change_are_many_and_have_names_of_their_own() {
    let names: std::collections::BTreeSet<&str> = KINDS.iter().map(|kind| kind.name).collect();
    assert_eq!(names.len(), KINDS.len());
    let refused = KINDS.iter().filter(|kind| kind.verdict == Verdict::Refused).count();
    assert!(refused >= 20 && KINDS.len() - refused >= 10, "{refused} of {}", KINDS.len());
}

#[test]
fn bytes_that_are_no_json_object_are_no_plan() {
    assert_eq!(fold::read(b"{").unwrap_err().to_string(), "not JSON");
    assert_eq!(fold::read(b"[]").unwrap_err().to_string(), "expected a JSON object, found an array");
    let empty = fold::read(b"{}").unwrap_err().to_string();
    assert!(
        empty.contains("missing: file_frames: expected an array with the zygote's frame, found none"),
        "{empty}"
    );
}

#[test]
fn numbers_that_json_does_not_have_and_text_cut_short_are_refused() {
    let mut file = planned("i14.txt", 2);
    file["zygote:thickness"] = json!("HERE");
    let text = serde_json::to_string(&file).unwrap();
    for number in ["NaN", "Infinity", "-Infinity", "1e999", "01", "0x1", ".5", "5."] {
        let bytes = text.replace("\"HERE\"", number).into_bytes();
        assert!(fold::check(&bytes).is_err(), "{number}");
    }
    let good = text.replace("\"HERE\"", "0.01");
    assert!(fold::check(good.as_bytes()).unwrap().is_valid());
    assert!(fold::check(format!("\u{feff}{good}").as_bytes()).is_err(), "a byte order mark");
    assert!(fold::check(format!("{good} 1").as_bytes()).is_err(), "something after the end");
    for length in [0, 1, good.len() / 2, good.len() - 1] {
        assert!(fold::check(&good.as_bytes()[..length]).is_err(), "the first {length} bytes");
    }
}
