//! Least squares: the point of the space whose hinge comes nearest to the readings, by Levenberg and Marquardt's method.

use crate::course::{Course, Moment};
use crate::model::State;
use crate::nominal::Nominal;
use crate::record::Record;
use crate::space::{COUNT, Candidate, Point, Space};
use levenberg_marquardt::{LeastSquaresProblem, LevenbergMarquardt};
use nalgebra::{Const, DVector, Dyn, OMatrix, Owned, SMatrix};

/// Covariance of a point.
pub(crate) type Covariance = SMatrix<f64, COUNT, COUNT>;

/// A record to be explained.
#[derive(Debug, Clone)]
pub(crate) struct Problem<'a> {
    space: Space,
    course: &'a Course,
    readings_c: Vec<f64>,
    /// 1 over the standard deviation of each reading.
    weights: Vec<f64>,
    point: Point,
}

/// What solves it.
#[derive(Debug, Clone)]
pub(crate) struct Solution {
    pub(crate) point: Point,
    /// Standard deviation of a reading in counts, from the residuals.
    pub(crate) noise_counts: f64,
    pub(crate) covariance: Option<Covariance>,
    /// Residuals over all samples, kelvins.
    pub(crate) residuals_k: Vec<f64>,
    /// How much each residual says of the next ones: 1 if nothing.
    pub(crate) correlation: f64,
}

/// Rounding alone: a converter's steps are spread evenly.
const LEAST_NOISE_COUNTS: f64 = 0.3;
/// Evaluations, as a multiple of the parameters' number.
const ROUNDS: usize = 12;
/// What a reading's noise is taken for at first.
const FIRST_NOISE_COUNTS: f64 = 1.2;

impl<'a> Problem<'a> {
    pub(crate) fn new(
        record: &Record,
        course: &'a Course,
        count: usize,
        nominal: &Nominal,
        space: Space,
    ) -> Self {
        let samples = record.samples.get(..count).unwrap_or(&record.samples);
        let readings_c: Vec<f64> = samples.iter().map(|sample| sample.reading_c).collect();
        let weight = |t_c: &f64| 1.0 / (FIRST_NOISE_COUNTS * nominal.sensor.k_per_count(*t_c));
        let weights = readings_c.iter().map(weight).collect();
        Self { space, course, readings_c, weights, point: Point::zeros() }
    }

    /// The sum of squares at a point.
    pub(crate) fn cost(&self, point: &Point) -> f64 {
        self.residuals_at(point).norm_squared()
    }

    /// The best point that is found from `start`, without its statistics.
    pub(crate) fn descend(&mut self, start: &Point, tolerance: f64) -> (Point, f64) {
        self.point = *start;
        let (problem, report) =
            LevenbergMarquardt::new().with_tol(tolerance).with_patience(ROUNDS).minimize(self.clone());
        let cost = 2.0 * report.objective_function;
        // Where the search broke off it still holds the best point so far.
        let cost = if cost.is_finite() { cost } else { f64::INFINITY };
        (problem.point, cost)
    }

    /// How much the residuals at a point hang together; 1 if they are noise.
    pub(crate) fn correlation(&self, point: &Point) -> f64 {
        correlation(&self.data_residuals(point))
    }

    /// The solution around a start near to it: once more with the noise that the residuals show, then the statistics.
    pub(crate) fn polish(mut self, start: &Point) -> Solution {
        let free = self.readings_c.len().saturating_sub(COUNT).max(1) as f64;
        let mut noise_counts = FIRST_NOISE_COUNTS;
        let mut point = *start;
        for _ in 0..2 {
            let squares = self.data_residuals(&point).iter().map(|r| r * r).sum::<f64>();
            let factor = (squares / free).sqrt().max(LEAST_NOISE_COUNTS / noise_counts);
            noise_counts *= factor;
            for weight in &mut self.weights {
                *weight /= factor;
            }
            point = self.descend(&point, 1e-6).0;
        }
        let whitened = self.data_residuals(&point);
        let correlation = correlation(&whitened);
        let residuals_k = whitened.iter().zip(&self.weights).map(|(r, weight)| r / weight).collect();
        self.point = point;
        // Residuals that hang together are worth as many fewer.
        let covariance = self.jacobian().and_then(|jacobian| {
            let rows = self.readings_c.len();
            let data = jacobian.rows(0, rows);
            let information = data.tr_mul(&data) / correlation + Covariance::identity();
            information.try_inverse()
        });
        Solution { point, noise_counts, covariance, residuals_k, correlation }
    }

    /// What the model says at every sample.
    pub(crate) fn moments(course: &Course, candidate: &Candidate) -> Vec<Moment> {
        let mut moments = Vec::new();
        let mut start = State::at_rest(candidate.model.ambient_c + candidate.start_k);
        // The bead is at rest with it.
        start.bead_c = start.foil_c;
        course.run(&candidate.model, start, |moment| moments.push(moment));
        moments
    }

    /// Readings less the model's, in standard deviations.
    fn data_residuals(&self, point: &Point) -> Vec<f64> {
        let candidate = self.space.at(point);
        let mut residuals = Vec::with_capacity(self.readings_c.len());
        let expected = self.readings_c.iter().zip(&self.weights);
        let mut expected = expected;
        let start = State::at_rest(candidate.model.ambient_c + candidate.start_k);
        self.course.run(&candidate.model, start, |moment| {
            if let Some((reading_c, weight)) = expected.next() {
                residuals.push((reading_c - moment.bead_c) * weight);
            }
        });
        residuals
    }

    /// The same, with the point itself: its distance from the nominal one, in spreads.
    fn residuals_at(&self, point: &Point) -> DVector<f64> {
        let mut residuals = self.data_residuals(point);
        residuals.extend(point.iter());
        DVector::from_vec(residuals)
    }
}

impl LeastSquaresProblem<f64, Dyn, Const<COUNT>> for Problem<'_> {
    type ResidualStorage = Owned<f64, Dyn>;
    type JacobianStorage = Owned<f64, Dyn, Const<COUNT>>;
    type ParameterStorage = Owned<f64, Const<COUNT>>;

    fn set_params(&mut self, point: &Point) {
        self.point = *point;
    }

    fn params(&self) -> Point {
        self.point
    }

    fn residuals(&self) -> Option<DVector<f64>> {
        let residuals = self.residuals_at(&self.point);
        residuals.iter().all(|r| r.is_finite()).then_some(residuals)
    }

    fn jacobian(&self) -> Option<OMatrix<f64, Dyn, Const<COUNT>>> {
        // Far above what the model's rounding does, far below what bends it.
        const STEP: f64 = 1e-4;
        let here = self.residuals_at(&self.point);
        let mut jacobian = OMatrix::<f64, Dyn, Const<COUNT>>::zeros(here.len());
        for parameter in 0..COUNT {
            let mut ahead = self.point;
            ahead[parameter] += STEP;
            jacobian.set_column(parameter, &((self.residuals_at(&ahead) - &here) / STEP));
        }
        jacobian.iter().all(|slope| slope.is_finite()).then_some(jacobian)
    }
}

/// 1 + 2 sum of the autocorrelation up to where it has faded: how many samples weigh as much as one that is independent.
fn correlation(residuals: &[f64]) -> f64 {
    const FADED: f64 = 0.05;
    const FURTHEST: usize = 300;
    let squares: f64 = residuals.iter().map(|r| r * r).sum();
    if squares == 0.0 {
        return 1.0;
    }
    let mut sum = 1.0;
    for lag in 1..FURTHEST.min(residuals.len()) {
        let products: f64 =
            residuals.iter().zip(residuals.get(lag..).unwrap_or_default()).map(|(a, b)| a * b).sum();
        let share = products / squares;
        if share < FADED {
            break;
        }
        sum += 2.0 * share;
    }
    sum
}

#[cfg(test)]
#[expect(clippy::float_cmp, reason = "the same bits are meant")]
mod tests {
    use super::*;

    #[test]
    fn residuals_that_stand_alone_count_as_one_and_runs_as_fewer() {
        let alternating: Vec<f64> = (0..100).map(|k| if k % 2 == 0 { 1.0 } else { -1.0 }).collect();
        assert_eq!(correlation(&alternating), 1.0);
        let runs: Vec<f64> = (0..400).map(|k| if k / 10 % 2 == 0 { 1.0 } else { -1.0 }).collect();
        assert!(correlation(&runs) > 4.0);
        assert_eq!(correlation(&[]), 1.0);
    }
}
