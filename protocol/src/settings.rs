//! What an MCU keeps over power cycles: its limits, lowered to what the rig at hand bears (S13).

use crate::{CentiCelsius, LimitName, Limits, Micros, Milliamps, Millis};
use postcard_schema::Schema;
use serde::{Deserialize, Serialize};

/// What can be set for good. A board never goes beyond what is compiled into it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, Schema)]
pub struct Settings {
    /// What no session can exceed.
    pub ceiling: Limits,
    /// Shortest servo pulse, microseconds.
    pub shortest_pulse_us: u16,
    /// Longest servo pulse, microseconds.
    pub longest_pulse_us: u16,
}

/// In what settings go beyond those of the board.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TooLax {
    /// A limit, with the board's value and the one asked for.
    Limit(LimitName, i64, i64),
    /// The servo pulses: the bound that was passed, and the pulse.
    Pulse(u16, u16),
}

impl Settings {
    /// In what `self` goes beyond `board`, first of all.
    pub fn laxer_than(&self, board: &Self) -> Option<TooLax> {
        if let Some((name, most, ours)) = self.ceiling.laxer_than(&board.ceiling) {
            return Some(TooLax::Limit(name, most, ours));
        }
        if self.shortest_pulse_us < board.shortest_pulse_us {
            return Some(TooLax::Pulse(board.shortest_pulse_us, self.shortest_pulse_us));
        }
        if self.longest_pulse_us > board.longest_pulse_us {
            return Some(TooLax::Pulse(board.longest_pulse_us, self.longest_pulse_us));
        }
        let is_empty = self.shortest_pulse_us > self.longest_pulse_us;
        is_empty.then_some(TooLax::Pulse(self.longest_pulse_us, self.shortest_pulse_us))
    }

    /// The stricter of the two in everything: what was stored holds as far as this board's firmware allows it.
    #[must_use]
    pub fn within(&self, board: &Self) -> Self {
        let (ours, most) = (&self.ceiling, &board.ceiling);
        Self {
            ceiling: Limits {
                max_temperature: CentiCelsius(ours.max_temperature.0.min(most.max_temperature.0)),
                max_on: Millis(ours.max_on.0.min(most.max_on.0)),
                min_rest: Millis(ours.min_rest.0.max(most.min_rest.0)),
                supply: Milliamps(ours.supply.0.min(most.supply.0)),
                link_timeout: Millis(ours.link_timeout.0.min(most.link_timeout.0)),
            },
            shortest_pulse_us: self.shortest_pulse_us.max(board.shortest_pulse_us),
            longest_pulse_us: self.longest_pulse_us.min(board.longest_pulse_us),
        }
    }
}

/// The settings of a board, asked for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, Schema)]
pub struct SettingsReport {
    /// MCU time.
    pub at: Micros,
    /// What holds.
    pub in_force: Settings,
    /// What is compiled into the board, and the most that can be set.
    pub compiled: Settings,
}

#[cfg(test)]
mod tests {
    use super::*;

    const BOARD: Settings = Settings {
        ceiling: Limits {
            max_temperature: CentiCelsius(12_000),
            max_on: Millis(60_000),
            min_rest: Millis(500),
            supply: Milliamps(10_000),
            link_timeout: Millis(5_000),
        },
        shortest_pulse_us: 500,
        longest_pulse_us: 2_500,
    };

    #[test]
    fn settings_as_strict_as_the_board_are_taken_and_laxer_ones_named() {
        assert_eq!(BOARD.laxer_than(&BOARD), None);
        let hot = Limits { max_temperature: CentiCelsius(12_001), ..BOARD.ceiling };
        assert_eq!(
            Settings { ceiling: hot, ..BOARD }.laxer_than(&BOARD),
            Some(TooLax::Limit(LimitName::MaxTemperature, 12_000, 12_001))
        );
        let pulses = |shortest_pulse_us, longest_pulse_us| {
            Settings { shortest_pulse_us, longest_pulse_us, ..BOARD }.laxer_than(&BOARD)
        };
        assert_eq!(pulses(499, 2_000), Some(TooLax::Pulse(500, 499)));
        assert_eq!(pulses(500, 2_501), Some(TooLax::Pulse(2_500, 2_501)));
        assert_eq!(pulses(1_500, 1_500), None);
        assert_eq!(pulses(1_501, 1_500), Some(TooLax::Pulse(1_500, 1_501)), "no pulse is left");
    }

    #[test]
    fn what_was_stored_is_held_to_the_board_in_every_field() {
        let lax = Settings {
            ceiling: Limits {
                max_temperature: CentiCelsius(20_000),
                max_on: Millis(90_000),
                min_rest: Millis(0),
                supply: Milliamps(50_000),
                link_timeout: Millis(9_000),
            },
            shortest_pulse_us: 100,
            longest_pulse_us: 9_000,
        };
        assert_eq!(lax.within(&BOARD), BOARD);
        let strict = Settings {
            ceiling: Limits {
                max_temperature: CentiCelsius(9_000),
                max_on: Millis(1_000),
                min_rest: Millis(900),
                supply: Milliamps(1_000),
                link_timeout: Millis(500),
            },
            shortest_pulse_us: 900,
            longest_pulse_us: 2_100,
        };
        assert_eq!(strict.within(&BOARD), strict);
    }
}
