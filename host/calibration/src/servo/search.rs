//! The next pulse to look at.

use super::ANGLES_DEG;
use super::record::{ServoBounds, ServoNominal, ServoRecord};
use super::view::{Seen, View};

/// So far it goes at once past all that was seen: what is there nobody knows.
const LONGEST_REACH_DEG: f64 = 45.0;
/// A pulse is approached from the middle's side over this, so that backlash lies on one side.
const RUN_UP_DEG: f64 = 10.0;
/// With so many readings near an angle the line doesn't help, and the gap is halved.
const HALVE_AFTER: usize = 5;
/// With so many the servo is what it is.
const GIVE_UP_AFTER: usize = 12;
const NEAR_DEG: f64 = 15.0;
/// No servo needs more readings.
const MOST_LOOKS: usize = 60;
/// By the guess it should have turned so far ..
const MOVING_DEG: f64 = 20.0;
/// .. but has turned by less than this share of it.
const MOVING_SHARE: f64 = 0.2;

/// What to do next.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum NextLook {
    /// Read the angle at a pulse.
    At {
        /// The pulse.
        pulse_us: u16,
        /// Go there first, so that the pulse is approached from the middle.
        via_us: Option<u16>,
        /// The angle that is looked for, degrees; none in the middle, at first.
        for_deg: Option<u16>,
    },
    /// Everything that can be found is.
    Done,
}

/// A servo that can't be calibrated.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum ServoRefusal {
    /// It pushes in the middle.
    #[error(
        "it pushes against something at {pulse_us} us, in the middle of its way: free the hinge, or mend its pulses in the rig file"
    )]
    Jammed {
        /// The pulse.
        pulse_us: u16,
    },
    /// Its angle stays.
    #[error(
        "it turned by {turned_deg} deg between {from_us} and {to_us} us, expected about {expected_deg} deg: look at its wire, channel and horn"
    )]
    Still {
        /// Shortest pulse.
        from_us: u16,
        /// Longest pulse.
        to_us: u16,
        /// How far it turned.
        turned_deg: u32,
        /// How far it should have.
        expected_deg: u32,
    },
    /// The readings lead nowhere.
    #[error(
        "{MOST_LOOKS} readings didn't settle it: it doesn't stand where it is told to, or the readings are wrong"
    )]
    Endless,
}

/// What is known of one angle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Aim {
    /// It was read at this pulse, within the tolerance.
    Found(Seen),
    /// To be looked at.
    Try(f64),
    /// The hinge's way ends at this angle.
    Stop(f64),
    /// The last pulse allowed turns it this far.
    Bound(f64),
    /// No pulse is nearer than this.
    Coarse(Seen),
}

/// The next reading to make.
///
/// # Errors
/// [`ServoRefusal`].
pub fn next_look(
    record: &ServoRecord,
    nominal: &ServoNominal,
    bounds: &ServoBounds,
) -> Result<NextLook, ServoRefusal> {
    let view = View::new(record, nominal, bounds);
    let Some(centre) = view.centre else {
        if let Some(pushed) = record.looks.first() {
            return Err(ServoRefusal::Jammed { pulse_us: pushed.pulse_us });
        }
        let middle = f64::midpoint(nominal.pulse_0_us, nominal.pulse_270_us);
        let middle = middle.clamp(f64::from(bounds.shortest_us), f64::from(bounds.longest_us));
        let pulse_us = view.pulse(view.along(middle));
        return Ok(NextLook::At { pulse_us, via_us: None, for_deg: None });
    };
    if record.looks.len() > MOST_LOOKS {
        return Err(ServoRefusal::Endless);
    }
    moves(&view, nominal)?;
    // Down first, then up: each way once.
    for for_deg in [90, 0, 180, 270] {
        if let Aim::Try(x) = aim(&view, f64::from(for_deg), bounds.tolerance_deg) {
            let (pulse_us, last) = (view.pulse(x), record.looks.last());
            let outward = (x - centre.x).signum();
            let run_up = RUN_UP_DEG / nominal.deg_per_us();
            let on_its_way =
                |last: &super::Look| !last.pushes && (x - view.x(last.pulse_us)) * outward >= run_up;
            // Not past the middle: that is where it is known to be free.
            let via_x = x - outward * run_up.min((x - centre.x).abs());
            let via_us = (!last.is_some_and(on_its_way)).then(|| view.pulse(via_x));
            return Ok(NextLook::At { pulse_us, via_us, for_deg: Some(for_deg) });
        }
    }
    Ok(NextLook::Done)
}

fn moves(view: &View, nominal: &ServoNominal) -> Result<(), ServoRefusal> {
    let looks = view.free.len() + view.pushed.len();
    let (Some(first), Some(last)) = (view.free.first(), view.free.last()) else { return Ok(()) };
    let expected_deg = (last.x - first.x) * nominal.deg_per_us();
    let angles = || view.free.iter().map(|seen| seen.angle_deg);
    let turned_deg = angles().fold(f64::MIN, f64::max) - angles().fold(f64::MAX, f64::min);
    // After one reading on either side: it may stand at an end stop.
    if looks < 3 || expected_deg < MOVING_DEG || turned_deg >= MOVING_SHARE * expected_deg {
        return Ok(());
    }
    let (one, other) = (view.pulse(first.x), view.pulse(last.x));
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "for people; it saturates")]
    let whole = |degrees: f64| degrees.round() as u32;
    Err(ServoRefusal::Still {
        from_us: one.min(other),
        to_us: one.max(other),
        turned_deg: whole(turned_deg),
        expected_deg: whole(expected_deg),
    })
}

/// What is known of the angle of each of [`ANGLES_DEG`], with the pulses as they are.
pub(super) fn aims(view: &View, tolerance_deg: f64) -> Vec<(u16, Aim)> {
    ANGLES_DEG.iter().map(|angle| (*angle, aim(view, f64::from(*angle), tolerance_deg))).collect()
}

fn aim(view: &View, target_deg: f64, tolerance_deg: f64) -> Aim {
    let back = |seen: Seen| Seen { x: -seen.x, angle_deg: -seen.angle_deg };
    if view.centre.is_some_and(|centre| target_deg < centre.angle_deg) {
        return match upward(&view.mirrored(), -target_deg, tolerance_deg) {
            Aim::Found(seen) => Aim::Found(back(seen)),
            Aim::Coarse(seen) => Aim::Coarse(back(seen)),
            Aim::Try(x) => Aim::Try(-x),
            Aim::Stop(angle_deg) => Aim::Stop(-angle_deg),
            Aim::Bound(angle_deg) => Aim::Bound(-angle_deg),
        };
    }
    upward(view, target_deg, tolerance_deg)
}

/// The aim for an angle above the middle.
fn upward(view: &View, target_deg: f64, tolerance_deg: f64) -> Aim {
    let miss = |seen: &&Seen| (seen.angle_deg - target_deg).abs();
    let nearest = || view.free.iter().min_by(|one, other| miss(one).total_cmp(&miss(other)));
    if let Some(stop_deg) = view.stop_deg() {
        if target_deg > stop_deg + 0.5 * tolerance_deg {
            return Aim::Stop(stop_deg);
        }
        if target_deg > stop_deg - 3.0 * tolerance_deg {
            return at_the_stop(view, target_deg, stop_deg, tolerance_deg);
        }
    }
    if let Some(seen) = nearest().filter(|seen| miss(seen) <= tolerance_deg) {
        return Aim::Found(*seen);
    }
    let below =
        view.free.iter().filter(|seen| seen.angle_deg < target_deg).max_by(|one, other| by_angle(one, other));
    let above =
        view.free.iter().filter(|seen| seen.angle_deg > target_deg).min_by(|one, other| by_angle(one, other));
    let Some(below) = below.or(view.free.last()) else { return Aim::Bound(target_deg) };
    match above {
        Some(above) => between(view, below, above, target_deg),
        None => beyond(view, below, target_deg),
    }
}

fn by_angle(one: &Seen, other: &Seen) -> std::cmp::Ordering {
    one.angle_deg.total_cmp(&other.angle_deg)
}

/// By the line between two readings; halving where that doesn't get on.
fn between(view: &View, below: &Seen, above: &Seen, target_deg: f64) -> Aim {
    let (low, high) = (below.x.min(above.x), below.x.max(above.x));
    let tries = view.free.iter().filter(|seen| (seen.angle_deg - target_deg).abs() < NEAR_DEG).count();
    let nearer = if target_deg - below.angle_deg <= above.angle_deg - target_deg { *below } else { *above };
    if high - low <= 1.0 || tries > GIVE_UP_AFTER {
        return Aim::Coarse(nearer);
    }
    let share = (target_deg - below.angle_deg) / (above.angle_deg - below.angle_deg);
    let by_line = below.x + share * (above.x - below.x);
    let x = if tries < HALVE_AFTER { by_line } else { f64::midpoint(low, high) };
    unseen(view, x, low, high).map_or(Aim::Coarse(nearer), Aim::Try)
}

/// The pulse nearest to `x` between two others at which nobody has looked.
fn unseen(view: &View, x: f64, low: f64, high: f64) -> Option<f64> {
    let seen = |x: f64| view.free.iter().any(|seen| (seen.x - x).abs() < 0.5);
    let middle = x.round();
    let mut away = 0.0;
    while away <= high - low {
        let fits = |x: &f64| *x > low && *x < high && !seen(*x);
        if let Some(x) = [middle + away, middle - away].into_iter().find(fits) {
            return Some(x);
        }
        away += 1.0;
    }
    None
}

/// Past all that was seen, but not far.
fn beyond(view: &View, outer: &Seen, target_deg: f64) -> Aim {
    let way_deg = (target_deg - outer.angle_deg).min(LONGEST_REACH_DEG);
    // Readings that don't rise all the way leave the furthest angle behind the furthest pulse.
    let last_x = view.free.last().map_or(outer.x, |last| last.x);
    let x = (outer.x + way_deg / view.slope_at(outer)).round().max(last_x + 1.0);
    // At a pulse at which it pushed it never looks again.
    if let Some(pushed) = view.pushed.iter().find(|seen| seen.x > outer.x && seen.x <= x) {
        let half = unseen(view, f64::midpoint(outer.x, pushed.x), outer.x, pushed.x);
        return half.map_or(Aim::Stop(pushed.angle_deg), Aim::Try);
    }
    if x <= view.most_x {
        return Aim::Try(x);
    }
    if last_x < view.most_x { Aim::Try(view.most_x) } else { Aim::Bound(outer.angle_deg) }
}

/// An angle at the end stop: a pulse at which the hinge has just not come to it, by the line of what is well inside.
fn at_the_stop(view: &View, target_deg: f64, stop_deg: f64, tolerance_deg: f64) -> Aim {
    let aim_deg = target_deg.min(stop_deg - 0.25 * tolerance_deg);
    let inside = view
        .free
        .iter()
        .filter(|seen| seen.angle_deg < stop_deg - 2.0 * tolerance_deg)
        .max_by(|one, other| by_angle(one, other));
    let Some(inside) = inside else { return Aim::Stop(stop_deg) };
    let x = (inside.x + (aim_deg - inside.angle_deg) / view.slope_at(inside)).round();
    let good = |seen: &&Seen| (seen.angle_deg - target_deg).abs() <= tolerance_deg;
    let safe = view.free.iter().rev().find(|seen| good(seen) && seen.x <= x + 1.0);
    if let Some(seen) = safe {
        return Aim::Found(*seen);
    }
    if !view.free.iter().any(|seen| (seen.x - x).abs() < 0.5) && x > inside.x {
        return Aim::Try(x);
    }
    // The line was wrong here: the innermost that does, or what is nearest.
    view.free.iter().find(good).map_or(Aim::Coarse(*inside), |seen| Aim::Found(*seen))
}
