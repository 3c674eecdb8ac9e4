//! The line between a host and a board, with what can go wrong on it. Virtual time, seeded.
//!
//! ```text
//!   host --send--> Wire --cut, lost, flipped, twice, late, out of turn--> board
//!   host <--take-- Wire <------------------------------------------------ board
//! ```
//!
//! The two directions have nothing in common but the cable: each has its own impairments and its own chance.

use crate::chance::Chance;
use std::collections::VecDeque;
use zygote_protocol::{Micros, Millis};

/// What is wrong with one direction. Probabilities are 0 to 1; a chunk is what one end sends at once.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Impairment {
    /// Every byte arrives this much later.
    pub delay: Millis,
    /// Probability of each byte to be lost.
    pub loss: f64,
    /// Probability of each byte to have one bit turned.
    pub flip: f64,
    /// Probability of each chunk to arrive twice.
    pub duplicate: f64,
    /// Probability of each chunk to change places with the one before it, where that is still on its way.
    pub reorder: f64,
}

impl Impairment {
    /// A good line.
    pub const NONE: Self = Self { delay: Millis(0), loss: 0.0, flip: 0.0, duplicate: 0.0, reorder: 0.0 };
}

/// One direction.
#[derive(Debug)]
pub struct Wire {
    impairment: Impairment,
    cut_until: Micros,
    chance: Chance,
    /// Chunks on their way with the time of their arrival, which never falls from one to the next.
    under_way: VecDeque<(Micros, Vec<u8>)>,
}

impl Wire {
    fn new(seed: u64) -> Self {
        Self {
            impairment: Impairment::NONE,
            cut_until: Micros(0),
            chance: Chance::new(seed),
            under_way: VecDeque::new(),
        }
    }

    /// Changes what is wrong, for what is sent from now on.
    pub fn impair(&mut self, impairment: Impairment) {
        self.impairment = impairment;
    }

    /// Everything sent before `until` is lost, and what is under way too.
    pub fn cut(&mut self, until: Micros) {
        self.cut_until = until;
        self.under_way.clear();
    }

    /// Takes a chunk.
    pub fn send(&mut self, now: Micros, bytes: &[u8]) {
        if now < self.cut_until || bytes.is_empty() {
            return;
        }
        let Impairment { delay, duplicate, reorder, .. } = self.impairment;
        let chunk = self.damaged(bytes);
        let due = self.under_way.back().map_or(Micros(0), |(due, _)| *due).max(now.plus(delay));
        let again = self.happens(duplicate).then(|| chunk.clone());
        self.under_way.push_back((due, chunk));
        if self.happens(reorder)
            && let [.., before, last] = self.under_way.make_contiguous()
        {
            std::mem::swap(&mut before.1, &mut last.1);
        }
        if let Some(again) = again {
            self.under_way.push_back((due, again));
        }
    }

    /// The bytes of a chunk that get through, as they get through.
    fn damaged(&mut self, bytes: &[u8]) -> Vec<u8> {
        let Impairment { loss, flip, .. } = self.impairment;
        let mut chunk = Vec::with_capacity(bytes.len());
        for byte in bytes {
            if self.happens(loss) {
                continue;
            }
            let turned = if self.happens(flip) { 1 << self.chance.below(8) } else { 0 };
            chunk.push(byte ^ turned);
        }
        chunk
    }

    /// A good line asks no chance, so that it costs nothing.
    fn happens(&mut self, probability: f64) -> bool {
        probability > 0.0 && self.chance.happens(probability)
    }

    /// When the next chunk arrives.
    pub fn next_arrival(&self) -> Option<Micros> {
        self.under_way.front().map(|(due, _)| *due)
    }

    /// The next chunk that has arrived by `now`.
    pub fn take(&mut self, now: Micros) -> Option<Vec<u8>> {
        self.next_arrival().filter(|due| *due <= now)?;
        self.under_way.pop_front().map(|(_, chunk)| chunk)
    }
}

/// Both directions.
#[derive(Debug)]
pub struct Line {
    /// From the host.
    pub to_board: Wire,
    /// From the board.
    pub to_host: Wire,
}

impl Line {
    /// A good line whose chance comes from a seed.
    pub fn new(seed: u64) -> Self {
        let mut seeds = Chance::new(seed);
        Self { to_board: Wire::new(seeds.bits()), to_host: Wire::new(seeds.bits()) }
    }

    /// The host is gone: nothing more from it, ever, and nobody to hear the board.
    pub fn kill_host(&mut self) {
        self.to_board.cut(Micros(u64::MAX));
        self.to_host.cut(Micros(u64::MAX));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const CHUNK: [u8; 4] = [1, 2, 3, 4];

    fn wire(impairment: Impairment) -> Wire {
        let mut wire = Wire::new(3);
        wire.impair(impairment);
        wire
    }

    fn arrived(wire: &mut Wire, now: Micros) -> Vec<u8> {
        std::iter::from_fn(|| wire.take(now)).flatten().collect()
    }

    #[test]
    fn a_good_line_brings_everything_at_once_and_in_order() {
        let mut wire = wire(Impairment::NONE);
        wire.send(Micros(5), &CHUNK);
        wire.send(Micros(5), &[5]);
        assert_eq!(arrived(&mut wire, Micros(5)), [1, 2, 3, 4, 5]);
    }

    #[test]
    fn a_delayed_chunk_comes_later_and_not_before() {
        let mut wire = wire(Impairment { delay: Millis(3), ..Impairment::NONE });
        wire.send(Micros(1_000), &CHUNK);
        assert_eq!(wire.next_arrival(), Some(Micros(4_000)));
        assert!(arrived(&mut wire, Micros(3_999)).is_empty());
        assert_eq!(arrived(&mut wire, Micros(4_000)), CHUNK);
    }

    #[test]
    fn a_shorter_delay_lets_nothing_overtake() {
        let mut wire = wire(Impairment { delay: Millis(3), ..Impairment::NONE });
        wire.send(Micros(0), &[1]);
        wire.impair(Impairment::NONE);
        wire.send(Micros(1_000), &[2]);
        assert!(arrived(&mut wire, Micros(1_000)).is_empty());
        assert_eq!(arrived(&mut wire, Micros(3_000)), [1, 2]);
    }

    #[test]
    fn a_cut_loses_what_is_sent_before_it_ends_and_what_is_under_way() {
        let mut wire = wire(Impairment { delay: Millis(3), ..Impairment::NONE });
        wire.send(Micros(0), &[1]);
        wire.cut(Micros(10_000));
        wire.send(Micros(9_999), &[2]);
        wire.send(Micros(10_000), &[3]);
        assert_eq!(arrived(&mut wire, Micros(20_000)), [3]);
    }

    #[test]
    fn bytes_are_lost_and_bits_turned_as_often_as_asked() {
        let mut wire = wire(Impairment { loss: 0.1, flip: 0.2, ..Impairment::NONE });
        wire.send(Micros(0), &vec![0; 100_000]);
        let bytes = arrived(&mut wire, Micros(0));
        // Ten standard deviations of a binomial distribution.
        assert!(bytes.len().abs_diff(90_000) < 950, "{} arrived", bytes.len());
        let flipped = bytes.iter().filter(|byte| byte.is_power_of_two()).count();
        assert!(flipped.abs_diff(18_000) < 1_250, "{flipped} turned");
        assert!(bytes.iter().all(|byte| byte.count_ones() <= 1));
    }

    #[test]
    fn chunks_come_twice_or_out_of_turn() {
        let mut twice = wire(Impairment { duplicate: 1.0, ..Impairment::NONE });
        twice.send(Micros(0), &[1, 2]);
        assert_eq!(arrived(&mut twice, Micros(0)), [1, 2, 1, 2]);
        let mut turned = wire(Impairment { reorder: 1.0, delay: Millis(1), ..Impairment::NONE });
        turned.send(Micros(0), &[1, 2]);
        turned.send(Micros(500), &[3]);
        assert_eq!(arrived(&mut turned, Micros(2_000)), [3, 1, 2]);
    }

    #[test]
    fn a_killed_host_is_not_heard_and_hears_nothing() {
        let mut line = Line::new(1);
        line.kill_host();
        line.to_board.send(Micros(1), &CHUNK);
        line.to_host.send(Micros(1), &CHUNK);
        assert_eq!((line.to_board.take(Micros(9)), line.to_host.take(Micros(9))), (None, None));
    }

    #[test]
    fn a_seed_gives_the_same_damage() {
        let damage = |seed| {
            let mut line = Line::new(seed);
            line.to_board.impair(Impairment { loss: 0.3, flip: 0.3, ..Impairment::NONE });
            line.to_board.send(Micros(0), &[9; 100]);
            line.to_board.take(Micros(0))
        };
        assert_eq!(damage(5), damage(5));
        assert_ne!(damage(5), damage(6));
    }
}
