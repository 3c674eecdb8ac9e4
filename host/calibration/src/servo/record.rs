//! What was seen of one servo, what was guessed of it, and what it may be driven with.

use super::judge;

/// One reading.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Look {
    /// The pulse.
    pub pulse_us: u16,
    /// The hinge's opening angle.
    pub angle_deg: f64,
    /// It pushed against something at this pulse, and was relaxed before it was read.
    pub pushes: bool,
}

/// All readings of one servo, in the order in which they were made.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ServoRecord {
    /// The readings; the first is in the middle.
    pub looks: Vec<Look>,
}

impl ServoRecord {
    /// Adds a reading that is believed. What contradicts it is forgotten, and what was read at the same pulse.
    pub fn take(&mut self, look: Look, nominal: &ServoNominal, bounds: &ServoBounds) {
        let wrong = judge::contradicted(self, nominal, bounds, &look);
        let stays = |old: &Look| {
            old.pushes != look.pushes || (old.pulse_us != look.pulse_us && !wrong.contains(&old.pulse_us))
        };
        self.looks.retain(stays);
        self.looks.push(look);
    }
}

/// What the rig file says of a servo.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ServoNominal {
    /// Pulse at an opening angle of 0 degrees.
    pub pulse_0_us: f64,
    /// Pulse at an opening angle of 270 degrees.
    pub pulse_270_us: f64,
}

impl ServoNominal {
    /// Degrees for a microsecond, above 0 whichever way it turns.
    pub fn deg_per_us(&self) -> f64 {
        270.0 / (self.pulse_270_us - self.pulse_0_us).abs()
    }
}

/// What a servo may be driven with, and how well its angles are to be met.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ServoBounds {
    /// Shortest pulse.
    pub shortest_us: u16,
    /// Longest pulse.
    pub longest_us: u16,
    /// A reading this near to an angle is at it.
    pub tolerance_deg: f64,
}
