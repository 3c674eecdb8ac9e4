//! What was calibrated, in the words of the calibration file, and as a table that marks hinges unlike the others.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;
use zygote_calibration::{Estimate, Fit, Quantity, Verdict};
use zygote_controller::calibrate::{Ending, Hinge};
use zygote_deployment::{Calibrated, CalibratedHinge, CalibrationVerdict};

/// Without these a hinge is not calibrated: schedules and boards go by them.
const ESSENTIAL: [Quantity; 5] = [
    Quantity::HeaterResistance,
    Quantity::FoilRise,
    Quantity::TimeConstant,
    Quantity::AusteniteStart,
    Quantity::AusteniteFinish,
];
/// A hinge so many median deviations from the median is unlike the others (Iglewicz and Hoaglin 1993) ..
const OUTLIER_SCORE: f64 = 3.5;
/// .. by at least this share: hinges that are all but equal have none.
const OUTLIER_SHARE: f64 = 0.05;
/// The normal distribution's standard deviation is so many median deviations.
const SIGMA_PER_MAD: f64 = 1.4826;
/// Fewer hinges have no outlier.
const FEWEST: usize = 5;

/// The key of a quantity in the calibration file.
pub(crate) fn key(quantity: Quantity) -> String {
    quantity.key()
}

/// A hinge's part of the calibration file.
pub(crate) fn hinge_of(hinge: &Hinge, fit: &Fit, date: &str, firmware: &str) -> CalibratedHinge {
    let told = |value: f64, quantity: Quantity| format!("{value:.4} {}", quantity.ascii_unit());
    let calibrated = |Estimate { quantity, verdict }: &Estimate| match verdict {
        Verdict::Identified(interval) => Calibrated::Known {
            value: told(interval.value, *quantity),
            low: told(interval.low, *quantity),
            high: told(interval.high, *quantity),
        },
        Verdict::NotIdentified { why } => Calibrated::Unknown { unknown: why.to_string() },
    };
    let why = match &hinge.ending {
        Some(Ending::Refused(why) | Ending::Fault(why)) => Some(why.clone()),
        Some(Ending::Done) | None => None,
    };
    let knows = |quantity: &Quantity| fit.value(*quantity).is_some();
    let verdict = if why.is_some() || fit.fault.is_some() {
        CalibrationVerdict::Failed
    } else if ESSENTIAL.iter().all(knows) {
        CalibrationVerdict::Calibrated
    } else {
        CalibrationVerdict::Incomplete
    };
    // What a hinge that failed seemed to be like is nobody's value.
    let values = match verdict {
        CalibrationVerdict::Failed => BTreeMap::new(),
        CalibrationVerdict::Calibrated | CalibrationVerdict::Incomplete => {
            fit.estimates.iter().map(|estimate| (key(estimate.quantity), calibrated(estimate))).collect()
        }
    };
    let mut residuals = BTreeMap::new();
    if let Some(of) = &fit.residuals {
        residuals.insert("rmse".to_owned(), format!("{:.3} K", of.rmse_k));
        residuals.insert("worst".to_owned(), format!("{:.3} K", of.worst_k));
    }
    if let Some(held_out) = &fit.held_out {
        residuals.insert("held_out_rmse".to_owned(), format!("{:.3} K", held_out.worse_rmse_k()));
    }
    let baseline = hinge.record.baseline();
    let ambient_c = baseline.get(baseline.len() / 2).map(|sample| sample.reading_c);
    CalibratedHinge {
        hinge: hinge.number,
        channel: hinge.channel,
        date: date.to_owned(),
        firmware: firmware.to_owned(),
        verdict,
        why: why.or_else(|| fit.fault.map(|fault| fault.to_string())),
        ambient: ambient_c.map(|celsius| format!("{celsius:.2} degC")),
        residuals,
        values,
        servo: None,
    }
}

/// What is missing of an incomplete calibration, and why.
pub(crate) fn essential(hinge: &CalibratedHinge) -> Option<String> {
    let missing = |quantity: &Quantity| match hinge.values.get(&key(*quantity)) {
        Some(Calibrated::Unknown { unknown }) => Some(format!("no {quantity}: {unknown}")),
        Some(Calibrated::Known { .. }) | None => None,
    };
    ESSENTIAL.iter().find_map(missing)
}

/// The number of a value that is known.
fn number(hinge: &CalibratedHinge, quantity: Quantity) -> Option<f64> {
    match hinge.values.get(&key(quantity))? {
        Calibrated::Known { value, .. } => value.split(' ').next()?.parse().ok(),
        Calibrated::Unknown { .. } => None,
    }
}

/// Hinges whose value is unlike that of the others.
pub(crate) fn outliers(hinges: &[CalibratedHinge], quantity: Quantity) -> BTreeSet<usize> {
    let values: Vec<(usize, f64)> =
        hinges.iter().filter_map(|hinge| Some((hinge.hinge, number(hinge, quantity)?))).collect();
    if values.len() < FEWEST {
        return BTreeSet::new();
    }
    let middle = median(values.iter().map(|(_, value)| *value));
    let deviation = median(values.iter().map(|(_, value)| (value - middle).abs())) * SIGMA_PER_MAD;
    let most = (OUTLIER_SCORE * deviation).max(OUTLIER_SHARE * middle.abs());
    values.iter().filter(|(_, value)| (value - middle).abs() > most).map(|(hinge, _)| *hinge).collect()
}

fn median(values: impl Iterator<Item = f64>) -> f64 {
    let mut values: Vec<f64> = values.collect();
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or_default()
}

/// The quantities of the table, with the words above their columns.
pub(crate) const COLUMNS: [(Quantity, &str); 7] = [
    (Quantity::HeaterResistance, "ohm"),
    (Quantity::ThermalResistance, "K/W"),
    (Quantity::TimeConstant, "tau s"),
    (Quantity::LatentHeat, "latent J"),
    (Quantity::AusteniteStart, "As degC"),
    (Quantity::AusteniteFinish, "Af degC"),
    (Quantity::MartensiteFinish, "Mf degC"),
];

/// A row a hinge; `*` marks what is unlike the others.
pub(crate) fn table(hinges: &[CalibratedHinge]) -> String {
    let unlike = COLUMNS.map(|(quantity, _)| outliers(hinges, quantity));
    let mut text = format!("{:>5} {:>7}", "hinge", "channel");
    for (_, head) in COLUMNS {
        // Writing to a string cannot fail.
        let _ = write!(text, " {head:>10}");
    }
    text.push_str("  verdict");
    for hinge in hinges {
        let _ = write!(text, "\n{:>5} {:>7}", hinge.hinge, hinge.channel);
        for ((quantity, _), unlike) in COLUMNS.iter().zip(&unlike) {
            let mark = if unlike.contains(&hinge.hinge) { '*' } else { ' ' };
            let value =
                number(hinge, *quantity).map_or_else(|| "-".to_owned(), |value| format!("{value:.2}"));
            let _ = write!(text, " {value:>9}{mark}");
        }
        let _ = write!(text, "  {}", hinge.verdict.name());
    }
    if unlike.iter().any(|unlike| !unlike.is_empty()) {
        text.push_str("\n*: unlike the other hinges");
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    fn hinge(number: usize, ohm: f64) -> CalibratedHinge {
        let value = format!("{ohm} ohm");
        let known = Calibrated::Known { value, low: "1 ohm".to_owned(), high: "99 ohm".to_owned() };
        CalibratedHinge {
            hinge: number,
            channel: 0,
            date: String::new(),
            firmware: String::new(),
            verdict: CalibrationVerdict::Calibrated,
            why: None,
            ambient: None,
            residuals: BTreeMap::new(),
            values: BTreeMap::from([(key(Quantity::HeaterResistance), known)]),
            servo: None,
        }
    }

    #[test]
    fn the_hinge_that_is_unlike_the_others_is_marked_and_no_other() {
        let mut hinges: Vec<_> = (0..9).map(|at| hinge(at, 25.0 + 0.2 * at as f64)).collect();
        assert!(outliers(&hinges, Quantity::HeaterResistance).is_empty());
        hinges.push(hinge(9, 33.0));
        assert_eq!(outliers(&hinges, Quantity::HeaterResistance), BTreeSet::from([9]));
        let table = table(&hinges);
        assert_eq!(table.matches('*').count(), 2, "{table}");
        assert!(table.contains("    9       0     33.00*"), "{table}");
    }

    #[test]
    fn hinges_that_are_all_but_equal_have_no_outlier_and_neither_have_few() {
        let equal: Vec<_> = (0..9).map(|at| hinge(at, if at == 8 { 25.4 } else { 25.0 })).collect();
        assert!(outliers(&equal, Quantity::HeaterResistance).is_empty());
        assert!(outliers(&[hinge(0, 25.0), hinge(1, 90.0)], Quantity::HeaterResistance).is_empty());
    }
}
