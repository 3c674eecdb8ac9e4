//! What is broken, as far as temperature, voltage and current tell. Judged before every pulse and before the fit, for a
//! broken hinge must neither be heated on nor be given values.

use crate::nominal::Nominal;
use crate::record::{Drive, Record, Sample};

/// A fault that the readings show.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum Diagnosis {
    /// The reading is at a rail of the converter.
    #[error(
        "no thermistor: it read {reading_c:.0} °C at {t_s:.1} s, expected -40 to 200 °C; open, shorted or not there"
    )]
    NoSensor {
        /// When first.
        t_s: f64,
        /// What it read.
        reading_c: f64,
    },
    /// The same reading again and again although power flows.
    #[error(
        "the thermistor read {reading_c:.2} °C without any change for {for_s:.1} s while the heater was on: frozen"
    )]
    Frozen {
        /// The reading.
        reading_c: f64,
        /// How long.
        for_s: f64,
    },
    /// Power flows and the reading stays.
    #[error(
        "{energy_j:.2} J into the heater warmed the thermistor by {rise_k:.2} K, expected at least {expected_k:.2} K: it is loose or another hinge's"
    )]
    Loose {
        /// Energy of the pulse.
        energy_j: f64,
        /// Rise of the reading.
        rise_k: f64,
        /// The least that a sound hinge shows.
        expected_k: f64,
    },
    /// No current flows when it should.
    #[error(
        "the heater drew {got_a:.3} A at {voltage_v:.2} V, expected about {expected_a:.3} A: it or its MOSFET is open"
    )]
    HeaterOpen {
        /// Mean current.
        got_a: f64,
        /// Mean voltage.
        voltage_v: f64,
        /// What the nominal resistance draws.
        expected_a: f64,
    },
    /// Far more current flows than should.
    #[error(
        "the heater has {got_ohm:.1} ohm, expected about {expected_ohm:.1} ohm: shorted, or another kind of heater"
    )]
    HeaterShorted {
        /// Measured.
        got_ohm: f64,
        /// Nominal.
        expected_ohm: f64,
    },
    /// Its resistance isn't the same in every pulse.
    #[error(
        "the heater had {first_ohm:.2} ohm in one pulse and {later_ohm:.2} ohm later: a bad contact, a short, or another consumer on the supply"
    )]
    HeaterChanged {
        /// In the earlier one.
        first_ohm: f64,
        /// In the later one.
        later_ohm: f64,
    },
    /// Current or warmth without a pulse.
    #[error(
        "with the heater off the supply gave {got_a:.3} A, expected at most {expected_a:.3} A: its MOSFET conducts, or another consumer is on"
    )]
    StuckOn {
        /// Mean current while off.
        got_a: f64,
        /// The most that is no sign of it.
        expected_a: f64,
    },
    /// The supply isn't there, before the first pulse or during one.
    #[error("the supply gave {got_v:.2} V, expected at least {expected_v:.2} V")]
    SupplyLost {
        /// Lowest voltage before the first pulse or during one.
        got_v: f64,
        /// The least for a measurement.
        expected_v: f64,
    },
    /// The reading at rest isn't what it was.
    #[error(
        "the thermistor came to rest {change_k:+.2} K from where it began, expected within {expected_k:.2} K: it drifts, or the air changed"
    )]
    Drifting {
        /// The change.
        change_k: f64,
        /// The most that is accepted.
        expected_k: f64,
    },
}

/// What the electrical readings say of the heater.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Electrical {
    /// Resistance.
    pub ohm: f64,
    /// Standard error of that.
    pub error_ohm: f64,
}

const READABLE_C: core::ops::RangeInclusive<f64> = -40.0..=200.0;
/// Fewer samples of a pulse say nothing of its current.
const FEWEST: usize = 4;
/// A supply below this is as good as none.
const LEAST_V: f64 = 1.0;

/// The first fault that the record shows.
pub(crate) fn first_fault(record: &Record, nominal: &Nominal) -> Option<Diagnosis> {
    no_sensor(record)
        .or_else(|| supply_lost(record))
        .or_else(|| heater(record, nominal))
        .or_else(|| stuck_on(record, nominal))
        .or_else(|| frozen(record))
        .or_else(|| loose(record, nominal))
}

fn no_sensor(record: &Record) -> Option<Diagnosis> {
    let sample = record.samples.iter().find(|sample| !READABLE_C.contains(&sample.reading_c))?;
    Some(Diagnosis::NoSensor { t_s: sample.t_s, reading_c: sample.reading_c })
}

fn supply_lost(record: &Record) -> Option<Diagnosis> {
    let driven = record.drives.iter().flat_map(|drive| record.during(drive));
    // At the input of the main switch it is there at rest too.
    let got_v = driven.chain(record.baseline()).map(|sample| sample.voltage_v).fold(f64::INFINITY, f64::min);
    (got_v < LEAST_V).then_some(Diagnosis::SupplyLost { got_v, expected_v: LEAST_V })
}

/// The heater's resistance over all pulses in which it was on alone, by least squares in the current, less what else flows at rest.
pub(crate) fn electrical(record: &Record) -> Option<Electrical> {
    let off: Vec<&Sample> = resting(record).filter(|sample| sample.current_a.is_some()).collect();
    let others_a = median_a(off.iter().copied());
    let found = resistance(record, &record.drives, others_a)?;
    // What flows at rest is known to a part of the converter's step, and all that is wrong with it is wrong with every pulse.
    let error_a = rounding_a(record).hypot(5e-3 / (off.len().max(1) as f64).sqrt());
    let (sum_a, count) = record
        .drives
        .iter()
        .flat_map(|drive| record.during(drive))
        .filter_map(|sample| sample.current_a)
        .fold((0.0, 0_u32), |(sum_a, count), current_a| (sum_a + current_a - others_a, count + 1));
    let share = error_a * f64::from(count) / sum_a;
    Some(Electrical { ohm: found.ohm, error_ohm: found.error_ohm.hypot(found.ohm * share) })
}

/// The standard deviation of what the converter rounds away: that of its step, which is the least by which two readings differ. A
/// steady current is rounded the same way every time, so that many readings know it no better than one.
fn rounding_a(record: &Record) -> f64 {
    const LEAST_STEP_A: f64 = 1e-3;
    /// Coarser than any converter that can tell a heater from none: then currents are few, not rounded.
    const MOST_STEP_A: f64 = 10e-3;
    let mut currents: Vec<f64> = record.samples.iter().filter_map(|sample| sample.current_a).collect();
    currents.sort_by(f64::total_cmp);
    let steps = currents.windows(2).map(|pair| pair[1] - pair[0]).filter(|step| *step > LEAST_STEP_A / 2.0);
    let step = steps.fold(MOST_STEP_A, f64::min).max(LEAST_STEP_A);
    step / 12.0_f64.sqrt()
}

/// What flows with the heater off before the first pulse.
fn others_a(record: &Record) -> f64 {
    median_a(record.baseline().iter())
}

/// The median, because a converter cuts noise off at 0.
fn median_a<'a>(samples: impl Iterator<Item = &'a Sample>) -> f64 {
    let mut currents: Vec<f64> = samples.filter_map(|sample| sample.current_a).collect();
    currents.sort_by(f64::total_cmp);
    currents.get(currents.len() / 2).copied().unwrap_or(0.0)
}

/// The samples with the heater off, a little after a pulse and before the next.
fn resting(record: &Record) -> impl Iterator<Item = &Sample> {
    const SETTLE_S: f64 = 0.15;
    record.samples.iter().filter(|sample| {
        let begun = record.drives.partition_point(|drive| drive.from_s - SETTLE_S <= sample.t_s);
        let latest = begun.checked_sub(1).and_then(|index| record.drives.get(index));
        latest.is_none_or(|drive| drive.until_s + SETTLE_S < sample.t_s)
    })
}

fn resistance(record: &Record, drives: &[Drive], others_a: f64) -> Option<Electrical> {
    let pairs: Vec<(f64, f64)> = drives
        .iter()
        .flat_map(|drive| record.during(drive).iter().map(|sample| (drive.duty * sample.voltage_v, sample)))
        .filter_map(|(mean_v, sample)| Some((mean_v, sample.current_a? - others_a)))
        .collect();
    if pairs.len() < FEWEST {
        return None;
    }
    let squares: f64 = pairs.iter().map(|(v, _)| v * v).sum();
    let siemens = pairs.iter().map(|(v, a)| v * a).sum::<f64>() / squares;
    let rest: f64 = pairs.iter().map(|(v, a)| (a - siemens * v).powi(2)).sum();
    let error_s = (rest / (pairs.len() - 1) as f64 / squares).sqrt();
    // A converter that always says the same leaves its rounding.
    let error_s = error_s.max(rounding_a(record) / squares.sqrt());
    Some(Electrical { ohm: 1.0 / siemens, error_ohm: error_s / (siemens * siemens) })
}

fn heater(record: &Record, nominal: &Nominal) -> Option<Diagnosis> {
    // A part that strays from its data sheet by more than this is another part.
    const MOST: f64 = 2.5;
    const OPEN: f64 = 5.0;
    let others_a = others_a(record);
    let mut first: Option<Electrical> = None;
    for drive in &record.drives {
        let Some(now) = resistance(record, core::slice::from_ref(drive), others_a) else { continue };
        let samples = record.during(drive);
        let voltage_v = samples.iter().map(|sample| sample.voltage_v).sum::<f64>() / samples.len() as f64;
        let expected_a = drive.duty * voltage_v / nominal.heater_ohm;
        let got_a = drive.duty * voltage_v / now.ohm;
        if got_a < expected_a / OPEN {
            return Some(Diagnosis::HeaterOpen { got_a, voltage_v, expected_a });
        }
        if got_a > expected_a * MOST && now.ohm + 4.0 * now.error_ohm < nominal.heater_ohm / MOST * 1.2 {
            return Some(Diagnosis::HeaterShorted { got_ohm: now.ohm, expected_ohm: nominal.heater_ohm });
        }
        let within = changed_within(record, drive, others_a);
        if let Some((first, later)) = first.map(|first| (first, now)).filter(differ).or(within) {
            return Some(Diagnosis::HeaterChanged { first_ohm: first.ohm, later_ohm: later.ohm });
        }
        first = first.or(Some(now));
    }
    None
}

/// Two resistances that one heater can't have.
fn differ((first, later): &(Electrical, Electrical)) -> bool {
    let most = 0.04 * first.ohm + 4.5 * later.error_ohm.hypot(first.error_ohm);
    (later.ohm - first.ohm).abs() > most
}

/// A heater that changes in the midst of a pulse: what is measured of the whole is then a mixture with a wide error.
fn changed_within(record: &Record, drive: &Drive, others_a: f64) -> Option<(Electrical, Electrical)> {
    const SPLITS: [f64; 3] = [0.35, 0.5, 0.65];
    // Few samples may look quieter than they are.
    const NOISE_A: f64 = 5e-3;
    let part = |from_s: f64, until_s: f64| {
        let part = Drive { from_s, until_s, ..*drive };
        let found = resistance(record, &[part], others_a)?;
        let squares: f64 =
            record.during(&part).iter().map(|sample| (drive.duty * sample.voltage_v).powi(2)).sum();
        let least_ohm = NOISE_A / squares.sqrt() * found.ohm * found.ohm;
        Some(Electrical { error_ohm: found.error_ohm.max(least_ohm), ..found })
    };
    SPLITS.into_iter().find_map(|share| {
        let split_s = drive.from_s + share * (drive.until_s - drive.from_s);
        part(drive.from_s, split_s).zip(part(split_s, drive.until_s)).filter(differ)
    })
}

/// Looks for current in every rest, the one before the first pulse too.
fn stuck_on(record: &Record, nominal: &Nominal) -> Option<Diagnosis> {
    const WINDOW: usize = 8;
    let voltage_v = record.samples.iter().map(|sample| sample.voltage_v).fold(0.0, f64::max);
    // A fifth of what the heater would draw.
    let expected_a = others_a(record) + 0.2 * voltage_v / nominal.heater_ohm;
    let resting: Vec<f64> = resting(record).filter_map(|sample| sample.current_a).collect();
    let worst_a =
        resting.windows(WINDOW).map(|window| window.iter().sum::<f64>() / WINDOW as f64).fold(0.0, f64::max);
    if worst_a > expected_a {
        return Some(Diagnosis::StuckOn { got_a: worst_a, expected_a });
    }
    // From the first moment on, the current looks like another consumer's; but the hinge warms at rest.
    let baseline = record.baseline();
    let (first, last) = (baseline.first()?, baseline.last()?);
    let most_k = 1.0 + 12.0 * nominal.sensor.k_per_count(last.reading_c);
    let flowing_a = others_a(record);
    let warms = last.reading_c - first.reading_c > most_k;
    warms.then_some(Diagnosis::StuckOn { got_a: flowing_a, expected_a: 0.2 * voltage_v / nominal.heater_ohm })
}

/// A sound thermistor's noise and the hinge's own warming move the count every few samples.
fn frozen(record: &Record) -> Option<Diagnosis> {
    const LEAST_S: f64 = 1.0;
    const FEWEST_SAME: usize = 9;
    for drive in &record.drives {
        let samples = record.during(drive);
        let early = samples.partition_point(|sample| sample.t_s < drive.from_s + LEAST_S + 1.5);
        // Later it may have settled.
        let Some(samples) = samples.get(..early) else { continue };
        let same = samples.chunk_by(|a, b| a.reading_c.to_bits() == b.reading_c.to_bits());
        for run in same.filter(|run| run.len() >= FEWEST_SAME) {
            let (Some(first), Some(last)) = (run.first(), run.last()) else { continue };
            let for_s = last.t_s - first.t_s;
            if for_s >= LEAST_S {
                return Some(Diagnosis::Frozen { reading_c: first.reading_c, for_s });
            }
        }
    }
    None
}

/// Holds each pulse's rise against a part of what the nominal hinge would show.
fn loose(record: &Record, nominal: &Nominal) -> Option<Diagnosis> {
    // Half of a hinge's heat may be latent, and a data sheet is off by a factor of 2.
    const LEAST_SHARE: f64 = 0.1;
    const NOISE_COUNTS: f64 = 10.0;
    // A lagging bead has followed by then.
    const AFTER_S: f64 = 0.5;
    let heater = electrical(record)?;
    let start_c = record.samples.first()?.reading_c;
    for drive in &record.drives {
        let samples = record.during(drive);
        let (Some(first), Some(last)) = (samples.first(), samples.last()) else { continue };
        let on_s = last.t_s - first.t_s;
        let volts_squared: f64 = samples.iter().map(|sample| sample.voltage_v.powi(2)).sum();
        let power_w = drive.duty * volts_squared / samples.len() as f64 / heater.ohm;
        let settling = 1.0 - (-on_s / nominal.time_constant_s).exp();
        // A hinge that is warm already rises less.
        let sound_k = power_w * nominal.thermal_resistance_k_per_w * settling;
        let expected_k = LEAST_SHARE * sound_k - (first.reading_c - start_c).max(0.0);
        let range = record.index_after(drive.from_s)..record.index_after(drive.until_s + AFTER_S);
        let after = record.samples.get(range).unwrap_or_default();
        let peak_c = after.iter().map(|sample| sample.reading_c).fold(first.reading_c, f64::max);
        let rise_k = peak_c - first.reading_c;
        let seen_k = NOISE_COUNTS * nominal.sensor.k_per_count(first.reading_c);
        if expected_k > seen_k && on_s > 3.0 * nominal.lag_s && rise_k < expected_k {
            return Some(Diagnosis::Loose { energy_j: power_w * on_s, rise_k, expected_k });
        }
    }
    None
}
