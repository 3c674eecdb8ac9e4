//! A simulator that people can watch: its clock goes no faster than theirs, or than so many times theirs.

use std::io;
use std::thread;
use std::time::{Duration, Instant};
use zygote_controller::Transport;
use zygote_protocol::Micros;

/// How long it sleeps at a time: a stop waits no longer than this.
const NAP: Duration = Duration::from_millis(2);
/// What was missed by more than this isn't made up for: the simulator was kept waiting.
const MOST_BEHIND: Duration = Duration::from_millis(100);

/// A simulator in real time.
pub(crate) struct RealTime<T> {
    simulator: T,
    /// Simulated seconds in a second.
    pace: f64,
    /// When it was what time there.
    since: (Instant, Micros),
}

impl<T: Transport> RealTime<T> {
    pub(crate) fn new(simulator: T, pace: f64) -> Self {
        let since = (Instant::now(), simulator.now());
        Self { simulator, pace, since }
    }

    /// The simulator, for a look at the truth.
    pub(crate) fn into_inner(self) -> T {
        self.simulator
    }

    /// Simulated time that corresponds to a time.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a run is far shorter than 2^63 us"
    )]
    fn simulated(&self, time: Duration) -> u64 {
        (time.as_secs_f64() * 1e6 * self.pace) as u64
    }

    /// The time there that the clock on the wall allows.
    fn allowed(&mut self) -> Micros {
        let (begin, then) = self.since;
        let allowed = Micros(then.0 + self.simulated(begin.elapsed()));
        let behind = allowed.since(self.simulator.now());
        if behind > self.simulated(MOST_BEHIND) {
            self.since = (Instant::now(), self.simulator.now());
            return Micros(self.simulator.now().0 + self.simulated(NAP));
        }
        allowed
    }
}

impl<T: Transport> Transport for RealTime<T> {
    fn now(&self) -> Micros {
        self.simulator.now()
    }

    fn send(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.simulator.send(bytes)
    }

    fn receive(&mut self, buffer: &mut [u8], deadline: Micros) -> io::Result<usize> {
        loop {
            let until = self.allowed().min(deadline);
            let received = self.simulator.receive(buffer, until)?;
            if received > 0 || self.simulator.now() >= deadline {
                return Ok(received);
            }
            thread::sleep(NAP);
        }
    }

    fn name(&self) -> String {
        self.simulator.name()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A clock with nobody at the other end.
    struct Silent(Micros);

    impl Transport for Silent {
        fn now(&self) -> Micros {
            self.0
        }
        fn send(&mut self, _: &[u8]) -> io::Result<()> {
            Ok(())
        }
        fn receive(&mut self, _: &mut [u8], deadline: Micros) -> io::Result<usize> {
            self.0 = self.0.max(deadline);
            Ok(0)
        }
        fn name(&self) -> String {
            "nobody".to_owned()
        }
    }

    #[test]
    fn simulated_time_goes_no_faster_than_asked() {
        let mut line = RealTime::new(Silent(Micros(0)), 20.0);
        let begin = Instant::now();
        assert_eq!(line.receive(&mut [0; 8], Micros(1_000_000)).ok(), Some(0));
        assert!(begin.elapsed() >= Duration::from_millis(50), "{:?}", begin.elapsed());
        assert_eq!(line.now(), Micros(1_000_000));
    }

    #[test]
    fn time_in_which_nobody_listened_is_not_made_up_for() {
        let mut line = RealTime::new(Silent(Micros(0)), 1.0);
        thread::sleep(2 * MOST_BEHIND);
        let begin = Instant::now();
        assert_eq!(line.receive(&mut [0; 8], Micros(50_000)).ok(), Some(0));
        assert!(begin.elapsed() >= Duration::from_millis(40), "{:?}", begin.elapsed());
    }
}
