//! Judges a rehearsal by what was truly the case. These rules hold in every rehearsal, whatever goes wrong.
//!
//! | rule | what must hold |
//! |---|---|
//! | S2 | no current flows unless the MCU is armed or running |
//! | S3 | no current flows 50 ms after the link timeout, counted from the last frame that reached the board |
//! | S4 | no foil gets hotter than its step's highest temperature and the [margin](margin_k) of physics, nor than the board's ceiling |
//! | S5 | no current flows 115 ms after a thermistor went open or shorted: three bad samples and 100 ms |
//! | S7 | the supply's current isn't over the limit and its 10 % for longer than three samples and a tick |
//! | S8 | no current flows 10 ms after a stop, nor at all after a reset (S1) or another host's hello (S2) |
//! | S10 | no actuator is driven before the hinges that it waits for are truly open |
//! | S11 | one arming, one start, and no step starts twice |
//! | S12 | what the host reports of each hinge is so |
//! | end | the host ends, whatever happens |
//!
//! While the MCU's program is stuck, S9's 500 ms hold in place of the shorter times. A MOSFET that sticks while the thermistor of the same
//! hinge is frozen or loose is judged by the ceiling alone. What no sensor of the board can see excuses S10 and S12 for the hinge concerned: see [`excuse`].

mod account;
mod excuse;
mod heat;
mod margin;
mod off;

pub use excuse::Excuses;
pub use margin::margin_k;

use crate::run::{Rehearsed, Trial};
use std::fmt;
use zygote_protocol::Micros;

/// A rule that didn't hold.
#[derive(Debug, Clone, PartialEq)]
pub struct Breach {
    /// Number of the rule.
    pub rule: &'static str,
    /// When.
    pub at: Micros,
    /// The heater channel concerned, where there is one.
    pub heater: Option<usize>,
    /// What was the case, and what should have been.
    pub what: String,
}

impl Breach {
    fn new(rule: &'static str, at: Micros, what: String) -> Self {
        Self { rule, at, heater: None, what }
    }
}

impl fmt::Display for Breach {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} at {:.3} s: {}", self.rule, seconds(self.at), self.what)
    }
}

/// Every rule that didn't hold.
pub fn judge(trial: &Trial, rehearsed: &Rehearsed) -> Vec<Breach> {
    let excuses = Excuses::of(trial, rehearsed);
    let mut breaches = off::judge(rehearsed);
    breaches.extend(heat::judge(trial, rehearsed));
    breaches.extend(account::judge(rehearsed, &excuses));
    breaches
}

/// What holds in a calibration: it arms and starts many times, and opens its hinges in any order, but S2 to S5, S7 and S8 are the same.
pub fn judge_calibration(trial: &Trial, rehearsed: &Rehearsed) -> Vec<Breach> {
    let mut breaches = off::judge(rehearsed);
    breaches.extend(heat::judge(trial, rehearsed));
    if rehearsed.overran {
        breaches.push(Breach::new("end", rehearsed.ended_at, "the host didn't end".to_owned()));
    }
    breaches
}

#[expect(clippy::cast_precision_loss, reason = "a rehearsal is far shorter than 2^52 us")]
pub(crate) fn seconds(time: Micros) -> f64 {
    time.0 as f64 / 1e6
}

#[cfg(test)]
mod tests;
