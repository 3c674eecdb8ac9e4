//! A short campaign, and that its trials are what they claim to be.
#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]

use super::*;

const SEED: u64 = 1;

#[test]
fn two_thousand_random_trials_break_no_rule() {
    let summary = run(Work::Deploy, SEED, 2_000, 2).unwrap();
    println!("{summary}");
    assert_eq!(summary.runs, 2_000);
    assert!(summary.failures.is_empty(), "seed {SEED}: {:#?}", summary.failures);
}

#[test]
fn random_calibrations_break_no_rule() {
    let summary = run(Work::Calibrate, SEED, 10, 2).unwrap();
    println!("{summary}");
    assert!(summary.failures.is_empty(), "seed {SEED}: {:#?}", summary.failures);
    assert!(summary.endings.contains_key("calibrated"), "{:?}", summary.endings);
}

#[test]
fn a_trial_replays_to_the_bit() {
    for number in 0..5 {
        let once = fingerprint(&replay(Work::Deploy, SEED, number, false).unwrap().1);
        let again = replay(Work::Deploy, SEED, number, true).unwrap().1;
        assert_eq!(once, fingerprint(&again), "trial {number}");
        assert!(!again.witness.log().is_empty());
    }
}

#[test]
fn other_numbers_and_other_seeds_give_other_trials() {
    let print = |seed, number| fingerprint(&replay(Work::Deploy, seed, number, false).unwrap().1);
    assert_ne!(print(SEED, 0), print(SEED, 1));
    assert_ne!(print(SEED, 0), print(SEED + 1, 0));
}
