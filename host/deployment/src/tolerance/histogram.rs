//! Percentiles of more samples than memory should hold: counted in bins a thousandth wide, relative to the value.

use super::Spread;

/// Natural logarithm of the ratio of a bin's ends.
const BIN: f64 = 1e-3;
/// Below this, in panel lengths, all is one bin: a rounding error.
const LEAST: f64 = 1e-15;

/// Samples counted by size.
#[derive(Debug, Default)]
pub(super) struct Histogram {
    bins: Vec<u64>,
    count: u64,
    sum_of_squares: f64,
    greatest: f64,
}

impl Histogram {
    pub(super) fn add(&mut self, value: f64) {
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "small and not negative")]
        let bin = ((value / LEAST).max(1.0).ln() / BIN) as usize;
        if bin >= self.bins.len() {
            self.bins.resize(bin + 1, 0);
        }
        self.bins[bin] += 1;
        self.count += 1;
        self.sum_of_squares += value * value;
        self.greatest = self.greatest.max(value);
    }

    pub(super) fn spread(&self) -> Spread {
        Spread {
            first_order_rms: 0.0,
            rms: (self.sum_of_squares / self.count.max(1) as f64).sqrt(),
            median: self.percentile(50),
            percentile_95: self.percentile(95),
            greatest: self.greatest,
        }
    }

    /// The middle of the bin below whose end so many of a hundred samples are.
    fn percentile(&self, percent: u64) -> f64 {
        let mut below = 0;
        for (bin, count) in self.bins.iter().enumerate() {
            below += count;
            if *count > 0 && below * 100 >= percent * self.count {
                return if bin == 0 { 0.0 } else { LEAST * ((bin as f64 + 0.5) * BIN).exp() };
            }
        }
        0.0
    }
}
