//! What a board keeps over power cycles, as one value: it is written down whole, so that no half of it is ever old.

use crate::{Actuator, Calibration, HeaterCalibration, ServoCalibration, Settings};
use heapless::Vec;
use serde::{Deserialize, Serialize};

/// What a board with so many heaters and servos keeps.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct Kept<const HEATERS: usize, const SERVOS: usize> {
    /// Limits lowered for good; `None` where those compiled in hold.
    pub settings: Option<Settings>,
    /// By channel; nothing is known of those beyond the last one here.
    heaters: Vec<Option<HeaterCalibration>, HEATERS>,
    /// By channel, as [`Self::heaters`].
    servos: Vec<Option<ServoCalibration>, SERVOS>,
}

impl<const HEATERS: usize, const SERVOS: usize> Kept<HEATERS, SERVOS> {
    /// Nothing.
    pub const NOTHING: Self = Self { settings: None, heaters: Vec::new(), servos: Vec::new() };

    /// What is known of a heater.
    pub fn heater(&self, channel: u16) -> Option<HeaterCalibration> {
        *self.heaters.get(usize::from(channel))?
    }

    /// What is known of a servo.
    pub fn servo(&self, channel: u16) -> Option<ServoCalibration> {
        *self.servos.get(usize::from(channel))?
    }

    /// What is known of an actuator.
    pub fn of(&self, actuator: Actuator) -> Calibration {
        match actuator {
            Actuator::Heater(channel) => Calibration::Heater { channel, known: self.heater(channel) },
            Actuator::Servo(channel) => Calibration::Servo { channel, known: self.servo(channel) },
        }
    }

    /// Takes this in; what was known of that actuator before. `None` for a channel that this board doesn't have: nothing
    /// is taken in then.
    pub fn put(&mut self, mut calibration: Calibration) -> Option<Calibration> {
        match &mut calibration {
            Calibration::Heater { channel, known } => swap(&mut self.heaters, *channel, known)?,
            Calibration::Servo { channel, known } => swap(&mut self.servos, *channel, known)?,
        }
        Some(calibration)
    }
}

/// Swaps a value with the one at a place of a list, which grows to it; `None` beyond the list's room.
fn swap<T: Clone, const N: usize>(
    list: &mut Vec<Option<T>, N>,
    channel: u16,
    value: &mut Option<T>,
) -> Option<()> {
    let at = usize::from(channel);
    if at >= list.len() {
        list.resize(at.checked_add(1)?, None).ok()?;
    }
    core::mem::swap(list.get_mut(at)?, value);
    Some(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_put_is_known_and_what_was_known_comes_back() {
        let mut kept = Kept::<4, 2>::NOTHING;
        let servo = |shortest_us| ServoCalibration { shortest_us, longest_us: 2_000 };
        let put = |channel, known| Calibration::Servo { channel, known };
        assert_eq!(kept.servo(1), None);
        assert_eq!(kept.put(put(1, Some(servo(500)))), Some(put(1, None)));
        assert_eq!((kept.servo(0), kept.servo(1)), (None, Some(servo(500))));
        assert_eq!(kept.put(put(1, Some(servo(600)))), Some(put(1, Some(servo(500)))));
        assert_eq!(kept.put(put(1, None)), Some(put(1, Some(servo(600)))));
        assert_eq!((kept.servo(1), kept.heater(1)), (None, None));
    }

    #[test]
    fn a_channel_that_the_board_does_not_have_takes_nothing_in() {
        let mut kept = Kept::<4, 2>::NOTHING;
        assert_eq!(kept.put(Calibration::Servo { channel: 2, known: None }), None);
        assert_eq!(kept.put(Calibration::Heater { channel: u16::MAX, known: None }), None);
        assert_eq!(kept, Kept::NOTHING);
    }
}
