//! Calibrations of hinges on the simulated plant, held against what they truly are. `cargo xtask bench calibration` does the same at
//! length.
#![expect(clippy::expect_used, reason = "a helper that fails fails its test")]

#[path = "../examples/calibration_bench/drive.rs"]
mod drive;
#[path = "../examples/calibration_bench/faults.rs"]
mod faults;
#[path = "../examples/calibration_bench/hinges.rs"]
mod hinges;

use drive::{Ended, Session, session};
use faults::accepted;
use hinges::{Spread, Subject};
use zygote_calibration::{
    Bounds, Diagnosis, Next, Nominal, Purpose, Quantity, Record, RecordError, Refusal, Sample, Verdict, Why,
    fit, next, picture,
};
use zygote_sim::plant::{Fault, SmaConfig};

/// Seeds of their own, not those of the bench.
const SEED: u64 = 77_000;

fn default_hinge() -> Subject {
    let mut subject = Subject::new(SEED, Spread::Plant);
    subject.hinge = SmaConfig::opening(180.0);
    subject.config.heaters = vec![subject.hinge];
    subject.config.ambient_c = 22.0;
    subject.nominal = Nominal::default();
    subject
}

fn driven(subject: &Subject, fault: Option<(f64, Fault)>) -> Session {
    session(subject, &Bounds::default(), fault).expect("a plant that runs")
}

fn why(subject: &Subject, record: &Record, quantity: Quantity) -> Why {
    match fit(record, &subject.nominal).expect("a sound record").verdict(quantity) {
        Some(Verdict::NotIdentified { why }) => why,
        other => panic!("{quantity}: expected no value, got {other:?}"),
    }
}

#[test]
fn sound_hinges_are_measured_within_what_is_accepted_and_the_intervals_cover() {
    let (mut values, mut covered) = (0, 0);
    for seed in 0..5 {
        let subject = Subject::new(SEED + seed, Spread::Plant);
        let Session { record, ended } = driven(&subject, None);
        assert_eq!(ended, None, "hinge {seed}");
        let fit = fit(&record, &subject.nominal).unwrap();
        let has_af = fit.value(Quantity::AusteniteFinish).is_some();
        assert!(has_af || !subject.can_reach_af(20.0), "hinge {seed} has no Af");
        let held_out = fit.held_out.expect("a pulse was held out");
        assert!(held_out.worse_rmse_k() <= 2.0, "hinge {seed}: {held_out:?}");
        for quantity in Quantity::ALL {
            let truth = subject.truth(quantity);
            let Some(at) = fit.value(quantity) else { continue };
            let most = accepted(quantity, truth).expect("only the opening has none, and no value either");
            assert!((at.value - truth).abs() <= most, "hinge {seed}, {quantity}: {at:?} for {truth}");
            values += 1;
            covered += usize::from((at.low..=at.high).contains(&truth));
        }
    }
    assert!(values >= 40, "{values} values of 5 hinges");
    assert!(covered * 100 >= values * 90, "{covered} of {values} intervals cover the truth");
}

#[test]
fn a_coarse_measurement_of_current_widens_the_intervals_so_that_they_still_cover() {
    /// A count of the boards' converter.
    const STEP_A: f64 = 33.0 / 4_095.0;
    for heater_ohm in [20.0, 22.0, 24.0, 25.0, 26.0, 28.0, 30.0] {
        let mut subject = default_hinge();
        subject.hinge.heater_ohm = heater_ohm;
        subject.config.heaters = vec![subject.hinge];
        let mut record = driven(&subject, None).record;
        for current in record.samples.iter_mut().filter_map(|sample| sample.current_a.as_mut()) {
            // In whole milliamperes, as they are told.
            *current = ((*current / STEP_A).round() * STEP_A * 1e3).round() / 1e3;
        }
        let fit = fit(&record, &subject.nominal).unwrap();
        for quantity in [Quantity::HeaterResistance, Quantity::ThermalResistance] {
            let (at, truth) = (fit.value(quantity).unwrap(), subject.truth(quantity));
            assert!((at.low..=at.high).contains(&truth), "{heater_ohm} ohm, {quantity}: {at:?} for {truth}");
            assert!(at.high - at.low < 0.3 * truth, "{heater_ohm} ohm, {quantity}: {at:?} says nothing");
        }
    }
}

#[test]
fn a_hinge_that_breaks_meanwhile_is_given_no_wrong_value() {
    for verdict in faults::all(&Subject::new(SEED, Spread::Plant), &Bounds::default(), 150.0, SEED).unwrap() {
        assert!(!verdict.is_wrong(), "{verdict}");
        if matches!(verdict.fault, Fault::MosfetStuckOn(_)) {
            assert!(verdict.noticed && verdict.identified == 0, "{verdict}");
        }
    }
}

#[test]
fn a_fault_is_named_before_the_hinge_is_heated_on() {
    let subject = default_hinge();
    let refused = |fault| match driven(&subject, Some((0.0, fault))) {
        Session { ended: Some(Ended::Refused(Refusal::Fault(diagnosis))), record } => {
            assert!(record.drives.len() <= 1, "{diagnosis}: {} pulses", record.drives.len());
            assert_eq!(why(&subject, &record, Quantity::AusteniteFinish), Why::Fault(diagnosis));
            diagnosis
        }
        other => panic!("{fault:?}: expected a refusal, got {:?}", other.ended),
    };
    assert!(matches!(refused(Fault::HeaterOpen(0)), Diagnosis::HeaterOpen { .. }));
    assert!(matches!(
        refused(Fault::HeaterShorted { channel: 0, ohm: 3.0 }),
        Diagnosis::HeaterShorted { .. }
    ));
    assert!(matches!(refused(Fault::ThermistorLoose(0)), Diagnosis::Loose { .. }));
    assert!(matches!(refused(Fault::ThermistorFrozen(0)), Diagnosis::Frozen { .. }));
    assert!(matches!(refused(Fault::MosfetStuckOn(0)), Diagnosis::StuckOn { .. }));
    assert!(matches!(refused(Fault::SupplyCut), Diagnosis::SupplyLost { .. }));
}

#[test]
fn a_supply_too_weak_for_af_still_gives_the_thermal_values() {
    let mut subject = default_hinge();
    subject.config.supply.open_circuit_v = 3.1;
    let Session { record, ended } = driven(&subject, None);
    assert_eq!(ended, None);
    assert!(matches!(why(&subject, &record, Quantity::AusteniteFinish), Why::NotReached { .. }));
    let fit = fit(&record, &subject.nominal).unwrap();
    for quantity in [Quantity::ThermalResistance, Quantity::TimeConstant] {
        let (at, truth) = (fit.value(quantity).expect("seen below As"), subject.truth(quantity));
        assert!((at.value / truth - 1.0).abs() < 0.05, "{quantity}: {at:?} for {truth}");
    }
}

#[test]
fn a_jammed_hinge_has_every_thermal_value_and_no_opening() {
    let subject = default_hinge();
    let Session { record, .. } =
        driven(&subject, Some((0.0, Fault::Jammed(zygote_sim::plant::Hinge::Sma(0)))));
    assert_eq!(why(&subject, &record, Quantity::Opening), Why::AngleUnseen);
    assert!(fit(&record, &subject.nominal).unwrap().value(Quantity::AusteniteFinish).is_some());
}

#[test]
fn a_hinge_that_is_warm_already_is_refused_before_it_is_heated() {
    let mut subject = default_hinge();
    subject.config.ambient_c = 60.0;
    let Session { record, ended } = driven(&subject, None);
    assert!(record.drives.is_empty());
    assert!(matches!(ended, Some(Ended::Refused(Refusal::TooWarm { .. }))), "{ended:?}");
}

#[test]
fn a_limit_below_the_transformation_is_refused_before_it_is_heated() {
    let subject = default_hinge();
    let Session { record, .. } = driven(&subject, None);
    let cold = Record { samples: record.baseline().to_vec(), drives: Vec::new() };
    let bounds = Bounds { max_temperature_c: 70.0, ..Bounds::default() };
    let refused = next(&cold, &subject.nominal, &bounds);
    assert_eq!(refused, Err(Refusal::LimitTooLow { limit_c: 70.0, as_c: 68.0 }));
}

#[test]
fn no_pulse_leaves_the_bounds() {
    let bounds = Bounds { max_temperature_c: 100.0, max_on_s: 12.0, min_rest_s: 0.5 };
    for seed in 0..2 {
        let subject = Subject::new(SEED + seed, Spread::Plant);
        let Session { record, ended } = session(&subject, &bounds, None).unwrap();
        assert_eq!(ended, None, "hinge {seed}");
        assert_eq!(record.drives.len(), Purpose::ALL.len());
        for drive in &record.drives {
            assert!(drive.until_s - drive.from_s <= 12.0 + 1e-6, "hinge {seed}: {drive:?}");
        }
        let highest = record.samples.iter().map(|sample| sample.reading_c).fold(0.0, f64::max);
        assert!(highest < 100.0, "hinge {seed}: {highest} °C");
    }
}

#[test]
fn an_interrupted_calibration_is_taken_up_where_it_ended() {
    let subject = default_hinge();
    let bounds = Bounds { min_rest_s: 120.0, ..Bounds::default() };
    let whole = session(&subject, &bounds, None).unwrap().record;
    // The host was away from half a minute after the second pulse until shortly before the third.
    let away = whole.drives[1].until_s + 30.0..whole.drives[2].from_s - 2.0;
    let mut resumed = whole.clone();
    resumed.samples.retain(|sample| !away.contains(&sample.t_s));
    assert!(whole.samples.len() - resumed.samples.len() > 800);
    assert_eq!(next(&resumed, &subject.nominal, &Bounds::default()), Ok(Next::Done));
    let (once, twice) = (fit(&whole, &subject.nominal).unwrap(), fit(&resumed, &subject.nominal).unwrap());
    for quantity in [Quantity::ThermalResistance, Quantity::TimeConstant, Quantity::AusteniteFinish] {
        let (once, twice) = (once.value(quantity).unwrap(), twice.value(quantity).unwrap());
        assert!((once.value / twice.value - 1.0).abs() < 0.01, "{quantity}: {once:?}, {twice:?}");
    }
}

#[test]
fn a_record_fits_the_same_each_time_and_is_drawn() {
    let subject = default_hinge();
    let record = driven(&subject, None).record;
    let once = fit(&record, &subject.nominal).unwrap();
    assert_eq!(once, fit(&record, &subject.nominal).unwrap());
    let svg = picture(&record, &once);
    assert_eq!(svg.matches("<rect").count(), 1 + record.drives.len());
    assert!(svg.contains("held out") && svg.contains("Af ") && svg.ends_with("</svg>\n"));
}

#[test]
fn a_record_that_contradicts_itself_is_refused_with_its_place() {
    let sample = |t_s| Sample { t_s, reading_c: 22.0, voltage_v: 5.0, current_a: Some(0.0) };
    let backwards = Record { samples: vec![sample(1.0), sample(0.5)], drives: Vec::new() };
    let error = fit(&backwards, &Nominal::default()).unwrap_err();
    assert_eq!(error, RecordError::SampleTime { index: 1, after_s: 1.0, got_s: 0.5 });
    assert_eq!(error.to_string(), "sample 1: expected a time after 1 s, got 0.5 s");
    let blind = Record { samples: vec![Sample { reading_c: f64::NAN, ..sample(0.0) }], drives: Vec::new() };
    assert!(matches!(fit(&blind, &Nominal::default()), Err(RecordError::SampleValue { index: 0, .. })));
}

#[test]
fn a_record_without_a_ramp_gives_no_values() {
    let subject = default_hinge();
    let mut record = driven(&subject, None).record;
    let end = record.samples.partition_point(|sample| sample.t_s < record.drives[2].from_s);
    record.samples.truncate(end);
    record.drives.truncate(2);
    assert_eq!(why(&subject, &record, Quantity::AusteniteStart), Why::TooShort { missing: "ramp" });
}
