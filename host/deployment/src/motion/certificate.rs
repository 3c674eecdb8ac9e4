//! What a check of a motion found, as it stands in a schedule.

use super::check::Report;
use super::ground::Ground;
use super::thickness::Thickness;
use serde::{Deserialize, Serialize};

/// What was checked of a schedule's motion, and what was found. Lengths are in panel lengths.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Certificate {
    /// Thickness of the plates.
    pub thickness: f64,
    /// Border of every plate that may touch anything.
    pub rim: f64,
    /// Whether the plates stand for panels of no thickness.
    pub ideal: bool,
    /// From the ground to the free side, where there is one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub ground: Option<[f64; 3]>,
    /// Pairs of a panel that moves and one that stands still, over all steps.
    pub panel_pairs: u64,
    /// Pairs of boxes that came near, of which every motion was looked at as a whole.
    pub box_pairs: u64,
    /// Gaps between what doesn't touch are no smaller; 0 where something collides.
    pub clearance: f64,
    /// Collisions that were allowed, in words; none in a free motion.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub collisions: Vec<String>,
}

impl Certificate {
    /// The certificate of a report.
    pub fn of(report: &Report, thickness: Thickness, ideal: bool, ground: Option<Ground>) -> Self {
        let told = |(step, collision): &(usize, super::Collision)| format!("step {step}: {collision}");
        Self {
            thickness: thickness.thickness,
            rim: thickness.rim,
            ideal,
            ground: ground.map(|ground| ground.normal.to_array()),
            panel_pairs: report.panel_pairs,
            box_pairs: report.box_pairs,
            clearance: report.clearance,
            collisions: report.collisions.iter().map(told).collect(),
        }
    }

    /// Whether nothing collides.
    pub fn is_free(&self) -> bool {
        self.collisions.is_empty()
    }
}
