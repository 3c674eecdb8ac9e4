//! One sound hinge: what its calibration said, beside what it is.

use crate::drive::{self, Ended};
use crate::hinges::Subject;
use core::fmt;
use std::error::Error;
use std::path::Path;
use zygote_calibration::{Bounds, HeldOut, Quantity, Residuals, Verdict, fit};

/// What came of one hinge.
pub(crate) struct Outcome {
    /// By quantity: truth and verdict.
    pub(crate) verdicts: Vec<(Quantity, f64, Verdict)>,
    pub(crate) residuals: Option<Residuals>,
    pub(crate) held_out: Option<HeldOut>,
    pub(crate) ended: Option<Ended>,
    pub(crate) length_s: f64,
    /// Its supply takes it past Af.
    pub(crate) can_reach_af: bool,
    /// Highest reading.
    pub(crate) highest_c: f64,
}

/// Calibrates a sound hinge.
pub(crate) fn sound(subject: &Subject, bounds: &Bounds) -> Result<Outcome, Box<dyn Error>> {
    let session = drive::session(subject, bounds, None)?;
    let fit = fit(&session.record, &subject.nominal)?;
    let verdicts = fit
        .estimates
        .iter()
        .map(|estimate| (estimate.quantity, subject.truth(estimate.quantity), estimate.verdict))
        .collect();
    let samples = &session.record.samples;
    Ok(Outcome {
        verdicts,
        residuals: fit.residuals,
        held_out: fit.held_out,
        ended: session.ended,
        length_s: samples.last().map_or(0.0, |sample| sample.t_s),
        can_reach_af: subject.can_reach_af(bounds.max_on_s),
        highest_c: samples.iter().map(|sample| sample.reading_c).fold(0.0, f64::max),
    })
}

/// Draws the calibration of a hinge.
pub(crate) fn picture(subject: &Subject, bounds: &Bounds, path: &Path) -> Result<(), Box<dyn Error>> {
    let session = drive::session(subject, bounds, None)?;
    let fit = fit(&session.record, &subject.nominal)?;
    std::fs::write(path, zygote_calibration::picture(&session.record, &fit))?;
    Ok(())
}

impl Outcome {
    /// Whether a quantity was identified.
    pub(crate) fn has(&self, quantity: Quantity) -> bool {
        let same = |row: &&(Quantity, f64, Verdict)| row.0 == quantity;
        self.verdicts.iter().find(same).is_some_and(|row| matches!(row.2, Verdict::Identified(_)))
    }
}

impl fmt::Display for Outcome {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:.0} s, {:.1} °C", self.length_s, self.highest_c)?;
        if !self.can_reach_af {
            write!(f, ", too weak")?;
        }
        if let Some(ended) = &self.ended {
            write!(f, ", {ended:?}")?;
        }
        if let Some(residuals) = self.residuals {
            write!(f, ", noise {:.2}, correlation {:.1}", residuals.noise_counts, residuals.correlation)?;
        }
        if let Some(held_out) = self.held_out {
            write!(f, ", held out {:.2} {:.2}", held_out.heat_rmse_k, held_out.cool_rmse_k)?;
        }
        for (quantity, truth, verdict) in &self.verdicts {
            match verdict {
                Verdict::Identified(at) => {
                    let missed = if (at.low..=at.high).contains(truth) { "" } else { " MISSED" };
                    write!(
                        f,
                        "\n   {quantity}: {:.3} ± {:.3}, is {truth:.3}{missed}",
                        at.value,
                        at.high - at.value
                    )?;
                }
                Verdict::NotIdentified { why } if *quantity != Quantity::Opening => {
                    write!(f, "\n   {quantity}: {why} (is {truth:.3})")?;
                }
                Verdict::NotIdentified { .. } => {}
            }
        }
        Ok(())
    }
}
