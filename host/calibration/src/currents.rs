//! The heaters' resistances from the sum of all currents in a run, of which each look says how much of the time every heater is on.
//!
//! A linear regression: sum = others + voltage x (duty / resistance of each). Heaters that are always on together can't be told apart, which
//! their errors show.

use crate::diagnosis::Electrical;
use nalgebra::{DMatrix, DVector};
use std::collections::BTreeMap;

/// One look at the supply.
#[derive(Debug, Clone, PartialEq)]
pub struct Currents {
    /// Sum of all currents.
    pub sum_a: f64,
    /// Voltage at the input of the main switch.
    pub voltage_v: f64,
    /// Share of full power of each hinge that was heated, by its number. Nothing else is on.
    pub duties: Vec<(usize, f64)>,
}

/// What flows with everything off is nothing, give or take so much.
const OTHERS_A: f64 = 0.02;
/// A resistance may be off by this share before anything is measured.
const UNKNOWN: f64 = 0.5;
/// Noise of one look, at least: the boards' amplifier gives 8 mA a count, which is rounded the same way every time.
const ROUNDED_A: f64 = 8e-3 / 3.464;
/// Fewer looks at a heater say nothing of it.
const FEWEST: usize = 5;

/// The resistance of every heater that was seen often enough, by its hinge's number. `known` is about what each has.
pub fn heaters(looks: &[Currents], known: &BTreeMap<usize, f64>) -> BTreeMap<usize, Electrical> {
    let mut seen: BTreeMap<usize, usize> = BTreeMap::new();
    for (hinge, _) in looks.iter().flat_map(|look| &look.duties) {
        *seen.entry(*hinge).or_default() += 1;
    }
    let hinges: Vec<(usize, f64)> =
        seen.keys().filter_map(|hinge| Some((*hinge, *known.get(hinge)?))).collect();
    let place: BTreeMap<usize, usize> =
        hinges.iter().enumerate().map(|(at, (hinge, _))| (*hinge, at)).collect();
    // A heater of which nothing is known would be taken for the others.
    let known_all = |look: &&Currents| look.duties.iter().all(|(hinge, _)| place.contains_key(hinge));
    let rows: Vec<&Currents> = looks.iter().filter(known_all).collect();
    let others = hinges.len();
    let mut matrix = DMatrix::zeros(rows.len(), others + 1);
    let mut sums = DVector::zeros(rows.len());
    for (row, look) in rows.iter().enumerate() {
        for (hinge, duty) in &look.duties {
            if let Some(at) = place.get(hinge) {
                matrix[(row, *at)] += duty * look.voltage_v;
            }
        }
        matrix[(row, others)] = 1.0;
        sums[row] = look.sum_a;
    }
    let centre = DVector::from_iterator(
        others + 1,
        hinges.iter().map(|(_, ohm)| 1.0 / ohm).chain(core::iter::once(0.0)),
    );
    let rest = &sums - &matrix * &centre;
    let mut noise_a = ROUNDED_A;
    let mut found = None;
    // Once with the least noise, then with what is left.
    for _ in 0..2 {
        let mut information = matrix.tr_mul(&matrix) / (noise_a * noise_a);
        for (at, (_, ohm)) in hinges.iter().enumerate() {
            information[(at, at)] += (ohm / UNKNOWN).powi(2);
        }
        information[(others, others)] += OTHERS_A.powi(-2);
        let Some(covariance) = information.try_inverse() else { return BTreeMap::new() };
        let moved = &covariance * matrix.tr_mul(&rest) / (noise_a * noise_a);
        let left = &rest - &matrix * &moved;
        noise_a = (left.norm_squared() / rows.len().max(1) as f64).sqrt().max(ROUNDED_A);
        found = Some((moved, covariance));
    }
    let Some((moved, covariance)) = found else { return BTreeMap::new() };
    let voltage_v = rows.iter().map(|look| look.voltage_v).fold(f64::INFINITY, f64::min);
    hinges
        .iter()
        .enumerate()
        .filter(|(_, (hinge, _))| seen.get(hinge).is_some_and(|count| *count >= FEWEST))
        .map(|(at, (hinge, known))| {
            let siemens = 1.0 / known + moved[at];
            // Rounding is wrong with all looks alike.
            let error_s = covariance[(at, at)].max(0.0).sqrt().hypot(ROUNDED_A / voltage_v);
            (*hinge, Electrical { ohm: 1.0 / siemens, error_ohm: error_s / (siemens * siemens) })
        })
        .filter(|(_, heater)| heater.ohm.is_finite() && heater.ohm > 0.0 && heater.error_ohm.is_finite())
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Heaters of these resistances at 5 V, 10 mA beside them.
    fn look(duties: &[(usize, f64)], ohms: &[f64]) -> Currents {
        let sum_a = 0.01 + duties.iter().map(|(hinge, duty)| 5.0 * duty / ohms[*hinge]).sum::<f64>();
        Currents { sum_a, voltage_v: 5.0, duties: duties.to_vec() }
    }

    #[test]
    fn heaters_that_overlap_are_told_apart() {
        let ohms = [25.0, 27.5, 22.0];
        let mut looks = Vec::new();
        for duties in
            [vec![], vec![(0, 1.0)], vec![(0, 1.0), (1, 1.0)], vec![(1, 1.0), (2, 1.0)], vec![(2, 0.5)]]
        {
            looks.extend(std::iter::repeat_n(look(&duties, &ohms), 20));
        }
        let known = BTreeMap::from([(0, 25.0), (1, 25.0), (2, 25.0)]);
        for (hinge, heater) in heaters(&looks, &known) {
            assert!((heater.ohm / ohms[hinge] - 1.0).abs() < 0.01, "hinge {hinge}: {heater:?}");
            assert!(heater.error_ohm < 0.02 * ohms[hinge], "hinge {hinge}: {heater:?}");
        }
    }

    #[test]
    fn heaters_that_are_always_on_together_have_wide_errors() {
        let looks = vec![look(&[(0, 1.0), (1, 1.0)], &[25.0, 27.5]); 50];
        let found = heaters(&looks, &BTreeMap::from([(0, 25.0), (1, 25.0)]));
        assert!(found.values().all(|heater| heater.error_ohm > 5.0), "{found:?}");
    }

    #[test]
    fn a_heater_that_was_seen_a_moment_or_of_which_nothing_is_known_has_none() {
        let looks = vec![look(&[(0, 1.0)], &[25.0]); 4];
        assert!(heaters(&looks, &BTreeMap::from([(0, 25.0)])).is_empty());
        assert!(heaters(&[look(&[(0, 1.0)], &[25.0])], &BTreeMap::new()).is_empty());
        assert!(heaters(&[], &BTreeMap::new()).is_empty());
    }
}
