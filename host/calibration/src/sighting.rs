//! What a run saw of one hinge while it was opened, and the record that this amounts to. A run isn't a calibration: a thermostat chooses
//! the power, and telemetry shows it ten times a second at best.

use crate::pulse_plan::Purpose;
use crate::record::{Drive, Record, Sample};

/// What a hinge was doing.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Doing {
    /// On the way to its target.
    Heating,
    /// Held there.
    Holding,
    /// Open, the heater off.
    Cooling,
}

/// One look at a hinge.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Look {
    /// By the clock that its start is told in.
    pub t_s: f64,
    /// What it was doing.
    pub doing: Doing,
    /// What the thermistor read.
    pub reading_c: f64,
    /// Share of full power at that moment, 0 to 1.
    pub duty: f64,
    /// Voltage at the input of the main switch.
    pub voltage_v: f64,
}

/// A hinge in a run, from when its heater went on to when it was cool.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Sighting {
    /// When its heater went on.
    pub started_s: f64,
    /// When it was open and its heater went off; none where it didn't get there.
    pub opened_s: Option<f64>,
    /// Looks, oldest first.
    pub looks: Vec<Look>,
}

/// Looks further apart leave open what the power was in between.
const GAP_S: f64 = 0.35;
/// The first look comes so soon that the hinge is still as cold as it was.
const FIRST_S: f64 = 0.3;

impl Sighting {
    /// How many looks there were while its heater was on, and how many there would have been at ten a second.
    pub fn seen(&self) -> (usize, usize) {
        let end_s =
            self.opened_s.or_else(|| self.looks.last().map(|look| look.t_s)).unwrap_or(self.started_s);
        let seen = self.looks.iter().filter(|look| look.doing != Doing::Cooling).count();
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "some seconds; it saturates"
        )]
        let of = ((end_s - self.started_s) * 10.0).round().max(0.0) as usize;
        (seen, of.max(seen))
    }

    /// As a record that begins when the heater went on and ends where it isn't known any more what the power was. None where the
    /// hinge wasn't seen from its beginning on.
    pub(crate) fn record(&self) -> Option<Record> {
        let first = self.looks.first()?;
        if !(0.0..=FIRST_S).contains(&(first.t_s - self.started_s)) {
            return None;
        }
        let sample = |look: &Look| Sample {
            t_s: look.t_s,
            reading_c: look.reading_c,
            voltage_v: look.voltage_v,
            current_a: None,
        };
        // It was at rest when the heater went on.
        let mut samples = vec![Sample { t_s: self.started_s - 1e-3, ..sample(first) }];
        let mut drives = Drives::default();
        drives.add(self.started_s, first.t_s, first.duty);
        samples.push(sample(first));
        for pair in self.looks.windows(2) {
            let [before, after] = pair else { continue };
            let known = drives.between(before, after, self.opened_s);
            if !known {
                break;
            }
            samples.push(sample(after));
        }
        Some(Record { samples, drives: drives.0 })
    }
}

/// The power over time, as far as looks tell.
#[derive(Default)]
struct Drives(Vec<Drive>);

impl Drives {
    /// Power between two looks; whether that is known.
    fn between(&mut self, before: &Look, after: &Look, opened_s: Option<f64>) -> bool {
        let (from_s, until_s) = (before.t_s, after.t_s);
        let far = until_s - from_s > GAP_S;
        match (before.doing, after.doing) {
            // Below its target it has full power, whatever was seen of it in between.
            (Doing::Heating, Doing::Heating) => {
                let middle_s = f64::midpoint(from_s, until_s);
                self.add(from_s, middle_s, before.duty);
                self.add(middle_s, until_s, after.duty);
                true
            }
            (Doing::Heating | Doing::Holding, Doing::Holding) => {
                self.add(from_s, until_s, f64::midpoint(before.duty, after.duty));
                !far
            }
            (Doing::Heating | Doing::Holding, Doing::Cooling) => {
                let Some(off_s) = opened_s else { return false };
                self.add(from_s, off_s.clamp(from_s, until_s), before.duty);
                !far
            }
            (Doing::Cooling, Doing::Cooling) => true,
            (Doing::Holding | Doing::Cooling, Doing::Heating) | (Doing::Cooling, Doing::Holding) => false,
        }
    }

    /// Goes on with the drive before where nothing changed.
    fn add(&mut self, from_s: f64, until_s: f64, duty: f64) {
        const SAME: f64 = 1e-6;
        if duty <= 0.0 || until_s <= from_s {
            return;
        }
        match self.0.last_mut() {
            Some(last) if (last.duty - duty).abs() < SAME && (last.until_s - from_s).abs() < SAME => {
                last.until_s = until_s;
            }
            _ => self.0.push(Drive { from_s, until_s, duty: duty.min(1.0), purpose: Purpose::HeldOut }),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn look(t_s: f64, doing: Doing, duty: f64) -> Look {
        Look { t_s, doing, reading_c: 22.0 + t_s, duty, voltage_v: 5.0 }
    }

    fn drives(looks: &[Look], opened_s: Option<f64>) -> Vec<(f64, f64, f64)> {
        let record = Sighting { started_s: 1.0, opened_s, looks: looks.to_vec() }.record().unwrap();
        record.check().unwrap();
        record.drives.iter().map(|drive| (drive.from_s, drive.until_s, drive.duty)).collect()
    }

    #[test]
    fn power_is_full_to_the_target_and_what_was_seen_of_it_after_that() {
        let looks = [
            look(1.1, Doing::Heating, 1.0),
            look(1.2, Doing::Heating, 1.0),
            look(1.3, Doing::Holding, 0.5),
            look(1.4, Doing::Cooling, 0.0),
            look(1.5, Doing::Cooling, 0.0),
        ];
        assert_eq!(drives(&looks, Some(1.35)), [(1.0, 1.2, 1.0), (1.2, 1.3, 0.75), (1.3, 1.35, 0.5)]);
    }

    #[test]
    fn a_gap_is_bridged_while_it_is_heated_and_ends_the_record_where_it_was_held() {
        let heated = [look(1.1, Doing::Heating, 1.0), look(3.0, Doing::Heating, 1.0)];
        assert_eq!(drives(&heated, None), [(1.0, 3.0, 1.0)]);
        let held =
            [look(1.1, Doing::Heating, 1.0), look(3.0, Doing::Holding, 0.2), look(3.1, Doing::Holding, 0.2)];
        let record = Sighting { started_s: 1.0, opened_s: None, looks: held.to_vec() }.record().unwrap();
        assert_eq!(record.samples.len(), 2);
    }

    #[test]
    fn a_hinge_that_was_seen_late_has_no_record() {
        let late = Sighting { started_s: 1.0, opened_s: None, looks: vec![look(2.0, Doing::Heating, 1.0)] };
        assert_eq!(late.record(), None);
        assert_eq!(late.seen(), (1, 10));
        assert_eq!(Sighting::default().record(), None);
    }
}
