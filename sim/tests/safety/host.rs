//! The host of the tests on a simulated board, and the steps of its servo and its spring.

use crate::link_host::{Host as LinkHost, TestBoard};
pub(crate) use crate::link_host::{LIMITS, RIG, heat};
use zygote_protocol::{
    Action, Channels, Command, Milliamps, Millis, Release, Reply, ResetCause, Step, StepState, Turn,
};
use zygote_sim::Board;
use zygote_sim::plant::{Config, Plant, ServoConfig, SmaConfig, SpringConfig};

pub(crate) type Host = LinkHost<Board>;

/// A rig of four SMA hinges, a servo and a spring.
pub(crate) fn plant() -> Config {
    Config {
        heaters: vec![SmaConfig::opening(90.0); 4],
        servos: vec![ServoConfig::default()],
        springs: vec![SpringConfig::opening(180.0)],
        seed: 7,
        ..Config::default()
    }
}

pub(crate) const CHANNELS: Channels = Channels { heaters: 4, servos: 1, springs: 1 };

pub(crate) fn turn(hinge: u16, after: &[u16]) -> Step {
    let action = Action::Turn(Turn {
        channel: 0,
        from_us: 500,
        to_us: 1_500,
        duration: Millis(1_000),
        settle: Millis(300),
        current: Milliamps(300),
        hold_current: Milliamps(10),
    });
    Step { hinge, after: after.iter().copied().collect(), action }
}

pub(crate) fn release(hinge: u16, after: &[u16]) -> Step {
    let action = Action::Release(Release {
        channel: 0,
        pulse: Millis(1_200),
        settle: Millis(500),
        current: Milliamps(1_000),
    });
    Step { hinge, after: after.iter().copied().collect(), action }
}

impl TestBoard for Board {
    fn plant(&self) -> &Plant {
        Board::plant(self)
    }

    /// By the outputs.
    fn is_all_off(&self) -> bool {
        let outputs = self.core().outputs();
        !outputs.main_switch
            && outputs.heaters.iter().all(|duty| duty.per_mille() == 0)
            && outputs.servos.iter().all(Option::is_none)
            && outputs.springs.iter().all(|on| !on)
    }
}

impl Host {
    /// Connected to a board on this plant.
    pub(crate) fn new(plant: &Config) -> Self {
        let mut host = Self::of(Board::new(plant, CHANNELS, 1).unwrap());
        host.connect(77);
        host
    }

    /// Why the MCU says that it started.
    pub(crate) fn reset_cause(&self) -> Option<ResetCause> {
        self.identity.as_ref().map(|identity| identity.reset)
    }

    pub(crate) fn step_states(&mut self) -> Vec<StepState> {
        match self.ask(Command::Progress { first: 0 }) {
            Ok(Reply::Progress { steps, .. }) => steps.iter().copied().collect(),
            other => panic!("{other:?}"),
        }
    }
}
