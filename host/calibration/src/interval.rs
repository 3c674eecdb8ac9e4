//! How far a quantity of a solution may be off: what fits and comparisons with a run's readings tell as an interval.

use crate::estimate::Quantity;
use crate::model::Model;
use crate::solve::{Covariance, Solution};
use crate::space::{COUNT, Point, Space};

/// Normal quantile of a two-sided interval of 95 %, a little wider for what the linearisation misses.
pub(crate) const SIGMAS: f64 = 2.1;

/// Half the interval of a quantity around its best value, from the covariance, to the second order: where film and foil happen to cool
/// alike, the capacity's slope over the film's share is nothing, and its bend is all. Infinite without a covariance.
pub(crate) fn half_interval(space: &Space, solution: &Solution, quantity: Quantity, best: f64) -> f64 {
    const STEP: f64 = 0.05;
    let at = |moves: &[(usize, f64)]| {
        let mut there = solution.point;
        for (parameter, step) in moves {
            there[*parameter] += step;
        }
        value(&space.at(&there).model, quantity).unwrap_or(best)
    };
    let mut slope = Point::zeros();
    let mut bend = Covariance::zeros();
    for a in 0..COUNT {
        let (ahead, behind) = (at(&[(a, STEP)]), at(&[(a, -STEP)]));
        slope[a] = (ahead - behind) / (2.0 * STEP);
        bend[(a, a)] = (ahead - 2.0 * best + behind) / (STEP * STEP);
        for b in 0..a {
            let corners = [(STEP, STEP, 1.0), (STEP, -STEP, -1.0), (-STEP, STEP, -1.0), (-STEP, -STEP, 1.0)];
            let mixed: f64 = corners.iter().map(|(x, y, sign)| sign * at(&[(a, *x), (b, *y)])).sum();
            bend[(a, b)] = mixed / (4.0 * STEP * STEP);
            bend[(b, a)] = bend[(a, b)];
        }
    }
    solution.covariance.map_or(f64::INFINITY, |covariance| {
        let spread = bend * covariance;
        let variance = slope.dot(&(covariance * slope)) + (spread * spread).trace() / 2.0;
        (SIGMAS * variance.max(0.0).sqrt()).hypot(quantity.resolution()) + spread.trace().abs() / 2.0
    })
}

/// A quantity of a hinge; none of the angle.
pub(crate) fn value(model: &Model, quantity: Quantity) -> Option<f64> {
    let at = &model.transformation;
    match quantity {
        Quantity::ThermalResistance => Some(model.thermal_resistance_k_per_w()),
        Quantity::TimeConstant => Some(model.time_constant_s()),
        Quantity::HeaterResistance => Some(model.heater_ohm),
        Quantity::LatentHeat => Some(model.latent_j),
        Quantity::AusteniteStart => Some(at.as_c),
        Quantity::AusteniteFinish => Some(at.af_c),
        Quantity::MartensiteStart => Some(at.ms_c),
        Quantity::MartensiteFinish => Some(at.mf_c),
        Quantity::FoilRise => Some(model.foil_rise_k_per_w()),
        Quantity::ThermistorLag => Some(model.lag_s),
        Quantity::Opening => None,
    }
}
