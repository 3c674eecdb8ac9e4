//! A record as the model runs through it: spans of constant power that end at a sample or at an edge of a drive.

use crate::model::{Model, State, Step};
use crate::record::{Drive, Record};

/// A span of constant power.
#[derive(Debug, Clone, Copy)]
struct Span {
    steps: u32,
    step_s: f64,
    /// Mean of the squared voltage at the heater: over its resistance it is the power.
    volts_squared: f64,
    /// A sample is taken at its end.
    sampled: bool,
}

/// The spans of a record from its first sample on.
#[derive(Debug, Clone)]
pub(crate) struct Course {
    spans: Vec<Span>,
}

/// What the model says at one sample.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Moment {
    pub(crate) bead_c: f64,
    pub(crate) foil_c: f64,
    pub(crate) austenite: f64,
}

impl Course {
    const HEATING_STEP_S: f64 = 0.025;
    const COOLING_STEP_S: f64 = 0.05;
    /// In a gap there is nothing to compare with.
    const GAP_S: f64 = 2.0;
    const GAP_STEP_S: f64 = 0.25;
    /// Steps so little apart differ by the rounding of their times.
    const SAME_S: f64 = 1e-9;

    /// The course of the first `count` samples.
    pub(crate) fn new(record: &Record, count: usize) -> Self {
        let mut spans = Vec::with_capacity(count + 2 * record.drives.len());
        let samples = record.samples.get(..count).unwrap_or(&record.samples);
        for pair in samples.windows(2) {
            let [before, after] = pair else { continue };
            let (mut from_s, until_s) = (before.t_s, after.t_s);
            let first = record.drives.partition_point(|drive| drive.until_s <= from_s);
            for drive in record.drives.iter().skip(first).take_while(|drive| drive.from_s < until_s) {
                spans.extend(Span::new(drive.from_s - from_s, 0.0, false));
                from_s = from_s.max(drive.from_s);
                let end_s = drive.until_s.min(until_s);
                let volts_squared = drive.duty * voltage_v(record, drive, from_s, end_s).powi(2);
                spans.extend(Span::new(end_s - from_s, volts_squared, false));
                from_s = end_s;
            }
            spans.extend(Span::new(until_s - from_s, 0.0, false));
            if let Some(last) = spans.last_mut() {
                last.sampled = true;
            }
        }
        Self { spans }
    }

    /// Runs a hinge through it; `see` is called at every sample, the first too.
    pub(crate) fn run(&self, model: &Model, start: State, mut see: impl FnMut(Moment)) {
        let mut state = start;
        let moment = |state: &State| Moment {
            bead_c: state.bead_c,
            foil_c: state.foil_c,
            austenite: state.austenite(),
        };
        see(moment(&state));
        let mut step = Step::new(model, Self::HEATING_STEP_S);
        for span in &self.spans {
            // Almost all are as long as the one before.
            if (step.dt_s - span.step_s).abs() > Self::SAME_S {
                step = Step::new(model, span.step_s);
            }
            let power_w = span.volts_squared / model.heater_ohm;
            for _ in 0..span.steps {
                step.advance(&mut state, power_w);
            }
            if span.sampled {
                see(moment(&state));
            }
        }
    }
}

impl Span {
    /// None for a span without length.
    fn new(length_s: f64, volts_squared: f64, sampled: bool) -> Option<Self> {
        const NOTHING_S: f64 = 1e-9;
        if length_s <= NOTHING_S {
            return None;
        }
        let longest_s = if volts_squared > 0.0 {
            Course::HEATING_STEP_S
        } else if length_s > Course::GAP_S {
            Course::GAP_STEP_S
        } else {
            Course::COOLING_STEP_S
        };
        // A hair less than whole, so that 0.1 s is one step of 0.1 s.
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "at least 1; `as` saturates"
        )]
        let steps = (length_s / longest_s - 1e-6).ceil().max(1.0) as u32;
        Some(Self { steps, step_s: length_s / f64::from(steps), volts_squared, sampled })
    }
}

/// Voltage during a part of a drive: of its sample next to that part's middle. A drive between two samples has none of its own; then
/// the next sample of all must do.
fn voltage_v(record: &Record, drive: &Drive, from_s: f64, until_s: f64) -> f64 {
    let middle_s = f64::midpoint(from_s, until_s);
    let own = record.during(drive);
    let samples = if own.is_empty() { &record.samples } else { own };
    let next = samples.partition_point(|sample| sample.t_s < middle_s);
    let apart_s =
        |index: usize| samples.get(index).map_or(f64::INFINITY, |sample| (sample.t_s - middle_s).abs());
    let near = if next > 0 && apart_s(next - 1) < apart_s(next) { next - 1 } else { next };
    samples.get(near).map_or(0.0, |sample| sample.voltage_v)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::nominal::Nominal;
    use crate::pulse_plan::Purpose;
    use crate::record::Sample;

    fn record(drives: &[(f64, f64)]) -> Record {
        let sample = |index: u32| Sample {
            t_s: f64::from(index) * 0.1,
            reading_c: 22.0,
            voltage_v: 5.0,
            current_a: Some(0.0),
        };
        let drive = |&(from_s, until_s)| Drive { from_s, until_s, duty: 0.5, purpose: Purpose::Probe };
        Record { samples: (0..=100).map(sample).collect(), drives: drives.iter().map(drive).collect() }
    }

    /// Joules at 1 ohm.
    fn energy(course: &Course) -> f64 {
        course.spans.iter().map(|span| f64::from(span.steps) * span.step_s * span.volts_squared).sum()
    }

    #[test]
    fn a_drive_gives_its_energy_wherever_its_edges_lie() {
        for drives in [vec![(1.0, 3.0)], vec![(1.033, 3.033)], vec![(1.01, 1.04), (1.05, 3.02)]] {
            let course = Course::new(&record(&drives), 101);
            assert!((energy(&course) - 25.0).abs() < 1e-9, "{drives:?}: {}", energy(&course));
            let mut seen = 0;
            let model = Model::nominal(&Nominal::default(), 22.0);
            course.run(&model, State::at_rest(22.0), |_| seen += 1);
            assert_eq!(seen, 101);
        }
    }
}
