//! Which hinges must wait for which: of an order that is free one hinge at a time, what is needed to stay free whatever the
//! hinges' speeds.
//!
//! What one hinge moves, as the order has it at that step, turning from closed to open, is its *leg*. Kept of the order is
//! (1) that of any two hinges one of which moves the other, and (2) that of any two whose legs can meet, at any two of
//! their angles, ends included. The rest may happen in any order, or at once.
//!
//! Why that is free, where the order is:
//! * By (1) every panel goes through the legs of the hinges that move it, one after the other, as the order has it; only
//!   when, compared with other panels, is open. At any moment it is on a leg or rests where one leg ends and the next begins.
//!   Take two panels x and y; hinges that move both don't bring them together.
//! * x on a leg of A, y on a leg of B, neither hinge moving the other panel: had the legs a common point, A and B would
//!   keep their order by (2), and not turn at once.
//! * x on a leg of A, y at rest between its legs of B and of C. Where the order has y rest there too when A turns, its own
//!   check says that they are apart. Else the order has A before B or after C. y's place of rest is an end of the legs of B and
//!   C; if x met it there, (1) or (2) would make B wait for A, or A for C, and y not rest there.
//! * Both at rest: as they were when the later one of them came to rest, or in the zygote.
//!
//! The ground stands still, so what the order's check says of it holds for every leg.

use super::TOUCHING;
use super::apart::{Pair, Wanted};
use super::state::Motion;
use super::thickness::{MotionError, Thickness};
use super::turning::Body;
use crate::order::Order;
use glam::DVec3;
use zygote_stacking::Plan;

/// Legs of more hinges, or of more boxes in all, aren't compared: then the order stays one by one.
const MOST_HINGES: usize = 20_000;
const MOST_BOXES: usize = 400_000;

/// Legs of which it doesn't show that they are apart in pieces of so much travel, panel lengths, keep their order: finer
/// pieces of two turns at once are many.
const FINEST: f64 = 1e-4;

/// The order with only those waits that keep it free whatever the hinges' speeds, and of those none that follows from others.
///
/// `hinges` are all hinges of the plan, in an order that [`super::check`] finds free, with the ground too where there is one.
/// Of an order with collisions the result has no collisions but these. Plans too large to compare (above 20,000 hinges, or
/// 400,000 boxes in motion, counted for every step anew) stay [`Order::one_by_one`].
///
/// # Errors
/// See [`Motion::new`]; also an order that doesn't have every hinge once.
pub fn waits_for(plan: &Plan, hinges: &[usize], thickness: Thickness) -> Result<Order, MotionError> {
    let mut motion = Motion::new(plan, thickness, None)?;
    each_once(hinges, motion.linkage().hinges())?;
    let one_by_one = || Ok(Order::one_by_one(hinges.to_vec()));
    if hinges.len() > MOST_HINGES {
        return one_by_one();
    }
    let mut legs = Vec::with_capacity(hinges.len());
    let mut boxes = 0;
    for hinge in hinges {
        let leg = Leg::new(&motion, *hinge);
        boxes += leg.parts.len();
        if boxes > MOST_BOXES {
            return one_by_one();
        }
        legs.push(leg);
        motion.open(*hinge);
    }
    let linkage = motion.linkage();
    let moves = |a: usize, b: usize| linkage.moves(a, linkage.child(b));
    let touching = thickness.touching();
    let mut waits_for = vec![Vec::new(); hinges.len()];
    let mut before: Vec<Places> = Vec::with_capacity(hinges.len());
    for (place, hinge) in hinges.iter().enumerate() {
        let mut all = Places::none(hinges.len());
        // From the latest on: what an earlier one would add then follows already, or is needed.
        for earlier in (0..place).rev() {
            let other = hinges[earlier];
            if !all.has(earlier)
                && (moves(other, *hinge)
                    || moves(*hinge, other)
                    || legs[earlier].can_meet(&legs[place], touching))
            {
                waits_for[*hinge].push(other);
                all.join(earlier, &before[earlier]);
            }
        }
        waits_for[*hinge].sort_unstable();
        before.push(all);
    }
    Ok(Order { hinges: hinges.to_vec(), waits_for })
}

fn each_once(hinges: &[usize], count: usize) -> Result<(), MotionError> {
    let mut times = vec![0; count];
    for hinge in hinges {
        *times.get_mut(*hinge).ok_or(MotionError::NoHinge { found: *hinge, hinges: count })? += 1;
    }
    match times.iter().position(|times| *times != 1) {
        Some(hinge) => Err(MotionError::Order { hinge, found: times[hinge] }),
        None => Ok(()),
    }
}

/// What a hinge moves, with all that it sweeps.
struct Leg {
    parts: Vec<(Body, Swept)>,
    whole: Swept,
}

impl Leg {
    fn new(motion: &Motion, hinge: usize) -> Self {
        let parts: Vec<_> =
            motion.leg(hinge).into_iter().map(|body| (body, Swept::from(body.swept()))).collect();
        let whole = parts.iter().fold(Swept::NOTHING, |whole, (_, swept)| whole.with(swept));
        Self { parts, whole }
    }

    fn can_meet(&self, other: &Self, touching: f64) -> bool {
        if !self.whole.reaches(&other.whole) {
            return false;
        }
        let near = |(_, swept): &&(Body, Swept)| swept.reaches(&other.whole);
        self.parts.iter().filter(near).any(|(first, swept)| {
            let mut others = other.parts.iter().filter(|(_, other)| swept.reaches(other));
            others.any(|(second, _)| {
                let wanted = Wanted::Any;
                Pair { first, second, wanted, touching, finest: FINEST, clearance: None, hint: None }
                    .over_all()
                    .is_some()
            })
        })
    }
}

/// Least and greatest coordinates of all that is swept.
#[derive(Clone, Copy)]
struct Swept {
    low: DVec3,
    high: DVec3,
}

impl From<[DVec3; 2]> for Swept {
    fn from([low, high]: [DVec3; 2]) -> Self {
        Self { low, high }
    }
}

impl Swept {
    const NOTHING: Self = Self { low: DVec3::INFINITY, high: DVec3::NEG_INFINITY };

    fn with(self, other: &Self) -> Self {
        Self { low: self.low.min(other.low), high: self.high.max(other.high) }
    }

    fn reaches(&self, other: &Self) -> bool {
        let touching = DVec3::splat(TOUCHING);
        (self.low + touching).cmplt(other.high).all() && (other.low + touching).cmplt(self.high).all()
    }
}

/// A set of places in the order.
struct Places(Vec<u64>);

impl Places {
    fn none(count: usize) -> Self {
        Self(vec![0; count.div_ceil(64)])
    }

    fn has(&self, place: usize) -> bool {
        self.0[place / 64] >> (place % 64) & 1 == 1
    }

    /// Takes in a place, and all that is before it.
    fn join(&mut self, place: usize, before: &Self) {
        for (word, other) in self.0.iter_mut().zip(&before.0) {
            *word |= other;
        }
        self.0[place / 64] |= 1 << (place % 64);
    }
}
