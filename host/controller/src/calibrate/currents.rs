//! Whose current it is: only the sum of all currents is measured. A heater that is on alone has what flows beyond what flows
//! with all off; several share it as their power and resistance say.

/// Resistance of the heaters as far as it is known, and what flows with all of them off.
#[derive(Debug, Clone, Default)]
pub(crate) struct Currents {
    quiet: Vec<f64>,
    idle_a: f64,
}

/// A heater and its share of time, 0 to 1.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Load {
    pub(crate) duty: f64,
    pub(crate) ohm: f64,
}

impl Currents {
    /// A measurement with everything off.
    pub(crate) fn rest(&mut self, sum_a: f64) {
        let at = self.quiet.partition_point(|earlier| *earlier < sum_a);
        self.quiet.insert(at, sum_a);
        self.idle_a = self.quiet.get(self.quiet.len() / 2).copied().unwrap_or_default();
    }

    /// What one heater drew of a measured sum, with what flows at rest.
    pub(crate) fn of(&self, own: Load, all: &[Load], sum_a: f64) -> f64 {
        let weight = |load: &Load| load.duty / load.ohm;
        let sum: f64 = all.iter().map(weight).sum();
        if sum > 0.0 { self.idle_a + (sum_a - self.idle_a) * weight(&own) / sum } else { sum_a }
    }

    /// Resistance of a heater that was on alone, from `(duty, volts, sum of currents)`; none where nothing flowed.
    pub(crate) fn resistance(&self, measured: &[(f64, f64, f64)]) -> Option<f64> {
        let volts: f64 = measured.iter().map(|(duty, volts, _)| duty * volts).sum();
        let amps: f64 = measured.iter().map(|(.., amps)| amps - self.idle_a).sum();
        (amps > 0.0).then(|| volts / amps)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_heater_alone_has_the_whole_current_and_two_share_it() {
        let mut currents = Currents::default();
        for amps in [0.01, 0.02, 0.03] {
            currents.rest(amps);
        }
        let (strong, weak) = (Load { duty: 1.0, ohm: 10.0 }, Load { duty: 0.5, ohm: 20.0 });
        let off = Load { duty: 0.0, ohm: 10.0 };
        assert_eq!(currents.of(strong, &[strong, off], 0.52), 0.52);
        assert_eq!(currents.of(off, &[strong, off], 0.52), 0.02, "what flows at rest");
        assert_eq!(currents.of(off, &[off], 0.011), 0.011);
        let (a, b) = (currents.of(strong, &[strong, weak], 0.645), currents.of(weak, &[strong, weak], 0.645));
        assert!((a - 0.52).abs() < 1e-12 && (b - 0.145).abs() < 1e-12, "{a}, {b}");
        let ohm = currents.resistance(&[(0.5, 5.0, 0.12), (0.5, 5.0, 0.12)]).unwrap();
        assert!((ohm - 25.0).abs() < 1e-9, "{ohm}");
        assert_eq!(currents.resistance(&[(0.5, 5.0, 0.02)]), None);
    }
}
