//! Whether two bodies stay apart over intervals of their angles: proved, not sampled.
//!
//! Where some direction parts the extents of both over the whole intervals, they are apart. Where none does, the interval
//! over which its body travels further is halved. A piece over which both travel less than [`FINEST`] and which is still
//! not parted counts as a conflict: so a verdict "apart" is always right, and a conflict is wrong by that little at most.

use super::TOUCHING;
use super::cuboid::directions;
use super::turning::{Body, Interval};
use glam::DVec3;

/// Over less than this, panel lengths, intervals aren't halved any more.
///
/// Plates that are laid against each other come apart by the square of the angle only: this fine, that is below
/// [`TOUCHING`].
pub const FINEST: f64 = 1e-5;

/// Where two bodies meet, or come too near to tell.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Conflict {
    /// Angles of the first body, radians, from the least.
    pub first: [f64; 2],
    /// Angles of the second body.
    pub second: [f64; 2],
}

/// Which conflict is looked for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Wanted {
    /// The one at the least angle of the first body.
    Least,
    /// Whichever is found soonest.
    Any,
}

/// Whether two bodies are apart whatever the angles of both are; else the conflict at the least angle of the first.
///
/// # Errors
/// The conflict.
pub fn apart(first: &Body, second: &Body) -> Result<(), Conflict> {
    Pair {
        first,
        second,
        wanted: Wanted::Least,
        touching: TOUCHING,
        finest: FINEST,
        clearance: None,
        hint: None,
    }
    .over_all()
    .map_or(Ok(()), Err)
}

/// Two bodies in question.
pub(super) struct Pair<'a> {
    pub(super) first: &'a Body,
    pub(super) second: &'a Body,
    pub(super) wanted: Wanted,
    /// So much of overlap still is touching.
    pub(super) touching: f64,
    /// Intervals over which both travel less aren't halved: [`FINEST`], or more where a conflict may be wrong by more.
    pub(super) finest: f64,
    /// The least clearance so far, where somebody asks for it: lowered to what is proved for these two.
    pub(super) clearance: Option<&'a mut f64>,
    /// The direction that parted them last.
    pub(super) hint: Option<DVec3>,
}

impl Pair<'_> {
    /// The conflict over the whole motions.
    pub(super) fn over_all(&mut self) -> Option<Conflict> {
        let seconds = self.second.quarters();
        for first in self.first.quarters() {
            for second in &seconds {
                if let Some(conflict) = self.over(&first, second) {
                    return Some(conflict);
                }
            }
        }
        None
    }

    fn over(&mut self, first: &Interval, second: &Interval) -> Option<Conflict> {
        if self.parted(first, second) {
            return None;
        }
        let travel = (self.first.travel(first), self.second.travel(second));
        let found = Conflict { first: [first.from, first.to], second: [second.from, second.to] };
        if travel.0.max(travel.1) <= self.finest {
            return Some(found);
        }
        if self.wanted == Wanted::Any {
            let (a, b) = (first.middle(), second.middle());
            if self.first.at(a).gap(&self.second.at(b)) < -self.touching {
                return Some(Conflict { first: [a, a], second: [b, b] });
            }
        }
        if travel.0 >= travel.1 {
            first.halves().iter().find_map(|half| self.over(half, second))
        } else {
            second.halves().iter().find_map(|half| self.over(first, half))
        }
    }

    /// Whether a direction parts both over the intervals.
    fn parted(&mut self, first: &Interval, second: &Interval) -> bool {
        let (a, b) = (self.first.at(first.middle()), self.second.at(second.middle()));
        let axes = [self.hint, self.first.axis(), self.second.axis()].into_iter().flatten();
        let mut widest: Option<f64> = None;
        // Where both turn, what lies against the other at an end of the interval is parted by its normal there, by none of
        // the middle.
        let both = self.first.axis().is_some() && self.second.axis().is_some();
        let normal = |body: &Body, angle: f64| body.at(angle).half[2].normalize_or_zero();
        let at_ends = [(self.first, first), (self.second, second)].into_iter().filter(|_| both);
        let at_ends = at_ends.flat_map(|(body, over)| [normal(body, over.from), normal(body, over.to)]);
        for direction in axes.chain(directions(&a.half, &b.half)).chain(at_ends) {
            let [low, high] = self.first.extent(direction, first);
            let [other_low, other_high] = self.second.extent(direction, second);
            let gap = (other_low - high).max(low - other_high);
            if gap < -self.touching {
                continue;
            }
            if widest.is_none_or(|widest| gap > widest) {
                self.hint = Some(direction);
                widest = Some(gap);
            }
            // Further directions could only prove more room: of use where this one proves less than is known so far.
            if self.clearance.as_deref().is_none_or(|clearance| gap >= *clearance) {
                break;
            }
        }
        if let (Some(widest), Some(clearance)) = (widest, self.clearance.as_deref_mut()) {
            *clearance = clearance.min(widest.max(0.0));
        }
        widest.is_some()
    }
}
