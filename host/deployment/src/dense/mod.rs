//! A motion seen anew, with code of its own: **dense sampling** of what [`crate::motion`] proves.
//!
//! ```text
//! Plan -> Plates (hinges as motions in the zygote's space) -> Sampler: boxes that move against all others, degree by degree
//! Schedule -> Scheduled (order, certificate)
//! Order -> runs: one by one; and at once, every hinge as soon as it may and at its own random speed
//!     -> Verdict: who meets whom, and the least clearance seen
//! ```
//!
//! Nothing here is shared with the motion's checker but the plan and the rules of geometry: poses are products of hinge
//! motions instead of chains of frames, boxes are compared pose by pose instead of over intervals. What happens between
//! two samples it doesn't see.

mod plates;
mod run;
mod sampler;
mod scheduled;
mod slab;
#[cfg(test)]
mod tests;

use crate::order::Order;
use crate::schedule::Fingerprint;
use plates::Plates;
use sampler::Sampler;
pub use scheduled::Scheduled;
use std::fmt;
use zygote_stacking::Plan;

/// What is looked at. Lengths are panel lengths.
#[derive(Debug, Clone, PartialEq)]
pub struct Setting {
    /// Thickness of the plates, above 0.
    pub thickness: f64,
    /// Border of every plate that may touch anything, from 0 to less than a half.
    pub rim: f64,
    /// From the ground to the free side, where there is one; of any length above 0.
    pub ground: Option<[f64; 3]>,
    /// No hinge turns further from one sample to the next, degrees, above 0.
    pub step_deg: f64,
    /// So many times the hinges move at once, as the order lets them, at random speeds; besides once one by one.
    pub at_once: usize,
}

/// Why nothing can be looked at.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum DenseError {
    /// A number out of its range.
    #[error("{what}: expected {expected}, found {found}")]
    Setting {
        /// Which one.
        what: &'static str,
        /// Its range.
        expected: &'static str,
        /// What was given.
        found: f64,
    },
    /// Hinges that are no tree.
    #[error("plan: the hinges must lead from the root to every panel in one way, not so to panel {panel}")]
    Tree {
        /// The panel.
        panel: usize,
    },
    /// A hinge whose angles don't lead from zygote to target.
    #[error("plan: hinge {hinge}: its angles don't bring its panels from the zygote to the target")]
    Angles {
        /// The hinge.
        hinge: usize,
    },
    /// An order that doesn't have every hinge once, after all that it waits for.
    #[error("order: hinge {hinge} must stand in it once, after all that it waits for")]
    Order {
        /// The hinge.
        hinge: usize,
    },
    /// No schedule, as far as its motion goes.
    #[error("schedule: {error}")]
    Schedule {
        /// What the reader of JSON says.
        error: String,
    },
    /// A schedule of another plan.
    #[error("schedule: made for plan {schedule}, this is plan {plan}")]
    OtherPlan {
        /// The plan in the schedule.
        schedule: Fingerprint,
        /// The plan at hand.
        plan: Fingerprint,
    },
}

/// What a plate meets.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Other {
    /// Another panel.
    Panel(usize),
    /// The ground.
    Ground,
}

/// Two plates seen in each other.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Meeting {
    /// The hinge that moves the first panel.
    pub hinge: usize,
    /// A panel that it moves.
    pub panel: usize,
    /// What it is in.
    pub other: Other,
    /// How far the hinge has opened when that is first seen, degrees.
    pub angle_deg: f64,
    /// How deep at the most, panel lengths.
    pub depth: f64,
    /// Whether other hinges moved at the same time.
    pub at_once: bool,
}

/// What was seen.
#[derive(Debug, Clone, PartialEq)]
pub struct Verdict {
    /// By hinge and panels.
    pub meetings: Vec<Meeting>,
    /// The least gap between a box that moves and another, one by one, panel lengths, at most [`LOOKED_FOR`]; without those that
    /// touch at the start or at the end of the hinge's motion. Gaps are those along the direction that shows the most.
    pub clearance: f64,
    /// Poses of the whole that were looked at.
    pub samples: u64,
    /// Pairs of boxes that were compared.
    pub pairs: u64,
}

/// Up to so many panels every pair is compared.
const EVERY_PAIR: usize = 200;

/// Gaps above this, panel lengths, aren't measured.
pub const LOOKED_FOR: f64 = 0.1;

impl Verdict {
    /// Whether no plates meet.
    pub fn is_free(&self) -> bool {
        self.meetings.is_empty()
    }
}

impl fmt::Display for Meeting {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { hinge, panel, other, angle_deg, depth, at_once } = self;
        let others = if *at_once { ", others moving too" } else { "" };
        write!(f, "hinge {hinge} at {angle_deg:.1} degrees{others}: panel {panel} is in ")?;
        match other {
            Other::Panel(other) => write!(f, "panel {other}")?,
            Other::Ground => f.write_str("the ground")?,
        }
        write!(f, ", {depth:.2e} panel lengths deep at the most")
    }
}

/// Opens a plan's hinges in an order, and looks at every pose on the way: once one by one, then at once, as the order lets
/// them, each at its own speed. Up to 200 panels every box that moves is compared with every other; above that, with those
/// near it.
///
/// # Errors
/// [`DenseError`] if the plan, the order or the setting make no sense.
pub fn verify(plan: &Plan, order: &Order, setting: &Setting) -> Result<Verdict, DenseError> {
    verify_with(plan, order, &[], setting, EVERY_PAIR)
}

/// The same for hinges of which some open at a jump, as springs do: nothing else moves meanwhile, wherever it is.
///
/// # Errors
/// As [`verify`].
pub fn verify_with_jumps(
    plan: &Plan,
    order: &Order,
    jumping: &[usize],
    setting: &Setting,
) -> Result<Verdict, DenseError> {
    verify_with(plan, order, jumping, setting, EVERY_PAIR)
}

/// The same, comparing every pair up to so many panels.
fn verify_with(
    plan: &Plan,
    order: &Order,
    jumping: &[usize],
    setting: &Setting,
    every_pair: usize,
) -> Result<Verdict, DenseError> {
    setting.check()?;
    check_order(plan, order)?;
    let plates = Plates::new(plan, setting)?;
    let mut sampler = Sampler::new(&plates, setting, plan.panels() <= every_pair);
    run::one_by_one(&mut sampler, order);
    for seed in 0..setting.at_once {
        sampler.close_all();
        run::at_once(&mut sampler, order, jumping, seed as u64);
    }
    Ok(sampler.verdict())
}

impl Setting {
    fn check(&self) -> Result<(), DenseError> {
        let above_0 = |number: f64| number > 0.0 && number.is_finite();
        let steepness = |[x, y, z]: [f64; 3]| x.hypot(y).hypot(z);
        for (what, expected, good, found) in [
            ("thickness", "a finite number above 0", above_0(self.thickness), self.thickness),
            ("rim", "0 to less than 0.5", (0.0..0.5).contains(&self.rim), self.rim),
            ("step", "a finite number of degrees above 0", above_0(self.step_deg), self.step_deg),
            (
                "ground",
                "a normal of a finite length above 0",
                self.ground.is_none_or(|normal| above_0(steepness(normal))),
                self.ground.map_or(0.0, steepness),
            ),
        ] {
            if !good {
                return Err(DenseError::Setting { what, expected, found });
            }
        }
        Ok(())
    }
}

/// Every hinge once, and waiting for earlier ones only.
fn check_order(plan: &Plan, order: &Order) -> Result<(), DenseError> {
    let mut seen = vec![false; plan.hinges.len()];
    for hinge in &order.hinges {
        let waits = order.waits_for.get(*hinge).ok_or(DenseError::Order { hinge: *hinge })?;
        let known = |other: &usize| seen.get(*other).copied().unwrap_or(false);
        if *hinge >= seen.len() || seen[*hinge] || !waits.iter().all(known) {
            return Err(DenseError::Order { hinge: *hinge });
        }
        seen[*hinge] = true;
    }
    match seen.iter().position(|seen| !seen) {
        Some(hinge) => Err(DenseError::Order { hinge }),
        None => Ok(()),
    }
}
