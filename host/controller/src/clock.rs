//! The MCU's clock as seen from the host: offset and rate, by regression over request/response pairs.
//!
//! ```text
//!   host  ---sent------------received--->        the MCU's time belongs to some moment between the two;
//!              \              /                  the middle is off by half the round trip at most
//!   MCU   ------+---- mcu ---+---------->
//! ```
//!
//! A pair counts by the inverse square of its round trip, so that one that waited in a queue or went out twice says
//! next to nothing.

use serde::{Deserialize, Serialize};
use std::collections::VecDeque;
use zygote_protocol::Micros;

/// Pairs that the regression looks at: the newest.
const KEPT: usize = 256;
/// Pairs must be spread over so much time before they tell a rate.
const LEAST_SPAN_US: f64 = 2_000_000.0;
/// Neither end tells time finer; keeps the weight of a round trip of nothing finite.
const RESOLUTION_US: f64 = 20.0;

/// A question for the time and its answer.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Exchange {
    /// Host time at which the question was put.
    pub sent: Micros,
    /// Host time at which the answer was there.
    pub received: Micros,
    /// MCU time in the answer.
    pub mcu: Micros,
}

/// Pairs seen so far.
#[derive(Debug, Clone, Default)]
pub struct Clock {
    exchanges: VecDeque<Exchange>,
}

/// The line through them: MCU time = host time + offset + rate x (host time - reference).
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct ClockFit {
    /// Host time at which the offset holds, us.
    pub reference_us: u64,
    /// MCU time less host time there, us.
    pub offset_us: f64,
    /// How much faster the MCU's clock runs than the host's, millionths; 0 until enough time has passed to tell.
    pub rate_ppm: f64,
    /// How far the pairs are off the line, us: the root of the weighted mean square.
    pub residual_us: f64,
    /// Pairs that it is made of.
    pub exchanges: usize,
}

impl Clock {
    /// A clock of which nothing is known.
    pub fn new() -> Self {
        Self::default()
    }

    /// Takes a pair. One that ends before it began, or whose MCU time runs backwards, is none of this clock.
    pub fn add(&mut self, exchange: Exchange) {
        let backwards = self.exchanges.back().is_some_and(|last| exchange.mcu < last.mcu);
        if exchange.received < exchange.sent || backwards {
            return;
        }
        if self.exchanges.len() == KEPT {
            self.exchanges.pop_front();
        }
        self.exchanges.push_back(exchange);
    }

    /// The line through the pairs; `None` before the first.
    pub fn fit(&self) -> Option<ClockFit> {
        let reference = self.exchanges.front()?.sent;
        // x: host time since the reference; y: how far the MCU's clock is ahead; w: weight.
        let points: Vec<(f64, f64, f64)> = self.exchanges.iter().map(|pair| point(pair, reference)).collect();
        let weight: f64 = points.iter().map(|(_, _, w)| w).sum();
        let mean_x = points.iter().map(|(x, _, w)| w * x).sum::<f64>() / weight;
        let mean_y = points.iter().map(|(_, y, w)| w * y).sum::<f64>() / weight;
        let spread: f64 = points.iter().map(|(x, _, w)| w * (x - mean_x).powi(2)).sum();
        let lean: f64 = points.iter().map(|(x, y, w)| w * (x - mean_x) * (y - mean_y)).sum();
        let span = points.last().map_or(0.0, |(x, _, _)| *x);
        let rate = if span >= LEAST_SPAN_US && spread > 0.0 { lean / spread } else { 0.0 };
        let offset_us = mean_y - rate * mean_x;
        let square: f64 = points.iter().map(|(x, y, w)| w * (y - offset_us - rate * x).powi(2)).sum();
        Some(ClockFit {
            reference_us: reference.0,
            offset_us,
            rate_ppm: rate * 1e6,
            residual_us: (square / weight).sqrt(),
            exchanges: points.len(),
        })
    }
}

fn point(pair: &Exchange, reference: Micros) -> (f64, f64, f64) {
    let trip = micros(pair.received.since(pair.sent));
    let x = micros(pair.sent.since(reference)) + trip / 2.0;
    // The difference first, in whole microseconds: both may be large.
    let ahead = difference(pair.mcu.0, pair.sent.0) - trip / 2.0;
    (x, ahead, (trip + RESOLUTION_US).powi(-2))
}

impl ClockFit {
    /// Host time of an MCU time, us; before the host's start it is negative.
    pub fn host_from_mcu(&self, mcu: Micros) -> f64 {
        let since = (difference(mcu.0, self.reference_us) - self.offset_us) / (1.0 + self.rate_ppm / 1e6);
        micros(self.reference_us) + since
    }
}

#[expect(clippy::cast_precision_loss, reason = "2^52 us are 142 years")]
fn micros(us: u64) -> f64 {
    us as f64
}

fn difference(a: u64, b: u64) -> f64 {
    if a >= b { micros(a - b) } else { -micros(b - a) }
}

#[cfg(test)]
mod checks {
    use super::*;

    /// A clock that is `rate_ppm` too fast and was switched on `before_us` before the host.
    #[derive(Clone, Copy)]
    struct Crystal {
        rate_ppm: f64,
        before_us: f64,
    }

    impl Crystal {
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "a test's times are small"
        )]
        fn at(self, host_us: f64) -> Micros {
            Micros(((host_us + self.before_us) * (1.0 + self.rate_ppm / 1e6)) as u64)
        }
    }

    /// A pair a second over a line with jitter to both sides; now and then one waits long on one side only.
    fn watch(crystal: Crystal, seconds: u32, seed: u64) -> Clock {
        let (mut clock, mut random) = (Clock::new(), seed | 1);
        let mut chance = || {
            random ^= random << 13;
            random ^= random >> 7;
            random ^= random << 17;
            micros(random >> 32) / micros(1 << 32)
        };
        for second in 0..seconds {
            let sent = 1e6 * f64::from(second) + 5e5;
            let stuck = if chance() < 0.1 { 300_000.0 * chance() } else { 0.0 };
            let (there, back) = (400.0 + 1_500.0 * chance() + stuck, 400.0 + 1_500.0 * chance());
            #[expect(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                reason = "a test's times are small"
            )]
            let host = |us: f64| Micros(us as u64);
            clock.add(Exchange {
                sent: host(sent),
                received: host(sent + there + back),
                mcu: crystal.at(sent + there),
            });
        }
        clock
    }

    #[test]
    fn a_clock_that_drifts_by_200_ppm_is_seen_through_a_jittery_line() {
        for (seed, rate_ppm) in [(1, 200.0), (2, -200.0), (3, 0.0), (4, 35.0)] {
            let crystal = Crystal { rate_ppm, before_us: 3.7e9 };
            let fit = watch(crystal, 120, seed).fit().unwrap();
            assert!((fit.rate_ppm - rate_ppm).abs() < 5.0, "seed {seed}: {fit:?}");
            assert!(fit.residual_us < 1_000.0, "seed {seed}: {fit:?}");
            for host_us in [0.0, 60e6, 120e6, 180e6] {
                let error = fit.host_from_mcu(crystal.at(host_us)) - host_us;
                assert!(error.abs() < 700.0, "seed {seed}: off by {error} us at {host_us}");
            }
        }
    }

    #[test]
    fn a_single_pair_tells_the_offset_within_half_its_round_trip_and_no_rate() {
        let mut clock = Clock::new();
        clock.add(Exchange { sent: Micros(1_000), received: Micros(3_000), mcu: Micros(502_700) });
        let fit = clock.fit().unwrap();
        assert_eq!((fit.rate_ppm, fit.exchanges), (0.0, 1));
        assert!((fit.host_from_mcu(Micros(502_700)) - 2_000.0).abs() < 1e-6);
    }

    #[test]
    fn a_board_that_was_switched_on_after_the_host_has_a_clock_too() {
        let crystal = Crystal { rate_ppm: 100.0, before_us: -4e5 };
        let fit = watch(crystal, 60, 5).fit().unwrap();
        assert!((fit.rate_ppm - 100.0).abs() < 5.0, "{fit:?}");
        assert!((fit.offset_us + 4e5).abs() < 1_000.0, "{fit:?}");
    }

    #[test]
    fn pairs_that_cannot_be_are_not_taken() {
        let mut clock = Clock::new();
        assert_eq!(clock.fit(), None);
        clock.add(Exchange { sent: Micros(10), received: Micros(5), mcu: Micros(1) });
        assert_eq!(clock.fit(), None);
        clock.add(Exchange { sent: Micros(10), received: Micros(15), mcu: Micros(100) });
        clock.add(Exchange { sent: Micros(20), received: Micros(25), mcu: Micros(99) });
        assert_eq!(clock.fit().unwrap().exchanges, 1);
    }
}
