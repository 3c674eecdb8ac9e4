//! `cargo xtask mutants [--package core|protocol] [OPTION ..]`: breaks the code in every small way that cargo-mutants knows, one
//! at a time, and counts the breaks that no test sees. What they were, and why they live, stands in `docs/src/mutation.md`.
//!
//! It runs on a copy: one that is stopped halfway must not leave a broken rule in the sources. Options go on to cargo-mutants.

use crate::tools;
use anyhow::{Context, Result, bail, ensure};
use serde_json::Value;
use std::{collections::BTreeMap, fs, ops::AddAssign};

/// What is mutated under which name, and the packages whose tests must see it.
const PACKAGES: &[(&str, &str, &str)] = &[
    ("core", "zygote-core", "zygote-core,zygote-sim"),
    ("protocol", "zygote-protocol", "zygote-protocol,zygote-core,zygote-sim"),
];
/// Of a hundred mutants that compile, fewer than so many may be missed.
const MOST_MISSED_PER_CENT: u32 = 5;

/// What became of the mutants of a file.
#[derive(Debug, Default, Clone, Copy, PartialEq, Eq)]
struct Score {
    caught: u32,
    missed: u32,
    /// They don't compile.
    unviable: u32,
    /// The tests hung, so they saw it.
    timeout: u32,
}

impl AddAssign for Score {
    fn add_assign(&mut self, other: Self) {
        self.caught += other.caught;
        self.missed += other.missed;
        self.unviable += other.unviable;
        self.timeout += other.timeout;
    }
}

/// Runs the packages asked for, or all.
pub(crate) fn run(options: &[String]) -> Result<()> {
    let (packages, options) = parse(options)?;
    let cargo_mutants = tools::from_crates_io("cargo-mutants", "^27.1", &[])?;
    let mut total = Score::default();
    for (name, package, tests) in packages {
        let output = tools::root().join("target/mutants").join(name);
        fs::create_dir_all(&output).with_context(|| format!("cannot make {}", output.display()))?;
        let mut mutants = tools::command(&cargo_mutants);
        mutants.args(["mutants", "--package", package, "--test-package", tests, "--output"]).arg(&output);
        let ended = mutants.args(options).status().context("cannot start cargo-mutants")?;
        // 0: none was missed; 2: some were; 3: some hung. Anything else is no result.
        ensure!(matches!(ended.code(), Some(0 | 2 | 3)), "cargo-mutants on {package} ended with {ended}");
        let path = output.join("mutants.out/outcomes.json");
        let text = fs::read_to_string(&path).with_context(|| format!("cannot read {}", path.display()))?;
        let outcomes = serde_json::from_str(&text).with_context(|| path.display().to_string())?;
        let scores = scores(&outcomes).with_context(|| path.display().to_string())?;
        print(&scores);
        for score in scores.into_values() {
            total += score;
        }
    }
    ensure!(
        is_good(total),
        "{} of {} mutants missed: expected fewer than {MOST_MISSED_PER_CENT} %",
        total.missed,
        viable(total)
    );
    Ok(())
}

type Packages = Vec<&'static (&'static str, &'static str, &'static str)>;

fn parse(options: &[String]) -> Result<(Packages, &[String])> {
    let [first, rest @ ..] = options else { return Ok((PACKAGES.iter().collect(), options)) };
    if first != "--package" {
        return Ok((PACKAGES.iter().collect(), options));
    }
    let names = || PACKAGES.iter().map(|(name, ..)| *name).collect::<Vec<_>>().join(" or ");
    let [wanted, rest @ ..] = rest else { bail!("--package: expected {}, found nothing", names()) };
    let package = PACKAGES.iter().find(|(name, ..)| name == wanted);
    Ok((vec![package.with_context(|| format!("--package: expected {}, found `{wanted}`", names()))?], rest))
}

/// The score of each file.
fn scores(outcomes: &Value) -> Result<BTreeMap<String, Score>> {
    let mut scores: BTreeMap<String, Score> = BTreeMap::new();
    for outcome in outcomes["outcomes"].as_array().context("no outcomes")? {
        // The tests before any mutation have no file.
        let Some(file) = outcome["scenario"]["Mutant"]["file"].as_str() else { continue };
        let score = scores.entry(file.to_owned()).or_default();
        match outcome["summary"].as_str() {
            Some("CaughtMutant") => score.caught += 1,
            Some("MissedMutant") => score.missed += 1,
            Some("Unviable") => score.unviable += 1,
            Some("Timeout") => score.timeout += 1,
            other => bail!("a mutant of {file} came to {other:?}"),
        }
    }
    Ok(scores)
}

/// The mutants that compile.
fn viable(score: Score) -> u32 {
    score.caught + score.missed + score.timeout
}

fn is_good(score: Score) -> bool {
    score.missed * 100 < viable(score) * MOST_MISSED_PER_CENT
}

/// The table of the documentation page.
fn print(scores: &BTreeMap<String, Score>) {
    println!("| file | mutants | caught | timeout | missed | unviable |\n|---|--:|--:|--:|--:|--:|");
    let row = |name: &str, score: Score| {
        let Score { caught, missed, unviable, timeout } = score;
        let all = viable(score) + unviable;
        println!("| {name} | {all} | {caught} | {timeout} | {missed} | {unviable} |");
    };
    let mut total = Score::default();
    for (file, score) in scores {
        row(&format!("`{}`", file.rsplit('/').next().unwrap_or(file)), *score);
        total += *score;
    }
    row("all", total);
}

#[cfg(test)]
mod checks {
    use super::*;
    use serde_json::json;

    fn words(text: &str) -> Vec<String> {
        text.split_whitespace().map(str::to_owned).collect()
    }

    #[test]
    fn a_package_is_chosen_by_its_short_name_and_the_rest_is_handed_on() {
        let options = words("--package core --file a.rs");
        let (packages, rest) = parse(&options).unwrap();
        assert_eq!((packages, rest), (vec![&PACKAGES[0]], &options[2..]));
        assert_eq!(parse(&[]).unwrap().0.len(), PACKAGES.len());
        for wrong in ["--package", "--package sim"] {
            assert!(parse(&words(wrong)).is_err(), "{wrong}");
        }
    }

    #[test]
    fn outcomes_are_counted_by_file_and_an_unknown_one_is_refused() {
        let mutant =
            |file, summary| json!({ "scenario": { "Mutant": { "file": file } }, "summary": summary });
        let baseline = json!({ "scenario": "Baseline", "summary": "Success" });
        let outcomes = [
            baseline,
            mutant("a.rs", "CaughtMutant"),
            mutant("b.rs", "Timeout"),
            mutant("a.rs", "MissedMutant"),
            mutant("b.rs", "Unviable"),
        ];
        let expected = [
            ("a.rs".to_owned(), Score { caught: 1, missed: 1, ..Score::default() }),
            ("b.rs".to_owned(), Score { timeout: 1, unviable: 1, ..Score::default() }),
        ];
        assert_eq!(scores(&json!({ "outcomes": outcomes })).unwrap(), BTreeMap::from(expected));
        assert!(scores(&json!({ "outcomes": [mutant("a.rs", "Failure")] })).is_err());
        assert!(scores(&json!({})).is_err());
    }

    #[test]
    fn one_in_twenty_missed_is_too_many() {
        assert!(!is_good(Score { caught: 19, missed: 1, ..Score::default() }));
        assert!(is_good(Score { caught: 19, timeout: 1, missed: 1, ..Score::default() }));
        assert!(!is_good(Score::default()), "nothing was shown");
    }
}
