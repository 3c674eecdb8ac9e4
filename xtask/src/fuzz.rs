//! `cargo xtask fuzz [--seconds N] [TARGET ..]`: runs the fuzz targets under `fuzz/`, a minute each unless told.
//!
//! cargo-fuzz asks for a nightly compiler, but what it needs of one is coverage and no sanitizer, which the stable one gives
//! when it is asked to. What is found goes to `fuzz/artifacts`; new inputs stay in `target/fuzz-corpus`, and those worth
//! keeping are copied to `fuzz/corpus` by hand, where `cargo test` replays them.

use crate::tools;
use anyhow::{Context, Result, bail, ensure};
use std::fs;

/// A target has a file of this name under `fuzz/fuzz_targets` and `fuzz/bodies`, and a folder under `fuzz/corpus`.
const TARGETS: &[&str] = &["frame", "message", "core", "plan", "rig", "schedule"];
const SECONDS: u32 = 60;
/// Longest input; plans are the longest.
const LONGEST: u32 = 8_192;

/// Runs the targets asked for, or all.
pub(crate) fn run(options: &[String]) -> Result<()> {
    let (seconds, targets) = parse(options)?;
    let cargo_fuzz = tools::from_crates_io("cargo-fuzz", "^0.13", &[]).context(
        "without cargo-fuzz nothing can be fuzzed; the corpus is replayed by `cargo xtask unit` all the same",
    )?;
    let root = tools::root();
    for target in &targets {
        let found = root.join("target/fuzz-corpus").join(target);
        fs::create_dir_all(&found).with_context(|| format!("cannot make {}", found.display()))?;
        let mut fuzz = tools::command(&cargo_fuzz);
        // Called by itself, cargo-fuzz wants the word that cargo would give it.
        fuzz.args(["fuzz", "run", "--fuzz-dir", "fuzz", "--sanitizer", "none", "--target-dir"]);
        fuzz.arg(root.join("target/fuzz")).arg(target).arg(&found).arg(root.join("fuzz/corpus").join(target));
        fuzz.args(["--", &format!("-max_total_time={seconds}"), &format!("-max_len={LONGEST}")]);
        fuzz.args(["-print_final_stats=1", "-verbosity=0"]).env("RUSTC_BOOTSTRAP", "1");
        tools::run(&mut fuzz).with_context(|| format!("target {target}"))?;
    }
    println!("\n{} targets, {seconds} s each: nothing found", targets.len());
    Ok(())
}

fn parse(options: &[String]) -> Result<(u32, Vec<&str>)> {
    let (mut seconds, mut targets) = (SECONDS, Vec::new());
    let mut options = options.iter();
    while let Some(option) = options.next() {
        if option == "--seconds" {
            let value = options.next().context("--seconds: expected a number, found nothing")?;
            seconds =
                value.parse().with_context(|| format!("--seconds: expected a number, found `{value}`"))?;
            ensure!(seconds > 0, "--seconds: expected at least 1");
        } else if TARGETS.contains(&option.as_str()) {
            targets.push(option.as_str());
        } else {
            bail!("`{option}`: expected --seconds N or one of {}", TARGETS.join(", "));
        }
    }
    if targets.is_empty() {
        targets.extend(TARGETS);
    }
    Ok((seconds, targets))
}

#[cfg(test)]
mod checks {
    use super::*;

    fn words(text: &str) -> Vec<String> {
        text.split_whitespace().map(str::to_owned).collect()
    }

    #[test]
    fn without_options_every_target_runs_for_a_minute() {
        assert_eq!(parse(&[]).unwrap(), (60, TARGETS.to_vec()));
    }

    #[test]
    fn seconds_and_targets_are_heeded_and_the_rest_is_refused() {
        assert_eq!(parse(&words("--seconds 5 core rig")).unwrap(), (5, vec!["core", "rig"]));
        for wrong in ["--seconds", "--seconds x", "--seconds 0", "cores"] {
            assert!(parse(&words(wrong)).is_err(), "{wrong}");
        }
    }

    #[test]
    fn every_target_has_its_body_and_its_corpus() {
        for target in TARGETS {
            let fuzz = tools::root().join("fuzz");
            for file in
                ["fuzz_targets", "bodies"].map(|folder| fuzz.join(folder).join(format!("{target}.rs")))
            {
                assert!(file.is_file(), "{}", file.display());
            }
            assert!(fuzz.join("corpus").join(target).is_dir(), "no corpus for {target}");
        }
    }
}
