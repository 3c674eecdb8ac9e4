//! The readings of a servo as one rising line: turned so that longer is further, and mirrored where the lower end is meant, so that
//! everything else deals with one way to turn and one end.

use super::record::{Look, ServoBounds, ServoNominal, ServoRecord};

/// Readings so far apart tell which way a servo turns.
const TELLING_DEG: f64 = 10.0;
/// A slope is taken over this at the least: readings are off by a degree.
const SLOPE_OVER_DEG: f64 = 15.0;
/// It should have turned by so much ..
const FLAT_OVER_DEG: f64 = 8.0;
/// .. but has turned by less than this share of it: it has come to its end.
const FLAT_SHARE: f64 = 0.35;

/// A reading on the line.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Seen {
    pub(super) x: f64,
    pub(super) angle_deg: f64,
}

/// The line.
#[derive(Debug, Clone)]
pub(super) struct View {
    /// By rising `x`; none of them pushed.
    pub(super) free: Vec<Seen>,
    /// By rising `x`.
    pub(super) pushed: Vec<Seen>,
    /// Where it began.
    pub(super) centre: Option<Seen>,
    /// The furthest pulse allowed.
    pub(super) most_x: f64,
    least_x: f64,
    nominal_slope: f64,
    /// Microseconds for a step along `x`: 1 or -1.
    sign: f64,
}

impl View {
    pub(super) fn new(record: &ServoRecord, nominal: &ServoNominal, bounds: &ServoBounds) -> Self {
        let sign = direction(record).unwrap_or((nominal.pulse_270_us - nominal.pulse_0_us).signum());
        let seen = |look: &Look| Seen { x: sign * f64::from(look.pulse_us), angle_deg: look.angle_deg };
        let mut free: Vec<Seen> = record.looks.iter().filter(|look| !look.pushes).map(seen).collect();
        let mut pushed: Vec<Seen> = record.looks.iter().filter(|look| look.pushes).map(seen).collect();
        let centre = free.first().copied();
        free.sort_by(|one, other| one.x.total_cmp(&other.x));
        pushed.sort_by(|one, other| one.x.total_cmp(&other.x));
        let ends = [sign * f64::from(bounds.shortest_us), sign * f64::from(bounds.longest_us)];
        Self {
            free,
            pushed,
            centre,
            most_x: ends[0].max(ends[1]),
            least_x: ends[0].min(ends[1]),
            nominal_slope: nominal.deg_per_us(),
            sign,
        }
    }

    /// The same with the lower end for the upper one; angles are turned as well.
    pub(super) fn mirrored(&self) -> Self {
        let turn = |seen: &Seen| Seen { x: -seen.x, angle_deg: -seen.angle_deg };
        Self {
            free: self.free.iter().rev().map(turn).collect(),
            pushed: self.pushed.iter().rev().map(turn).collect(),
            centre: self.centre.as_ref().map(turn),
            most_x: -self.least_x,
            least_x: -self.most_x,
            sign: -self.sign,
            ..*self
        }
    }

    pub(super) fn pulse(&self, x: f64) -> u16 {
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "it saturates, within the bounds"
        )]
        let pulse = (self.sign * x.clamp(self.least_x, self.most_x)).round() as u16;
        pulse
    }

    pub(super) fn x(&self, pulse_us: u16) -> f64 {
        self.along(f64::from(pulse_us))
    }

    pub(super) fn along(&self, pulse_us: f64) -> f64 {
        self.sign * pulse_us
    }

    /// Degrees for a microsecond around a reading, from it and what is inside of it.
    pub(super) fn slope_at(&self, outer: &Seen) -> f64 {
        let inner = self
            .free
            .iter()
            .rev()
            .find(|seen| seen.x < outer.x && seen.angle_deg <= outer.angle_deg - SLOPE_OVER_DEG);
        inner.map_or(self.nominal_slope, |inner| (outer.angle_deg - inner.angle_deg) / (outer.x - inner.x))
    }

    /// The angle at a pulse, between or beyond what was seen.
    pub(super) fn predicted_deg(&self, x: f64) -> Option<f64> {
        let (first, last) = (self.free.first()?, self.free.last()?);
        if x > last.x {
            return Some(last.angle_deg + self.slope_at(last) * (x - last.x));
        }
        if x < first.x {
            return self.mirrored().predicted_deg(-x).map(|angle_deg| -angle_deg);
        }
        let between = self.free.windows(2).find(|pair| pair[0].x <= x && x <= pair[1].x)?;
        let share = (x - between[0].x) / (between[1].x - between[0].x);
        Some(between[0].angle_deg + share * (between[1].angle_deg - between[0].angle_deg))
    }

    /// Where the hinge's way ends, as far as that was met: it pushed there, or its angle stayed.
    pub(super) fn stop_deg(&self) -> Option<f64> {
        let centre = self.centre?;
        if let Some(pushed) = self.pushed.iter().find(|seen| seen.x > centre.x) {
            return Some(pushed.angle_deg);
        }
        let outer = self.free.last().filter(|outer| outer.x > centre.x)?;
        let flat = |inner: &&Seen| {
            let expected_deg = self.slope_at(inner) * (outer.x - inner.x);
            expected_deg >= FLAT_OVER_DEG
        };
        let inner = self.free.iter().rev().filter(|seen| seen.x < outer.x).find(flat)?;
        let expected_deg = self.slope_at(inner) * (outer.x - inner.x);
        (outer.angle_deg - inner.angle_deg < FLAT_SHARE * expected_deg).then_some(outer.angle_deg)
    }
}

/// Which way it turns: 1 where longer pulses open it further.
fn direction(record: &ServoRecord) -> Option<f64> {
    let free = || record.looks.iter().filter(|look| !look.pushes);
    let low = free().min_by(|one, other| one.angle_deg.total_cmp(&other.angle_deg))?;
    let high = free().max_by(|one, other| one.angle_deg.total_cmp(&other.angle_deg))?;
    let telling = high.angle_deg - low.angle_deg >= TELLING_DEG;
    telling.then(|| (f64::from(high.pulse_us) - f64::from(low.pulse_us)).signum())
}
