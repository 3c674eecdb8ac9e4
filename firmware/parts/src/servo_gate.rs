//! When pulses may come out of the servo driver: only those that are wanted now, and none that were wanted before a stop.
//!
//! The core's side says what is wanted and shuts the gate at once. The bus's side is slower: when it has told the chip, the gate opens, if
//! nothing was stopped meanwhile and the same servos are wanted still. A pulse may be some milliseconds old, as a servo on its way.

use crate::CHANNELS;
use zygote_core::PulseMicros;

/// A pulse for each servo, or none.
pub type Pulses = [Option<PulseMicros>; CHANNELS];

/// What is wanted at some time, with the number of stops until then.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Wanted {
    /// The pulses.
    pub pulses: Pulses,
    stops: u32,
}

/// What is wanted now.
#[derive(Debug)]
pub struct ServoGate(Wanted);

impl ServoGate {
    /// Shut: nothing is wanted.
    #[must_use]
    pub const fn new() -> Self {
        Self(Wanted { pulses: [None; CHANNELS], stops: 0 })
    }

    /// What is wanted from now on; whether the gate must be shut.
    #[must_use]
    pub fn want(&mut self, pulses: &Pulses) -> bool {
        self.0.pulses = *pulses;
        let stops = pulses.iter().all(Option::is_none);
        self.0.stops = self.0.stops.wrapping_add(stops.into());
        stops
    }

    /// What the chip is to be told.
    pub const fn wanted(&self) -> Wanted {
        self.0
    }

    /// The chip has been told this; whether the gate may open.
    #[must_use]
    pub fn may_open(&self, told: &Wanted) -> bool {
        let mut pairs = told.pulses.iter().zip(&self.0.pulses);
        told.stops == self.0.stops
            && pairs.all(|(told, wanted)| told.is_some() == wanted.is_some())
            && told.pulses.iter().any(Option::is_some)
    }
}

impl Default for ServoGate {
    fn default() -> Self {
        Self::new()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pulses(of: &[(usize, u16)]) -> Pulses {
        let mut pulses = [None; CHANNELS];
        for &(channel, us) in of {
            pulses[channel] = Some(PulseMicros(us));
        }
        pulses
    }

    #[test]
    fn the_gate_opens_once_the_chip_was_told_and_not_for_nothing() {
        let mut gate = ServoGate::new();
        assert!(!gate.may_open(&gate.wanted()), "nothing is wanted");
        assert!(!gate.want(&pulses(&[(3, 1_500)])));
        assert!(gate.may_open(&gate.wanted()));
        assert!(gate.want(&pulses(&[])), "shut");
        assert!(!gate.may_open(&gate.wanted()));
    }

    #[test]
    fn servos_on_their_way_open_it_although_they_moved_on() {
        let mut gate = ServoGate::new();
        assert!(!gate.want(&pulses(&[(0, 500), (15, 900)])));
        let told = gate.wanted();
        assert!(!gate.want(&pulses(&[(0, 502), (15, 899)])));
        assert!(gate.may_open(&told));
    }

    #[test]
    fn a_stop_while_the_chip_is_being_told_keeps_it_shut() {
        let mut gate = ServoGate::new();
        assert!(!gate.want(&pulses(&[(0, 500)])));
        let told = gate.wanted();
        assert!(gate.want(&pulses(&[])));
        assert!(!gate.may_open(&told));
        assert!(!gate.want(&pulses(&[(0, 500)])), "even if the same is wanted again");
        assert!(!gate.may_open(&told));
        assert!(gate.may_open(&gate.wanted()));
    }

    #[test]
    fn a_servo_more_or_less_has_to_be_told_first() {
        let mut gate = ServoGate::new();
        assert!(!gate.want(&pulses(&[(0, 500)])));
        let told = gate.wanted();
        for other in [&[(0, 500), (1, 500)][..], &[(1, 500)]] {
            assert!(!gate.want(&pulses(other)));
            assert!(!gate.may_open(&told));
        }
    }
}
