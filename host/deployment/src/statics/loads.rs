//! What a weighing amounts to, as it stands in a schedule.

use super::tipping::Support;
use super::walk::Statics;
use crate::rig::Rig;
use serde::{Deserialize, Serialize};

/// Numbers that differ by a smaller share are the same: far above the rounding of sums over thousands of panels.
const SAME: f64 = 1e-6;

/// What was weighed of a schedule's steps, one after another, and what was found.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Loads {
    /// What a panel weighs, grams.
    pub panel_mass_g: f64,
    /// Where down is.
    pub gravity: [f64; 3],
    /// Hinges that are loaded beyond their rating, rising.
    pub overloaded: Vec<usize>,
    /// The greatest torque over its rating.
    pub worst_factor: f64,
    /// What the whole stands on.
    pub support: Support,
    /// The first step in which the whole tips, or has nothing to stand on.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub tips_in_step: Option<usize>,
    /// The least margin, where there is anything to stand on; negative where the whole tips.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub tipping_margin_mm: Option<f64>,
}

impl Loads {
    /// What was found with the panels and the gravity of a rig.
    pub fn of(statics: &Statics, rig: &Rig) -> Self {
        Self {
            panel_mass_g: statics.panel_mass.0,
            gravity: rig.gravity.direction,
            overloaded: statics.overloaded(),
            worst_factor: statics.worst_first().first().map_or(0.0, super::Load::factor),
            support: statics.tipping.support,
            tips_in_step: statics.tipping.first(),
            tipping_margin_mm: statics.tipping.least().map(|(_, margin)| margin.0),
        }
    }

    /// The first key that isn't as in another weighing, with what each has there.
    pub(crate) fn difference(&self, other: &Self) -> Option<(&'static str, String, String)> {
        let near = |a: f64, b: f64| (a - b).abs() <= SAME * a.abs().max(b.abs()).max(1.0);
        let margins = match (self.tipping_margin_mm, other.tipping_margin_mm) {
            (Some(a), Some(b)) => near(a, b),
            (a, b) => a.is_none() && b.is_none(),
        };
        let gravity = self.gravity.iter().zip(other.gravity).all(|(a, b)| near(*a, b));
        let key = |same: bool, key: &'static str, of: &dyn Fn(&Self) -> String| {
            (!same).then(|| (key, of(self), of(other)))
        };
        key(near(self.panel_mass_g, other.panel_mass_g), "loads.panel_mass_g", &|of| {
            of.panel_mass_g.to_string()
        })
        .or_else(|| key(gravity, "loads.gravity", &|of| format!("{:?}", of.gravity)))
        .or_else(|| {
            key(self.overloaded == other.overloaded, "loads.overloaded", &|of| format!("{:?}", of.overloaded))
        })
        .or_else(|| {
            let same = near(self.worst_factor, other.worst_factor);
            key(same, "loads.worst_factor", &|of| of.worst_factor.to_string())
        })
        .or_else(|| {
            let same = self.tips_in_step == other.tips_in_step;
            key(same, "loads.tips_in_step", &|of| told(of.tips_in_step))
        })
        .or_else(|| key(margins, "loads.tipping_margin_mm", &|of| told(of.tipping_margin_mm)))
    }
}

fn told<T: ToString>(value: Option<T>) -> String {
    value.map_or("none".to_owned(), |value| value.to_string())
}
