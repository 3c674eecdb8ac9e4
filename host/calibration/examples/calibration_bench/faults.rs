//! Hinges that break while they are calibrated: is a wrong value said with confidence?

use crate::drive::{self, Ended};
use crate::hinges::Subject;
use core::fmt;
use std::error::Error;
use zygote_calibration::{Bounds, Interval, Quantity, fit};
use zygote_sim::Chance;
use zygote_sim::plant::{Fault, Hinge};

/// What a calibration made of a fault.
pub(crate) struct Verdict {
    pub(crate) fault: Fault,
    pub(crate) at_s: f64,
    pub(crate) ended: Option<Ended>,
    /// Values that are outside both of what is accepted: the quantity, its truth, what was said.
    pub(crate) wrong: Vec<(Quantity, f64, Interval)>,
    /// How many parameters got a value.
    pub(crate) identified: usize,
    /// The fit or the plan named a fault.
    pub(crate) noticed: bool,
}

/// Accepted errors: a share of the truth, or kelvins.
pub(crate) fn accepted(quantity: Quantity, truth: f64) -> Option<f64> {
    match quantity {
        Quantity::ThermalResistance
        | Quantity::TimeConstant
        | Quantity::HeaterResistance
        | Quantity::FoilRise => Some(0.05 * truth),
        Quantity::AusteniteStart | Quantity::AusteniteFinish => Some(2.0),
        Quantity::MartensiteStart | Quantity::MartensiteFinish => Some(3.0),
        Quantity::LatentHeat => Some(0.2 * truth),
        Quantity::ThermistorLag => Some(0.3),
        Quantity::Opening => None,
    }
}

/// Each fault once, at a random moment of the calibration.
pub(crate) fn all(
    subject: &Subject,
    bounds: &Bounds,
    length_s: f64,
    seed: u64,
) -> Result<Vec<Verdict>, Box<dyn Error>> {
    let mut chance = Chance::new(seed ^ 0x5eed);
    let drift = 10_f64.powf(chance.between(-2.5, 0.0)) * if chance.happens(0.5) { 1.0 } else { -1.0 };
    let faults = [
        Fault::ThermistorOpen(0),
        Fault::ThermistorShorted(0),
        Fault::ThermistorFrozen(0),
        Fault::ThermistorDrifting { channel: 0, kelvin_per_s: drift },
        Fault::ThermistorLoose(0),
        Fault::HeaterOpen(0),
        Fault::HeaterShorted { channel: 0, ohm: subject.hinge.heater_ohm * chance.between(0.1, 0.8) },
        Fault::MosfetStuckOn(0),
        Fault::SupplySag { open_circuit_v: chance.between(2.0, 4.5), source_ohm: chance.between(0.2, 3.0) },
        Fault::SupplyCut,
        Fault::Jammed(Hinge::Sma(0)),
    ];
    faults
        .into_iter()
        .map(|fault| {
            // A third from the first moment on.
            let at_s = if chance.happens(0.33) { 0.0 } else { chance.between(0.0, length_s) };
            one(subject, bounds, fault, at_s)
        })
        .collect()
}

fn one(subject: &Subject, bounds: &Bounds, fault: Fault, at_s: f64) -> Result<Verdict, Box<dyn Error>> {
    let session = drive::session(subject, bounds, Some((at_s, fault)))?;
    let fit = fit(&session.record, &subject.nominal)?;
    let first_s = session.record.drives.first().map_or(f64::INFINITY, |drive| drive.from_s);
    let mut wrong = Vec::new();
    let mut identified = 0;
    for estimate in &fit.estimates {
        let Some(interval) = fit.value(estimate.quantity) else { continue };
        identified += 1;
        // What is left of a heater that was shorted before it was first used is its resistance.
        let truth = match (estimate.quantity, fault) {
            (Quantity::HeaterResistance, Fault::HeaterShorted { ohm, .. }) if at_s <= first_s => ohm,
            (quantity, _) => subject.truth(quantity),
        };
        if accepted(estimate.quantity, truth).is_some_and(|most| (interval.value - truth).abs() > most) {
            wrong.push((estimate.quantity, truth, interval));
        }
    }
    let noticed = fit.fault.is_some() || session.ended.is_some();
    Ok(Verdict { fault, at_s, ended: session.ended, wrong, identified, noticed })
}

impl Verdict {
    pub(crate) fn is_wrong(&self) -> bool {
        !self.wrong.is_empty()
    }
}

impl fmt::Display for Verdict {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:?} at {:.1} s, {:?}:", self.fault, self.at_s, self.ended)?;
        for (quantity, truth, at) in &self.wrong {
            write!(f, " {quantity} {:.3} ({:.3} to {:.3}), is {truth:.3};", at.value, at.low, at.high)?;
        }
        Ok(())
    }
}
