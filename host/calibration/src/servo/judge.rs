//! Is a reading to be believed? People misread and mistype, and a sensor comes loose.

use super::record::{Look, ServoBounds, ServoNominal, ServoRecord};
use super::view::View;

/// No hinge opens further, nor closes further.
const HINGES_DEG: (f64, f64) = (-30.0, 300.0);
/// A reading further off what is expected is asked for again.
const SURPRISE_DEG: f64 = 40.0;
/// In the middle, at first: a horn sits on some tooth.
const FIRST_SURPRISE_DEG: f64 = 60.0;
/// Which way it turns two readings tell.
const ENOUGH: usize = 2;

/// Why a reading is asked for again.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum Doubt {
    /// No hinge stands there.
    #[error("no hinge opens to {found_deg:.1} deg: expected {} to {} deg", HINGES_DEG.0, HINGES_DEG.1)]
    Impossible {
        /// The reading.
        found_deg: f64,
    },
    /// Another reading was on the other side of it.
    #[error("{found_deg:.1} deg contradicts the {other_deg:.1} deg that were read at {other_us} us")]
    Contradiction {
        /// The reading.
        found_deg: f64,
        /// The earlier one.
        other_deg: f64,
        /// Its pulse.
        other_us: u16,
    },
    /// Far from where it was expected.
    #[error("{found_deg:.1} deg is far from the {expected_deg:.0} deg that were expected")]
    Surprise {
        /// The reading.
        found_deg: f64,
        /// By what was seen before.
        expected_deg: f64,
    },
}

impl Doubt {
    /// It can't be, however often it is read.
    pub fn is_final(&self) -> bool {
        match self {
            Self::Impossible { .. } => true,
            Self::Contradiction { .. } | Self::Surprise { .. } => false,
        }
    }
}

/// What is odd about a reading; read again, it may be believed.
pub fn doubt(
    record: &ServoRecord,
    nominal: &ServoNominal,
    bounds: &ServoBounds,
    look: &Look,
) -> Option<Doubt> {
    let found_deg = look.angle_deg;
    if !(HINGES_DEG.0..=HINGES_DEG.1).contains(&found_deg) {
        return Some(Doubt::Impossible { found_deg });
    }
    if look.pushes {
        return None;
    }
    let wrong = contradicted(record, nominal, bounds, look);
    let other = record.looks.iter().find(|other| !other.pushes && wrong.contains(&other.pulse_us));
    if let Some(other) = other {
        let Look { pulse_us: other_us, angle_deg: other_deg, .. } = *other;
        return Some(Doubt::Contradiction { found_deg, other_deg, other_us });
    }
    let view = View::new(record, nominal, bounds);
    let by_guess =
        270.0 * (f64::from(look.pulse_us) - nominal.pulse_0_us) / (nominal.pulse_270_us - nominal.pulse_0_us);
    let (expected_deg, most_deg) = match view.predicted_deg(view.x(look.pulse_us)) {
        Some(expected_deg) => (expected_deg, SURPRISE_DEG),
        None => (by_guess, FIRST_SURPRISE_DEG),
    };
    ((found_deg - expected_deg).abs() > most_deg).then_some(Doubt::Surprise { found_deg, expected_deg })
}

/// The pulses of free readings that can't be true together with this one: the hinge would turn back.
pub(super) fn contradicted(
    record: &ServoRecord,
    nominal: &ServoNominal,
    bounds: &ServoBounds,
    look: &Look,
) -> Vec<u16> {
    if look.pushes {
        return Vec::new();
    }
    let slack_deg = 2.0 * bounds.tolerance_deg + 1.0;
    let mut with = record.clone();
    // One reading doesn't tell which way it turns; this one may.
    if record.looks.iter().filter(|look| !look.pushes).count() < ENOUGH {
        with.looks.push(*look);
    }
    let view = View::new(&with, nominal, bounds);
    let (x, angle_deg) = (view.x(look.pulse_us), look.angle_deg);
    let turns_back = |other: &&Look| {
        let (way, turned_deg) = (view.x(other.pulse_us) - x, other.angle_deg - angle_deg);
        if way == 0.0 { turned_deg.abs() > slack_deg } else { turned_deg * way.signum() < -slack_deg }
    };
    let free = record.looks.iter().filter(|other| !other.pushes);
    free.filter(turns_back).map(|other| other.pulse_us).collect()
}
