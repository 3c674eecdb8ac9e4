//! Hinges on the simulated plant that change after their calibration, and hinges that don't. `cargo xtask bench calibration --drift N` does
//! the same at length.
#![expect(clippy::expect_used, reason = "a helper that fails fails its test")]

#[path = "../examples/calibration_bench/drifts.rs"]
mod drifts;
#[path = "../examples/calibration_bench/drive.rs"]
mod drive;
#[path = "../examples/calibration_bench/hinges.rs"]
mod hinges;

use drifts::{Calibrated, Since, calibrate, opened};
use hinges::{Spread, Subject};
use std::collections::BTreeMap;
use zygote_calibration::{
    Bounds, Change, Doing, Drift, Known, Look, Nominal, Quantity, Sighting, Unclear, drift,
};

/// Seeds of their own, not those of the bench.
const SEED: u64 = 91_000;
const HINGES: usize = 4;

/// Hinges whose supply takes them far past Af, a tenth weaker too; calibrated.
fn hinges() -> Vec<(Subject, Calibrated)> {
    (SEED..)
        .map(|seed| Subject::new(seed, Spread::Plant))
        .filter(|subject| subject.can_reach_af(6.0))
        .filter_map(|subject| {
            let calibrated = calibrate(&subject, &Bounds::default()).expect("a plant that runs")?;
            Some((subject, calibrated))
        })
        .take(HINGES)
        .collect()
}

#[test]
fn hinges_that_changed_are_named_with_what_changed_and_no_others_are() {
    let hinges = hinges();
    for since in Since::ALL {
        let (mut named, mut must) = (0, 0);
        for (at, (subject, calibrated)) in hinges.iter().enumerate() {
            let drift = opened(subject, calibrated, since, 7 + at as u64).expect("a plant that runs");
            must += usize::from(matters(subject, since));
            let Drift::Recalibrate { changes } = &drift else { continue };
            assert!(is_named(changes, since), "hinge {at}, {}: {drift:?}", since.name());
            named += usize::from(matters(subject, since));
        }
        // A run may be too short to tell, as for one of them.
        assert!(named + 1 >= must, "{}: {named} of {must} named", since.name());
    }
}

/// What is said to have changed has.
fn is_named(changes: &[Change], since: Since) -> bool {
    let named = |wanted: Quantity| {
        let is = |change: &Change| matches!(change, Change::Value { quantity, .. } if *quantity == wanted);
        changes.iter().any(is)
    };
    match since {
        Since::Nothing => false,
        Since::HeaterUpTenPercent => named(Quantity::HeaterResistance),
        Since::ConvectionUpThirtyPercent => named(Quantity::FoilRise) || named(Quantity::TimeConstant),
        Since::AlloyUpFiveKelvin | Since::ThermistorDownTenPercent => named(Quantity::AusteniteFinish),
        Since::ThermistorDrifts => true,
    }
}

/// A hinge that gives most of its heat to its panels hardly notices the air.
fn matters(subject: &Subject, since: Since) -> bool {
    let mut changed = subject.hinge;
    since.change(&mut changed);
    let rise =
        |hinge| Subject { config: subject.config.clone(), hinge, ..*subject }.truth(Quantity::FoilRise);
    match since {
        Since::Nothing => false,
        Since::ConvectionUpThirtyPercent => rise(changed) / rise(subject.hinge) < 0.88,
        Since::HeaterUpTenPercent
        | Since::AlloyUpFiveKelvin
        | Since::ThermistorDownTenPercent
        | Since::ThermistorDrifts => true,
    }
}

fn look(t_s: f64, doing: Doing) -> Look {
    Look { t_s, doing, reading_c: 22.0 + 10.0 * t_s, duty: 1.0, voltage_v: 5.0 }
}

fn known() -> Known {
    let exact = |value: f64| zygote_calibration::Interval { value, low: value * 0.99, high: value * 1.01 };
    Known(BTreeMap::from([
        (Quantity::HeaterResistance, exact(25.0)),
        (Quantity::FoilRise, exact(110.0)),
        (Quantity::TimeConstant, exact(5.4)),
        (Quantity::AusteniteStart, exact(68.0)),
        (Quantity::AusteniteFinish, exact(78.0)),
    ]))
}

#[test]
fn a_hinge_that_was_seldom_seen_or_did_not_open_is_not_judged() {
    let seldom = Sighting {
        started_s: 0.0,
        opened_s: Some(6.0),
        looks: (0..6).map(|at| look(0.1 + f64::from(at), Doing::Heating)).collect(),
    };
    let unclear = |known: &Known, sighting: &Sighting| match drift(known, &Nominal::default(), sighting, None)
    {
        Drift::CannotTell { why } => why,
        other => panic!("{other:?}"),
    };
    let why = unclear(&known(), &seldom);
    assert_eq!(why, Unclear::SeldomSeen { seen: 6, of: 60, expected: 30 });
    assert!(why.to_string().contains("seen 6 times of 60") && why.to_string().contains("at most 8 hinges"));
    assert_eq!(unclear(&known(), &Sighting { opened_s: None, ..seldom.clone() }), Unclear::NotOpened);
    let mut less = known();
    less.0.remove(&Quantity::AusteniteFinish);
    assert_eq!(unclear(&less, &seldom), Unclear::Unknown(Quantity::AusteniteFinish));
}

#[test]
fn a_hinge_that_does_not_read_like_any_is_named_as_such() {
    // Warmer by 10 K in every second, whatever its heater does.
    let looks = (1..150).map(|at| {
        let doing = if at < 70 { Doing::Heating } else { Doing::Cooling };
        Look { duty: if at < 70 { 1.0 } else { 0.0 }, ..look(f64::from(at) * 0.1, doing) }
    });
    let sighting = Sighting { started_s: 0.0, opened_s: Some(6.95), looks: looks.collect() };
    match drift(&known(), &Nominal::default(), &sighting, None) {
        Drift::Recalibrate { changes } => {
            assert!(changes.iter().any(|change| matches!(change, Change::Misfit { .. })), "{changes:?}");
        }
        other => panic!("{other:?}"),
    }
}
