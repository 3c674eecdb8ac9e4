//! A box that turns about an axis, or stands still, and how wide it gets along a direction over an interval of angles.

use super::cuboid::Cuboid;
use glam::DVec3;
use std::f64::consts::TAU;

/// A hinge's motion in space: a turn about an axis, and with it an even shift.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Turn {
    /// A point of the axis.
    pub anchor: DVec3,
    /// Direction of the axis, a unit vector.
    pub axis: DVec3,
    /// The whole turn, radians, 0 or more.
    pub angle: f64,
    /// Shift for every radian, panel lengths.
    pub shift: DVec3,
}

impl Turn {
    /// A turn by `angle` radians, 0 or more, in which everything also shifts by `stretch` in all.
    pub fn new(anchor: DVec3, axis: DVec3, angle: f64, stretch: DVec3) -> Self {
        let shift = if angle > 0.0 { stretch / angle } else { DVec3::ZERO };
        Self { anchor, axis, angle, shift }
    }

    /// The shift of the whole turn.
    pub fn stretch(&self) -> DVec3 {
        self.shift * self.angle
    }
}

/// Angles from one to another, radians, less than half a turn apart.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Interval {
    /// The smaller angle.
    pub from: f64,
    /// The larger angle.
    pub to: f64,
    /// Sine and cosine of both.
    ends: [(f64, f64); 2],
}

impl Interval {
    /// The angles from `from` to `to`.
    pub fn new(from: f64, to: f64) -> Self {
        Self { from, to, ends: [from.sin_cos(), to.sin_cos()] }
    }

    /// Both halves, the smaller angles first.
    pub(super) fn halves(&self) -> [Self; 2] {
        let middle = self.middle();
        let at_middle = middle.sin_cos();
        [
            Self { from: self.from, to: middle, ends: [self.ends[0], at_middle] },
            Self { from: middle, to: self.to, ends: [at_middle, self.ends[1]] },
        ]
    }

    pub(super) fn middle(&self) -> f64 {
        f64::midpoint(self.from, self.to)
    }

    pub(super) fn width(&self) -> f64 {
        self.to - self.from
    }
}

/// A vector in a turn: the part along the axis, the part across, and that one a quarter turn further.
#[derive(Debug, Clone, Copy)]
struct Turned {
    along: f64,
    across: DVec3,
    quarter: DVec3,
}

impl Turned {
    fn new(vector: DVec3, axis: DVec3) -> Self {
        let along = vector.dot(axis);
        Self { along, across: vector - axis * along, quarter: axis.cross(vector) }
    }

    fn at(&self, axis: DVec3, (sin, cos): (f64, f64)) -> DVec3 {
        axis * self.along + self.across * cos + self.quarter * sin
    }
}

/// A coordinate that is `k + p cos(angle) + q sin(angle) + l angle`.
#[derive(Debug, Clone, Copy)]
struct Wave {
    k: f64,
    p: f64,
    q: f64,
}

impl Wave {
    fn plus(self, other: Self, sign: f64) -> Self {
        Self { k: self.k + sign * other.k, p: self.p + sign * other.p, q: self.q + sign * other.q }
    }

    fn at(self, l: f64, angle: f64, (sin, cos): (f64, f64)) -> f64 {
        self.k + self.p * cos + self.q * sin + l * angle
    }

    /// Widens `extent` by all values over the interval: those at its ends, and where the slope is 0 within.
    fn widen(self, l: f64, interval: &Interval, extent: &mut [f64; 2]) {
        let [start, end] = interval.ends;
        let mut take = |value: f64| {
            extent[0] = extent[0].min(value);
            extent[1] = extent[1].max(value);
        };
        take(self.at(l, interval.from, start));
        take(self.at(l, interval.to, end));
        let slope = |(sin, cos): (f64, f64)| self.q * cos - self.p * sin + l;
        let slopes = [slope(start), slope(end)];
        if l == 0.0 {
            // Less than half a turn has one turning point at most, and the slope changes its sign there.
            if slopes[0] > 0.0 && slopes[1] < 0.0 {
                take(self.k + self.p.hypot(self.q));
            } else if slopes[0] < 0.0 && slopes[1] > 0.0 {
                take(self.k - self.p.hypot(self.q));
            }
            return;
        }
        let bend = |(sin, cos): (f64, f64)| self.p * cos + self.q * sin;
        let (one_bend, one_slope) = (bend(start) * bend(end) > 0.0, slopes[0] * slopes[1] > 0.0);
        let steepest = self.p.hypot(self.q);
        if (one_bend && one_slope) || steepest <= l.abs() {
            return;
        }
        // The slope is steepest * cos(angle + phase) + l.
        let (phase, half) = (self.p.atan2(self.q), (-l / steepest).acos());
        for zero in [-phase - half, -phase + half] {
            let angle = interval.from + (zero - interval.from).rem_euclid(TAU);
            if angle <= interval.to {
                take(self.at(l, angle, angle.sin_cos()));
            }
        }
    }
}

/// A box that turns, or stands still.
#[derive(Debug, Clone, Copy)]
pub struct Body {
    start: Cuboid,
    turning: Option<Turning>,
}

#[derive(Debug, Clone, Copy)]
struct Turning {
    turn: Turn,
    centre: Turned,
    half: [Turned; 3],
    /// No point of the box travels further for a radian.
    speed: f64,
}

impl Body {
    /// A box that stands still.
    pub fn still(cuboid: Cuboid) -> Self {
        Self { start: cuboid, turning: None }
    }

    /// A box that turns; `cuboid` is where it is at angle 0.
    pub fn turning(cuboid: Cuboid, turn: &Turn) -> Self {
        let centre = Turned::new(cuboid.centre - turn.anchor, turn.axis);
        let half = cuboid.half.map(|half| Turned::new(half, turn.axis));
        let arm = (0..4)
            .map(|corner| {
                let sign = |bit: u32| if corner >> bit & 1 == 0 { 1.0 } else { -1.0 };
                let spoke = half[0].across + half[1].across * sign(0) + half[2].across * sign(1);
                (centre.across + spoke).length().max((centre.across - spoke).length())
            })
            .fold(0.0, f64::max);
        let speed = arm + turn.shift.length();
        Self { start: cuboid, turning: Some(Turning { turn: *turn, centre, half, speed }) }
    }

    /// The box at angle 0.
    pub fn start(&self) -> &Cuboid {
        &self.start
    }

    /// The box at an angle, radians.
    pub fn at(&self, angle: f64) -> Cuboid {
        let Some(turning) = &self.turning else { return self.start };
        let (Turn { anchor, axis, shift, .. }, ends) = (turning.turn, angle.sin_cos());
        Cuboid {
            centre: anchor + turning.centre.at(axis, ends) + shift * angle,
            half: turning.half.map(|half| half.at(axis, ends)),
        }
    }

    /// The least and the greatest coordinate along a unit vector over all angles of the interval; exact but for rounding.
    pub fn extent(&self, direction: DVec3, interval: &Interval) -> [f64; 2] {
        let Some(turning) = &self.turning else {
            let (middle, reach) = (self.start.centre.dot(direction), self.start.reach(direction));
            return [middle - reach, middle + reach];
        };
        let Turn { anchor, axis, shift, .. } = turning.turn;
        let rise = direction.dot(axis);
        let wave = |turned: &Turned| Wave {
            k: turned.along * rise,
            p: turned.across.dot(direction),
            q: turned.quarter.dot(direction),
        };
        let mut centre = wave(&turning.centre);
        centre.k += anchor.dot(direction);
        let [u, v, w] = [0, 1, 2].map(|axis| wave(&turning.half[axis]));
        let l = shift.dot(direction);
        let mut extent = [f64::INFINITY, f64::NEG_INFINITY];
        for sign in [1.0, -1.0] {
            let centre = centre.plus(u, sign);
            for sign in [1.0, -1.0] {
                let centre = centre.plus(v, sign);
                centre.plus(w, 1.0).widen(l, interval, &mut extent);
                centre.plus(w, -1.0).widen(l, interval, &mut extent);
            }
        }
        extent
    }

    /// The angles of the whole motion, in pieces of a quarter turn at most.
    pub(super) fn quarters(&self) -> Vec<Interval> {
        let angle = self.turning.map_or(0.0, |turning| turning.turn.angle);
        quarters(angle)
    }

    /// The least and the greatest coordinates over the whole motion.
    pub(super) fn swept(&self) -> [DVec3; 2] {
        let pieces = self.quarters();
        let [x, y, z] = [DVec3::X, DVec3::Y, DVec3::Z].map(|axis| {
            let extents = pieces.iter().map(|piece| self.extent(axis, piece));
            extents.fold([f64::INFINITY, f64::NEG_INFINITY], |all, [low, high]| {
                [all[0].min(low), all[1].max(high)]
            })
        });
        [0, 1].map(|end| DVec3::new(x[end], y[end], z[end]))
    }

    /// No point of the box travels further over the interval, panel lengths.
    pub(super) fn travel(&self, interval: &Interval) -> f64 {
        self.turning.map_or(0.0, |turning| turning.speed * interval.width())
    }

    /// The direction of the axis, where there is one.
    pub(super) fn axis(&self) -> Option<DVec3> {
        self.turning.map(|turning| turning.turn.axis)
    }
}

/// The angles from 0 to `angle`, in pieces of a quarter turn at most.
fn quarters(angle: f64) -> Vec<Interval> {
    // A quarter that came out a little too long is still one.
    let pieces = (angle / std::f64::consts::FRAC_PI_2 - 1e-9).ceil().max(1.0);
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a few pieces, at least one")]
    let count = pieces as usize;
    (0..count)
        .map(|piece| Interval::new(angle * piece as f64 / pieces, angle * (piece + 1) as f64 / pieces))
        .collect()
}
