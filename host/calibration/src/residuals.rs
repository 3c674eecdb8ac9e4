//! What a model misses: of the samples that it was fitted to, and of those that it wasn't.

use crate::course::Moment;
use crate::pulse_plan::Purpose;
use crate::record::{Record, Sample};
use crate::solve::Solution;

/// Residuals of the fitted samples.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Residuals {
    /// How many there are.
    pub samples: usize,
    /// Root of their mean square.
    pub rmse_k: f64,
    /// The largest, whatever its sign.
    pub worst_k: f64,
    /// When it was.
    pub worst_at_s: f64,
    /// Standard deviation in counts of the converter: about 1 where nothing but noise is left.
    pub noise_counts: f64,
    /// Samples that say together what an independent one says alone: 1 where nothing but noise is left. The intervals are
    /// wider by its root.
    pub correlation: f64,
}

impl Residuals {
    pub(crate) fn new(record: &Record, solution: &Solution) -> Self {
        let worst =
            solution.residuals_k.iter().zip(&record.samples).max_by(|a, b| a.0.abs().total_cmp(&b.0.abs()));
        Self {
            samples: solution.residuals_k.len(),
            rmse_k: root_mean_square(solution.residuals_k.iter().copied()),
            worst_k: worst.map_or(0.0, |(residual_k, _)| residual_k.abs()),
            worst_at_s: worst.map_or(0.0, |(_, sample)| sample.t_s),
            noise_counts: solution.noise_counts,
            correlation: solution.correlation,
        }
    }
}

/// How well the held-out pulse was predicted.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HeldOut {
    /// Root of the mean square error while it was heated.
    pub heat_rmse_k: f64,
    /// The same while it cooled.
    pub cool_rmse_k: f64,
}

impl HeldOut {
    pub(crate) fn new(record: &Record, predicted: &[Moment]) -> Option<Self> {
        let drive = record.drives.iter().find(|drive| drive.purpose == Purpose::HeldOut)?;
        let errors = |wanted: &dyn Fn(&Sample) -> bool| {
            let both = record.samples.iter().zip(predicted).filter(|(sample, _)| wanted(sample));
            root_mean_square(both.map(|(sample, moment)| sample.reading_c - moment.bead_c))
        };
        Some(Self {
            heat_rmse_k: errors(&|sample| sample.t_s > drive.from_s && sample.t_s <= drive.until_s),
            cool_rmse_k: errors(&|sample| sample.t_s > drive.until_s),
        })
    }

    /// The worse of the two, a NaN if either is.
    pub fn worse_rmse_k(&self) -> f64 {
        if self.heat_rmse_k >= self.cool_rmse_k || self.heat_rmse_k.is_nan() {
            self.heat_rmse_k
        } else {
            self.cool_rmse_k
        }
    }
}

fn root_mean_square(values: impl Iterator<Item = f64>) -> f64 {
    let (mut sum, mut count) = (0.0, 0_u32);
    for value in values {
        sum += value * value;
        count += 1;
    }
    (sum / f64::from(count.max(1))).sqrt()
}
