//! What was done to a hinge and what was read meanwhile: the only thing that a fit sees of it.

use crate::pulse_plan::Purpose;

/// One reading, ten a second or so.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sample {
    /// Time since any moment before the record, by the clock that the drives are told in.
    pub t_s: f64,
    /// What the thermistor reads, as the firmware converts it.
    pub reading_c: f64,
    /// Voltage at the input of the main switch.
    pub voltage_v: f64,
    /// Current out of the supply, all consumers together; none while another hinge was heated, so that it isn't known whose it is.
    pub current_a: Option<f64>,
}

/// A pulse that was driven. Its times matter: 0.1 s too long is 0.1 J at 1 W, of some 5 J in all.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Drive {
    /// When the heater went on.
    pub from_s: f64,
    /// When it went off.
    pub until_s: f64,
    /// The constant share of time that it conducted, above 0, at most 1.
    pub duty: f64,
    /// What the plan wanted it for.
    pub purpose: Purpose,
}

/// Samples and drives of one hinge that began cold and at rest, in order of time. A record may have gaps without power:
/// an interrupted calibration that was taken up again.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Record {
    /// Samples, oldest first.
    pub samples: Vec<Sample>,
    /// Pulses, oldest first, the unfinished one not among them.
    pub drives: Vec<Drive>,
}

/// A record that no hinge can have given.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum RecordError {
    /// Time stood still or ran backwards, or isn't a number.
    #[error("sample {index}: expected a time after {after_s} s, got {got_s} s")]
    SampleTime {
        /// Counted from 0.
        index: usize,
        /// Time of the sample before.
        after_s: f64,
        /// Its own.
        got_s: f64,
    },
    /// A reading isn't a finite number.
    #[error("sample {index}: expected finite {quantity}, got {got}")]
    SampleValue {
        /// Counted from 0.
        index: usize,
        /// What was read.
        quantity: &'static str,
        /// What it said.
        got: f64,
    },
    /// A drive is empty, overlaps the one before it, or isn't a number.
    #[error(
        "drive {index}: expected an end after its start and a start after {after_s} s, got {from_s} to {until_s} s"
    )]
    DriveTime {
        /// Counted from 0.
        index: usize,
        /// End of the drive before.
        after_s: f64,
        /// Its start.
        from_s: f64,
        /// Its end.
        until_s: f64,
    },
    /// A duty is not within its range.
    #[error("drive {index}: expected a duty above 0 and at most 1, got {got}")]
    Duty {
        /// Counted from 0.
        index: usize,
        /// The duty.
        got: f64,
    },
}

impl Record {
    /// Checks that time goes forward and every number is one.
    ///
    /// # Errors
    /// [`RecordError`], of the first thing that is wrong.
    pub fn check(&self) -> Result<(), RecordError> {
        let mut after_s = f64::NEG_INFINITY;
        for (index, sample) in self.samples.iter().enumerate() {
            // Asked this way round, a NaN is refused too.
            if !(sample.t_s > after_s && sample.t_s.is_finite()) {
                return Err(RecordError::SampleTime { index, after_s, got_s: sample.t_s });
            }
            after_s = sample.t_s;
            for (quantity, got) in [
                ("temperature", sample.reading_c),
                ("voltage", sample.voltage_v),
                ("current", sample.current_a.unwrap_or_default()),
            ] {
                if !got.is_finite() {
                    return Err(RecordError::SampleValue { index, quantity, got });
                }
            }
        }
        let mut after_s = f64::NEG_INFINITY;
        for (index, drive) in self.drives.iter().enumerate() {
            let (from_s, until_s) = (drive.from_s, drive.until_s);
            if !(from_s >= after_s && until_s > from_s && from_s.is_finite() && until_s.is_finite()) {
                return Err(RecordError::DriveTime { index, after_s, from_s, until_s });
            }
            if !(drive.duty > 0.0 && drive.duty <= 1.0) {
                return Err(RecordError::Duty { index, got: drive.duty });
            }
            after_s = until_s;
        }
        Ok(())
    }

    /// The samples before the first drive, all of them if there is none.
    pub fn baseline(&self) -> &[Sample] {
        let end = self.drives.first().map_or(self.samples.len(), |drive| self.index_after(drive.from_s));
        self.samples.get(..end).unwrap_or_default()
    }

    /// The samples of a drive, those at its edges not counted: they may have been taken before or after.
    pub(crate) fn during(&self, drive: &Drive) -> &[Sample] {
        const EDGE_S: f64 = 0.02;
        let range = self.index_after(drive.from_s + EDGE_S)..self.index_after(drive.until_s - EDGE_S);
        self.samples.get(range).unwrap_or_default()
    }

    /// How many samples were taken at `t_s` or before.
    pub(crate) fn index_after(&self, t_s: f64) -> usize {
        self.samples.partition_point(|sample| sample.t_s <= t_s)
    }
}
